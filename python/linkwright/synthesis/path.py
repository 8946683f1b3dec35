"""Path generation: a four-bar linkage whose coupler point passes given points as its crank turns.

Some ten thousand shapes, each in its best pose, are judged (`path_search`); the best of each group begins a
refinement by least squares (`path_search`), all at once: coarse at first, to the end for those that lead.
Several starts that end at the same error are the evidence that it is the minimum; how many did is reported.
With given crank angles the point is compared at those angles, else with the nearest place of the curve, and
the places must follow one another in the order of the points.

Source: D. Nolle, K. H. Hunt, Optimum synthesis of planar linkages to generate coupler curves, Journal of
Mechanisms 6 (1971) 267–287 for the statement as least squares.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import SynthesisError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.linkages.kinematics import motions
from linkwright.machine.machine import Machine
from linkwright.synthesis.four_bar import worst_transmission
from linkwright.synthesis.path_model import Linkages, PathModel, shape
from linkwright.synthesis.path_search import TRIALS, refine, starts
from linkwright.synthesis.task import PathTask
from linkwright.synthesis.verification import TransmissionResult

# Stages of the refinement: weight of broken constraints, steps over the task's, share of the linkages that go
# through it, the best first. A weight of 1 draws starts towards what is allowed; one of 0.1 lets them move
# along their constraints, as distances of a thousandth of the path then count as much.
_STAGES = ((1.0, 0.1, 1.0), (0.1, 0.35, 1.0), (0.1, 1.0, 0.2))

# Errors within this share of the minimum are the same minimum; within the next, the transmission angle
# decides.
_SAME = 0.01
_ALIKE = 1e-3
# Transmission angles [rad], and shares of the coupler, this near are those of one linkage or of its cognates:
# refined numbers agree to about the square of this.
_SAME_ANGLE = 1e-6

# Errors over the size of the path that are rounding.
_ROUNDING = 1e-12

# Starts that end at the minimum error before it counts as the global minimum.
_SURE = 3

SOURCE = "Synthesised by linkwright for given points of a path"

# Called after every step with steps done and to be done at most.
Track = Callable[[int, int], None]


_PATH_GENERATOR_LIMITED_BY = (
    "Keys of the task's limits at which the linkage stands; none if its error is rounding."
)
_PATH_GENERATOR_HISTORY = (
    "Root of the mean square of the best linkage's errors after each step of the refinement [m], "
    "shape (steps,); NaN as long as none keeps the constraints."
)


@dataclass(frozen=True)
class PathGenerator(TransmissionResult):
    """A four-bar linkage whose coupler point follows given points."""

    type: Annotated[str, About("Which links turn fully.")]
    frame: Annotated[float, Label("length of the frame", "", "m")]
    crank: Annotated[float, Label("length of the crank", "", "m")]
    coupler: Annotated[float, Label("length of the coupler", "", "m")]
    rocker: Annotated[float, Label("length of the rocker", "", "m")]
    along: Annotated[float, Label("position of the coupler point along the coupler", "", "m")]
    across: Annotated[float, Label("position of the coupler point across the coupler", "", "m")]
    assembly: Annotated[str, About("Side of the joint.")]
    error_rms: Annotated[
        float,
        Label(
            "root-mean-square distance of the points from the curve",
            "",
            "m",
            "In the machine analysed again.",
        ),
    ]
    error_max: Annotated[
        float,
        Label("maximum distance of the points from the curve", "", "m", "In the machine analysed again."),
    ]
    error_relative: Annotated[float, Label("root-mean-square distance over the size of the path", "", "")]
    transmission_angle_min: Annotated[
        float, Label("minimum transmission angle", "μ_min", "rad", "Over the revolution.")
    ]
    starts: Annotated[int, Label("starts that were refined", "", "")]
    found_by: Annotated[int, Label("starts that ended at this error", "", "", "Within 1 %.")]
    evaluated: Annotated[int, Label("linkages computed", "", "")]
    rate: Annotated[float, About("Linkages computed per second, by the clock [1/s].")]
    seed: Annotated[int, About("Start of the random numbers.")]
    limited_by: Annotated[tuple[str, ...], About(_PATH_GENERATOR_LIMITED_BY)]
    crank_angles: Annotated[Floats, Label("crank angles of the points", "", "rad", "In the machine.")]
    x: Annotated[Floats, Label("x of the coupler point", "", "m", "At these crank angles.")]
    y: Annotated[Floats, Label("y of the coupler point", "", "m", "At these crank angles.")]
    history: Annotated[Floats, About(_PATH_GENERATOR_HISTORY)]
    machine: Annotated[Machine, About("The linkage; its point ``P`` draws the path.")]

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to know of the search and of the linkage."""
        sentences = []
        if self.found_by < _SURE:
            sentences.append(
                f"only {self.found_by} of {self.starts} starts ended at this error: there may be a better "
                "linkage; raise population"
            )
        if self.limited_by:
            keys = " and ".join(self.limited_by)
            sentences.append(
                f"the linkage stands at its limit of {keys}: a wider one may allow a smaller error"
            )
        return (*sentences, *super().warnings)


