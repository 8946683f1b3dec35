"""A four-bar linkage in the plane of complex numbers: what its lengths say without moving it.

A₀ and B₀ are the fixed pivots, A the pin of the crank, B the joint of coupler and rocker. The distance d of A
from B₀ decides everything:

    d² = g² + r² − 2 g r cos(φ − γ)          cos μ = (c² + b² − d²)/(2 c b)
    S = 4 c² d² − (d² + c² − b²)²

with the frame g in the direction γ, crank r, coupler c, rocker b, and the transmission angle μ between
coupler and rocker. The linkage closes where S ≥ 0.

Source: VDI 2127, VDI 2130; Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.machine.machine import Machine

Assembly = Literal["left", "right"]

# Lengths that differ by less than this share of the longest are taken as equal: a change point.
_EQUAL = 1e-9


@dataclass(frozen=True)
class FourBar:
    """A four-bar linkage with its place in the plane."""

    # The fixed pivots A₀ and B₀, x + i y [m].
    crank_pivot: complex
    rocker_pivot: complex
    # Lengths [m].
    crank: float
    coupler: float
    rocker: float
    assembly: Assembly = "left"  # side of the joint B, seen from A to B₀: `"left"` or `"right"`
    phase: float = 0.0  # direction of the crank at crank angle zero [rad]

    @property
    def frame(self) -> float:
        """Distance of the fixed pivots [m]."""
        return abs(self.rocker_pivot - self.crank_pivot)

    @property
    def type(self) -> str:
        """Which links turn fully; see `type_of`."""
        return type_of(self.frame, self.crank, self.coupler, self.rocker)

    def pin(self, angles: Floats) -> Complexes:
        """The crank pin A at crank angles, (n,) [m]."""
        return np.asarray(self.crank_pivot + self.crank * np.exp(1j * (self.phase + np.asarray(angles))))

    def gap(self, angles: Floats) -> Floats:
        """S at crank angles, (n,) [m⁴]; negative where the linkage does not close."""
        d2 = np.abs(self.rocker_pivot - self.pin(angles)) ** 2
        return np.asarray(4 * self.coupler**2 * d2 - (d2 + self.coupler**2 - self.rocker**2) ** 2)

    def transmission_angle(self, angles: Floats) -> Floats:
        """μ at crank angles, at most a right angle, (n,) [rad]."""
        d2 = np.abs(self.rocker_pivot - self.pin(angles)) ** 2
        cosine = (self.coupler**2 + self.rocker**2 - d2) / (2 * self.coupler * self.rocker)
        return np.asarray(np.arccos(np.clip(np.abs(cosine), 0, 1)))

    def machine(self, name: str, *, points: Mapping[str, complex] | None = None, source: str = "") -> Machine:
        """The linkage as a machine with fixed points ``A0``, ``B0``, crank ``A``, rocker ``B``.

        `name`: what it is; `points`: of the coupler by name, along + i across [m]; `source`: where it is
        from.
        """
        carried = {key: plain_point("B.coupler", at) for key, at in (points or {}).items()}
        mechanism = {
            "points": {"A0": plain_place(self.crank_pivot), "B0": plain_place(self.rocker_pivot)},
            "cranks": {"A": {"pivot": "A0", "radius": float(self.crank), "phase": float(self.phase)}},
            "rockers": {"B": plain_rocker("A", "B0", self.coupler, self.rocker, self.assembly)},
        }
        return machine_of(name, mechanism | ({"rigid_points": carried} if carried else {}), source)


def machine_of(name: str, mechanism: Mapping[str, object], source: str = "") -> Machine:
    """A machine of a name and the tables of its mechanism."""
    tables: dict[str, object] = {"format": 1, "name": name}
    if source:
        tables["source"] = source
    return Machine.model_validate(tables | {"mechanism": dict(mechanism)})


def plain_place(point: complex) -> dict[str, float]:
    """A fixed point as the table of a file."""
    return {"x": float(point.real), "y": float(point.imag)}


def plain_point(link: str, place: complex) -> dict[str, object]:
    """A rigid point as the table of a file."""
    return {"link": link, "along": float(place.real), "across": float(place.imag)}


def plain_rocker(
    crank: str, pivot: str, coupler: float, rocker: float, assembly: str = "left"
) -> dict[str, object]:
    """A rocker as the table of a file."""
    return {
        "crank": crank,
        "pivot": pivot,
        "coupler": float(coupler),
        "rocker": float(rocker),
        "assembly": assembly,
    }


def cross(a: complex | Complexes, b: complex | Complexes) -> Floats:
    """The cross product of vectors in the plane, positive if b is to the left of a."""
    return np.asarray(np.imag(np.conj(a) * b))


def side_of(crank_pin: complex, rocker_pivot: complex, joint: complex) -> Assembly:
    """Side of the joint, seen from the crank pin to the rocker's pivot."""
    return "left" if cross(rocker_pivot - crank_pin, joint - crank_pin) >= 0 else "right"


def type_of(frame: float, crank: float, coupler: float, rocker: float) -> str:
    """Which links of a four-bar linkage turn fully.

    `frame`, `crank`, `coupler`, `rocker`: lengths [m]. Returns: ``"crank-rocker"``, ``"double-crank"``,
    ``"rocker-crank"`` (the rocker turns, the crank does not), ``"double-rocker"``, ``"triple-rocker"`` (no
    link turns), or ``"change-point"``.

    Source: Grashof's condition: shortest + longest < sum of the other two.
    """
    lengths = {"double-crank": frame, "crank-rocker": crank, "double-rocker": coupler, "rocker-crank": rocker}
    ordered = sorted(lengths.values())
    spare = ordered[1] + ordered[2] - ordered[0] - ordered[3]
    if abs(spare) <= _EQUAL * ordered[3]:
        return "change-point"
    return "triple-rocker" if spare < 0 else min(lengths, key=lambda key: lengths[key])


def turn_spare(frame: Floats, crank: Floats, coupler: Floats, rocker: Floats) -> Floats:
    """How far a crank is from losing its full revolution, (n,) [m]; negative if it does not turn fully.

    The crank turns if the coupler and the rocker meet at both ends of the range of d, g − r and g + r.
    """
    far = coupler + rocker - (frame + crank)
    near = np.abs(frame - crank) - np.abs(coupler - rocker)
    return np.asarray(np.minimum(far, near))


def worst_transmission(frame: Floats, crank: Floats, coupler: Floats, rocker: Floats) -> Floats:
    """Minimum transmission angle in a full revolution of the crank, (n,) [rad]; NaN where it does not turn.

    It is smallest where the crank is in line with the frame: d = g − r or d = g + r.
    """
    product = 2 * coupler * rocker
    cosines = [(coupler**2 + rocker**2 - (frame + sign * crank) ** 2) / product for sign in (-1, 1)]
    with np.errstate(invalid="ignore"):
        return np.asarray(np.arccos(np.maximum(np.abs(cosines[0]), np.abs(cosines[1]))))
