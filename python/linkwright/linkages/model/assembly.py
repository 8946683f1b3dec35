"""In which order a mechanism is built: single elements, dyads of joints, groups that are solved together.

Elements that refer to what is placed already come one by one. The coordinates of joints are unknowns, bars
and guides are equations: a matching of equations to unknowns tells what is missing or too much; its strongly
connected parts are the smallest groups that can be solved, one after another (Dulmage and Mendelsohn,
*Coverings of bipartite graphs*, Canadian J. Math. 10 (1958); for linkages these parts are the Assur groups).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal, NamedTuple


class Part(NamedTuple):
    """One element as the assembly sees it."""

    # `"element"`, `"joint"`, `"bar"`, `"cylinder"` (of varying length) or `"carried"` (a point of a link).
    role: Literal["element", "joint", "bar", "cylinder", "carried"]
    # Points and links that must be placed before: the ends of a bar, what the guide of a joint hangs on.
    needs: tuple[str, ...]
    makes: tuple[str, ...]  # points and links that it places


class Step(NamedTuple):
    """One step of the build."""

    kind: Literal["element", "dyad", "group"]  # `"element"`, `"dyad"` or `"group"`
    names: tuple[str, ...]  # the element, or the joints
    # Bars and cylinders, and joints in place of their guides, that hold the joints.
    conditions: tuple[str, ...] = ()


# Roles of what holds two points at a distance.
_HOLDING = ("bar", "cylinder")


@dataclass(frozen=True, slots=True)
class Build:
    """The steps, and what stands in the way."""

    steps: list[Step] = field(default_factory=list)  # in order
    loose: list[str] = field(default_factory=list)  # joints that can still move
    # Bars, and joints in place of their guides, that are too many.
    surplus: list[str] = field(default_factory=list)
    stuck: list[str] = field(default_factory=list)  # elements that could not be placed


def build(parts: Mapping[str, Part], placed: Iterable[str], ignored: Iterable[str] = ()) -> Build:
    """Find the order.

    `parts`: name of each element → what it needs and makes; `placed`: what is there from the start: points at
    rest; `ignored`: bars that are redundant: they hold nothing. Returns: the steps, as far as they go, and
    what is missing or too much.
    """
    return _Builder(dict(parts), set(placed), set(ignored)).run()


@dataclass(slots=True)
class _Builder:
    parts: dict[str, Part]
    placed: set[str]
    ignored: set[str]
    used: set[str] = field(default_factory=set)
    build: Build = field(default_factory=Build)

    def run(self) -> Build:
        while self._single() or self._together():
            pass
        self.build.stuck.extend(self.parts)
        return self.build

    def _single(self) -> bool:
        for name, part in self.parts.items():
            if part.role != "joint" and self.placed.issuperset(part.needs):
                if part.role in _HOLDING and name not in self.used and name not in self.ignored:
                    self.build.surplus.append(name)
                self._place([name], Step("element", (name,)))
                return True
        return False

    def _place(self, names: Iterable[str], step: Step) -> None:
        self.build.steps.append(step)
        for name in names:
            self.placed.update(self.parts.pop(name).makes)

    # -- joints ------------------------------------------------------------------------------------------

    def _together(self) -> bool:
        """Solve the first group of joints that depends on placed elements alone."""
        system = self._system()
        matched = _matching(system)
        joints = {joint for joint, _ in matched.values()}
        depends = {joint: set[str]() for joint in joints}
        for condition, (joint, _) in matched.items():
            depends[joint] |= system[condition]
        held = {joint: [c for c, (j, _) in matched.items() if j == joint] for joint in joints}
        full = {joint for joint in joints if len(held[joint]) == 2}
        for group in _smallest(depends, full):
            conditions = [c for c in system if c in matched and matched[c][0] in group]
            self._group(sorted(group, key=list(self.parts).index), conditions)
            return True
        self._complain(system, matched)
        return False

    def _system(self) -> dict[str, set[str]]:
        """Condition → the joints that it holds, without those that depend on other open elements."""
        system: dict[str, set[str]] = {}
        for name, part in self.parts.items():
            if name in self.ignored or part.role not in (*_HOLDING, "joint"):
                continue
            if part.role == "joint" and not part.needs:
                continue
            hangs = [self._joints_of(need) for need in part.needs]
            own = {name} if part.role == "joint" else set[str]()
            if None not in hangs:
                held = own.union(*(hang for hang in hangs if hang is not None))
                if held:
                    system[name] = held
        return system

    def _joints_of(self, need: str, depth: int = 0) -> set[str] | None:
        """Open joints that a point or link depends on; None if it depends on other open elements."""
        if need in self.placed:
            return set()
        maker = next((name for name, part in self.parts.items() if need in part.makes), None)
        if maker is None or depth > len(self.parts):
            return None
        part = self.parts[maker]
        if part.role == "joint":
            return {maker}
        if part.role in ("element", "cylinder"):
            return None
        below = [self._joints_of(need, depth + 1) for need in part.needs]
        return None if None in below else set().union(*(name for name in below if name is not None))

    def _group(self, joints: list[str], conditions: list[str]) -> None:
        self.used.update(conditions)
        kind: Literal["dyad", "group"] = "group"
        if len(joints) == 1 and not any(self._turns_with(condition, joints[0]) for condition in conditions):
            # The dyads have bars of constant length.
            varies = any(self.parts[condition].role == "cylinder" for condition in conditions)
            kind = "group" if varies else "dyad"
        self._place(joints, Step(kind, tuple(joints), tuple(conditions)))

    def _turns_with(self, condition: str, joint: str) -> bool:
        """Whether a condition holds the joint by something else than the joint itself and what is placed."""
        part = self.parts[condition]
        return any(need not in self.placed and need != joint for need in part.needs)

    def _complain(self, system: dict[str, set[str]], matched: dict[str, tuple[str, int]]) -> None:
        taken = list(matched.values())
        open_joints = [name for name, part in self.parts.items() if part.role == "joint"]
        self.build.loose.extend(
            joint for joint in open_joints if taken.count((joint, 0)) + taken.count((joint, 1)) < 2
        )
        self.build.surplus.extend(condition for condition in system if condition not in matched)


def _matching(system: Mapping[str, set[str]]) -> dict[str, tuple[str, int]]:
    """Gives each condition, if possible, one coordinate of a joint that it holds (augmenting paths)."""
    owner: dict[tuple[str, int], str] = {}

    def give(condition: str, seen: set[tuple[str, int]]) -> bool:
        for coordinate in [(joint, k) for joint in sorted(system[condition]) for k in (0, 1)]:
            if coordinate in seen:
                continue
            seen.add(coordinate)
            if coordinate not in owner or give(owner[coordinate], seen):
                owner[coordinate] = condition
                return True
        return False

    for condition in system:
        give(condition, set())
    return {condition: coordinate for coordinate, condition in owner.items()}


def _smallest(depends: Mapping[str, set[str]], full: set[str]) -> Iterator[set[str]]:
    """Smallest sets of joints that depend on themselves alone and are fully held, in ascending order."""
    reach = {joint: _reach(joint, depends) for joint in depends}
    for joint in sorted(reach, key=lambda group: (len(reach[group]), group)):
        if reach[joint] <= full:
            yield reach[joint]


def _reach(joint: str, depends: Mapping[str, set[str]]) -> set[str]:
    reach, open_ = {joint}, [joint]
    while open_:
        for other in depends.get(open_.pop(), ()):
            if other not in reach:
                reach.add(other)
                open_.append(other)
    return reach
