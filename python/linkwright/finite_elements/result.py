"""What is known about the loads on a link."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record, Result

# Share of the peak below which a force or a moment is rounding.
_ROUNDING = 1e-9


@dataclass(frozen=True)
class LinkLoad(Record):
    """A force and a moment on a link at one place; in the axes of the link."""

    name: Annotated[str, About("Of the joint, ``NAME drive`` of a drive, ``loads.NAME`` of a load.")]
    kind: Annotated[str, About('``"pin"``, ``"guide"``, …, ``"drive"`` or ``"load"``.')]
    place: Annotated[Floats, Label("place along and across the link", "", "m", shape="(n, 2)")]
    force: Annotated[Floats, Label("force along and across the link", "", "N", shape="(n, 2)")]
    moment: Annotated[Floats, Label("moment about the place", "", "N m", shape="(n,)")]

    @property
    def size(self) -> Annotated[Floats, Label("size of the force", "", "N", shape="(n,)")]:
        """Of both components."""
        size: Floats = np.hypot(self.force[:, 0], self.force[:, 1])
        return size

    @property
    def is_fixed(self) -> bool:
        """Whether it acts at one place of the link all the time."""
        return bool(np.ptp(self.place, axis=0).max() <= _ROUNDING * max(1.0, np.abs(self.place).max()))


class Instant(NamedTuple):
    """A crank angle at which the link is to be examined.

    Attributes
    ----------
    names : tuple of str
        What peaks there, in words.
    place : int
        Number of the angle.
    """

    names: tuple[str, ...]
    place: int


@dataclass(frozen=True)
class LinkLoads(Result):
    """Loads on one link in its own axes over the crank angle."""

    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad")]
    time: Annotated[Floats, Label("time", "t", "s")]
    link: Annotated[str, About("Name of the link.")]
    length: Annotated[float | None, Label("length of the link", "l", "m", "None for a block.")]
    angle: Annotated[Floats, Label("angle of the link", "ψ", "rad")]
    speed: Annotated[Floats, Label("angular speed of the link", "ω", "rad/s")]
    acceleration: Annotated[Floats, Label("angular acceleration of the link", "α", "rad/s²")]
    origin_acceleration: Annotated[
        Floats, Label("acceleration of the start of the link", "a_0", "m/s²", shape="(n, 2)")
    ]
    gravity: Annotated[
        Floats, Label("acceleration of gravity in the axes of the link", "g", "m/s²", shape="(n, 2)")
    ]
    mass: Annotated[float, Label("mass of the bodies on the link", "m", "kg")]
    weight: Annotated[Floats, Label("weight", "", "N", shape="(n, 2)")]
    weight_moment: Annotated[Floats, Label("moment of the weight about the start", "", "N m")]
    inertia_force: Annotated[Floats, Label("inertia force", "", "N", shape="(n, 2)")]
    inertia_moment: Annotated[Floats, Label("moment of inertia forces about the start", "", "N m")]
    bending: Annotated[
        Floats,
        Label(
            "maximum bending moment",
            "M_b",
            "N m",
            "Of all sections, with its sign; each body counts as the uniform rod that has its mass, centre "
            "and moment of inertia.",
        ),
    ]
    bending_place: Annotated[Floats, Label("section of the maximum bending moment", "", "m")]
    loads: Annotated[dict[str, LinkLoad], About("Forces and moments at joints, drives and points by name.")]
    turns: Annotated[bool, About("Whether the link can take a moment.")]
    size: Annotated[
        float, Label("mean length of the links", "", "m", "By which a moment compares with a force.")
    ]
    findings: Annotated[tuple[str, ...], About("As of `forces`.")] = field(default=())

    @property
    def force_residual(self) -> Annotated[Floats, Label("residual of the forces", "", "N", shape="(n, 2)")]:
        """Sum of all forces, weight and inertia included: rounding."""
        total: Floats = self.weight + self.inertia_force + sum(load.force for load in self.loads.values())
        return total

    @property
    def moment_residual(self) -> Annotated[Floats, Label("residual of the moments", "", "N m")]:
        """Sum of all moments about the start: rounding."""
        total = self.weight_moment + self.inertia_moment
        for load in self.loads.values():
            x, y = load.place.T
            total = total + load.moment + x * load.force[:, 1] - y * load.force[:, 0]
        return total if self.turns else np.zeros_like(total)

    @property
    def residual(self) -> Annotated[float, Label("relative residual of the balance", "", "")]:
        """Largest residual of force and moment over the largest force, and over the largest moment."""
        parts = (self.weight, self.inertia_force, *(load.force for load in self.loads.values()))
        force = max(float(np.nanmax(np.abs(part), initial=0.0)) for part in parts)
        turning = (self.weight_moment, self.inertia_moment, *(load.moment for load in self.loads.values()))
        # A link that carries forces alone has moments of rounding, beside force times arm.
        moment = max(force * self.size, *(float(np.nanmax(np.abs(part), initial=0.0)) for part in turning))
        residuals = ((self.force_residual, force), (self.moment_residual, moment))
        return max(
            float(np.nanmax(np.abs(residual), initial=0.0)) / scale if scale > 0 else 0.0
            for residual, scale in residuals
        )

    @property
    def force_max(self) -> dict[str, float]:
        """Maximum force of each joint, drive and load [N]."""
        return {name: float(np.nanmax(load.size)) for name, load in self.loads.items()}

    @property
    def instants(self) -> tuple[Instant, ...]:
        """Where forces and moments at joints, bending moment and angular acceleration peak."""
        curves = [(f"maximum force at {name}", load.size) for name, load in self.loads.items()]
        curves += [(f"maximum moment at {name}", load.moment) for name, load in self.loads.items()]
        curves += [("maximum bending moment", self.bending), ("maximum angular speed", self.speed)]
        curves += [("maximum angular acceleration", self.acceleration)]
        scale = max(self.force_max.values(), default=0.0) * self.size
        peaks: dict[int, list[str]] = {}
        for name, curve in curves:
            size = np.abs(curve)
            at = int(np.nanargmax(size)) if np.isfinite(size).any() else None
            if at is not None and size[at] > (_ROUNDING * scale if "moment" in name else 0.0):
                peaks.setdefault(at, []).append(name)
        return tuple(Instant(tuple(names), at) for at, names in sorted(peaks.items()))

    def columns(self) -> dict[str, Floats]:
        """Components in the axes of the link by name and unit."""
        columns: dict[str, Floats] = {}
        for name, vectors, unit in (
            ("origin_acceleration", self.origin_acceleration, "m/s²"),
            ("gravity", self.gravity, "m/s²"),
            ("weight", self.weight, "N"),
            ("inertia_force", self.inertia_force, "N"),
            ("force_residual", self.force_residual, "N"),
        ):
            columns |= {f"{name}_{axis} [{unit}]": vectors[:, k] for k, axis in enumerate("xy")}
        for name, load in self.loads.items():
            columns |= {f"{name}: {axis} [m]": load.place[:, k] for k, axis in enumerate("xy")}
            columns |= {f"{name}: F_{axis} [N]": load.force[:, k] for k, axis in enumerate("xy")}
            columns[f"{name}: M [N m]"] = load.moment
        return columns

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Scalars, maximum forces and instants by name; with ``curves`` also all loads as lists."""
        results = super().to_dict(curves=curves) | {"force_max": self.force_max}
        results["instants"] = [
            {"names": list(instant.names), "crank_angle": float(self.crank_angle[instant.place])}
            for instant in self.instants
        ]
        if curves:
            results["loads"] = {
                name: {part: getattr(load, part).tolist() for part in ("place", "force", "moment")}
                for name, load in self.loads.items()
            }
        return results