@public
def path_generator(task: PathTask, *, track: Track | None = None) -> PathGenerator:
    """Find the four-bar linkage whose coupler point passes given points.

    Parameters
    ----------
    task : PathTask
        Points, timing, constraints, and the size of the search.
    track : callable, optional
        Called after every step of the refinement with steps done and to be done at most.

    Returns
    -------
    PathGenerator
        The linkage of the minimum error; where several have it, the one with the largest minimum transmission
        angle, and of cognates the one whose coupler point is nearest for its coupler. The same for the same
        task.

    Raises
    ------
    SynthesisError
        No linkage that was tried keeps the constraints.
    """
    began = perf_counter()
    model = PathModel(task)
    search = _Search(model, starts(model, task.population), track)
    search.run()
    rows, errors, broken = search.rows, search.errors(), model.violation(search.rows)
    evaluated = search.evaluated + task.population * TRIALS
    kept = broken <= 0.0
    if not kept.any():
        raise SynthesisError(_none(task, float(broken.min()), evaluated))
    least = float(errors[kept].min())
    exact = max(task.accuracy, _ROUNDING)
    found_by = int((kept & (errors <= max((1 + _SAME) * least, exact))).sum())
    alike = np.flatnonzero(kept & (errors <= max((1 + _ALIKE) * least, exact)))
    best = alike[_preferred(model, rows.take(alike))]
    effort = _Effort(found_by, evaluated, evaluated / (perf_counter() - began), search.known_history())
    return _result(model, rows.take(np.array([best])), effort)


class _Search:
    """All starts on their way through the stages of the refinement."""

    def __init__(self, model: PathModel, rows: Linkages, track: Track | None) -> None:
        self.model, self.rows, self.track = model, rows, track
        self.evaluated, self.done = 0, 0
        self.history: list[float] = []
        self._stages = [
            (w, max(1, round(steps * model.task.generations)), part) for w, steps, part in _STAGES
        ]
        self._total = sum(steps for _, steps, _ in self._stages)

    def run(self) -> None:
        for weight, steps, share in self._stages:
            merit = self.errors() ** 2 + self.model.violation(self.rows) ** 2
            leading = np.sort(np.argsort(merit, kind="stable")[: max(1, round(share * len(merit)))])
            part = self.rows.take(leading)
            end = self.done + steps
            for count in refine(self.model, part, weight, steps):
                self.evaluated += count
                self._tell(part)
            self.rows.put(leading, part)
            self.done = end

    def errors(self) -> Floats:
        """Root of the mean square of the distances of all rows, over the size of the path, (m,)."""
        return self.model.errors(self.rows)

    def known_history(self) -> Floats:
        """The history, NaN where nothing was found yet."""
        history = np.array(self.history)
        return np.where(np.isfinite(history), history, np.nan)

    def _tell(self, part: Linkages) -> None:
        """Record the best error after a step, and report progress."""
        self.done += 1
        kept = self.model.violation(part) <= 0.0
        best = float(self.model.errors(part)[kept].min(initial=np.inf)) * self.model.size
        self.history.append(min(best, self.history[-1] if self.history else np.inf))
        if self.track is not None:
            self.track(self.done, self._total)


@dataclass(frozen=True)
class _Effort:
    found_by: int
    evaluated: int
    rate: float
    history: Floats


def _preferred(model: PathModel, rows: Linkages) -> int:
    """Preferred among linkages of one error: the largest minimum transmission angle."""
    # Roberts's cognates draw the same path with the same angles. Of them, the one with the smallest outreach
    # of its coupler point is chosen, since clearance of the joints moves the point by that share.
    angle, lengths = _transmission(model, rows), shape(rows.p[:, :3], rows.is_double)[0]
    s, z, _ = (number[:, 0] for number in model.pose(rows.p))
    outreach = np.abs(z) / (np.abs(s) * lengths[:, 1])
    outreach = np.where(angle >= angle.max() - _SAME_ANGLE, outreach, np.inf)
    return int(np.flatnonzero(outreach <= outreach.min() + _SAME_ANGLE)[0])


def _transmission(model: PathModel, rows: Linkages) -> Floats:
    lengths, _ = shape(rows.p[:, :3], rows.is_double)
    return worst_transmission(np.ones(len(lengths)), *lengths.T)


def _result(model: PathModel, row: Linkages, effort: _Effort) -> PathGenerator:
    task = model.task
    bar, place, angles = model.linkage(row)
    machine = bar.machine(task.name or "Path generator", points={"P": place}, source=SOURCE)
    table = motions(machine, angles, points=["P"])[0]
    errors = np.hypot(table[0] - task.x, table[1] - task.y)
    rms = float(np.sqrt(np.mean(errors**2)))
    worst = float(_transmission(model, row)[0])
    return PathGenerator(
        type=bar.type,
        frame=float(bar.frame),
        crank=float(bar.crank),
        coupler=float(bar.coupler),
        rocker=float(bar.rocker),
        along=float(place.real),
        across=float(place.imag),
        assembly=bar.assembly,
        error_rms=rms,
        error_max=float(errors.max()),
        error_relative=rms / model.size,
        transmission_angle_min=worst,
        starts=task.population,
        found_by=effort.found_by,
        evaluated=effort.evaluated,
        rate=effort.rate,
        seed=task.seed,
        limited_by=() if rms <= max(task.accuracy, _ROUNDING) * model.size else model.binding(row),
        crank_angles=angles,
        x=table[0].copy(),
        y=table[1].copy(),
        history=effort.history,
        machine=machine,
    )


def _none(task: PathTask, least: float, evaluated: int) -> str:
    return (
        f"none of {evaluated} linkages satisfies all constraints ({task.linkage}, transmission angle "
        f"at least {np.degrees(task.transmission_angle_min):.4g}°, lengths within {task.length_ratio_max:g} "
        f"to 1, points in order, pivots in their box); the nearest violates them by {least:.3g} in sum. "
        "Lower transmission_angle_min, raise length_ratio_max, widen pivots, or raise population"
    )
