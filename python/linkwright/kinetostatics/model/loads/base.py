"""What all loads have in common."""

from __future__ import annotations

from collections.abc import Iterator

from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault


class Load(CheckedDescription):
    """What all loads have in common."""


def one_of(load: Load, for_points: str, for_links: str) -> Iterator[InitErrorDetails]:
    """The fault of a load that has neither or both of two entries."""
    given = [name for name in (for_points, for_links) if getattr(load, name) is not None]
    if len(given) == 2:
        remedy = f"{for_points} acts on a point or a slider, {for_links} on a link"
        yield fault(for_links, found=getattr(load, for_links), expected="only one of the two", remedy=remedy)
    if not given:
        yield fault(expected=f"{for_points} (on a point or a slider) or {for_links} (on a link)")


def number_or_curve(load: Load, number: str, argument: str, value: str) -> Iterator[InitErrorDetails]:
    """The fault of a load that is not described by either one number or a curve of two lists."""
    curve = [name for name in (argument, value) if getattr(load, name) is not None]
    if getattr(load, number) is not None and curve:
        yield fault(
            curve[0], found=getattr(load, curve[0]), expected=f"either {number}, or {argument} and {value}"
        )
    elif len(curve) == 1 or (getattr(load, number) is None and not curve):
        yield fault(expected=f"{number}, or a curve by {argument} and {value}")
