"""Limits of a size by the text of its tolerance, as on a drawing, and by the clearance of a joint.

A tolerance in percent is a share of the size, of whatever quantity this is: 1 % of a ratio of 4 is 0.04.
"""

from __future__ import annotations

import math
import re

from linkwright.kernel.errors import MachineError, Problem, UnitError, show
from linkwright.kernel.units.kinds import LENGTH, RATIO, Dimension, Kind
from linkwright.kernel.units.reading import NUMBER, parse, worded
from linkwright.kernel.units.spellings import factor_of
from linkwright.machine import iso286

# "± 0.2 mm"; "+0.1 -0.3 mm" or "+0.1/-0.3 mm", in either order; before it there may be the size,
# "0.8 m ± 0.2 mm". A comma belongs to the number, so that it is that which is refused.
_AND = r"(?:\s*+/\s*+|\s++)"
# One of two limits: with its sign, or 0, as drawings write it.
_SIGNED, _ZERO = r"[+-]\s*+[\d.,]++(?:[eE][+-]?\d++)?", r"0(?:[.,]0*+)?"
_LIMIT = rf"(?:{_SIGNED}|{_ZERO})"
_SIZE = re.compile(r"\s*+-?[\d.,]++(?:[eE][+-]?\d++)?")
_SIGN = re.compile(r"[±+-]")
_ZERO_FIRST = re.compile(rf"(?<=\s){_ZERO}{_AND}\Z")
_LIMITS = re.compile(rf"±|\+/-|{_SIGNED}{_AND}{_LIMIT}|{_ZERO}{_AND}{_SIGNED}")
_EVEN = re.compile(r"\s*+(?:±|\+/-)\s*+([\d.,]++(?:[eE][+-]?\d++)?)\s*+(.*)", re.DOTALL)
_UNEVEN = re.compile(rf"\s*+({_LIMIT}){_AND}({_LIMIT})\s*+(.*)", re.DOTALL)
# A number and its unit.
_MEASURE = re.compile(rf"({NUMBER.pattern})\s*+(.*)", re.DOTALL)
# A size and its class, "25 H7", "25 mm H7", "0.2 m H7": grades are no powers of a unit.
_CODED = re.compile(
    rf"\s*+({NUMBER.pattern})(?:\s*+([A-Za-zµ]++)(?=\s))?\s++([A-Za-z]{{1,2}}(?:[5-9]|1\d))\s*+"
)


def problem(key: str, found: str, expected: str, remedy: str = "") -> MachineError:
    """What is wrong with a tolerance or a clearance."""
    return MachineError([Problem(key, found, expected, remedy)])


def size_and_limits(text: str) -> tuple[str, str] | None:
    """Size and tolerance of a text with both, "0.8 m ± 0.2 mm"; None of another."""
    if code := _CODED.fullmatch(text):
        return f"{code[1]} {code[2] or 'mm'}", code[3]
    parts = _divided(text)
    if parts is None:
        return None
    size, limits, unit = parts
    # On a drawing the unit at the end is that of all numbers.
    return (f"{size} {unit}".strip() if NUMBER.fullmatch(size) and not _is_share(unit) else size), limits


def is_bare(text: str) -> bool:
    """Whether a tolerance has no unit although its size has one: "90 deg ± 0.5"."""
    parts = _divided(text)
    return parts is not None and not parts[2] and not NUMBER.fullmatch(parts[0])


def _divided(text: str) -> tuple[str, str, str] | None:
    sized = _sized(text.replace("−", "-"))
    if sized is None or not _MEASURE.fullmatch(sized[0]):
        return None
    size, limits = sized
    match = _EVEN.fullmatch(limits) or _UNEVEN.fullmatch(limits)
    return None if match is None else (size, limits, match[match.re.groups].strip())


def _sized(text: str) -> tuple[str, str] | None:
    """The size and what follows it, from the first sign or the zero before it; None of another text."""
    size = _SIZE.match(text)
    sign = _SIGN.search(text, size.end()) if size else None
    if size is None or sign is None:
        return None
    zero = _ZERO_FIRST.search(text, size.end(), sign.start())
    places = (zero.start(), sign.start()) if zero else (sign.start(),)
    at = next((place for place in places if _LIMITS.match(text, place)), None)
    return None if at is None else (text[:at].strip(), text[at:].strip())


def toleranced(key: str, value: object, text: str, kind: Kind) -> tuple[float, float]:
    """Limits of an entry by the text of its tolerance, which stands at a key."""
    if not isinstance(value, int | float):
        raise problem(key, "an entry without a value", "an entry that the machine has")
    stripped = text.replace("−", "-")
    # Behind a value the size may have another unit than millimetres.
    coded = _CODED.fullmatch(stripped)
    if code := iso286.CODE.fullmatch(coded[3] if coded and coded[2] not in (None, "mm") else stripped):
        return _coded(key, float(value), text, code, kind)
    size, limits = _sized(stripped) or (None, stripped)
    parts, unit = _parts(key, text, limits)
    if _is_share(unit):
        shares = [_measure(key, text, part, unit, RATIO) for part in parts]
        changes, unit = [abs(value) * share for share in shares], ""
        _refuse_points(key, text, size, max(map(abs, shares)))
    else:
        changes = [_measure(key, text, part, unit, kind) for part in parts]
    if size is not None:
        _require_size(key, float(value), text, size, unit, kind)
    low, high = sorted(value + change for change in changes)
    if not low < high:
        raise problem(key, show(text), "two limits that differ")
    return low, high


