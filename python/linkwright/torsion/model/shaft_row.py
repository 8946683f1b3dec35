"""Sections of a shaft in a row: their flexibilities with those of the steps between them.

Sections in a row add their flexibilities. A step to the next section adds a length of the thinner one where a
fillet is given, 0 for a sharp corner (`shaft_flexibility`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault
from linkwright.kernel.numerics.tangent import total
from linkwright.torsion.model.shaft_flexibility import polar_moment, step_length
from linkwright.torsion.model.shaft_section import ShaftSection


def _step(first: ShaftSection, second: ShaftSection) -> tuple[float, float]:
    """Flexibility that a step adds to the section before it and to the one after it [1/m³]."""
    if first.fillet is None:
        return 0.0, 0.0
    (d, bore), (D, other) = (first.diameters[1], first.bores[1]), (second.diameters[0], second.bores[0])
    if d <= D:
        return step_length(d, D, first.fillet, bore) / polar_moment(d, bore), 0.0
    return 0.0, step_length(D, d, first.fillet, other) / polar_moment(D, other)


def flexibilities(sections: Sequence[ShaftSection]) -> tuple[float, ...]:
    """Twist per torque of sections in a row, times the shear modulus; steps count with the thinner ones.

    Of each section [1/m³].
    """
    e = [section.flexibility for section in sections]
    for n, pair in enumerate(pairwise(sections)):
        before, after = _step(*pair)
        e[n] += before
        e[n + 1] += after
    return tuple(e)


def fillet_faults(sections: Sequence[ShaftSection]) -> Iterator[InitErrorDetails]:
    """Fillets that lie at no step between cylinders or tapers, or do not fit into theirs.

    Each with the number of its section and the key.
    """
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
    """Radius that a step has room for, and that its closed form holds for [m]."""
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
    whole, before, first, second = total(parts), 0.0, 0.0, 0.0
    for section, part in zip(sections, parts, strict=True):
        share, J = (before + part / 2) / whole, section.inertia(density)
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
