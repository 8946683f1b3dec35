"""What is wrong with a motion programme: angles and lifts that do not close, ends that contradict it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from pydantic_core import InitErrorDetails

from linkwright.cam.laws.programme import CLOSES, TURN, boundaries, section_law
from linkwright.cam.model.motion_section import ENDS, Family, MotionSection, key_of, stretch
from linkwright.kernel.description.base import fault, wrong
from linkwright.kernel.errors import LawError
from linkwright.kernel.units import LENGTH, to_text

# Slopes that differ by less than this share are the same slope.
_SAME = 1e-9


def section_faults(
    sections: Sequence[MotionSection], expected: Family = "lift", key: str = "sections"
) -> Iterator[InitErrorDetails]:
    """What is wrong with the sections of a programme."""
    if not sections:
        yield fault(key, found="an empty list", expected="at least one section")
        return
    found = [
        each
        for i, section in enumerate(sections)
        for each in (*_family_faults(section, expected, (key, i)), *_own_faults(section, expected, (key, i)))
    ]
    found += _turn_faults(sections, key)
    found = found or list(_lift_faults(sections, expected, key))
    yield from found or _law_faults(sections, expected, key)


def _family_faults(
    section: MotionSection, family: Family, place: tuple[str | int, ...]
) -> Iterator[InitErrorDetails]:
    """Entries of the other kind of follower."""
    other: Family = "lift" if family == "swing" else "swing"
    moves = "swings" if family == "swing" else "moves along a guide"
    for here, instead in ((other, family), *((key_of(n, other), key_of(n, family)) for n in ENDS)):
        value = getattr(section, here)
        if value is not None:
            yield fault(*place, here, found=value, expected=f"{instead}: the follower {moves}")


def _own_faults(
    section: MotionSection, family: Family, place: tuple[str | int, ...]
) -> Iterator[InitErrorDetails]:
    """Ends that contradict the section itself, and a lift that nothing says."""
    said = {name: section.end(name, family) for name in ENDS}
    if section.is_dwell:
        yield from _ends_other_than(0.0, said, "0, as the section is a dwell", family, place)
        return
    lift = section.change(family)
    if lift is None:
        other = f", or {key_of('velocity_start', family)}" if section.is_steady else ""
        yield fault(*place, family, expected=f"how far the section goes{other}")
    elif section.is_steady:
        slope = lift / section.angle
        words = f"the slope {slope:.10g}, which the section has throughout"
        speeds = {name: value for name, value in said.items() if name.startswith("velocity")}
        yield from _ends_other_than(slope, speeds, words, family, place)
        bends = {name: value for name, value in said.items() if name.startswith("acceleration")}
        yield from _ends_other_than(0.0, bends, "0, as the velocity is constant", family, place)


def _ends_other_than(
    wanted: float,
    said: dict[str, float | None],
    expected: str,
    family: Family,
    place: tuple[str | int, ...],
) -> Iterator[InitErrorDetails]:
    """Entries that are given and are not what they must be."""
    for name, value in said.items():
        if value is not None and abs(value - wanted) > _SAME * abs(wanted):
            yield fault(*place, key_of(name, family), found=value, expected=expected)


def _turn_faults(sections: Sequence[MotionSection], key: str) -> Iterator[InitErrorDetails]:
    """Angles that do not add to a revolution."""
    turn = math.fsum(section.angle for section in sections)
    over = turn - TURN
    if abs(over) <= CLOSES * TURN:
        return
    # A dwell can give way without touching any motion; the longest changes least for its length.
    longest = max(range(len(sections)), key=lambda i: (sections[i].is_dwell, sections[i].angle))
    if sections[longest].angle <= over:
        longest = max(range(len(sections)), key=lambda i: sections[i].angle)
    new = sections[longest].angle - over
    few = f'{_degrees(over)} too much: {key}.{longest}.angle = "{_degrees(new)}" closes the revolution'
    many = f"{_degrees(over)} too much: more than any one section has; shorten all to {TURN / turn:.6g} of it"
    short = f'{_degrees(-over)} missing: {key}.{longest}.angle = "{_degrees(new)}" closes the revolution'
    remedy = short if over < 0 else few if new > 0 else many
    found = f"angles that add to {_degrees(turn)}"
    problem = wrong(found, "angles that add to 360 deg", remedy)
    yield InitErrorDetails(type=problem, loc=(key,), input=found)


def _lift_faults(sections: Sequence[MotionSection], family: Family, key: str) -> Iterator[InitErrorDetails]:
    """Lifts that do not come back to zero."""
    lifts = [section.change(family) or 0.0 for section in sections]
    over, largest = math.fsum(lifts), max(map(abs, lifts))
    if abs(over) <= CLOSES * largest:
        return
    # The last section that moves brings the follower home.
    last = max(i for i, lift in enumerate(lifts) if lift)
    noun = "swings" if family == "swing" else "lifts"
    remedy = f'{key}.{last}.{family} = "{_size(lifts[last] - over, family)}" brings the follower back'
    found = f"{noun} that add to {_size(over, family)}"
    problem = wrong(found, f"{noun} that add to 0", remedy)
    yield InitErrorDetails(type=problem, loc=(key,), input=found)


def _law_faults(sections: Sequence[MotionSection], family: Family, key: str) -> Iterator[InitErrorDetails]:
    """Laws that cannot do what their section asks."""
    stretches = [stretch(section, family) for section in sections]
    for i, (section, task) in enumerate(zip(stretches, boundaries(stretches), strict=True)):
        try:
            section_law(section, task)
        except LawError as error:
            problem = error.problem
            below = (part for part in problem.key.split(".") if part)
            words = wrong(problem.found, problem.expected, problem.remedy)
            yield InitErrorDetails(type=words, loc=(key, i, "law", *below), input=problem.found)


def _degrees(angle: float) -> str:
    """An angle in degrees, to ten digits."""
    return f"{math.degrees(angle):.10g} deg"


def _size(value: float, family: Family) -> str:
    """A lift or a swing with its unit, to ten digits."""
    return _degrees(value) if family == "swing" else to_text(float(f"{value:.10g}"), LENGTH)
