"""Curves of a study by name, and their picture: all results, every point, link and slide over the cycle."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from io import BytesIO
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from linkwright.app.study import Study
from linkwright.drive.cycle_motion import CycleMotion
from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError
from linkwright.kernel.figure.lines import Line, Panel, line_figure
from linkwright.kernel.figure.style import LINES, named, styled
from linkwright.kernel.quantities import Label, declared, over
from linkwright.kernel.reader.angle_marks import mark_angles
from linkwright.kernel.reader.out_units import reader
from linkwright.kernel.result import Result
from linkwright.linkages.motion import Motion

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# What people say for the position of a slide.
_OTHER_WORDS = {"position": "place", "displacement": "place"}

CRANK_ANGLE = "crank_angle"

# Derivatives by the time, the last part of a name.
_RATES = ("velocity", "acceleration", "jerk")

_COORDINATES = {"place": "position", "angle": "angle"}

# What an axis holds, by its SI unit.
_HELD = {
    "m": "position",
    "m/s": "velocity",
    "m/s²": "acceleration",
    "rad": "angle",
    "rad/s": "speed",
    "rad/s²": "angular acceleration",
    "N": "force",
    "N m": "torque",
    "W": "power",
    "J": "energy",
    "s": "time",
    "kg m²": "moment of inertia",
}


@dataclass(frozen=True)
class Curve:
    """A curve of a study."""

    name: str  # with the analysis before it: `"motion.ram.place.velocity"`
    values: Floats  # (n,): [unit]
    unit: str  # SI unit; empty for a plain number
    # Name of what it runs over, without the analysis, and its SI unit.
    over: str
    over_unit: str
    x: Floats  # (n,): what it runs over
    scale: float = 0.0  # largest value of its analysis with its unit; what is rounding beside it is zero
    word: str = ""  # of a declared quantity: ``"driving torque"``
    over_word: str = ""  # with the symbol, of what is declared: ``"crank angle φ"``

    @property
    def words(self) -> str:
        """What tables and legends call it: ``"ram, velocity"``."""
        return self.word or coordinate_words(self.name.split(".", 1)[1])

    @property
    def over_words(self) -> str:
        """What it runs over."""
        return self.over_word or coordinate_words(self.over).replace("_", " ")


def coordinate_words(name: str) -> str:
    """A coordinate and its derivative: ``"ram.place.velocity"`` is ``"ram, velocity"``."""
    coordinate, _, last = name.rpartition(".")
    if coordinate and last in _RATES:
        link = coordinate.removesuffix(".angle")
        return (
            f"{coordinate.removesuffix('.place')}, {last}"
            if link == coordinate
            else f"{link}, angular {last}"
        )
    if coordinate and last in _COORDINATES:
        return f"{coordinate}, {_COORDINATES[last]}"
    return name


def curves_of(study: Study) -> dict[str, Curve]:
    """All curves of a study by name."""
    return {curve.name: curve for name, result in study.results().items() for curve in _of(name, result)}


def _of(analysis: str, result: Result) -> Iterator[Curve]:
    curves = dict(result.curves())
    units = {name: result.unit_of(name) for name in curves}
    for head, curve in result.columns().items():
        name, _, unit = head.rpartition(" [")
        curves[name], units[name] = curve, "" if unit == "-]" else unit.rstrip("]")
    # A motion is known over the time, and asked for over the crank angle.
    first = CRANK_ANGLE if isinstance(result, Motion) else next(iter(curves), "")
    scales = _scales(curves, units)
    for name, curve in curves.items():
        is_declared = name in declared(type(result)) and not isinstance(result, Motion)
        along = over(type(result), name) if is_declared else first
        if along and along in curves and name != along:
            scale = scales.get(units[name], 0.0)
            mark = declared(type(result))[name][1] if is_declared else None
            word = mark.word if isinstance(mark, Label) else ""
            x = along, units[along], curves[along]
            yield Curve(
                f"{analysis}.{name}", curve, units[name], *x, scale, word, _with_symbol(result, along)
            )


def _with_symbol(result: Result, name: str) -> str:
    """Words of a declared quantity with its symbol: a cam angle θ is no crank angle φ."""
    mark = declared(type(result)).get(name, (None, None))[1]
    return f"{mark.word} {mark.symbol}".rstrip() if isinstance(mark, Label) else ""


def _scales(curves: Mapping[str, Floats], units: Mapping[str, str]) -> dict[str, float]:
    """Largest magnitude of the curves of each unit; plain numbers stand beside no other."""
    scales: dict[str, float] = {}
    for name, curve in curves.items():
        if unit := units[name]:
            largest = float(np.nanmax(np.abs(curve), initial=0.0))
            scales[unit] = max(scales.get(unit, 0.0), largest if np.isfinite(largest) else 0.0)
    return scales


def chosen(study: Study, names: Sequence[str], along: str | None = None) -> list[Curve]:
    """The curves that are asked for, over what is asked for.

    `names`: in full, or so many of their parts in order that one curve alone has them and ends so:
    ``"ram.velocity"`` is ``"motion.ram.place.velocity"``. `along`: another curve of the same result to draw
    over. Raises `InputError` if there is no such curve, or several; or they run over different quantities.
    """
    known = curves_of(study)
    curves = [known[_name(name, known)] for name in names]
    if along is not None:
        curves = [_over(curve, along, known) for curve in curves]
    first = curves[0]
    for curve in curves[1:]:
        if (curve.over, curve.over_unit) != (first.over, first.over_unit):
            raise InputError(
                f"{curve.name} runs over {curve.over}, {first.name} over {first.over}: draw them "
                "separately, or give --over with a quantity that both have"
            )
    return curves


def _name(asked: str, known: dict[str, Curve]) -> str:
    if asked in known:
        return asked
    parts = [_OTHER_WORDS.get(part, part) for part in asked.split(".")]
    fitting = [name for name in known if _fits(parts, name.split("."))]
    if len(fitting) > 1:
        # What is asked for in full below the analysis goes before what has more parts between.
        exact = [name for name in fitting if name.endswith("." + ".".join(parts))]
        fitting = exact or fitting
        # A slide has a point of its own: its velocity is that along the guide, which a cam's lift has too.
        along = [name for name in fitting if ".place." in name and ".lift." not in name]
        fitting = along if len(along) == 1 else fitting
    if len(fitting) == 1:
        return fitting[0]
    if fitting:
        raise InputError(f'"{asked}" may be {", ".join(fitting[:6])}: give a longer part of its name')
    listed = suggestion(asked, list(known)) if known else "the study of this machine has none"
    remedy = "`linkwright plot FILE` without a quantity lists them all"
    raise InputError(f'found no curve "{asked}"; ' + "; ".join(part for part in (listed, remedy) if part))


def _fits(parts: Sequence[str], name: Sequence[str]) -> bool:
    rest = iter(name)
    return parts[-1] == name[-1] and all(part in rest for part in parts)


def _over(curve: Curve, along: str, known: dict[str, Curve]) -> Curve:
    if along == curve.over:
        return curve
    analysis = curve.name.split(".")[0]
    same = {name: curve for name, curve in known.items() if name.split(".")[0] == analysis}
    other = known[_name(along, same or known)]
    over = other.name.removeprefix(f"{analysis}.")
    return replace(curve, over=over, over_unit=other.unit, x=other.values, over_word="")


def from_zero(curve: Curve, zero: float) -> Curve:
    """A curve over the crank angle, counted from another angle [rad]; one over something else stays as it is.

    Over a whole number of revolutions it begins at the new zero, else its angles are shifted. What does not
    repeat, such as the angle of a link that turns on, goes on where it would begin anew.
    """
    if curve.over != CRANK_ANGLE or zero == 0:
        return curve
    x, y = curve.x - zero, curve.values
    span = float(x[-1] - x[0])
    turns = span / (2 * np.pi)
    if abs(turns - round(turns)) > 1e-9 or round(turns) == 0:
        return replace(curve, x=x)
    # The last point is the first one again; between two points the new zero is one of its own.
    rise = y[-1] - y[0]
    # What rounding leaves below the zero belongs to it.
    inner = np.maximum((x[:-1] + 1e-9) % span - 1e-9, 0.0)
    order = np.argsort(inner, kind="stable")
    wrapped = np.round((inner - x[:-1]) / span)
    values = (y[:-1] + rise * wrapped)[order]
    angles = inner[order]
    if angles[0] < 1e-9:
        angles = np.concatenate([angles, [span]])
        values = np.concatenate([values, [values[0] + rise]])
    return replace(curve, x=angles, values=values)


# Places that differ by less of the range are one: what rounding makes of a crank angle.
_SAME = 1e-9


def on_common_points(curves: Sequence[Curve]) -> list[Curve]:
    """Curves on the points of the coarsest of them, so that a table has one column for what they run over.

    The grids of the analyses are parts of each other; a curve that is not known at those points, or runs over
    something that does not rise, stays as it is.
    """
    coarse = min(curves, key=lambda curve: len(curve.x)).x
    if np.any(np.diff(coarse) <= 0):
        return list(curves)
    return [_at(curve, coarse) for curve in curves]


def _at(curve: Curve, places: Floats) -> Curve:
    """A curve at some of its own points, if all of the places are such."""
    if np.any(np.diff(curve.x) <= 0):
        return curve
    after = np.clip(np.searchsorted(curve.x, places), 1, len(curve.x) - 1)
    nearest = np.where(places - curve.x[after - 1] < curve.x[after] - places, after - 1, after)
    if np.abs(curve.x[nearest] - places).max() > _SAME * np.ptp(places):
        return curve
    return replace(curve, x=places, values=curve.values[nearest])


class CurveExtremes(NamedTuple):
    """Minimum and maximum of a curve, and where."""

    # In SI; what the curve runs over.
    minimum: float
    minimum_at: float
    maximum: float
    maximum_at: float
    is_exact: bool  # whether they are those of the motion itself, not of the points of the curve


def extremes(study: Study, curve: Curve, zero: float = 0.0) -> CurveExtremes:
    """Extremes of a curve [SI], exact ones where its analysis knows them; without any number, NaN.

    `zero`: crank angle [rad] of the file from which those of the curve are counted.
    """
    known = _exact(study, curve)
    if known is not None:
        low, low_at, high, high_at = known
        return CurveExtremes(low, _on(curve, low_at - zero), high, _on(curve, high_at - zero), True)
    if not np.isfinite(curve.values).any():
        nan = float("nan")
        return CurveExtremes(nan, nan, nan, nan, False)
    low_k, high_k = int(np.nanargmin(curve.values)), int(np.nanargmax(curve.values))
    low, high = float(curve.values[low_k]), float(curve.values[high_k])
    return CurveExtremes(low, float(curve.x[low_k]), high, float(curve.x[high_k]), False)


def _exact(study: Study, curve: Curve) -> tuple[float, float, float, float] | None:
    """Minimum, its crank angle, maximum, its crank angle, if the analysis has them."""
    if curve.over != CRANK_ANGLE:
        return None
    results = study.results()
    analysis = max((key for key in results if curve.name.startswith(f"{key}.")), key=len)
    name, result = curve.name.removeprefix(f"{analysis}."), results[analysis]
    if isinstance(result, CycleMotion):
        if name in ("speed", "acceleration") and result.is_steady:
            return _declared(study.steady_state, name)
        extremes = result.extremes.get(name)
        numbers = () if extremes is None else tuple(vars(extremes).values())
        return _four(numbers)
    return _declared(result, name)


def _declared(result: Result | None, name: str) -> tuple[float, float, float, float] | None:
    names = (f"{name}_min", f"{name}_min_angle", f"{name}_max", f"{name}_max_angle")
    return _four([getattr(result, name, None) for name in names])


def _four(numbers: Sequence[float | None]) -> tuple[float, float, float, float] | None:
    known = [float(number) for number in numbers if number is not None]
    return (known[0], known[1], known[2], known[3]) if len(known) == 4 else None


def _on(curve: Curve, angle: float) -> float:
    """A crank angle on the revolutions that a curve runs over [rad]."""
    turn = 2 * np.pi
    low, high = float(curve.x[0]) - 1e-9, float(curve.x[-1]) + 1e-9
    while angle < low:
        angle += turn
    while angle > high:
        angle -= turn
    return angle


# Height of each axis, and of what stands around them [inch].
_PANEL, _AROUND = 2.0, 0.8


@styled
def curves_figure(curves: Sequence[Curve], zero: str = "") -> Figure:
    """Draw curves over one quantity, an axis for each unit; `zero`: from where crank angles are counted."""
    by_unit: dict[tuple[str, float], list[Curve]] = {}
    for curve in curves:
        by_unit.setdefault(_shown(curve.unit), []).append(curve)
    colours, drawn = iter(LINES * len(curves)), []
    for (unit, factor), group in by_unit.items():
        lines = [
            Line(one.values / factor, next(colours), named(one.words), one.x / _shown(one.over_unit)[1])
            for one in group
        ]
        drawn.append(Panel(f"{_HELD.get(group[0].unit, group[0].words)} [{unit or '–'}]", lines))
    figure = line_figure(curves[0].x, *drawn, height=_AROUND + _PANEL * len(by_unit), over="")
    _under(figure.axes[-1], curves, zero)
    return figure


def _under(axes: Axes, curves: Sequence[Curve], zero: str) -> None:
    first = curves[0]
    unit, factor = _shown(first.over_unit)
    word = first.over_words
    if zero and first.over == CRANK_ANGLE:
        word += f" from the {zero}"
    axes.set_xlabel(f"{word} [{unit or '–'}]")
    low = min(float(np.nanmin(curve.x)) for curve in curves) / factor
    high = max(float(np.nanmax(curve.x)) for curve in curves) / factor
    if high > low:
        axes.set_xlim(low, high)
    if unit == "°" and high > low:
        mark_angles(axes, low, high)


def _shown(unit: str) -> tuple[str, float]:
    """The unit of an axis and its size: angles in degrees, unless another unit of angles is wanted."""
    return reader().shown(unit, "deg" if unit == "rad" else "")


@styled
def bytes_of(figure: Figure, ending: str) -> bytes:
    """A figure as a file: ``".png"``, ``".svg"`` or ``".pdf"``; the same bytes in every run."""
    from linkwright.kernel.figure.svg import png, svg

    if ending == ".png":
        return png(figure)
    if ending == ".svg":
        return svg(figure).encode()
    data = BytesIO()
    figure.savefig(data, format="pdf", metadata={"CreationDate": None})
    return data.getvalue()
