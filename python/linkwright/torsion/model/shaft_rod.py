r"""A shaft as a rod: its stiffness and inertia piece by piece along it, for the inertia that is distributed.

A cylindrical section is one piece, whatever its length: `torsion/core/rod.py` is exact for it. A taper is cut
into pieces that each have the stiffness and the inertia of their part of the cone; what is left of an error
falls with the square of their number.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from linkwright.torsion.model.shaft_flexibility import cone_integral, polar_moment
from linkwright.torsion.model.shaft_row import flexibilities
from linkwright.torsion.model.shaft_section import ShaftSection, mean_fourth

if TYPE_CHECKING:
    from linkwright.torsion.model.train import Shaft

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
        return (RodPiece(float(shaft.rate), float(shaft.own_inertia), None, None, None),)
    assert shaft.density is not None
    return tuple(_pieces(shaft.sections, float(shaft.density), float(shaft.shear_modulus)))


def _pieces(sections: Sequence[ShaftSection], density: float, modulus: float) -> Iterator[RodPiece]:
    """Pieces of sections; what a step adds to the twist is spread over its section."""
    for section, flexibility in zip(sections, flexibilities(sections), strict=True):
        further = float(flexibility) / float(section.flexibility)
        if section.kind == "taper":
            for piece in _cone(section, density, modulus):
                yield piece._replace(stiffness=piece.stiffness / further)
        else:
            yield RodPiece(
                modulus / float(flexibility),
                float(section.inertia(density)),
                float(section.length),
                float(section.section_modulus),
                float(min(section.diameters)),
            )


def _cone(section: ShaftSection, density: float, modulus: float) -> Iterator[RodPiece]:
    """Pieces of a taper, of one length."""
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