def _parts(key: str, text: str, limits: str) -> tuple[tuple[str, str], str]:
    """The two numbers of a tolerance with their signs, and the unit behind them."""
    if match := _EVEN.fullmatch(limits):
        return (f"-{match[1]}", match[1]), match[2]
    if match := _UNEVEN.fullmatch(limits):
        return (match[1].replace(" ", ""), match[2].replace(" ", "")), match[3]
    expected = 'such as "± 0.2 mm", "± 1 %", "800 ± 0.2 mm", "+0.1 -0.3 mm" or "25 H7"'
    raise problem(key, show(text), expected)


def _is_share(unit: str) -> bool:
    known = factor_of(unit) if unit else None
    return known is not None and known[1] == Dimension()


def _refuse_points(key: str, text: str, size: str | None, share: float) -> None:
    """Refuse a share of a size that is in percent itself: it may be meant as a difference in percent."""
    parts = _MEASURE.fullmatch(size or "")
    if parts is not None and _is_share(parts[2].strip()):
        expected = "a size without percent, of which the tolerance is a share"
        remedy = f'write "± {100 * share:.6g} %" for that share of the size, "± {share:.6g}" for a difference'
        raise problem(key, show(text), expected, remedy)


def _measure(key: str, given: str, text: str, unit: str, kind: Kind) -> float:
    """A number of a tolerance; without a unit of its own it has that at the end, as on a drawing."""
    is_bare = NUMBER.fullmatch(text)
    try:
        return parse(float(text) if is_bare and not unit else f"{text} {unit if is_bare else ''}", kind)
    except UnitError as error:
        raise problem(key, show(given), error.problem.expected, error.problem.remedy) from None


def _require_size(key: str, value: float, text: str, size: str, unit: str, kind: Kind) -> None:
    given = _measure(key, text, size, unit, kind)
    if abs(given - value) > 1e-9 * abs(value):
        parts = _MEASURE.fullmatch(size)
        assert parts is not None
        # As many digits as are compared: a size so written is accepted.
        shown = f"{float(parts[1]) * value / given:.10g} {parts[2] or unit}" if given else worded(value, kind)
        expected = f"the size that the machine has, {shown.rstrip()}"
        raise problem(key, show(text), expected, "leave the size out")


def _coded(key: str, value: float, text: str, code: re.Match[str], kind: Kind) -> tuple[float, float]:
    """Limits of a size by its class of ISO 286; the nominal size is that of the machine."""
    if kind.unit != LENGTH.unit:
        raise problem(key, f"{show(text)} of {kind.word}", "limits with a unit: classes are of lengths")
    size, letter, grade = code.groups()
    if size is not None and abs(float(size) * 1e-3 - value) > 1e-9 * abs(value):
        expected = f"the size that the machine has, {value * 1e3:.6g} mm"
        raise problem(key, show(text), expected, f'"{letter}{grade}" takes that size')
    limits = iso286.deviations(value, letter, int(grade))
    if limits is None:
        found = f"{show(text)} of {value * 1e3:.6g} mm"
        is_sized = 0 < value * 1e3 <= iso286.GREATEST
        expected = iso286.KNOWN if is_sized else f"a size above 0 and to {iso286.GREATEST} mm"
        raise problem(key, found, expected, "give the limits themselves")
    return value + limits[0], value + limits[1]


def half_clearance(key: str, value: object, given: float | str, kind: Kind) -> float:
    """How far a pin that bears on its hole shifts along a length, at most [m]."""
    if not isinstance(value, int | float) or kind.unit != LENGTH.unit:
        raise problem(key, f"one of {kind.word}", "one of a length that the machine has")
    fit = iso286.FIT.fullmatch(given) if isinstance(given, str) else None
    clearance = parsed(key, given, kind) if fit is None else _of_fit(key, fit)
    if not clearance > 0:
        raise problem(key, show(given), "more than 0")
    return 0.5 * clearance


def parsed(key: str, value: object, kind: Kind) -> float:
    """A value as the quantity of its entry."""
    try:
        return parse(value, kind)
    except UnitError as error:
        raise problem(key, error.problem.found, error.problem.expected, error.problem.remedy) from None


def _of_fit(key: str, fit: re.Match[str]) -> float:
    """Clearance of a fit with pin and hole in the middle of their limits [m]."""
    size, hole, hole_grade, pin, pin_grade = fit.groups()
    limits = [
        iso286.deviations(float(size) * 1e-3, letter, int(grade))
        for letter, grade in ((hole, hole_grade), (pin, pin_grade))
    ]
    if not 0 < float(size) <= iso286.GREATEST:
        raise problem(key, show(fit[0]), f"a size to {iso286.GREATEST} mm")
    if limits[0] is None or limits[1] is None or not hole.isupper() or not pin.islower():
        raise problem(key, show(fit[0]), f"a hole and a pin, {iso286.KNOWN}")
    if limits[0][0] < limits[1][1]:
        text = f"{show(fit[0])}, a transition or interference fit"
        raise problem(key, text, "a clearance fit")
    return 0.5 * (sum(limits[0]) - sum(limits[1]))


def of_pin(length: float, play: float) -> tuple[str, float, float]:
    """Scatter of a length by a pin that bears in a direction of which none is preferred: a sine of it."""
    return "arcsine", length, play / math.sqrt(2.0)
