"""Derivatives of random machines of all kinds along random directions over all their entries at once.

One difference along a direction tells a wrong derivative by any entry, at the price of one: so thousands of
machines can be looked at. The files beside this one vary the entries one by one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np
import test_gradient_in_time as in_time
import test_random_cams as cams
import test_random_machines as drives
import test_random_pumping_units as units
import test_random_toppers as toppers
from numpy.random import Generator
from numpy.typing import NDArray
from random_diagrams import areas, formula, table
from random_drives import Table, torque_size, with_blow
from random_parts import log_uniform, random_train
from sizes import random_cases

import linkwright as lw
from linkwright import FindingError, LinkwrightError
from linkwright.cam import cam_force
from linkwright.kernel.arrays import Floats
from linkwright.machine import exchanged
from linkwright.machine.address import is_given

# Shares of entries over which they are varied: shorter ones do not reach a kink or a tie of two extremes
# beside the machine; over longer ones rounding counts less.
_STEPS = (1e-4, 2e-5, 4e-6, 1e-3, 1e-6, 1e-7, 1e-8)

# What differences are good for, as a share of the largest derivative of a response, or of the response.
_TOLERANCE = 1e-7

# Responses of which one may be zero that is a difference of the others.
_ALIKE = ("torque_net", ".last_", "torque_motor_", "power_motor_", "energy_", ".acceleration_m")

# Accuracy of a steady motion that is asked for, and what is made of peaks of its acceleration and of
# the motor torque.
_ASKED = 1e-9
_OF_PEAKS = (
    "acceleration",
    "dynamism",
    "motion_coefficient",
    "torque_motor_max",
    "torque_motor_min",
    "power_motor_max",
)

# Works are rounding where inertia carries much more along; multipliers where all dies at once.
_OF_WORKS = ("energy_", "efficiency", "multiplier")

# Ratios of means, which are small differences of what noise counts of, where the motion is not known better.
_OF_MEANS, _QUIET = ("cyclic_load_factor", "efficiency"), 1e-10

# By how many of its own uncertainties a difference may be off.
_UNCERTAIN = 3.0

# Directions over all entries of a machine.
_DIRECTIONS = 2

# Range of speeds over which a jump is looked at.
_RANGE = 1e-4

# Entry → by how much it goes.
Way = dict[str, float]


@dataclass(frozen=True)
class Case:
    """A machine, what of its results is compared, and how these are computed anew."""

    machine: lw.Machine
    analyses: list[str]
    measure: Callable[[lw.Machine, list[str]], Floats]
    ways: Callable[[lw.Machine, tuple[str, ...]], Iterator[Way]]
    tolerance: Callable[[str], float] = lambda name: _TOLERANCE
    # What the motion itself is good for: under a steep motor rounding of the speed is torque.
    reached: float = 0.0
    # The same of the motions that differences are taken of: what a nearly neutral drive makes of rounding.
    noise: float = 0.0
    # Elasticities up to this are compared: a run-up that barely settles, or barely does not, changes within
    # shares of an entry that no difference is short enough for.
    steepest: float = 1e100


def _alone(machine: lw.Machine, names: tuple[str, ...]) -> Iterator[Way]:
    for name in names:
        # Sections of a cam have to close.
        if ".sections." not in name and (value := lw.get(machine, name)):
            yield {name: abs(value)}


def _as_listed(measure: drives.Measure, listed: list[str]) -> Callable[[lw.Machine, list[str]], Floats]:

    def some(machine: lw.Machine, names: list[str]) -> Floats:
        known = dict(zip(listed, measure(machine), strict=True))
        return np.array([known[name] for name in names])

    return some


def _steady(random: Generator) -> Case:
    return _steady_of(drives.random_drive(random))


def _struck(random: Generator) -> Case:
    drive = drives.random_drive(random)
    state = lw.steady_state(lw.Machine.model_validate(drive))
    size = torque_size(state)
    # Beside jumps rounding of the angle allows no more.
    case = _steady_of(with_blow(random, drive, size), accuracy=1e-12)
    return replace(case, analyses=[name for name in case.analyses if not any(of in name for of in _OF_WORKS)])


def _steady_of(drive: Table, accuracy: float = 1e-13) -> Case:
    machine = lw.Machine.model_validate(drive)
    # What is zero but for rounding, as the torque without load, is left out.
    known = lw.gradient(machine, ["steady_state"], ["drive.gearbox.ratio"]).responses
    reached = lw.steady_state(machine).accuracy
    # Where rounding of the speed forbids the accuracy that is asked for, it leaves few digits of what a steep
    # drive makes of the speed.
    names = [name for name in known if reached <= _ASKED or not any(of in name for of in _OF_PEAKS)]

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        state = lw.steady_state(machine, accuracy=accuracy)
        return np.array([getattr(state, name.partition(".")[2]) for name in names], dtype=float)

    noise = lw.steady_state(machine, accuracy=accuracy).accuracy
    names = [name for name in names if noise <= _QUIET or not any(of in name for of in _OF_MEANS)]
    return Case(machine, names, measure, _alone, reached=reached, noise=noise)


def _jumping(random: Generator) -> Case:
    machine = drives._jumping_drive(random)
    names = [f"steady_state.{name}" for name in drives._NUMBERS]
    measure, state = _as_listed(drives._measures, names), lw.steady_state(machine)
    if state.speed_max < (1.0 + _RANGE) * state.speed_min:
        raise FindingError("a step may take all speeds from one side of the jump to the other")
    return Case(machine, names, measure, _alone, lambda name: drives._BEHIND_JUMPS, reached=state.accuracy)


def _forces(random: Generator) -> Case:
    machine, names, measure = drives._forces(random)
    reached, noise = (lw.steady_state(machine, accuracy=of).accuracy for of in (_ASKED, 1e-13))
    return Case(machine, names, _as_listed(measure, names), _alone, reached=reached, noise=noise)


def _running(kind: str) -> Callable[[Generator], Case]:
    def case(random: Generator) -> Case:
        names, measure = in_time.KINDS[kind]
        return Case(in_time._drive(random), names, _as_listed(measure, names), _alone, steepest=1e3)

    return case


def _train(random: Generator) -> Case:
    machine = lw.Machine.model_validate({"format": 1, "name": "train", "train": random_train(random)})

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        modes = lw.free_vibration(machine)
        places = [name.split(".")[2:] for name in names]
        shapes = dict(enumerate(modes.mode_shapes))
        return np.array(
            [
                shapes[int(mode)][modes.discs.index(disc[0])]
                if disc
                else modes.natural_frequencies[int(mode)]
                for mode, *disc in places
            ]
        )

    return Case(
        machine, ["free_vibration.natural_frequencies", "free_vibration.mode_shapes"], measure, _alone
    )


def _excited(random: Generator) -> Case:
    train = {"format": 1, "name": "train", "train": random_train(random)}
    machine = lw.Machine.model_validate(train)
    response = lw.forced_vibration(machine)

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        parts = [name.split(".")[1:] for name in names]
        places = [(kind, response.shafts.index(shaft)) for kind, shaft in parts]
        peaks = [int(getattr(response, kind)[shaft].argmax()) for kind, shaft in places]
        speeds, nth = np.unique(response.speeds[peaks], return_inverse=True)
        at = lw.forced_vibration(machine, speeds)
        return np.array([getattr(at, kind)[shaft, n] for (kind, shaft), n in zip(places, nth, strict=True)])

    return Case(machine, ["forced_vibration"], measure, _alone)


def _cam(random: Generator) -> Case:
    machine = cams._machine(random)
    if faults := lw.cam_faults(lw.cam_profile(machine, "c")):
        raise FindingError(str(faults[0]))

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        return cams._numbers(machine, [name.rpartition(".")[2] for name in names])

    return Case(machine, ["cam"], measure, cams._ways)


def _loaded_cam(random: Generator) -> Case:
    described = cams._machine(random).model_dump(exclude_unset=True)
    described["mechanism"]["cams"]["c"]["width"] = float(random.uniform(8e-3, 20e-3))
    described["bodies"] = {"c": {"mass": log_uniform(random, 0.1, 3.0)}}
    described["drive"]["speed"] = log_uniform(random, 3.0, 60.0)
    machine = lw.Machine.model_validate(described)
    if faults := lw.cam_faults(lw.cam_profile(machine, "c")):
        raise FindingError(str(faults[0]))

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        loaded = cam_force(machine, "c")
        return np.array([getattr(loaded, name.rpartition(".")[2]) for name in names], dtype=float)

    return Case(machine, ["cam_force"], measure, cams._ways)


def _turning(random: Generator) -> Case:
    described = (formula, table, areas)[random.integers(3)](random)
    machine = lw.loads(f'format = 1\nname = "shaft"\n[turning_moment]\nspeed = 25\n{described}\n')

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        diagram = lw.turning_moment(machine, n=1)
        return np.array([getattr(diagram, name.partition(".")[2]) for name in names], dtype=float)

    def ways(machine: lw.Machine, names: tuple[str, ...]) -> Iterator[Way]:
        # Areas balance together alone.
        return _alone(machine, tuple(name for name in names if ".areas." not in name))

    return Case(machine, ["turning_moment"], measure, ways)


def _unit(random: Generator) -> Case:
    machine = units._machine(random, str(random.choice(list(units._BASES))))

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        return units._numbers(machine, names)

    def ways(machine: lw.Machine, names: tuple[str, ...]) -> Iterator[Way]:
        # The last position is the end of the stroke, beyond which none may be.
        ends = [name for name in names if ".position." in name and lw.get(machine, name) == 1.0]
        return _alone(machine, tuple(name for name in names if name not in ends))

    return Case(machine, ["pumping_unit"], measure, ways)


def _topper(random: Generator) -> Case:
    kind = str(random.choice(["harmonic", "constant", "one_way", "slider", "cam"]))

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        study = lw.topper(machine)
        return np.array([float(getattr(study, name.partition(".")[2])) for name in names])

    def tolerance(name: str) -> float:
        return toppers._tolerance(name.partition(".")[2])

    return Case(toppers._machine(random, kind), ["topper"], measure, _alone, tolerance)


# As often as they are quick; `make test` looks at the first of them.
_QUICK = (_steady, _struck, _train, _cam, _forces, _excited, _unit, _topper, _turning, _loaded_cam)
KINDS = (
    *_QUICK,
    *(_steady, _train, _cam, _forces, _jumping, _running("up"), _running("down"), _steady, _train, _cam),
    *(_struck, _jumping, _topper, _loaded_cam),
)


def _directions(machine: lw.Machine, ways: list[Way], random: Generator) -> Iterator[Way]:
    """Random ways over all entries together; one of those that others follow from is varied alone."""
    together = [way for way in ways if all(is_given(machine, name) for name in way)]
    following = [way for way in ways if way not in together]
    for _ in range(_DIRECTIONS if together else 0):
        direction: Way = Counter()
        for way in together:
            share = random.uniform(0.3, 1.0) * random.choice([-1, 1])
            direction.update({name: share * size for name, size in way.items()})
        yield direction
    if following:
        yield following[random.integers(len(following))]


@dataclass(frozen=True)
class Difference:
    """Differences along a direction, (responses,) each."""

    # Central, extrapolated to sixth order.
    value: Floats
    # By how much that of fourth order is another, and those to either side: where they are, truncation,
    # rounding or a kink count.
    uncertainty: Floats
    # Smallest change from value to value, infinite where there is none; and whether some are equal.
    smallest: Floats
    has_equal: NDArray[np.bool_]


def _difference(machine: lw.Machine, direction: Way, measure: drives.Measure, step: float) -> Difference:
    """Differences over h, 2h and 4h."""
    here = {name: lw.get(machine, name) for name in direction}
    near = {
        n: np.array(measure(exchanged(machine, {k: here[k] + n * step * x for k, x in direction.items()})))
        for n in (-4, -2, -1, 0, 1, 2, 4)
    }
    once, twice, four = ((near[n] - near[-n]) / (2 * n * step) for n in (1, 2, 4))
    sixth, fourth = (64 * once - 20 * twice + four) / 45, (4 * once - twice) / 3
    right, left = (
        (-21 * near[0] + 32 * near[side] - 12 * near[2 * side] + near[4 * side]) / (12 * side * step)
        for side in (1, -1)
    )
    changes = np.diff(np.sort(list(near.values()), axis=0), axis=0)
    smallest = np.where(changes > 0.0, changes, np.inf).min(axis=0)
    uncertainty = np.abs(sixth - fourth) + 0.3 * np.abs(right - left)
    return Difference(sixth, uncertainty, smallest, (changes == 0.0).any(axis=0))


@dataclass
class Tally:
    """What was compared: derivatives along directions."""

    count: int = 0
    # Of these, such as no difference is good enough for: they agree within its uncertainty.
    coarse: int = 0
    wrong: list[str] = field(default_factory=list)


def compared(case: Case, random: Generator) -> Tally:
    found = lw.gradient(case.machine, case.analyses)
    ways = list(case.ways(case.machine, found.variables))
    used = [found.variables.index(name) for name in {name for way in ways for name in way}]
    sizes = np.abs(found.derivatives[:, used] * found.at[used]).max(axis=1, initial=0.0)
    is_flat = ~(sizes > case.steepest * np.abs(found.values))
    rows = [row for row, name in enumerate(found.responses) if name not in found.ties and is_flat[row]]
    names, d, sizes = [found.responses[row] for row in rows], found.derivatives[rows], sizes[rows]
    # Where a disturbance dies at once its growth over a revolution is no number.
    scales = np.maximum(sizes, np.abs(found.values[rows])) + 1e-200
    # The largest amplitude of a shape is 1.
    scales[["mode_shapes" in name for name in names]] += 1.0
    # Rounding of a net torque of zero is that of the largest, of a place on an axis that along the axis.
    for alike in _ALIKE:
        those = np.array([alike in name for name in names], dtype=bool)
        scales[those] = scales[those].max(initial=0.0)
    good = np.array([max(case.tolerance(name), case.reached) for name in names]) * scales
    tally = Tally()
    for direction in _directions(case.machine, ways, random):
        exact = sum(d[:, found.variables.index(name)] * x for name, x in direction.items())
        try:
            _compare(
                case, names, np.broadcast_to(exact, len(names)), direction, (good, case.noise * scales), tally
            )
        except (LinkwrightError, TypeError):
            # Beside it the machine cannot do it, or the law of the cam is another one.
            continue
    return tally


def _compare(
    case: Case, names: list[str], exact: Floats, direction: Way, limits: tuple[Floats, Floats], tally: Tally
) -> None:
    """Over each step as far as they are needed; what counts is the difference that is surest of itself."""
    good, noise = limits
    errors, uncertainties = [], []
    quantum, has_equal = np.full(len(names), np.inf), np.zeros(len(names), dtype=bool)
    agrees = np.zeros(len(names), dtype=bool)
    for step in _STEPS:
        found = _difference(case.machine, direction, lambda x: case.measure(x, names), step)
        # There may be none beside the machine, as of a load factor where the mean passes zero.
        errors.append(np.nan_to_num(np.abs(exact - found.value), nan=np.inf))
        uncertainties.append(np.nan_to_num(found.uncertainty, nan=np.inf))
        quantum, has_equal = np.fmin(quantum, found.smallest), has_equal | found.has_equal
        agrees |= errors[-1] + uncertainties[-1] <= good
        if agrees.all():
            tally.count += len(names)
            return
    # A number that stays the same over short steps is known to its smallest change only, over long ones too.
    floor = (np.where(has_equal & np.isfinite(quantum), quantum, 0.0) + noise) / np.array(_STEPS)[:, None]
    least, off = _surest(np.array(uncertainties) + floor, np.array(errors))
    wrong = ~agrees & ~(off <= good + _UNCERTAIN * least)
    tally.count += len(names)
    tally.coarse += int((~agrees & ~wrong).sum())
    tally.wrong += [
        f"{names[row]} is {off[row] / good[row]:.2g} times what is allowed off, with a difference good to "
        f"{least[row] / good[row]:.2g}, along {direction}"
        for row in np.flatnonzero(wrong)
    ]


def _surest(uncertainties: Floats, errors: Floats) -> tuple[Floats, Floats]:
    """Uncertainty and error of the surest differences of those over all steps, (steps, responses)."""
    # Rounding is steps of a number: over one length they may cancel, and a difference seems exact that is
    # not. Rounding that a shorter one shows is in the longer ones, too, by the share of their lengths; of the
    # shortest none tells it.
    order = np.argsort(_STEPS)
    steps = np.array(_STEPS)[order, None]
    sure = np.maximum.accumulate(uncertainties[order] * steps)[1:] / steps[1:]
    surest = sure.argmin(axis=0), np.arange(sure.shape[1])
    return sure[surest], errors[order][1:][surest]


def test_derivatives_are_those_of_the_analyses() -> None:
    counts, coarse = Counter[str](), 0
    for number, random in random_cases(41, len(_QUICK), 10_000):
        kind = KINDS[number % len(KINDS)]
        try:
            tally = compared(kind(random), random)
        except LinkwrightError:
            # It does not close, nothing drives it, all of it is rounding.
            continue
        assert not tally.wrong, (number, kind.__name__, tally.wrong)
        counts[kind.__name__] += tally.count
        coarse += tally.coarse
    # Where no difference is good enough nothing is compared: an exception.
    assert coarse < 0.05 * sum(counts.values())
    assert sum(counts.values()) > 50
    assert len(counts) >= len(_QUICK) - 2, counts


def test_steps_of_rounding_are_no_wrong_derivatives() -> None:
    """Of a sine that is known to steps of 1e-10: a difference over one length may seem exact by chance."""
    random, names = np.random.default_rng(1), [f"sine {n}" for n in range(2000)]
    described = 'format = 1\nname = "sines"\n[mechanism.cranks.A]\nradius = 1.0\n'

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        steps = np.round(random.standard_normal(len(names)))
        return np.sin(lw.get(machine, "mechanism.cranks.A.radius")) + 1e-10 * steps

    case = Case(lw.loads(described), [], measure, _alone)
    limits = np.full(len(names), _TOLERANCE), np.zeros(len(names))
    for off, wrong in ((0.0, 0), (1e-5, len(names))):
        tally, exact = Tally(), np.full(len(names), np.cos(1.0) + off)
        _compare(case, names, exact, {"mechanism.cranks.A.radius": 1.0}, limits, tally)
        assert len(tally.wrong) == wrong
