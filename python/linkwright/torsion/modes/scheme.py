r"""The equivalent scheme of a train: inertias and stiffnesses as they are, and referred to its first disc.

With n the speed of a disc over that of the first, inertias and stiffnesses count by n². A shaft of stiffness
k twists like a solid one of one diameter d and the *equivalent length*

.. math:: L_e = \frac{G\,\pi d^4}{32\,n^2 k}

so that a scheme drawn with these lengths shows where a train is soft.

References
----------
.. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 1, 1956, chapters 2 and 3.
.. [2] Den Hartog, Mechanical Vibrations, 4th ed. 1956, section 5.3.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import LENGTH
from linkwright.kernel.units.marks import positive
from linkwright.machine.machine import Machine
from linkwright.torsion.core.train import HELD, ReferredTrain, refer
from linkwright.torsion.excitation.drive_line import train_of
from linkwright.torsion.model.train import GROUND, Train
from linkwright.torsion.modes.free import own_stiffness

Kind = Literal["shaft", "coupling", "mesh", "gears", "bearing", "clutch", "damper", "pendulum"]

# Shear modulus of the shaft of equivalent lengths: steel.
_SHEAR_MODULUS = 79.3e9


class Connection(NamedTuple):
    """What joins two discs, or a disc with the ground.

    Attributes
    ----------
    name : str
        Of the shaft, the gear stage, the coupling or the damper.
    kind : str
        ``"shaft"``, ``"coupling"``, ``"mesh"`` (elastic gears), ``"gears"`` (rigid), ``"bearing"`` (of a gear
        on its carrier), ``"clutch"`` (or a freewheel) or ``"damper"``.
    first, second : str
        Discs, or ``"ground"``.
    ratio : float
        Speed of the first over that of the second.
    stiffness, stiffness_referred : float or None
        At its own speed, of a mesh at its first disc; referred. None of rigid gears, and of a fluid
        [N m/rad].
    equivalent_length : float or None
        Of the shaft of the scheme's diameter [m].
    """

    name: str
    kind: Kind
    first: str
    second: str
    ratio: float
    stiffness: float | None = None
    stiffness_referred: float | None = None
    equivalent_length: float | None = None

    @property
    def is_geared(self) -> bool:
        """Whether its ends are on two lines of shafts."""
        return self.kind in ("gears", "mesh", "bearing") and self.second != GROUND


@dataclass(frozen=True)
class Scheme(Result):
    """A train referred to the speed of its first disc."""

    discs: Annotated[tuple[str, ...], About("Discs in the order of the file; rings of dampers last.")]
    speed: Annotated[Floats, Label("speed of each disc over that of the first", "n", "", shape="(discs,)")]
    inertia: Annotated[
        Floats, Label("moment of inertia of each disc", "J", "kg m²", "At its own speed.", shape="(discs,)")
    ]
    inertia_referred: Annotated[
        Floats, Label("referred moment of inertia of each disc", "n² J", "kg m²", shape="(discs,)")
    ]
    connections: Annotated[tuple[Connection, ...], About("Shafts, couplings and dampers, then gear stages.")]
    diameter: Annotated[float, Label("diameter of the solid steel shaft of the equivalent lengths", "", "m")]

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """As of any result, each connection by the names of its entries."""
        results = super().to_dict(curves=curves)
        return results | {"connections": [part._asdict() for part in self.connections]}


@public
def scheme(machine: Machine, *, diameter: float = 0.1) -> Scheme:
    """The equivalent scheme of a train.

    Parameters
    ----------
    machine : Machine
        With a [train], or a [drive] that twists.
    diameter : float
        Of the shaft of the equivalent lengths [m].

    Returns
    -------
    Scheme
        Own and referred numbers.

    Raises
    ------
    InputError
        The machine has no train, or the diameter is not greater than 0.
    AssemblyError
        The mechanism behind a driveline does not close all round.
    """
    in_range(diameter=(diameter, positive(LENGTH)))
    train = train_of(machine)
    referred = refer(train)
    inertia = np.array([disc.inertia for disc in train.discs.values()])
    return Scheme(
        discs=referred.discs,
        speed=referred.speed,
        inertia=inertia,
        inertia_referred=referred.scale**2 * inertia,
        connections=(*_twisting(machine, train, referred, diameter), *_rigid(train), *_bearings(train)),
        diameter=float(diameter),
    )


def _twisting(
    machine: Machine, train: Train, referred: ReferredTrain, diameter: float
) -> Iterator[Connection]:
    own = own_stiffness(referred)
    GI = _SHEAR_MODULUS * math.pi * diameter**4 / 32
    for n, name in enumerate(referred.shafts):
        first, second = (GROUND if end == HELD else referred.discs[end] for end in referred.tip[n])
        gear = train.gears.get(name)
        ratio = 1.0 if gear is None else abs(gear.speed_ratio)
        kind = _kind(machine, train, name)
        if referred.stiffness[n] > 0:
            k = float(referred.stiffness[n])
            # The stiffness of a pendulum is that of centrifugal force: no shaft has it.
            length = None if kind == "pendulum" else GI / k
            yield Connection(name, kind, first, second, ratio, float(own[n]), k, length)
        else:
            yield Connection(name, kind, first, second, ratio)


def _kind(machine: Machine, train: Train, name: str) -> Kind:
    if name in train.gears:
        return "mesh"
    described = machine.train
    if described is not None and name in described.couplings:
        return "coupling"
    if described is not None and name in described.pendulums:
        return "pendulum"
    return "damper" if described is not None and name in described.dampers else "shaft"


def _rigid(train: Train) -> Iterator[Connection]:
    for name, gear in train.gears.items():
        if gear.stiffness is None:
            yield Connection(name, "gears", *gear.between, abs(gear.speed_ratio))
    for name, pair in train.coaxial.items():
        yield Connection(name, "clutch", *pair, 1.0)


def _bearings(train: Train) -> Iterator[Connection]:
    """Those of gears on a carrier, each once."""
    carried = {gear.between[-1]: gear.carrier for gear in train.gears.values() if gear.carrier is not None}
    for gear, carrier in carried.items():
        if gear != GROUND:
            yield Connection(f"{gear}_bearing", "bearing", gear, carrier, 1.0)
