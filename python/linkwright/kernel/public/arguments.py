"""What the public functions take: plain numbers, whole numbers and lists of them, checked and named.

Checks follow the annotations of a function. A list becomes an array of its own, which nobody else writes to;
a complex number, a text or a list of lists of different length is refused with the name of the argument.

| annotation | takes |
| --- | --- |
| `float` | a finite number; an infinite one where that is the default |
| `int` | a whole number; some have limits by their name |
| `bool`, `str` | true or false; a text |
| a name of `Literal[…]` or `Callable[…]` in the module of the function | one of these words; a function |
| `ArrayLike` | numbers, one or an array of them |
| `Column` | a number, or a list of them |
| `Floats`, `Sequence[float]` | a list of finite numbers |
| `os.PathLike[str]` | the name of a file |
| `Overrides` | texts ``PATH=VALUE``, or path → value |
| `Sequence[str]`, `Iterable[str]` | texts, not one text |
| `Mapping[str, …]` | something by name |
| `Machine`, `Study`, … | what `read` and `study` give, and other classes of the package |
"""

from __future__ import annotations

import inspect
import math
import numbers
import operator
import os
from collections.abc import Callable, Mapping
from typing import Any, Literal, NamedTuple, get_args, get_origin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, ShapeError

Check = Callable[[str, Any], Any]

# A number or a list of numbers, not a table.
Column = ArrayLike


class Range(NamedTuple):
    """Minimum and maximum value, both allowed."""

    least: float
    greatest: float


# Numbers that mean the same wherever they occur. Ten million angles are some hundred megabytes of each curve.
RANGES: dict[str, Range] = {
    "n": Range(1, 10_000_000),
    "fine": Range(1, 1_000_000),
    "count": Range(1, 10_000_000),
    "per_turn": Range(16, 1_000_000),
    "order": Range(0, 100_000),
    # What every generator of random numbers takes.
    "seed": Range(0, 2**32 - 1),
    # Confidence level: nearer to 0 or 1 an interval has no width, or no end, in rounding.
    "level": Range(1e-3, 1 - 1e-9),
}

# How much of a wrong value is shown.
_SHOWN = 60


def number(name: str, value: Any, *, finite: bool = True, infinite: bool = False) -> float:
    """A real number in its range as a float, else an `InputError`; `infinite`: whether it may be infinite."""
    # Most are floats; whether a value is of an abstract class takes a microsecond to tell.
    real = value if type(value) is float else _real(name, value)
    if finite and (math.isnan(real) or (math.isinf(real) and not infinite)):
        raise _wrong(name, value, "a finite number")
    if name in RANGES:
        _require_in_range(name, real, f"{real:g}")
    return real


def _real(name: str, value: Any) -> float:
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, bool | np.bool_) or not isinstance(value, numbers.Real):
        raise _wrong(name, value, "a number")
    try:
        return float(value)
    except OverflowError:
        raise _wrong(name, value, "a number below 1e308 in size") from None


def integer(name: str, value: Any) -> int:
    """A whole number; an `InputError` if it is none, or out of its range."""
    try:
        number = operator.index(value)
    except TypeError:
        raise _wrong(name, value, "a whole number") from None
    # Beyond 2⁵³ whole numbers are no floats.
    if isinstance(value, bool | np.bool_) or abs(number) > 2**53:
        raise _wrong(name, value, "a whole number of usual size")
    if name in RANGES:
        _require_in_range(name, number, shown(number))
    return number


def array(name: str, value: Any, *, finite: bool = True, complex_too: bool = False) -> NDArray[Any]:
    """Numbers of any shape as a contiguous array of floats, or complex, that is its own and read-only.

    Raises `ShapeError` if they are no numbers, rows of different length, or not finite where they must be.
    """
    try:
        given = np.asarray(value)
    except (TypeError, ValueError, OverflowError):
        raise ShapeError(f"{name}: found {shown(value)}, expected numbers in rows of one length") from None
    if given.dtype == object and all(isinstance(entry, numbers.Real) for entry in given.flat):
        # Fractions, and whole numbers beyond those of machines.
        given = np.array([number(name, entry) for entry in given.flat]).reshape(given.shape)
    # Of a masked array the masks would be lost.
    if isinstance(value, np.ndarray) and np.any(getattr(value, "mask", False)):
        raise ShapeError(f"{name}: found masked values, expected numbers; leave the masked ones out")
    kinds = "iufc" if complex_too else "iuf"
    if given.dtype.kind not in kinds:
        raise ShapeError(f"{name}: found {shown(value)}, expected {'' if complex_too else 'real '}numbers")
    result = np.array(given, dtype=complex if complex_too else np.float64, order="C")
    if finite and not np.isfinite(result).all():
        first = int(np.argmin(np.isfinite(result)))
        raise ShapeError(f"{name}: found {result.flat[first]:g} at index {first}, expected finite numbers")
    result.flags.writeable = False
    return result


