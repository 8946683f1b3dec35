"""One response of a study: where it comes from, and one number out of a result."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.drive.batch import SteadyStates
from linkwright.driveline.batch import QUANTITIES as OF_ELASTIC
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, MachineError, Problem, show
from linkwright.kernel.quantities import declared
from linkwright.studies.model import StudyPath

# What is no analysis: the motion of a point, which needs no drive, its distance from a path, and what stands
# in the machine.
MOTION, PATH, ENTRY = "motion", "path", "entry"

# The linkage, whose elements have numbers of their own.
LINKAGE = "linkage"

# The motion over the cycle, whose curves have extremes.
CYCLE = "cycle_motion"

# Analyses of one part of the machine, by its name.
OF_ONE_PART = ("cam", "cam_check", "cam_force", "cylinder", "axis")

# Parts of a train that a list of curves has a row for.
PARTS = ("discs", "shafts", "stations", "motors")

# What the core gives of the steady motion of many machines.
_OF_BATCH = frozenset(declared(SteadyStates))


class NoPlaceError(FindingError):
    """A list of the machine, of so many values, ends before the place that is asked for."""

    def __init__(self, message: str, count: int) -> None:
        super().__init__(message)
        self.count = count


@dataclass(frozen=True)
class StudyResponse:
    """One response of a study."""

    name: str  # its name in the study
    analysis: str  # analysis that it comes from
    # Name of the cam, point, pair, path, element of a linkage, or part of a train, where there are several;
    # the address of an entry.
    of: tuple[str, ...]
    quantity: str  # attribute of the result; of a point `"x"` or `"y"`
    # What it is called, SI unit.
    word: str
    unit: str
    extreme: str | None = None  # what is taken of a curve
    index: int | None = None  # place in a list
    at: float | None = None  # crank angle at which a motion is taken [rad]
    inner: str = ""  # name of the result within that of the analysis
    axes: tuple[str, ...] = ()  # of a list of curves: `("shafts", "speeds")`
    level: float | None = None  # confidence level of an interval; without it, that of the analysis
    otherwise: float | None = None  # what stands for a number that the machine does not have
    path: StudyPath | None = None  # the path that distances are taken from

    @property
    def arguments(self) -> tuple[str, ...]:
        """What the analysis takes besides the machine."""
        return self.of if self.analysis in OF_ONE_PART else ()

    @property
    def options(self) -> dict[str, float]:
        """What the analysis takes besides, by name."""
        return {} if self.level is None else {"level": self.level}

    @property
    def key(self) -> tuple[str, tuple[str, ...], float | None]:
        """Analysis, name and level: what is computed once for all responses that share it."""
        return self.analysis, self.arguments, self.level

    @property
    def is_batch(self) -> bool:
        """Whether the core computes it for many machines at once."""
        is_scalar = self.extreme is None and self.index is None and self.otherwise is None
        known = {"steady_state": _OF_BATCH, "elastic_motion": OF_ELASTIC}
        return self.analysis in (MOTION, PATH, ENTRY) or (
            is_scalar and self.quantity in known.get(self.analysis, ())
        )

    @property
    def is_of_part(self) -> bool:
        """Whether it is the number of a part in a list of those of all."""
        return bool(self.of) and not self.arguments and len(self.axes) == 1 and self.axes[0] in PARTS

    def number(self, result: Any) -> float:
        """The number that is asked for, out of a result; a `FindingError` if the machine has none."""
        if self.analysis in (LINKAGE, CYCLE) and self.of:
            result = result.element(*self.of)
        if self.inner:
            result = getattr(result, self.inner)
        value = None if result is None else getattr(result, self.quantity)
        if isinstance(value, Mapping):
            value = value.get(*self.of)
        if value is not None and (self.extreme is not None or self.index is not None or self.is_of_part):
            value = self._picked(result, np.asarray(value))
        if value is None or not math.isfinite(float(value)):
            if self.otherwise is not None:
                return self.otherwise
            raise FindingError(f"{self.word} has no value for this machine")
        return float(value)

    def _picked(self, result: Any, values: NDArray[Any]) -> Any:
        """One number of a curve, or of all curves of a list; of complex amplitudes their absolute values."""
        values = np.abs(values) if np.iscomplexobj(values) else values.astype(float)
        if self.of and not self.arguments:
            axis = next(axis for axis, parts in enumerate(self.axes) if parts in PARTS)
            values = np.take(values, getattr(result, self.axes[axis]).index(self.of[0]), axis=axis)
        if self.extreme is not None:
            return taken(values.ravel(), self.extreme)
        if self.index is None:
            return values
        assert self.index is not None
        if self.index >= len(values):
            message = f"{self.analysis}.{self.quantity} has {len(values)} values, none of number {self.index}"
            raise NoPlaceError(message, len(values))
        return values[self.index]


def taken(curve: Floats, extreme: str) -> Any:
    """One number of each curve, over its last axis."""
    match extreme:
        case "max":
            return curve.max(axis=-1)
        case "min":
            return curve.min(axis=-1)
        case "range":
            return np.ptp(curve, axis=-1)
        case "mean":
            return curve.mean(axis=-1)
    return np.sqrt((curve**2).mean(axis=-1))


def wrong(name: str, key: str, found: str, expected: str, remedy: str = "") -> MachineError:
    """What is wrong at a key of a response."""
    return MachineError([Problem(f"responses.{name}.{key}", show(found), expected, remedy)])
