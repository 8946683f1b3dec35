"""One of the equal planets of a stage, for drawings: the others would lie over it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from linkwright.torsion.modes.scheme import Connection, Scheme

# Parts of a planetary stage.
_OF_PLANETS = {"mesh", "bearing"}


class Drawn(NamedTuple):
    """A scheme as it is drawn."""

    scheme: Scheme
    kept: list[int]  # places of its discs among those of the whole scheme
    names: dict[str, str]  # of the discs that are left → as they are written


def equal_planets_once(scheme: Scheme) -> Drawn:
    """The scheme with one of the equal planets of a stage, which its name counts."""
    about: dict[str, list[Connection]] = {name: [] for name in scheme.discs}
    for part in scheme.connections:
        for end in {part.first, part.second} & about.keys():
            about[end].append(part)
    numbers = {
        name: (_rounded(J), _rounded(n))
        for name, J, n in zip(scheme.discs, scheme.inertia, scheme.speed, strict=True)
    }
    alike: dict[Any, list[str]] = {}
    for name, parts in about.items():
        if len(parts) > 1 and {part.kind for part in parts} == _OF_PLANETS:
            joins = frozenset(_join(part, name) for part in parts)
            alike.setdefault((numbers[name], joins), []).append(name)
    counted = {names[0]: f"{len(names)} × {names[0]}" for names in alike.values() if len(names) > 1}
    left_out = {name for names in alike.values() for name in names[1:]}
    kept = [n for n, name in enumerate(scheme.discs) if name not in left_out]
    names = {scheme.discs[n]: counted.get(scheme.discs[n], scheme.discs[n]) for n in kept}
    drawn = replace(
        scheme,
        discs=tuple(names.values()),
        speed=scheme.speed[kept],
        inertia=scheme.inertia[kept],
        inertia_referred=scheme.inertia_referred[kept],
        connections=tuple(
            part._replace(first=names.get(part.first, part.first), second=names.get(part.second, part.second))
            for part in scheme.connections
            if not {part.first, part.second} & left_out
        ),
    )
    return Drawn(drawn, kept, names)


def _join(part: Connection, name: str) -> tuple[Any, ...]:
    """A connection of a disc but for its name: its kind, what it joins, and its numbers."""
    other = (part.first == name, part.second if part.first == name else part.first)
    return part.kind, *other, _rounded(part.ratio), _rounded(part.stiffness or 0.0)


def _rounded(number: float) -> float:
    """A number without the rounding of its last digits."""
    return float(f"{number:.9g}")
