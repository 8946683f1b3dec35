"""Sections of a shaft in a row: flexibilities, with those of the steps between them, and the shaft as a rod.

Sections in a row add their flexibilities. A step to the next section adds a length of the thinner one where a
fillet is given, 0 for a sharp corner (`shaft_flexibility`).

As a rod a shaft has stiffness and inertia piece by piece along it, for the inertia that is distributed. A
cylindrical section is one piece, whatever its length: `torsion/core/rod.py` is exact for it. A taper is cut
into pieces that each have the stiffness and the inertia of their part of the cone; what is left of an error
falls with the square of their number.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault
from linkwright.kernel.numerics.tangent import total
from linkwright.torsion.model.shaft_flexibility import cone_integral, polar_moment, step_length
from linkwright.torsion.model.shaft_section import ShaftSection, mean_fourth

if TYPE_CHECKING:
    from linkwright.torsion.model.train import Shaft


def _step(first: ShaftSection, second: ShaftSection) -> tuple[float, float]:
    """Flexibility that a step adds to the sections on both sides [1/m³]."""
    if first.fillet is None:
        return 0.0, 0.0
    (d, bore), (D, other) = (first.diameters[1], first.bores[1]), (second.diameters[0], second.bores[0])
    if d <= D:
        return step_length(d, D, first.fillet, bore) / polar_moment(d, bore), 0.0
    return 0.0, step_length(D, d, first.fillet, other) / polar_moment(D, other)


def flexibilities(sections: Sequence[ShaftSection]) -> tuple[float, ...]:
    """Twist per torque of sections in a row times G, steps with the thinner ones [1/m³]."""
    e = [section.flexibility for section in sections]
    for n, pair in enumerate(pairwise(sections)):
        before, after = _step(*pair)
        e[n] += before
        e[n + 1] += after
    return tuple(e)


def fillet_faults(sections: Sequence[ShaftSection]) -> Iterator[InitErrorDetails]:
    """Fillets at no step of cylinders or tapers, or too large, by number of the section and key."""
    for n, section in enumerate(sections):
        if section.fillet is None or section.kind == "flange":
            continue
        following = sections[n + 1] if n + 1 < len(sections) else None
        if following is None or following.kind not in ("cylinder", "taper"):
            expected = "a cylinder or a taper after this section, to which the step leads"
            yield fault(n, "fillet", found=section.fillet, expected=expected)
        elif section.fillet > _largest_fillet(section, following):
            largest = _largest_fillet(section, following)
            expected = f"at most {largest:.6g} m: the height of the step, a quarter of the thinner diameter"
            remedy = "describe a larger rounding as a taper"
            yield fault(n, "fillet", found=section.fillet, expected=expected, remedy=remedy)


def _largest_fillet(first: ShaftSection, second: ShaftSection) -> float:
    """Largest fillet that fits the step and for which its closed form holds [m]."""
    d, D = first.diameters[1], second.diameters[0]
    thin = first if d <= D else second
    return min(abs(D - d) / 2, min(d, D) / 4, thin.length)


def end_inertias(sections: Sequence[ShaftSection], density: float) -> tuple[float, float]:
    """Inertia of the sections themselves, shared out to the two ends of the shaft [kg m²].

    Each section's is shared by the twist on both sides of its middle, as a lever shares a weight. A plain
    cylinder gives half to each end.

    At the first end and at the second. `density`: [kg/m³].
    """
    parts = flexibilities(sections)
    flexibility, before, first, second = total(parts), 0.0, 0.0, 0.0
    for section, part in zip(sections, parts, strict=True):
        share, J = (before + part / 2) / flexibility, section.inertia(density)
        first, second = first + (1 - share) * J, second + share * J
        before += part
    return first, second


def place(sections: Sequence[ShaftSection], share: float) -> float:
    """How far from the first end a share of the twist of all sections lies [m]."""
    parts = flexibilities(sections)
    left, along = share * math.fsum(parts), 0.0
    for section, part in zip(sections, parts, strict=True):
        if left <= part:
            return along + section.place(left / part)
        left, along = left - part, along + section.length
    return along


# Pieces of a taper: cones of 2 to 1 in diameter keep their first natural frequencies within 2e-5.
_PIECES = 32


class RodPiece(NamedTuple):
    """A part of a shaft that counts as a uniform rod."""

    stiffness: float  # of the piece alone [N m/rad]
    inertia: float  # of the piece alone [kg m²]
    length: float | None  # None where a shaft has no sections [m]
    section_modulus: float | None  # torque per nominal stress [m³]
    diameter: float | None  # outside, where the stress counts [m]


def rod_pieces(shaft: Shaft) -> tuple[RodPiece, ...]:
    """A shaft with an inertia of its own, from its first end to its second."""
    if shaft.sections is None:
        assert shaft.own_inertia is not None
        return (RodPiece(shaft.rate, shaft.own_inertia, None, None, None),)
    assert shaft.density is not None
    return tuple(_pieces(shaft.sections, shaft.density, shaft.shear_modulus))


def _pieces(sections: Sequence[ShaftSection], density: float, modulus: float) -> Iterator[RodPiece]:
    """Pieces of sections; what a step adds to the twist is spread over its section."""
    for section, flexibility in zip(sections, flexibilities(sections), strict=True):
        softer = flexibility / section.flexibility
        if section.kind == "taper":
            for piece in _cone(section, density, modulus):
                yield piece._replace(stiffness=piece.stiffness / softer)
        else:
            yield RodPiece(
                modulus / flexibility,
                section.inertia(density),
                section.length,
                section.section_modulus,
                min(section.diameters),
            )


def _cone(section: ShaftSection, density: float, modulus: float) -> Iterator[RodPiece]:
    length = section.length / _PIECES

    def at(ends: tuple[float, float], n: int) -> float:
        return ends[0] + (ends[1] - ends[0]) * n / _PIECES

    for n in range(_PIECES):
        outside = at(section.diameters, n), at(section.diameters, n + 1)
        bores = at(section.bores, n), at(section.bores, n + 1)
        moment = mean_fourth(*outside) - mean_fourth(*bores)
        thin = min(zip(outside, bores, strict=True), key=lambda ring: polar_moment(*ring) / ring[0])
        yield RodPiece(
            modulus / cone_integral(length, outside, bores),
            density * length * math.pi / 32 * moment,
            length,
            polar_moment(*thin) / (thin[0] / 2),
            thin[0],
        )
