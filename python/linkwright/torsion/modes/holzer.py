r"""Holzer's table of a train at any frequency.

Every disc is carried through the angle θ at the frequency ω; all are in equilibrium but one, which needs an
external torque, the *residual*:

.. math:: (K - \omega^2 J)\,\theta = -e_r M_r, \qquad \theta_1 = 1

For a free chain that is the sum of all :math:`J\omega^2\theta` at its end. A natural frequency is where it is
zero. A shaft whose inertia is distributed is, at the frequency, a spring with an inertia at each end, which
counts with its disc: exactly, but with other numbers at every frequency.

References
----------
.. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, section 5.4.
.. [2] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 1, 1956, chapter 4: branched
trains.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import FindingError, InputError, UnitError, cut
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import FREQUENCY, SPEED
from linkwright.kernel.units.marks import not_negative
from linkwright.kernel.units.reading import parse
from linkwright.machine.machine import Machine
from linkwright.torsion.core.distributed import lossless
from linkwright.torsion.core.train import HELD, ReferredTrain, refer
from linkwright.torsion.excitation.drive_line import train_of
from linkwright.torsion.model.train import Train
from linkwright.torsion.modes.free import FreeVibration, own_stiffness, twists_of


@dataclass(frozen=True)
class HolzerTable(Result):
    """The state of a train that swings at one frequency."""

    frequency: Annotated[float, Label("frequency of the swing", "ω/2π", "Hz")]
    discs: Annotated[tuple[str, ...], About("Discs in the order of the file.")]
    inertia: Annotated[Floats, Label("moment of inertia of each disc", "J", "kg m²", shape="(discs,)")]
    inertia_squared: Annotated[
        Floats, Label("inertia times the square of the frequency", "J ω²", "N m/rad", shape="(discs,)")
    ]
    amplitude: Annotated[
        Floats, Label("angle of each disc", "θ", "rad", "1 at the first disc.", shape="(discs,)")
    ]
    torque: Annotated[
        Floats,
        Label("inertia torque of each disc", "J ω² θ", "N m", "At the speed of the disc.", shape="(discs,)"),
    ]
    shafts: Annotated[tuple[str, ...], About("Shafts, then elastic meshes.")]
    stiffness: Annotated[Floats, Label("stiffness of each shaft", "k", "N m/rad", shape="(shafts,)")]
    twist: Annotated[
        Floats,
        Label(
            "twist of each shaft",
            "Δ",
            "rad",
            "Angle of the first end less that of the second.",
            shape="(shafts,)",
        ),
    ]
    shaft_torque: Annotated[
        Floats,
        Label(
            "torque in each shaft",
            "k Δ",
            "N m",
            "In a chain the sum of all torques before it.",
            shape="(shafts,)",
        ),
    ]
    end: Annotated[str, About("Disc that is not in equilibrium.")]
    residual_torque: Annotated[
        float, Label("residual torque at the end", "", "N m", "Zero at a natural frequency.")
    ]


@public
def holzer_table(machine: Machine, frequency: float, *, end: str | None = None) -> HolzerTable:
    """Holzer's table of a train.

    Parameters
    ----------
    machine : Machine
        With a [train].
    frequency : float
        At which it swings [Hz].
    end : str, optional
        Disc where the residual is; without it, the last of the file.

    Returns
    -------
    HolzerTable
        Amplitudes and torques.

    Raises
    ------
    InputError
        The machine has no train, the frequency is negative, or there is no such disc.
    FindingError
        The first disc is at rest at this frequency whatever acts on the end.

    References
    ----------
    .. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, section 5.4.
    """
    train = train_of(machine)
    in_range(frequency=(frequency, not_negative(FREQUENCY)))
    end = _last(train) if end is None else end
    if end not in train.discs:
        remedy = suggestion(end, train.discs)
        raise InputError(
            f'end: found "{end}", expected the name of a disc' + (f"; {remedy}" if remedy else "")
        )
    referred, omega = refer(train), 2 * math.pi * frequency
    J = np.array([disc.inertia for disc in train.discs.values()])
    if referred.rods:
        referred, J = _at_frequency(referred, J, omega)
    last = referred.discs.index(end)
    q, residual = _state(referred, omega**2, int(referred.mass[last]))
    theta = referred.scale * q[referred.mass]
    k, twist = own_stiffness(referred), twists_of(referred, theta)
    return HolzerTable(
        frequency=float(frequency),
        discs=referred.discs,
        inertia=J,
        inertia_squared=J * omega**2,
        amplitude=theta,
        torque=J * omega**2 * theta,
        shafts=referred.shafts,
        stiffness=k,
        twist=twist,
        shaft_torque=k * twist,
        end=end,
        residual_torque=residual / float(referred.scale[last]),
    )


def _at_frequency(referred: ReferredTrain, J: Floats, omega: float) -> tuple[ReferredTrain, Floats]:
    """A train whose rods are springs with inertias at their ends, and the inertia of its discs."""
    at = lossless(referred, np.array([omega]))
    J = J.copy()
    for rod, one in zip(referred.rods, at.rods, strict=True):
        for disc, end, lumped in zip(referred.tip[rod.shaft], (one.first, one.second), rod.ends, strict=True):
            if disc != HELD:
                J[disc] += (float(end[0].real) - lumped) / referred.speed[disc] ** 2
    return replace(referred, stiffness=at.stiffness.real[:, 0], inertia=at.inertia.real[:, 0]), J


def holzer_frequency(asked: float | str, free: FreeVibration) -> float:
    """A frequency [Hz] from a number, a text with the unit of a frequency or speed, or f_3 of the train."""
    if not isinstance(asked, str):
        return asked
    text = asked.strip()
    if match := re.fullmatch(r"f_?(\d+)", text):
        mode, last = int(match[1]), len(free.natural_frequencies) - 1
        if mode > last:
            raise InputError(f'holzer: found "{text}", expected a natural frequency, f_0 to f_{last}')
        return float(free.natural_frequencies[mode])
    expected = 'a frequency such as 45 (in Hz), "20 rad/s", "300 rpm" or f_1'
    wrong = InputError(f'holzer: found "{cut(text)}", expected {expected}')
    try:
        is_speed = _OF_SPEED.search(text) is not None
        frequency = parse(text, SPEED) / (2 * math.pi) if is_speed else _hertz(text)
    except UnitError:
        raise wrong from None
    if not math.isfinite(frequency):
        raise wrong
    return frequency


# Radians and revolutions are no cycles per second, though both are numbers per time.
_OF_SPEED = re.compile(r"rad|rev|r/|rpm|1/min", re.IGNORECASE)


def _hertz(text: str) -> float:
    """A frequency; a number alone is in hertz."""
    try:
        return float(text)
    except ValueError:
        return parse(text, FREQUENCY)


def _last(train: Train) -> str:
    """Last disc of a file; rings held by a fluid alone do not count, since nothing follows from them."""
    loose = {end for shaft in train.shafts.values() if shaft.stiffness == 0 for end in shaft.between[1:]}
    return [name for name in train.discs if name not in loose][-1]


def _state(referred: ReferredTrain, square: float, end: int) -> tuple[Floats, float]:
    """Angles of the masses, 1 at the first, and the residual torque at one of them."""
    dynamic = referred.stiffness_matrix - square * np.diag(referred.inertia)
    # The first angle is known, and the residual takes its column.
    system = dynamic.copy()
    scale = float(np.abs(dynamic).max()) or 1.0
    system[:, 0] = 0.0
    system[end, 0] = scale
    # Rows are brought to one size, so that what is solved does not depend on units.
    size = np.abs(system).max(axis=1)
    if not size.all() or 1 / np.linalg.cond(system / size[:, None]) < 1e-13:
        raise FindingError(
            f"at {math.sqrt(square) / (2 * math.pi):.6g} Hz the first disc is at rest whatever acts on the "
            "end; take another end"
        )
    angles: Floats = np.asarray(np.linalg.solve(system, -dynamic[:, 0]), dtype=float)
    residual = float(angles[0]) * scale
    angles[0] = 1.0
    return angles, residual
