r"""A measured curve laid over the computed one, and how far apart their peaks are.

Peaks of the measured curve are its local maxima of at least a third of the largest, and its largest value
where that lies at an end. Each is set beside the highest peak of the computed curve within 15 % of its speed,
which is sought between the speeds of the run as well; the differences are those of the computed one over the
measured one.

Measured curves come from a file of comma-separated values: a column of speeds, a column for each curve. The
head names shafts and discs, and the unit says what was measured, as in ``speed [rpm], line [MPa], front
[deg]``; one order alone is ``line_order_2_5 [MPa]``, here order 2.5.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import ValidationError

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, MachineFileError, Problem, UnitError, show
from linkwright.kernel.files.points import columns_of, read_columns
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import ANGLE, PRESSURE, SPEED, TORQUE, Kind
from linkwright.kernel.units.reading import parse
from linkwright.torsion.excitation.excited_train import ExcitedTrain
from linkwright.torsion.excitation.harmonics import span
from linkwright.torsion.limits.criteria import peaks_between
from linkwright.torsion.limits.survey import Survey, between
from linkwright.torsion.model.measured_response import MeasuredResponse
from linkwright.torsion.response.forced import TorsionResponse, torsion_response
from linkwright.torsion.response.stress import shaft_stress

# Share of the largest measured value from which on a maximum is a peak.
_PEAK = 1 / 3

# Share of its speed within which a measured peak is sought among the computed ones.
_NEAR = 0.15

# Even speeds at which the computed curve is examined about a measured peak.
_POINTS = 60

# Orders that differ by a smaller share are one.
_EQUAL = 1e-9

_KINDS: dict[str, Kind] = {"stress": PRESSURE, "torque": TORQUE, "angle": ANGLE}


class PeakComparison(NamedTuple):
    """A measured peak beside the computed one.

    Attributes
    ----------
    speed, value : float
        Measured [rad/s], [SI].
    speed_computed, value_computed : float or None
        Computed; None where no peak is near.
    """

    speed: float
    value: float
    speed_computed: float | None
    value_computed: float | None

    @property
    def speed_difference(self) -> float | None:
        """Computed less measured speed, over the measured one."""
        return None if self.speed_computed is None else self.speed_computed / self.speed - 1

    @property
    def value_difference(self) -> float | None:
        """Computed less measured amplitude, over the measured one."""
        return None if self.value_computed is None else self.value_computed / self.value - 1


@dataclass(frozen=True)
class Overlay(Result):
    """A measured curve over the computed one."""

    name: Annotated[str, About("Of the measurement.")]
    part: Annotated[str, About("Shaft or disc.")]
    what: Annotated[str, About("Stress, torque or angle.")]
    order: Annotated[float | None, About("Order of the first disc; None for all together.")]
    speeds: Annotated[
        Floats, Label("speed of the first disc", "ω", "rad/s", "Of the measurement.", shape="(points,)")
    ]
    measured: Annotated[Floats, About("Measured amplitudes, shape (points,) [SI].")]
    computed: Annotated[Floats, About("Computed ones at the same speeds, shape (points,) [SI].")]
    run_speeds: Annotated[Floats, About("Speeds of the computed curve as drawn, shape (n,) [rad/s].")]
    run_computed: Annotated[Floats, About("Computed amplitudes there, shape (n,) [SI].")]
    permitted: Annotated[
        Floats | None, About("Permitted in continuous operation at the measured speeds, of a stress [Pa].")
    ]
    peaks: Annotated[tuple[PeakComparison, ...], About("Measured peaks beside computed ones, by speed.")]

    @property
    def kind(self) -> Kind:
        """The quantity."""
        return _KINDS[self.what]

    @property
    def mean_difference(
        self,
    ) -> Annotated[float, Label("root mean square of computed less measured values over measured", "", "")]:
        """Root mean square of computed less measured values, over that of the measured ones."""
        return float(np.sqrt(np.mean((self.computed - self.measured) ** 2) / np.mean(self.measured**2)))

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Peaks as a table, curves as lists."""
        peaks = [
            peak._asdict()
            | {"speed_difference": peak.speed_difference, "value_difference": peak.value_difference}
            for peak in self.peaks
        ]
        lists = {
            name: None if (array := getattr(self, name)) is None else array.tolist()
            for name in ("speeds", "measured", "computed", "permitted")
        }
        scalars = {"name": self.name, "part": self.part, "what": self.what, "order": self.order}
        unit = {"unit": self.kind.unit, "mean_difference": self.mean_difference, "peaks": peaks}
        return scalars | unit | lists


