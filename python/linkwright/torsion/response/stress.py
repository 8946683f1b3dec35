r"""Shear stress in the shafts of a train, and what is permitted there.

With the torque T of a shaft, mean :math:`T_m`, and its section modulus :math:`W_p`,

.. math:: \tau_m = K \frac{|T_m|}{W_p}, \qquad \tau_v = K \frac{T_{max} - T_{min}}{2 W_p}, \qquad
    \tau_{max} = K \frac{\max|T|}{W_p}

where all orders have been added up in phase and K is the stress concentration that limits ask for, 1 for the
nominal stresses of rules. The torque is all that the shaft carries, elastic and damping part: hysteresis is
in the steel.

References
----------
.. [1] IACS, UR M68, 2021: half the peak-to-peak stress.
.. [2] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963: stresses in shafts.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import SPEED
from linkwright.kernel.units.marks import positive
from linkwright.machine.machine import Machine
from linkwright.torsion.excitation.drive_line import steady_speed, train_of
from linkwright.torsion.excitation.excited_train import excited_train
from linkwright.torsion.model.drive_train import CRANK
from linkwright.torsion.model.shaft_limit import ShaftLimit, StressedSection
from linkwright.torsion.model.shaft_row import RodPiece
from linkwright.torsion.model.train import Shaft
from linkwright.torsion.model.whole_train import RodShaft
from linkwright.torsion.model.whole_train import speeds as turning
from linkwright.torsion.response.forced import TorsionResponse, torsion_response


@dataclass(frozen=True)
class ShaftStress(Result):
    """Stresses in those shafts of which a section is known.

    Not finite at a resonance without any damping.
    """

    speeds: Annotated[Floats, Label("speed of the first disc", "ω", "rad/s", shape="(speeds,)")]
    shafts: Annotated[tuple[str, ...], About("Shafts with sections, or with a section in their limit.")]
    section_modulus: Annotated[
        Floats,
        Label("section modulus of each shaft", "W", "m³", "Torque per nominal stress.", shape="(shafts,)"),
    ]
    concentration: Annotated[Floats, Label("stress concentration of each shaft", "K", "", shape="(shafts,)")]
    mean: Annotated[Floats, Label("mean stress of each shaft", "", "Pa", shape="(shafts, speeds)")]
    vibratory: Annotated[
        Floats,
        Label(
            "vibratory stress of each shaft",
            "τ",
            "Pa",
            "Of half the range of the torque.",
            shape="(shafts, speeds)",
        ),
    ]
    greatest: Annotated[
        Floats,
        Label("maximum stress of each shaft", "", "Pa", "Of the largest torque.", shape="(shafts, speeds)"),
    ]
    continuous: Annotated[
        Floats,
        Label(
            "stress permitted in continuous operation",
            "τ_C",
            "Pa",
            "Vibratory; NaN where nothing is said.",
            shape="(shafts, speeds)",
        ),
    ]
    transient: Annotated[
        Floats,
        Label(
            "stress permitted in transient passage",
            "τ_T",
            "Pa",
            "Vibratory; NaN where nothing is said.",
            shape="(shafts, speeds)",
        ),
    ]

    @property
    def utilisation(
        self,
    ) -> Annotated[Floats, Label("vibratory over permitted stress", "", "", shape="(shafts, speeds)")]:
        """Vibratory stress over that permitted in continuous operation, shape (shafts, speeds)."""
        return self.vibratory / self.continuous


@public
def shaft_stress(
    machine: Machine, response: TorsionResponse | None = None, service: float | None = None
) -> ShaftStress:
    """Stresses in the shafts of a train over its speeds.

    Parameters
    ----------
    machine : Machine
        With a [train] that something excites.
    response : TorsionResponse, optional
        What its shafts carry, as `forced_vibration` tells, if that is there already.
    service : float, optional
        Speed of the first disc that λ = 1 stands for; without it that of `service_speed` [rad/s].

    Returns
    -------
    ShaftStress
        Without shafts of which no section is known.

    Raises
    ------
    InputError
        Nothing excites the train, or it has no speeds.

    References
    ----------
    .. [1] IACS, UR M68, 2021, M68.5.
    """
    in_range(service=(service, positive(SPEED)))
    response = torsion_response(excited_train(machine)) if response is None else response
    shafts = train_of(machine).shafts
    known = stressed(shafts)
    rows = [response.shafts.index(name) for name in known]
    W = np.array([section.section_modulus for section, _ in known.values()])
    K = np.array([limit.concentration for _, limit in known.values()])
    ratio = response.speeds / (service_speed(machine, response.speeds) if service is None else service)
    factor = stress_per_torque(shafts, response)
    permitted = [limit.permitted_stress(ratio, section.diameter) for section, limit in known.values()]
    both = np.array(permitted).reshape(len(known), 2, len(ratio))
    for row, (name, (_, limit)) in enumerate(known.items()):
        for one, there in _pieces(shafts[name], limit, response.places.get(name)):
            both[row, :, there] = np.transpose(limit.permitted_stress(ratio[there], one.diameter))
    return ShaftStress(
        speeds=response.speeds,
        shafts=tuple(known),
        section_modulus=W,
        concentration=K,
        mean=factor * np.abs(response.mean_torques[rows]),
        vibratory=factor * response.shaft_torque_vibratory[rows],
        greatest=factor * response.shaft_torque_max[rows],
        continuous=both[:, 0],
        transient=both[:, 1],
    )


def stress_per_torque(shafts: dict[str, Shaft], response: TorsionResponse) -> Floats:
    """Stress with its concentration over torque, of shafts of which a section is known, (shafts, speeds)."""
    known = stressed(shafts)
    factor = np.empty((len(known), len(response.speeds)))
    for row, (name, (section, limit)) in enumerate(known.items()):
        factor[row] = limit.concentration / section.section_modulus
        for one, there in _pieces(shafts[name], limit, response.places.get(name)):
            assert one.section_modulus is not None
            factor[row, there] = limit.concentration / one.section_modulus
    return factor


def _pieces(
    shaft: Shaft, limit: ShaftLimit, places: NDArray[np.int64] | None
) -> Iterator[tuple[RodPiece, Bools]]:
    """Pieces of a shaft with distributed inertia, with the speeds at which each carries most."""
    if isinstance(shaft, RodShaft) and places is not None and not limit.has_section:
        for piece in np.unique(places).tolist():
            yield shaft.pieces[piece], places == piece


def stressed(shafts: dict[str, Shaft]) -> dict[str, tuple[StressedSection, ShaftLimit]]:
    """Section and limit of each shaft with a known section; a limit without entries if none is given."""
    limits = {name: shaft.limit or ShaftLimit() for name, shaft in shafts.items()}
    sections = {name: limits[name].section(shaft.sections) for name, shaft in shafts.items()}
    return {name: (section, limits[name]) for name, section in sections.items() if section is not None}


def service_speed(machine: Machine, speeds: Floats) -> float:
    """The speed that λ = 1 stands for.

    Of the first disc: `speed_rated` of [train.run]; of a driveline its steady speed; else the highest speed
    [rad/s]. `speeds`: (speeds,) [rad/s].
    """
    if machine.train is None:
        train = train_of(machine)
        return steady_speed(machine) / abs(turning(train)[0][CRANK])
    run = machine.train.run
    return float(speeds.max()) if run is None else run.service