def rows(name: str, value: Any) -> Floats:
    """A list of finite numbers, (n,), contiguous and read-only; a `ShapeError` if it is none, or empty."""
    numbers = array(name, value)
    if numbers.ndim != 1 or not len(numbers):
        raise ShapeError(f"{name}: found an array of shape {numbers.shape}, expected a list of numbers")
    return numbers


def shown(value: Any) -> str:
    """A value in a message, cut where it is long."""
    if isinstance(value, np.ndarray):
        return f"an array of {value.dtype} of shape {value.shape}"
    if isinstance(value, int) and value.bit_length() > 128:
        return f"a whole number of {value.bit_length()} bits"
    text = repr(value)
    return text if len(text) <= _SHOWN else text[:_SHOWN] + "…"


def checks_of(function: Callable[..., Any]) -> dict[str, Check]:
    """Checks of the arguments of a function by name: what takes name and value, and returns the value.

    Its annotations are texts, as with ``from __future__ import annotations``.
    """
    parameters = inspect.signature(function).parameters.values()
    checks = {
        parameter.name: _check(str(parameter.annotation), parameter.default)
        or _choice(str(parameter.annotation), function.__globals__)
        for parameter in parameters
    }
    return {name: check for name, check in checks.items() if check is not None}


def _check(annotation: str, default: Any) -> Check | None:
    kinds = {annotation} if annotation in _CHECKS else set(annotation.split(" | "))
    if kinds & _KINDS.keys() and kinds <= _KINDS.keys() | {"None"}:
        return _of_kinds(kinds)
    if {"float", "Floats"} <= kinds:
        kinds |= {"Column"}
    asked = [_CHECKS[kind] for kind in _CHECKS if kind in kinds]
    check = _named_or(asked[1]) if _mapping in asked[:-1] else next(iter(asked), None)
    if check is number and isinstance(default, float) and math.isinf(default):
        check = _any_number
    others = kinds - _CHECKS.keys() - {"None"}
    if check is None or (others and check is _text):
        return None
    numeric = (int, float, complex, str, list, np.ndarray, np.generic)

    def checked(name: str, value: Any) -> Any:
        is_left_out = value is default or (value is None and "None" in kinds)
        if is_left_out or (others and not isinstance(value, numeric)):
            return value
        return check(name, value)

    return checked


def _choice(annotation: str, known: Mapping[str, Any]) -> Check | None:
    """The check of an annotation of some words or a function, or of them and None; else None."""
    first, *others = annotation.split(" | ")
    if others not in ([], ["None"]):
        return None
    if first.startswith("Callable[") or get_origin(known.get(first)) is Callable:
        return _function(is_optional=bool(others))
    if get_origin(known.get(first)) is not Literal:
        return None
    words: tuple[Any, ...] = get_args(known[first])

    def check(name: str, value: Any) -> Any:
        is_none = value is None and bool(others)
        if not is_none and not (isinstance(value, str) and value in words):
            raise _wrong(name, value, "one of " + ", ".join(f'"{word}"' for word in words))
        return value

    return check


def _function(*, is_optional: bool) -> Check:

    def check(name: str, value: Any) -> Any:
        if not callable(value) and not (value is None and is_optional):
            raise _wrong(name, value, "a function")
        return value

    return check


def _any_number(name: str, value: Any) -> float:
    return number(name, value, infinite=True)


def _one_or_more(name: str, value: Any) -> Any:
    """A number stays one; lists become arrays. How large they may be depends on what they are."""
    if isinstance(value, numbers.Number):
        return number(name, value, finite=False)
    return array(name, value, finite=False)


