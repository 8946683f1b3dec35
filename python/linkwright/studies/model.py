"""A study as it stands in a file: which entries vary, what is asked, within which limits.

Values of variables keep the form of the file here; `linkwright.studies.plan` reads them as quantities of the
entries that they stand for.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, Name, Whole, fault, formerly
from linkwright.kernel.description.problems import WholeDescription
from linkwright.kernel.limits import SWEEP_ROWS
from linkwright.kernel.units.marks import Angle, Speed
from linkwright.linkages.model.path_points import PathPoints

# A number, or a text with a unit, read when it is known what it stands for.
Value = Annotated[float, Field(strict=True)] | str

# The ways in which a variable is given, of which it has one.
WAYS = ("range", "values", "distribution", "tolerance", "clearance")


def _as_list(value: object) -> object:
    return [value] if isinstance(value, str) else value


class Distribution(CheckedDescription):
    """How a variable scatters, cut off at its ends."""

    kind: Literal["normal", "lognormal", "uniform", "triangular"]
    mean: Value | None = Field(None, description="Mean; of a triangular distribution, the mode.")
    deviation: Value | None = Field(None, description="Standard deviation of the whole distribution.")
    min: Value | None = Field(
        None, validation_alias=formerly("least", "min"), description="Lower truncation."
    )
    max: Value | None = Field(
        None, validation_alias=formerly("greatest", "max"), description="Upper truncation."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        bell = ("mean", "deviation")
        wanted = {"uniform": ("min", "max"), "triangular": ("mean", "min", "max")}
        for key in wanted.get(self.kind, bell):
            if getattr(self, key) is None:
                yield fault(key, expected=f"a value: a {self.kind} distribution needs it")
        extra = {"uniform": bell, "triangular": ("deviation",)}
        for key in extra.get(self.kind, ()):
            if getattr(self, key) is not None:
                remedy = "its ends say all of it"
                yield fault(key, found=getattr(self, key), expected="nothing", remedy=remedy)


class Variable(CheckedDescription):
    """An entry of the machine, or several at once, and the values that it takes."""

    address: Annotated[tuple[str, ...], BeforeValidator(_as_list)] = Field(
        min_length=1, description="Address of the entry, or a list of them: all take the same value."
    )
    range: tuple[Value, Value] | None = Field(None, description="Minimum and maximum value.")
    steps: Whole | None = Field(None, ge=2, description="Number of values of the range in a grid.")
    scale: Literal["linear", "log"] = Field("linear", description="Division of the range.")
    whole: bool = Field(False, description="Integer variable.")
    values: tuple[Any, ...] | None = Field(None, description="List of values: numbers, texts or tables.")
    distribution: Distribution | None = Field(None, description="Distribution.")
    tolerance: str | None = Field(
        None,
        description='Limits about the value of the machine: "± 0.2 mm", "+0.1 -0.3 mm", "± 1 %", or "25 '
        'H7" by ISO 286.',
    )
    clearance: Value | None = Field(
        None,
        description='Diametral clearance of a pin joint at one end of the length, "0.05 mm", or the fit '
        'of hole and pin by ISO 286, "25 H7/g6", at mid-tolerance. It adds to a tolerance of the length.',
    )
    cost: float | None = Field(
        None, gt=0, description="Cost of this tolerance; allocation changes tolerances with a cost."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.cost is not None and self.tolerance is None:
            yield fault("cost", found=self.cost, expected="nothing without tolerance")
        if self.values is not None and not self.values:
            yield fault("values", found="an empty list", expected="at least one value")
        given = [way for way in WAYS if getattr(self, way) is not None]
        is_loose = given == ["tolerance", "clearance"]
        if self.cost is not None and is_loose:
            remedy = "allocate without the clearance, or give the clearance alone"
            yield fault("cost", found=self.cost, expected="nothing beside clearance", remedy=remedy)
        if len(given) > 1 and not is_loose:
            yield fault(
                given[1],
                found=" and ".join(given),
                expected=f"one of {', '.join(WAYS)}; tolerance and clearance add up",
            )
        if self.steps is not None and self.values is not None:
            yield fault("steps", found=self.steps, expected="nothing beside values")
        if self.whole and given and self.range is None:
            yield fault("whole", found=True, expected=f"nothing beside {given[0]}")


class Response(CheckedDescription):
    """A number that is asked for: a scalar of an analysis, a number of a curve, an entry, or a formula."""

    quantity: str | None = Field(None, description='Scalar of an analysis, "steady_state.unevenness".')
    curve: str | None = Field(None, description='Curve of an analysis, "steady_state.speed".')
    extreme: Literal["max", "min", "range", "mean", "rms"] | None = Field(
        None, description="Statistic of the samples of the curve."
    )
    index: Whole | None = Field(None, ge=0, description="Index in a list, from 0.")
    at: Angle | None = Field(None, description="Crank angle at which a motion is evaluated.")
    entry: str | None = Field(
        None, description='Number of the machine, "drive.motor.power_rated", also from a catalogue.'
    )
    formula: str | None = Field(None, description="Formula of variables and other responses, in SI.")
    level: float | None = Field(
        None, gt=0, lt=1, description="Confidence level of the end of an interval. Default: 0.95."
    )
    otherwise: float | None = Field(
        None,
        description="Value if the machine has none, such as `inf` for a length that no edge reaches. "
        "Default: the row fails.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        ways = ("quantity", "curve", "entry", "formula")
        given = [way for way in ways if getattr(self, way) is not None]
        if len(given) != 1:
            yield fault(found=" and ".join(given) or None, expected="one of quantity, curve, entry, formula")
        picks = [pick for pick in ("extreme", "index", "at") if getattr(self, pick) is not None]
        if self.curve is not None and len(picks) != 1:
            remedy = "a response is one number"
            found = " and ".join(picks) or None
            yield fault("extreme", found=found, expected="one of extreme, index, at", remedy=remedy)
        if self.at is not None and not (self.curve or "").startswith("motion."):
            yield fault("at", found=self.at, expected='nothing but beside curve = "motion.POINT.x"')
        elif self.curve is None and picks:
            yield fault(picks[0], found=getattr(self, picks[0]), expected="nothing without curve")
        yield from self._faults_of_results()

    def _faults_of_results(self) -> Iterator[InitErrorDetails]:
        if self.otherwise is not None and math.isnan(self.otherwise):
            yield fault("otherwise", found=self.otherwise, expected="a number, or inf")
        has_result = self.quantity is not None or self.curve is not None
        for key in ("level", "otherwise"):
            if getattr(self, key) is not None and not has_result:
                yield fault(key, found=getattr(self, key), expected="nothing without quantity or curve")


def _as_response(value: object) -> object:
    return {"quantity": value} if isinstance(value, str) else value


class DerivedNumber(Description):
    """A number that follows from variables."""

    formula: str = Field(description="Formula of variables and of preceding derived numbers, in SI.")
    address: Annotated[tuple[str, ...], BeforeValidator(_as_list)] = Field(
        (), description="Entries of the machine that it sets; none for an auxiliary number."
    )


def _as_derived(value: object) -> object:
    return {"formula": value} if isinstance(value, str) else value


class StudyPath(PathPoints, CheckedDescription):
    """Points of a path, and the point of the machine whose distances from them are responses."""

    point: str = Field(description="Point of the machine that shall follow the path.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from self._faults_of_points(1)


class Constraint(CheckedDescription):
    """Limits of a response, in its unit or with one."""

    min: Value | None = Field(None, description="Permitted minimum.")
    max: Value | None = Field(None, description="Permitted maximum.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.min is None and self.max is None:
            yield fault(expected="min, max, or both")


class Sweep(CheckedDescription):
    """Rows of a sweep."""

    method: Literal["grid", "sobol", "latin_hypercube", "random", "list"] = Field(
        "grid",
        description="Full factorial grid, space-filling sequence (Sobol, Latin hypercube), "
        "independent random rows, or a file.",
    )
    rows: Whole | None = Field(
        None, ge=1, le=SWEEP_ROWS.most, description="Number of rows; not for a grid or a list."
    )
    seed: Whole = Field(0, ge=0, description="Seed of the random generator.")
    file: str | None = Field(
        None,
        description="File of a list: CSV with a header, or Parquet in SI; columns are named after "
        "the variables.",
    )
    chunk: Whole | None = Field(
        None, ge=1, le=1_000_000, description="Rows per file of results. Default: suited to the analyses."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        follows = self.method in ("grid", "list")
        if follows and self.rows is not None:
            yield fault(
                "rows", found=self.rows, expected=f"nothing: the rows of a {self.method} follow from it"
            )
        if not follows and self.rows is None:
            yield fault("rows", expected="the number of rows")
        if (self.method == "list") != (self.file is not None):
            expected = "the file with the rows" if self.file is None else 'nothing without method = "list"'
            yield fault("file", found=self.file, expected=expected)


class FitOptions(Description):
    """Of which motion a record is, and what is known of it besides."""

    record: str | None = Field(
        None,
        description="CSV file with a header such as `time [s], speed [rpm]`, relative to the folder "
        "of the study file.",
    )
    motion: Literal["run_up", "run_down", "coast", "steady_state", "manoeuvre"] = Field(
        "run_down",
        description="Motor on; motor off and brake on; both off; steady motion over the crank angle; "
        "the manoeuvre of a train.",
    )
    speed_start: Speed | None = Field(
        None, ge=0, description="Crank speed at the first sample. Default: fitted."
    )
    angle_start: Angle | None = Field(None, description="Crank angle at the first sample. Default: fitted.")
    torque_per_current: float | None = Field(
        None, gt=0, description="Motor torque over recorded current [N m/A]. Default: fitted."
    )


class StudyFile(WholeDescription):
    """A study: beside its machine in a file of its own, or the table ``study`` of a machine file."""

    machine: str | None = Field(None, description="Machine file, relative to the folder of the study file.")
    name: str = Field("", description="Description of the study.")
    variables: dict[Name, Variable] = Field(default_factory=dict, description="Variables, by name.")
    derived: dict[Name, Annotated[DerivedNumber, BeforeValidator(_as_derived)]] = Field(
        default_factory=dict, description="Derived numbers, by name."
    )
    paths: dict[Name, StudyPath] = Field(
        default_factory=dict, description="Paths whose errors are responses, by name."
    )
    responses: dict[Name, Annotated[Response, BeforeValidator(_as_response)]] = Field(
        default_factory=dict, description="Responses, by name."
    )
    constraints: dict[str, Constraint] = Field(
        default_factory=dict, description="Limits by the name of the response."
    )
    goals: dict[str, Literal["minimise", "maximise"]] = Field(
        default_factory=dict, description="Goals, by the name of the response."
    )
    sweep: Sweep = Field(default_factory=Sweep, description="Rows of a sweep.")
    fit: FitOptions | None = Field(None, description="Measured record for fitting the variables.")
