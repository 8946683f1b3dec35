"""Path generation: a four-bar linkage whose coupler point passes given points as its crank turns.

A global search (`evolution`) over nine or ten numbers, each generation one batch of machines in the core, and
then Gauss and Newton's method with damping on the best, where derivatives by lengths are differences in one
more batch and those by crank angles are exact. With given crank angles the point is compared at those angles,
else with the nearest place of the curve, and the places must follow one another in the order of the points.

Source: D. Nolle, K. H. Hunt, Optimum synthesis of planar linkages to generate coupler curves, Journal of
Mechanisms 6 (1971) 267–287 for the statement as least squares; the search: see `evolution`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.kinematics import motions
from linkwright.analysis.result import Result
from linkwright.errors import SynthesisError
from linkwright.machine import Machine
from linkwright.public import public
from linkwright.synthesis.evolution import Generation, evolve
from linkwright.synthesis.four_bar import Assembly, FourBar, worst_transmission
from linkwright.synthesis.path_model import PathModel
from linkwright.synthesis.path_refine import refine
from linkwright.synthesis.task import PathTask

Floats = NDArray[np.float64]

# Of the last generation this many are refined; the best of the search need not be the best after refinement.
_REFINED = 6

# Generations after which the best is refined, to see whether the search can end.
_TRY = 50

SOURCE = "Synthesised by linkwright for given points of a path"

# Called after every generation with generations done and to be done at most.
Track = Callable[[int, int], None]


@dataclass(frozen=True)
class PathGenerator(Result):
    """A four-bar linkage whose coupler point follows given points.

    Attributes
    ----------
    type : str
        Which links turn fully.
    frame, crank, coupler, rocker : float
        Lengths [m].
    along, across : float
        Place of the coupler point on the coupler [m].
    assembly : str
        Side of the joint.
    error_rms, error_max : float
        Distance of the points from the curve, in the machine analysed again [m].
    error_relative : float
        ``error_rms`` over the size of the path [–].
    transmission_angle_min : float
        Least transmission angle in the turn [rad].
    evaluated : int
        Machines that were computed.
    rate : float
        Machines computed a second, by the clock.
    seed : int
        Start of the random numbers.
    crank_angles : ndarray, shape (n,)
        Crank angles of the points in the machine [rad].
    x, y : ndarray, shape (n,)
        What the coupler point reaches there [m].
    history : ndarray, shape (generations,)
        Root of the mean square of the best machine's errors after each generation of both searches [m]; NaN
        as long as none keeps the constraints.
    machine : Machine
        The linkage; its point ``P`` draws the path.
    """

    type: str
    frame: float
    crank: float
    coupler: float
    rocker: float
    along: float
    across: float
    assembly: str
    error_rms: float
    error_max: float
    error_relative: float
    transmission_angle_min: float
    evaluated: int
    rate: float
    seed: int
    crank_angles: Floats
    x: Floats
    y: Floats
    history: Floats
    machine: Machine


@public
def path_generator(task: PathTask, *, track: Track | None = None) -> PathGenerator:
    """Find the four-bar linkage whose coupler point passes given points.

    Parameters
    ----------
    task : PathTask
        Points, timing, constraints, and the size of the search.
    track : callable, optional
        Called after every generation with generations done and to be done at most.

    Returns
    -------
    PathGenerator
        The best linkage of both assemblies; the same for the same task.

    Raises
    ------
    SynthesisError
        No linkage that was tried keeps the constraints.

    Notes
    -----
    Both assemblies are searched, one after the other. A search ends at the accuracy of the task, at its
    generations, or when it has come to rest; at the accuracy, the other assembly is left out.
    """
    began = perf_counter()
    total = 2 * task.generations
    searches = []
    for turn, assembly in enumerate(("left", "right")):
        model = PathModel(task, "left" if assembly == "left" else "right")
        done = turn * task.generations
        searches.append(_searched(model, task.seed + turn, track, done, total))
        if any(cost < model.enough for cost, _, _ in searches[-1].refined):
            break
    candidates = [each for search in searches for each in search.refined]
    evaluated = sum(search.evaluated for search in searches)
    if not candidates:
        raise SynthesisError(_none(task, searches, evaluated))
    best = min(candidates, key=lambda each: each[0])
    history = np.sqrt(np.concatenate([search.history for search in searches]))
    return _result(best[1], best[2], evaluated, perf_counter() - began, history)


@dataclass(frozen=True)
class _Search:
    """What a search of one assembly found: cost, model and row of the refined ones."""

    refined: list[tuple[float, PathModel, Floats]]
    evaluated: int
    history: Floats
    violation: float


def _searched(model: PathModel, seed: int, track: Track | None, done: int, total: int) -> _Search:
    """Search one assembly and refine the best rows."""
    task, history, work = model.task, [], 0
    state: Generation | None = None
    for state in evolve(model.judge, model.low, model.high, task.population, seed):
        history.append(state.cost if state.violation == 0 else np.nan)
        if track is not None:
            track(done + state.number, total)
        if state.number >= task.generations:
            break
        if state.number % _TRY == 0 and state.violation == 0:
            refined, count = _refined(model, state.population[:1])
            work += count
            if refined and refined[0][0] < model.enough:
                return _Search(refined, work + state.evaluated, np.array(history), 0.0)
    assert state is not None
    refined, count = _refined(model, state.population[:_REFINED] if state.violation == 0 else ())
    return _Search(refined, work + count + state.evaluated, np.array(history), state.violation)


def _refined(model: PathModel, rows: Iterable[Floats]) -> tuple[list[tuple[float, PathModel, Floats]], int]:
    """Cost, model and improved row of the rows that keep the constraints; how many linkages it took."""
    found, work = [], 0
    for row in rows:
        cost, better, count = refine(model, row)
        work += count
        if np.isfinite(cost):
            found.append((cost, model, better))
    return found, work


def _result(model: PathModel, row: Floats, evaluated: int, seconds: float, history: Floats) -> PathGenerator:
    """The machine of a row, analysed again."""
    task = model.task
    bar, place, angles = linkage(model, row)
    machine = bar.machine(task.name or "Path generator", points={"P": place}, source=SOURCE)
    table = motions(machine, angles, points=["P"])[0]
    errors = np.hypot(table[0] - model.x, table[1] - model.y)
    rms = float(np.sqrt(np.mean(errors**2)))
    sizes = (np.array([each]) for each in (bar.frame, bar.crank, bar.coupler, bar.rocker))
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
        transmission_angle_min=float(worst_transmission(*sizes)[0]),
        evaluated=evaluated,
        rate=evaluated / seconds,
        seed=task.seed,
        crank_angles=angles,
        x=table[0].copy(),
        y=table[1].copy(),
        history=history,
        machine=machine,
    )


def linkage(model: PathModel, row: Floats) -> tuple[FourBar, complex, Floats]:
    """Linkage, coupler point and crank angles of the points of a row."""
    x = row[: model.n_entries]
    assembly: Assembly = model.assembly
    pivots = complex(x[0], x[1]), complex(x[2], x[3])
    if model.timed is None:
        angles = model.nearest(row)
        return FourBar(*pivots, x[4], x[5], x[6], assembly), complex(x[7], x[8]), angles
    # Machine angle zero is that of the task's own count.
    phase = float(np.angle(np.exp(1j * x[9])))
    return FourBar(*pivots, x[4], x[5], x[6], assembly, phase), complex(x[7], x[8]), model.timed


def _none(task: PathTask, searches: list[_Search], evaluated: int) -> str:
    """That nothing keeps the constraints, and by how much the best fails."""
    least = min(search.violation for search in searches)
    return (
        f"none of {evaluated} linkages keeps all constraints ({task.linkage}, transmission angle at least "
        f"{np.degrees(task.transmission_angle_min):.4g}°, lengths within {task.length_ratio_max:g} to 1, "
        f"points in order, pivots in their box); the nearest violates them by {least:.3g} in sum. Lower "
        "transmission_angle_min, raise length_ratio_max, widen pivots, or give more generations"
    )
