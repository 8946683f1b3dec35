"""How fast each disc of a train turns against the others, and where loops contradict themselves."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping
from typing import NamedTuple, TypeVar

from linkwright.torsion.model.train import GROUND, Train

Node = TypeVar("Node", bound=Hashable)

# Ratios that differ by less are the same but for rounding of what was typed.
_EQUAL = 1e-9


class Contradiction(NamedTuple):
    """A connection whose discs turn otherwise than it asks."""

    # `table`, `name`: of the connection.
    table: str
    name: str
    # `wanted`, `found`: speed of its first disc over that of its second: by itself, and by the way around the
    # loop.
    wanted: float
    found: float


class Joint(NamedTuple):
    """A connection of two discs."""

    # `table`, `name`: where it is described.
    table: str
    name: str
    # `first`, `second`: the discs.
    first: str
    second: str
    ratio: float  # speed of the first over that of the second


def parts_of(names: Iterable[Node], pairs: Iterable[tuple[Node, Node]]) -> list[list[Node]]:
    """The connected parts of a graph. Each part in the order of its names."""
    part = {name: [name] for name in names}
    for a, b in pairs:
        one, other = part[a], part[b]
        if one is not other:
            one += other
            part |= dict.fromkeys(other, one)
    order = {name: n for n, name in enumerate(part)}
    return [
        sorted(each, key=order.__getitem__) for each in {id(each): each for each in part.values()}.values()
    ]


def joints(train: Train) -> Iterator[Joint]:
    """All connections between discs: shafts, then gears; those to the ground are left out."""
    for name, shaft in train.shafts.items():
        if GROUND not in shaft.between:
            yield Joint("shafts", name, *shaft.between, 1.0)
    for name, gear in train.gears.items():
        yield Joint("gears", name, *gear.between, gear.speed_ratio)


def speeds(train: Train) -> tuple[dict[str, float], list[Contradiction]]:
    """Speeds of the discs when the train rotates as a rigid body.

    Gives `speeds`: over that of the first disc of its part, with the sense; as far as they are known;
    `contradictions`: connections that close a loop and ask for another ratio.
    """
    listed = list(joints(train))
    about: dict[str, list[tuple[str, float]]] = {name: [] for name in train.discs}
    for each in listed:
        about[each.first].append((each.second, 1.0 / each.ratio))
        about[each.second].append((each.first, each.ratio))
    found: dict[str, float] = {}
    for root in train.discs:
        if root not in found:
            _spread(root, about, found)
    wrong = (_checked(each, found) for each in listed)
    return {name: found[name] for name in train.discs}, [each for each in wrong if each is not None]


def _spread(root: str, about: Mapping[str, list[tuple[str, float]]], found: dict[str, float]) -> None:
    """Give speeds to all that is connected with a disc."""
    found[root] = 1.0
    waiting = [root]
    while waiting:
        at = waiting.pop(0)
        for name, factor in about[at]:
            if name not in found:
                found[name] = found[at] * factor
                waiting.append(name)


def _checked(joint: Joint, found: Mapping[str, float]) -> Contradiction | None:
    """Whether a connection fits the speeds of its discs."""
    ratio = found[joint.first] / found[joint.second]
    if abs(ratio - joint.ratio) <= _EQUAL * abs(joint.ratio):
        return None
    return Contradiction(joint.table, joint.name, joint.ratio, ratio)
