"""What is known about the forces in a machine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record, Result
from linkwright.kinetostatics.motion import Motion

_PAIR_FORCE_FRICTION = (
    "Share of friction: torque of a pin [N m], force along a guide or slot [N], on the second member."
)
_PAIR_FORCE_NORMAL = (
    "Of a guide or slot to the left of it, of teeth along their path, tension of a cable [N]; of "
    "a belt its torque on the gear [N m]; of a pin the size of its force."
)


@dataclass(frozen=True)
class PairForce(Record):
    """What a pair passes on; arrays (n,), vectors (n, 2)."""

    name: Annotated[str, About("Of the pair (`linkwright.linkages.model.structure`).")]
    kind: Annotated[str, About("Of the pair.")]
    first: Annotated[str, About("Its first member.")]
    second: Annotated[str, About("Its second member.")]
    force: Annotated[
        Floats, Label("force on the second member", "", "N", "Friction included.", shape="(n, 2)")
    ]
    moment: Annotated[
        Floats,
        Label(
            "moment on the second member",
            "",
            "N m",
            "Of a guide, and friction of a pin, about the point of the pair.",
            shape="(n,)",
        ),
    ]
    friction: Annotated[Floats, About(_PAIR_FORCE_FRICTION, "(n,)")]
    normal: Annotated[Floats, About(_PAIR_FORCE_NORMAL, "(n,)")]

    @property
    def size(self) -> Annotated[Floats, Label("size of the force", "", "N", shape="(n,)")]:
        """On the second member."""
        size: Floats = np.hypot(self.force[:, 0], self.force[:, 1])
        return size


@dataclass(frozen=True)
class Contribution(Record):
    """The share of one source in the forces."""

    reactions: Annotated[
        dict[str, Floats], About("Share in the force of each pair on its second member [N].", "(n, 2)")
    ]
    torque_drive: Annotated[Floats, Label("share in the driving torque", "", "N m", shape="(n,)")]
    shaking_force: Annotated[Floats, Label("share in the shaking force", "", "N", shape="(n, 2)")]
    shaking_moment: Annotated[
        Floats, Label("share in the shaking moment", "", "N m", "About the origin.", shape="(n,)")
    ]


_CONTRIBUTIONS = (
    '``"inertia"``, ``"friction"`` (its viscous share), and each load as ``"loads.name"``. Dry friction '
    "is part of the contribution that causes it."
)


@dataclass(frozen=True)
class Forces(Result):
    """Forces over the crank angle."""

    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad")]
    time: Annotated[Floats, Label("time", "t", "s")]
    speed: Annotated[Floats, Label("speed of the crank", "ω", "rad/s")]
    acceleration: Annotated[Floats, Label("acceleration of the crank", "ε", "rad/s²")]
    torque_drive: Annotated[
        Floats, Label("driving torque at the crank", "M_d", "N m", "That the motion needs.")
    ]
    power_drive: Annotated[Floats, Label("driving power at the crank", "P_d", "W")]
    power_load: Annotated[Floats, Label("power of the loads", "P_r", "W", "Of all loads on the machine.")]
    power_friction: Annotated[Floats, Label("power of friction in the pairs", "P_f", "W")]
    power_kinetic: Annotated[Floats, Label("change of the kinetic energy in time", "dE/dt", "W")]
    shaking_moment: Annotated[
        Floats,
        Label(
            "shaking moment about the origin",
            "M_g",
            "N m",
            "By pairs, springs and the torque of the drive.",
        ),
    ]
    shaking_force: Annotated[Floats, Label("shaking force", "F_g", "N", shape="(n, 2)")]
    pairs: Annotated[dict[str, PairForce], About("Forces of pins, guides, slots, teeth and cables by name.")]
    drives: Annotated[
        dict[str, Floats],
        About("Torque on each crank [N m], force on each linear driver along its guide [N]."),
    ]
    contributions: Annotated[Mapping[str, Contribution], About(_CONTRIBUTIONS)]
    motion: Annotated[Motion, About("As it was given.")]
    load_forces: Annotated[
        dict[str, Floats], About("Force of each load on a slide, along its guide [N]; forward is positive.")
    ] = field(default_factory=dict)
    load_torques: Annotated[
        dict[str, Floats], About("Torque of each load on a link or on the crankshaft [N m].")
    ] = field(default_factory=dict)
    shaking_couple: Annotated[
        Floats | None,
        Label(
            "shaking couple of inertia about x and y",
            "C_g",
            "N m",
            "About the plane z = 0; None without a body that has a position along the crankshaft.",
            shape="(n, 2)",
        ),
    ] = field(default=None)
    shaft_torques: Annotated[
        dict[str, Floats],
        About("Torque of each drive referred to the master shaft, its power over the speed of that [N m]."),
    ] = field(default_factory=dict)
    laws: Annotated[
        tuple[str, ...],
        About(
            "Drivers that follow a law by a formula or have an axis: the driving torque is the sum of all, "
            "referred to the master shaft, and ``drives`` is what they need themselves."
        ),
    ] = field(default=())
    findings: Annotated[
        tuple[str, ...], About("Where forces are unbounded, friction locks, or a cable pushes, in sentences.")
    ] = field(default=())

    @property
    def power_residual(self) -> Annotated[Floats, Label("power-balance residual", "", "W")]:
        """Driving, load and friction power less the change of kinetic energy: rounding."""
        residual: Floats = self.power_drive + self.power_load + self.power_friction - self.power_kinetic
        return residual

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
    ) -> Annotated[float, Label("peak driving torque", "M_d,max", "N m")]:
        """With its sign."""
        return float(self.torque_drive[np.nanargmax(np.abs(self.torque_drive))])

    @property
    def shaking_force_max(self) -> Annotated[float, Label("maximum shaking force", "F_g,max", "N")]:
        """Peak absolute value among the angles."""
        return float(np.nanmax(np.hypot(self.shaking_force[:, 0], self.shaking_force[:, 1])))

    def drive_unit(self, name: str) -> str:
        """Unit of what a drive gives: what has a guide is pushed along it, what has none is turned."""
        return "N" if f"{name}.guide" in self.pairs else "N m"

    @property
    def drive_max(self) -> dict[str, float]:
        """Peak torque [N m] or force [N] of each drive, with its sign."""
        return {name: float(values[np.nanargmax(np.abs(values))]) for name, values in self.drives.items()}

    @property
    def shaft(self) -> str:
        """What the driving torque is, where drives follow laws; empty where it is that of the crank."""
        return "torque referred to the master shaft" if self.laws else ""

    @public
    def word_of(self, name: str, word: str) -> str:
        """That of the driving torque says where it acts."""
        return self.shaft or word if name in ("torque_drive", "torque_drive_max") else word

    def columns(self) -> dict[str, Floats]:
        """Components of the forces by name and unit: the frame, each pair with its moment, each driver."""
        unit = self.unit_of("shaking_force")
        columns = {f"shaking_force_{axis} [{unit}]": self.shaking_force[:, k] for k, axis in enumerate("xy")}
        if self.shaking_couple is not None:
            columns |= {
                f"shaking_couple_{axis} [N m]": self.shaking_couple[:, k] for k, axis in enumerate("xy")
            }
        for name, pair in self.pairs.items():
            columns |= {f"{name}_{axis} [N]": pair.force[:, k] for k, axis in enumerate("xy")}
            columns[f"{name}_moment [N m]"] = pair.moment
        for name, values in self.drives.items():
            columns[f"{name}_drive [{self.drive_unit(name)}]"] = values
        columns |= {f"loads.{name} [N]": values for name, values in self.load_forces.items()}
        return columns | {f"loads.{name} [N m]": values for name, values in self.load_torques.items()}

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Scalars and maximum forces by name, ready for JSON; with ``curves`` also all forces as lists."""
        results = super().to_dict(curves=curves) | {
            "reaction_max": self.reaction_max,
            "drive_max": self.drive_max,
        }
        if self.laws:
            results["torque_drive_is"] = self.shaft
        if curves:
            results["reactions"] = {name: pair.force.tolist() for name, pair in self.pairs.items()}
            results["moments"] = {name: pair.moment.tolist() for name, pair in self.pairs.items()}
            results["drives"] = {name: torque.tolist() for name, torque in self.drives.items()}
            results["shaft_torques"] = {name: torque.tolist() for name, torque in self.shaft_torques.items()}
            results["load_forces"] = {name: force.tolist() for name, force in self.load_forces.items()}
            results["load_torques"] = {name: torque.tolist() for name, torque in self.load_torques.items()}
        return results