def overlay(seen: Survey, name: str, curve: MeasuredResponse) -> Overlay:
    """Lay a measured curve over the computed one. `name`: of the measurement."""
    speeds, values = np.array(curve.speed), np.array(curve.values)
    known = np.sort(seen.at.torques.speeds)
    outside = speeds[(speeds < known[0]) | (speeds > known[-1])]
    if len(outside):
        low, high, beyond = (speed * 30 / np.pi for speed in (known[0], known[-1], outside[0]))
        raise InputError(
            f"measurement {name}: found a speed of {beyond:.6g} rpm, expected speeds from {low:.6g} to "
            f"{high:.6g} rpm, those of [train.run]; widen them, or leave the point out"
        )
    computed = _computed(seen, name, curve)
    grid = np.union1d(known, seen.resonant_speeds)
    return Overlay(
        name=name,
        part=curve.on,
        what=curve.what,
        order=curve.order,
        speeds=speeds,
        measured=values,
        computed=computed(speeds),
        run_speeds=grid,
        run_computed=computed(grid),
        permitted=_permitted(seen, curve, speeds),
        peaks=tuple(_compared(speeds, values, n, computed, known) for n in _peaks(values)),
    )


def _computed(seen: Survey, name: str, curve: MeasuredResponse) -> Callable[[Floats], Floats]:
    parts = seen.found.discs if curve.what == "angle" else seen.found.shafts
    if curve.on not in parts:
        remedy = suggestion(curve.on, parts)
        expected = "the name of a disc" if curve.what == "angle" else "the name of a shaft or coupling"
        raise InputError(
            f'measurement {name}: found {curve.what} of "{curve.on}", expected {expected}'
            + (f"; {remedy}" if remedy else "")
        )
    order = None if curve.order is None else _order(seen.at, name, curve.order)
    if curve.what == "stress" and curve.on not in shaft_stress(seen.machine, seen.found, seen.service).shafts:
        raise InputError(
            f"measurement {name}: no section of {curve.on} is known, so that it has no stress: give its "
            "sections, or a diameter in its limit"
        )

    def at(speeds: Floats) -> Floats:
        response = torsion_response(between(seen.machine, seen.at, speeds))
        amplitudes = _amplitudes(response, curve, order)
        if curve.what != "stress":
            return amplitudes
        stress = shaft_stress(seen.machine, response, seen.service)
        row, size = (
            stress.shafts.index(curve.on),
            response.shaft_torque_vibratory[response.shafts.index(curve.on)],
        )
        factor = np.divide(stress.vibratory[row], size, out=np.zeros_like(size), where=size > 0)
        return np.asarray(factor * amplitudes, float)

    return at


def _amplitudes(response: TorsionResponse, curve: MeasuredResponse, order: int | None) -> Floats:
    """Torque or angle, of one order or of all together, (speeds,)."""
    if curve.what == "angle":
        waves = response.amplitudes[:, response.discs.index(curve.on)]
    else:
        waves = response.shaft_torques[:, response.shafts.index(curve.on)]
    if order is not None:
        return np.asarray(np.abs(waves[order]), float)
    greatest, least = span(response.together, waves)
    return np.asarray(0.5 * (greatest - least), float)


def _order(at: ExcitedTrain, name: str, order: float) -> int:
    orders = at.torques.orders
    place = int(np.abs(orders - order).argmin())
    if abs(orders[place] - order) > _EQUAL * order:
        listed = ", ".join(f"{number:.5g}" for number in orders.tolist())
        raise InputError(f"measurement {name}: found order {order:g}, expected one of {listed}")
    return place


def _permitted(seen: Survey, curve: MeasuredResponse, speeds: Floats) -> Floats | None:
    """Stress permitted in continuous operation at some speeds; None of anything else, or without a limit."""
    if curve.what != "stress":
        return None
    stress = shaft_stress(
        seen.machine, torsion_response(between(seen.machine, seen.at, speeds)), seen.service
    )
    permitted: Floats = stress.continuous[stress.shafts.index(curve.on)]
    return permitted if np.isfinite(permitted).any() else None