def _column(name: str, value: Any) -> Any:
    if isinstance(value, numbers.Number):
        return _one_or_more(name, value)
    return rows(name, np.atleast_1d(array(name, value)))


def _two(name: str, value: Any) -> tuple[float, float]:
    pair = rows(name, value)
    if len(pair) != 2:
        raise ShapeError(f"{name}: found {len(pair)} numbers, expected two")
    return float(pair[0]), float(pair[1])


def _two_whole(name: str, value: Any) -> tuple[int, int]:
    pair = _several(name, value, "two whole numbers")
    if len(pair) != 2:
        raise _wrong(name, value, "two whole numbers")
    return integer(name, pair[0]), integer(name, pair[1])


def _three(name: str, value: Any) -> Any:
    if not isinstance(value, tuple | list) or len(value) != 3:
        raise _wrong(name, value, "three numbers or arrays")
    return tuple(_one_or_more(name, entry) for entry in value)


def _complexes(name: str, value: Any) -> Any:
    return array(name, value, complex_too=True)


def _mapping(name: str, value: Any) -> Any:
    """Something by name; what it is the function checks itself."""
    if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
        raise _wrong(name, value, "a dictionary with names")
    return value


def _mappings(name: str, value: Any) -> Any:
    for key, table in _mapping(name, value).items():
        _mapping(f"{name}[{key}]", table)
    return value


def _named_or(other: Check) -> Check:
    return lambda name, value: (_mapping if isinstance(value, Mapping) else other)(name, value)


def _truth(name: str, value: Any) -> bool:
    if not isinstance(value, bool | np.bool_):
        raise _wrong(name, value, "true or false")
    return bool(value)


def _truths(name: str, value: Any) -> Any:
    truths = _several(name, value, "a list of truths")
    if not truths or not all(isinstance(truth, bool | np.bool_) for truth in truths):
        raise _wrong(name, value, "a list of truths")
    return np.array(truths)


def _text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise _wrong(name, value, "a text")
    return value


def _path(name: str, value: Any) -> Any:
    try:
        # Bytes of a name that are no text have substitutes; other halves of characters stand for none.
        is_name = b"\0" not in os.fsencode(value)
    except (TypeError, UnicodeEncodeError):
        is_name = False
    if not is_name or isinstance(value, bytes):
        raise _wrong(name, value, "the name of a file")
    return value


def _overrides(name: str, value: Any) -> Any:
    if isinstance(value, Mapping):
        return _mapping(name, value)
    is_list = isinstance(value, str) or (isinstance(value, list | tuple) and all(map(_is_text, value)))
    if not is_list:
        raise _wrong(name, value, "texts PATH=VALUE, or a dictionary of values by their paths")
    return value


def _texts(name: str, value: Any) -> Any:
    texts = _several(name, value, "a list of texts")
    if not all(map(_is_text, texts)):
        raise _wrong(name, value, "a list of texts")
    return texts


def _parts(kind: str, expected: str) -> Check:
    """Checks that something is several parts of a catalogue."""

    def check(name: str, value: Any) -> Any:
        listed = _several(name, value, expected)
        if not all(type(part).__name__ == kind for part in listed):
            raise _wrong(name, value, expected)
        return listed

    return check


def _cards_or_files(name: str, value: Any) -> Any:
    listed = _several(name, value, "a list of cards, such as read_card() gives, or of their files")
    return tuple(part if type(part).__name__ == "SurfaceCard" else _path(name, part) for part in listed)


def _numbers_or_texts(name: str, value: Any) -> Any:
    parts = _several(name, value, "a list of numbers or texts")
    return tuple(part if _is_text(part) else number(name, part) for part in parts)


def _several(name: str, value: Any, expected: str) -> tuple[Any, ...]:
    """What a list holds; one text alone would be taken for its letters."""
    if isinstance(value, str | bytes):
        raise _wrong(name, value, expected)
    try:
        return tuple(value)
    except TypeError:
        raise _wrong(name, value, expected) from None


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


