"""Curves given by points: an argument that increases, and a value at each point."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

from pydantic import BaseModel
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault
from linkwright.kernel.description.schema_walk import annotation_at, mark_of
from linkwright.kernel.units.reading import worded


def curve_faults(owner: BaseModel, argument: str, values: Iterable[str]) -> Iterator[InitErrorDetails]:
    """What is wrong with a curve: too few points, arguments that do not increase, lists of different length.

    `argument`, `values`: fields of the owner; one that is None is left out.
    """
    points: tuple[float, ...] = getattr(owner, argument)
    mark = mark_of(annotation_at(type(owner), (argument,)))
    # A slope is a difference of values over one of arguments: these have a size of their kind, too.
    apart = 0.0 if mark is None else mark.kind.least
    if len(points) < 2:
        yield fault(argument, found=_values(len(points)), expected="at least 2 values")
    for place, (before, here) in enumerate(pairwise(points), start=1):
        if here <= before or here - before < 0.5 * apart:
            yield not_rising(owner, argument, place, before, here, apart)
    yield from _length_faults(owner, argument, values)


def not_rising(
    owner: BaseModel, name: str, place: int, before: float, here: float, apart: float = 0.0
) -> InitErrorDetails:
    """The fault of a value, at a place of the list `name`, that is not `apart` [SI] above the last one."""
    mark = mark_of(annotation_at(type(owner), (name,)))
    least = f"{before:.6g}" if mark is None else worded(before, mark.kind)
    by = f" by {apart:g} or more" if here > before else ""
    found = here if mark is None else worded(here, mark.kind)
    return fault(name, place, found=found, expected=f"more than {least}, the value before it{by}")


def unread_file(found: str) -> InitErrorDetails:
    """The fault of a file of points in a description that is not read from a machine file."""
    expected = "points in lists: a file of points is read with the machine file that names it"
    return fault("file", found=found, expected=expected)


def _length_faults(owner: BaseModel, argument: str, values: Iterable[str]) -> Iterator[InitErrorDetails]:
    n = len(getattr(owner, argument))
    for name in values:
        field = type(owner).model_fields[name]
        listed = getattr(owner, name)
        if listed is not None and len(listed) != n:
            key = field.alias or name
            yield fault(key, found=_values(len(listed)), expected=f"{_values(n)}, one for each {argument}")


def _values(n: int) -> str:
    return "1 value" if n == 1 else f"{n} values"