def _peaks(values: Floats) -> list[int]:
    inner, top = np.arange(1, len(values) - 1), float(values.max())
    higher = (values[inner] >= values[inner - 1]) & (values[inner] > values[inner + 1])
    peaks = set(inner[higher & (values[inner] >= _PEAK * top)].tolist())
    return sorted(peaks | {int(values.argmax())})


def _compared(
    speeds: Floats, values: Floats, n: int, computed: Callable[[Floats], Floats], known: Floats
) -> PeakComparison:
    speed, value = float(speeds[n]), float(values[n])
    low, high = max(speed * (1 - _NEAR), known[0]), min(speed * (1 + _NEAR), known[-1])
    grid = np.linspace(low, high, _POINTS)
    curve = np.nan_to_num(computed(grid), nan=np.inf)
    inner = np.arange(1, len(grid) - 1)
    tops = inner[(curve[inner] >= curve[inner - 1]) & (curve[inner] > curve[inner + 1])]
    if not len(tops):
        return PeakComparison(speed, value, None, None)
    top = int(tops[curve[tops].argmax()])
    (best,) = peaks_between(
        lambda at: computed(at)[None],
        [(0, float(grid[top - 1]), float(grid[top + 1]))],
        [(float(grid[top]), float(curve[top]))],
    )
    return PeakComparison(speed, value, best, float(computed(np.array([best]))[0]))


_ORDER = re.compile(r"(.+)_order_(\d+)(?:_(\d+))?")


@public
def read_measured(path: str | os.PathLike[str]) -> dict[str, MeasuredResponse]:
    """Read curves measured over the speed, such as those of a sea trial.

    Parameters
    ----------
    path : path
        The file; see the head of the module, and `docs/torsion.md`.

    Returns
    -------
    dict of str to MeasuredResponse
        By the head of the column.

    Raises
    ------
    MachineFileError
        The file cannot be read, has no such head or holds something else; with file and line.
    """
    place = Path(path)
    if not place.exists():
        expected = "a CSV file of speeds and measured curves"
        raise MachineFileError([Problem("--measured", f"{place}, no such file", expected)])
    speed = read_columns(place, {"speed": SPEED})["speed"]
    columns, lines = columns_of(place, "", "response")
    curves = [name for name in columns if name != "speed"]
    kinds = {name: _kind(columns[name][0], name, place, lines[0]) for name in curves}
    values = read_columns(place, {name: _KINDS[kind] for name, kind in kinds.items()})
    if not curves:
        expected = "a column for each shaft or disc beside the speed"
        raise MachineFileError([Problem("", "speed alone", expected, path=str(place), line=lines[0])])
    responses = {}
    for name, kind in kinds.items():
        on, order = _part(name)
        entries = {"on": on, "order": order, "speed": tuple(speed.tolist())}
        try:
            responses[name] = MeasuredResponse.model_validate(entries | {kind: tuple(values[name].tolist())})
        except ValidationError as error:
            raise MachineFileError([_problem(error, name, place, lines)]) from None
    return responses


def _kind(entry: object, name: str, path: Path, line: int) -> str:
    for what, kind in _KINDS.items():
        try:
            parse(entry, kind)
        except UnitError:
            # silent: a unit that none of the quantities has is reported with those that have one
            continue
        if isinstance(entry, str):
            return what
    expected = "a unit of stress, torque or angle in brackets"
    remedy = f"such as {name} [MPa], {name} [kN m] or {name} [deg]"
    raise MachineFileError([Problem(f"column {name}", show(str(entry)), expected, remedy, str(path), line)])


def _part(name: str) -> tuple[str, float | None]:
    match = _ORDER.fullmatch(name)
    if match is None:
        return name, None
    return match[1], float(f"{match[2]}.{match[3] or 0}")


def _problem(error: ValidationError, name: str, path: Path, lines: list[int]) -> Problem:
    first = error.errors()[0]
    place = next((part for part in first["loc"] if isinstance(part, int)), None)
    line = lines[0] if place is None else lines[1 + place]
    key = "column speed" if "speed" in first["loc"] else f"column {name}"
    context = first.get("ctx", {})
    found, expected = (
        str(context.get("found", first.get("input"))),
        str(context.get("expected", first["msg"])),
    )
    return Problem(key, found, expected, str(context.get("remedy", "")), str(path), line)