# Classes of the package that arguments may be, by their names as they lie in layers above.
_KINDS = {
    "Machine": "a machine, such as read() gives",
    "Study": "a study, such as study() gives",
    "FreeVibration": "a free vibration",
    "StudyPlan": "a study file that was read, such as read_study() gives",
    "MeasuredRecord": "a measured record, such as read_record() gives",
    "Transient": "a motion in time, such as transient() gives",
    "SteadyState": "a steady motion, such as steady_state() gives",
    "ElasticMotion": "a steady motion, such as elastic_motion() gives",
    "ElasticTransient": "a motion in time, such as elastic_transient() gives",
    "Motion": "a motion over time, such as motion() gives",
    "TorsionResponse": "a torsional response, such as forced_vibration() gives",
    "Forces": "joint forces, such as forces() gives",
    "Drawing": "a drawing, such as cam_drawings() gives",
    "CamProfile": "a cam profile, such as cam_profile() gives",
    "CamCourse": "a cam's course, such as cam_course() gives",
    "Push": "a push, such as pushes() gives",
    "DriverCycle": "the cycle of a driver, such as that of servo_axis()",
    "FollowerLoad": "a FollowerLoad",
    "OneMass": "a OneMass",
    "Material": "a Material",
    "MotionLaw": "a motion law",
    "MeasuredSpeed": "a measured speed, such as measured_speed() gives",
    "Mechanism": "a mechanism, such as a machine has",
    "FunctionTask": "a FunctionTask",
    "PathTask": "a PathTask",
    "PoseTask": "a PoseTask",
    "ReciprocatingEngine": "an engine, such as a train has",
    "Claim": "a Claim",
    "Stroke": "a Stroke",
    "TrainTransient": "a manoeuvre, such as a train has",
    "Heading": "a head of reports, such as read_heading() gives",
}


def _of_kinds(kinds: set[str]) -> Check:
    expected = " or ".join(words for kind, words in _KINDS.items() if kind in kinds)

    def check(name: str, value: Any) -> Any:
        is_none = value is None and "None" in kinds
        if not is_none and kinds.isdisjoint(base.__name__ for base in type(value).__mro__):
            raise _wrong(name, value, expected)
        return value

    return check


_CHECKS: dict[str, Check] = {
    "os.PathLike[str]": _path,
    "Overrides": _overrides,
    "Mapping[str, Any]": _mapping,
    "Mapping[str, ArrayLike]": _mapping,
    "Mapping[str, Mapping[str, Any]]": _mappings,
    "Mapping[str, Floats]": _mapping,
    "Mapping[str, float]": _mapping,
    "Mapping[str, str]": _mapping,
    "Mapping[str, DriverCycle]": _mapping,
    "Mapping[str, Friction]": _mapping,
    "Mapping[str, MeasuredResponse]": _mapping,
    "Sequence[str]": _texts,
    "Sequence[float | str]": _numbers_or_texts,
    "Iterable[str]": _texts,
    "Sequence[DriveSwitch]": _parts("DriveSwitch", "a list of DriveSwitch"),
    "Sequence[SurfaceCard]": _parts("SurfaceCard", "a list of cards, such as read_card() gives"),
    "Sequence[CardOrFile]": _cards_or_files,
    "Sequence[CatalogueMotor]": _parts(
        "CatalogueMotor", "a list of motors, such as motors() or read_motors() gives"
    ),
    "Sequence[CatalogueServo]": _parts(
        "CatalogueServo", "a list of servo motors, such as read_servo_motors() gives"
    ),
    "Sequence[CatalogueGearbox]": _parts(
        "CatalogueGearbox", "a list of gearboxes, such as read_gearboxes() gives"
    ),
    "ArrayLike": _one_or_more,
    "tuple[ArrayLike, ArrayLike, ArrayLike]": _three,
    "tuple[float, float]": _two,
    "tuple[int, int]": _two_whole,
    "Column": _column,
    "Floats": rows,
    "Complexes": _complexes,
    "Sequence[float]": rows,
    "int": integer,
    "float": number,
    "bool": _truth,
    "Bools": _truths,
    "str": _text,
}


def _require_in_range(name: str, value: float, text: str) -> None:
    allowed = RANGES[name]
    if not allowed.least <= value <= allowed.greatest:
        limits = f"at least {allowed.least:.15g}, at most {allowed.greatest:.15g}"
        raise InputError(f"{name}: found {text}, expected {limits}")


def _wrong(name: str, value: Any, expected: str) -> InputError:
    return InputError(f"{name}: found {shown(value)}, expected {expected}")
