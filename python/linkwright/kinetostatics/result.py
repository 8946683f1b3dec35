"""What is known about the forces in a machine."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.quantities import About, Shown
from linkwright.kernel.result import Result
from linkwright.kinetostatics.motion import Motion

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class PairForce:
    """What a pair passes on; arrays (n,), vectors (n, 2).

    Attributes
    ----------
    name, kind : str
        Of the pair (`linkwright.linkages.model.structure`).
    first, second : str
        Its members.
    force : ndarray, shape (n, 2)
        On the second member, friction included [N].
    moment : ndarray, shape (n,)
        Of a guide, and friction of a pin, on the second member about the point of the pair [N m].
    friction : ndarray, shape (n,)
        Share of friction: torque of a pin [N m], force along a guide or slot [N], on the second member.
    normal : ndarray, shape (n,)
        Of a guide or slot to the left of it, of teeth along their path, tension of a cable [N]; of a belt its
        torque on the gear [N m]; of a pin the size of its force.
    """

    name: str
    kind: str
    first: str
    second: str
    force: Floats
    moment: Floats
    friction: Floats
    normal: Floats

    @property
    def size(self) -> Floats:
        """Size of the force, (n,) [N]."""
        found: Floats = np.hypot(self.force[:, 0], self.force[:, 1])
        return found


@dataclass(frozen=True)
class Contribution:
    """The share of one source in the forces.

    Attributes
    ----------
    reactions : dict of str to ndarray, shape (n, 2)
        In the force of each pair on its second member [N].
    torque_drive : ndarray, shape (n,)
        In the driving torque [N m].
    shaking_force : ndarray, shape (n, 2)
        In the shaking force [N].
    shaking_moment : ndarray, shape (n,)
        In the shaking moment about the origin [N m].
    """

    reactions: dict[str, Floats]
    torque_drive: Floats
    shaking_force: Floats
    shaking_moment: Floats


_CONTRIBUTIONS = (
    '``"inertia"``, ``"friction"`` (its viscous share), and each load as ``"loads.name"``. Dry friction '
    "goes with what causes it."
)


@dataclass(frozen=True)
class Forces(Result):
    """Forces over the crank angle."""

    crank_angle: Annotated[Floats, Shown("crank angle", "φ", "rad")]
    time: Annotated[Floats, Shown("time", "t", "s")]
    speed: Annotated[Floats, Shown("speed of the crank", "ω", "rad/s")]
    acceleration: Annotated[Floats, Shown("acceleration of the crank", "ε", "rad/s²")]
    torque_drive: Annotated[
        Floats, Shown("driving torque at the crank", "M_d", "N m", "That the motion needs.")
    ]
    power_drive: Annotated[Floats, Shown("driving power at the crank", "P_d", "W")]
    power_load: Annotated[Floats, Shown("power of the loads", "P_r", "W", "Of all loads on the machine.")]
    power_friction: Annotated[Floats, Shown("power of friction in the pairs", "P_f", "W")]
    power_kinetic: Annotated[Floats, Shown("change of the kinetic energy in time", "dE/dt", "W")]
    shaking_moment: Annotated[
        Floats,
        Shown(
            "shaking moment about the origin",
            "M_g",
            "N m",
            "By pairs, springs and the torque of the drive.",
        ),
    ]
    shaking_force: Annotated[Floats, Shown("shaking force", "F_g", "N", shape="(n, 2)")]
    pairs: Annotated[dict[str, PairForce], About("Forces of pins, guides, slots, teeth and cables by name.")]
    drives: Annotated[
        dict[str, Floats],
        About("Torque on each crank [N m], force on each linear driver along its guide [N]."),
    ]
    contributions: Annotated[dict[str, Contribution], About(_CONTRIBUTIONS)]
    motion: Annotated[Motion, About("As it was given.")]
    findings: Annotated[
        tuple[str, ...], About("Where forces are unbounded, friction locks, or a cable pushes, in sentences.")
    ] = field(default=())

    @property
    def power_residual(self) -> Annotated[Floats, Shown("power-balance residual", "", "W")]:
        """Driving, load and friction power less the change of kinetic energy: rounding."""
        found: Floats = self.power_drive + self.power_load + self.power_friction - self.power_kinetic
        return found

    @property
    def reactions(self) -> dict[str, Floats]:
        """Force of each pin on its second member by name, (n, 2) [N]."""
        return {name: pair.force for name, pair in self.pairs.items() if pair.kind == "pin"}

    @property
    def reaction_max(self) -> dict[str, float]:
        """Maximum force of each pair [N]."""
        return {name: float(np.nanmax(pair.size)) for name, pair in self.pairs.items()}

    @property
    def torque_drive_max(
        self,
    ) -> Annotated[float, Shown("peak driving torque", "M_d,max", "N m")]:
        """With its sign."""
        return float(self.torque_drive[np.nanargmax(np.abs(self.torque_drive))])

    @property
    def shaking_force_max(self) -> Annotated[float, Shown("maximum shaking force", "F_g,max", "N")]:
        """Peak absolute value among the angles."""
        return float(np.nanmax(np.hypot(self.shaking_force[:, 0], self.shaking_force[:, 1])))

    def columns(self) -> dict[str, Floats]:
        """Components of the forces by name and unit: the frame, each pair with its moment, each driver."""
        unit = self.unit_of("shaking_force")
        found = {f"shaking_force_{axis} [{unit}]": self.shaking_force[:, k] for k, axis in enumerate("xy")}
        for name, pair in self.pairs.items():
            found |= {f"{name}_{axis} [N]": pair.force[:, k] for k, axis in enumerate("xy")}
            found[f"{name}_moment [N m]"] = pair.moment
        return found | {f"{name}_drive [N m or N]": values for name, values in self.drives.items()}

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Scalars and maximum forces by name, with ``curves`` also all forces as lists.

        Parameters
        ----------
        curves : bool
            Whether arrays are included.

        Returns
        -------
        dict
            Plain numbers, texts and lists, ready for JSON.
        """
        found = super().to_dict(curves=curves) | {"reaction_max": self.reaction_max}
        if curves:
            found["reactions"] = {name: pair.force.tolist() for name, pair in self.pairs.items()}
            found["moments"] = {name: pair.moment.tolist() for name, pair in self.pairs.items()}
            found["drives"] = {name: torque.tolist() for name, torque in self.drives.items()}
        return found
