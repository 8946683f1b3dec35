"""Derivatives of random machines of all kinds along random directions over all their entries at once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from operator import attrgetter
from pathlib import Path

import along_directions
import numpy as np
import pytest
from along_directions import TOLERANCE, Case, Way, all_agree, closing, compared
from numpy.random import Generator
from random_cams import random_cam
from random_diagrams import areas, formula, table
from random_drives import Table, random_drive, torque_size, with_blow, with_jump
from random_parts import log_uniform, random_train
from random_toppers import MOTIONS, random_topper
from random_units import GEOMETRIES, random_rotator, random_unit
from sizes import cases, generator, random_cases

import linkwright as lw
from linkwright import FindingError, LinkwrightError
from linkwright.cam import cam_force
from linkwright.drive import accurate_run_down, accurate_run_up
from linkwright.kernel.arrays import Floats
from linkwright.sensitivity.sources import source

EXAMPLES = Path(__file__).parents[2] / "examples"

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

# Range of speeds over which a jump is looked at.
_RANGE = 1e-4

# Works are left out: of springs and weights they are zero but for rounding.
_NUMBERS = ("speed_mean_time", "period", "speed_max", "torque_motor_rms", "unevenness")

# The same of drives that pass jumps: what leaps at an extreme is known to the accuracy of its angle.
_BEHIND_JUMPS = 1e-6

# What a derivative is refused for: the torque of a motor without load stands on the kink at zero.
_STANDS_ON_A_KINK = "within rounding error, or two kinks"

# What random drives and trains, and those with an entry varied, are refused for.
# An accuracy of 1e-13 is not reached behind every jump.
_REFUSALS = (
    "no steady motion",
    "the motion slides along a jump",
    "steady motion was found to a relative accuracy",
    "Newton's method does not converge to it",
    "the existence of a steady motion was not determined",
    _STANDS_ON_A_KINK,
    "it is zero within rounding error",
)

# Of a sum over heads, at some of which something begins to be left with the power 3/2 of the step.
_OF_THE_MEAN = 1e-3

# Places of extremes are found by looking, to 1e-8 of their range: differences are good for the rest.
_OF_PLACES = 1e-2

_PLACES = ("uncut_phase", "uncut_offset", "last_x", "last_y", "worst_phase", "worst_offset")


def _scalars(of: Callable[[lw.Machine], object]) -> Callable[[lw.Machine, list[str]], Floats]:
    """Numbers of a result by the names of its responses, the last parts of which are attributes."""

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        result = of(machine)
        # The gear of a pumping unit is a result of its own.
        places = (
            name.rpartition(".")[2] if ".gear." not in name else name.partition(".")[2] for name in names
        )
        return np.array([float(attrgetter(place)(result)) for place in places])

    return measure


def _steady(random: Generator) -> Case:
    return steady_of(random_drive(random))


def _struck(random: Generator) -> Case:
    """A load jumps, or has kinks, at some angles."""
    drive = random_drive(random)
    state = lw.steady_state(lw.Machine.model_validate(drive))
    size = torque_size(state)
    # Beside jumps rounding of the angle allows no more.
    case = steady_of(with_blow(random, drive, size), accuracy=1e-12)
    return replace(case, analyses=[name for name in case.analyses if not any(of in name for of in _OF_WORKS)])


def steady_of(drive: Table, accuracy: float = 1e-13) -> Case:
    machine = lw.Machine.model_validate(drive)
    # What is zero but for rounding, as the torque without load, is left out.
    known = lw.gradient(machine, ["steady_state"], ["drive.gearbox.ratio"]).responses
    reached = lw.steady_state(machine).accuracy
    # Where rounding of the speed forbids the accuracy that is asked for, it leaves few digits of what a steep
    # drive makes of the speed.
    names = [name for name in known if reached <= _ASKED or not any(of in name for of in _OF_PEAKS)]

    noise = lw.steady_state(machine, accuracy=accuracy).accuracy
    names = [name for name in names if noise <= _QUIET or not any(of in name for of in _OF_MEANS)]
    measure = _scalars(partial(lw.steady_state, accuracy=accuracy))
    return Case(machine, names, measure, reached=reached, noise=noise)


def _jumping(random: Generator) -> Case:
    """A drive whose load jumps at a speed that it passed without the jump."""
    drive = random_drive(random)
    state = lw.steady_state(lw.Machine.model_validate(drive))
    drive = with_jump(random, drive, (state.speed_min, state.speed_max), torque_size(state))
    machine = lw.Machine.model_validate(drive)
    state = lw.steady_state(machine)
    if state.speed_max < (1.0 + _RANGE) * state.speed_min:
        raise FindingError("a step may take all speeds from one side of the jump to the other")
    names = [f"steady_state.{name}" for name in _NUMBERS]
    # Below, rounding of slow drives makes thousands of steps.
    measure = _scalars(partial(lw.steady_state, accuracy=1e-12))
    return Case(machine, names, measure, tolerance=lambda _: _BEHIND_JUMPS, reached=state.accuracy, steps=3)


def forces_of(drive: Table) -> Case:
    """Largest forces of a drive in steady motion, at the angles that `forces` looks at."""
    machine = lw.Machine.model_validate(drive)
    # What is zero but for rounding is left out.
    responses = list(lw.gradient(machine, ["forces"], ["drive.gearbox.ratio"]).responses)

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        found = lw.forces(machine, lw.steady_state(machine, accuracy=1e-13), contributions=False)
        known = {f"forces.reaction_max.{pair}": force for pair, force in found.reaction_max.items()}
        known |= {
            f"forces.{name}": getattr(found, name) for name in ("torque_drive_max", "shaking_force_max")
        }
        return np.array([known[name] for name in names])

    reached, noise = (lw.steady_state(machine, accuracy=of).accuracy for of in (_ASKED, 1e-13))
    return Case(machine, responses, measure, reached=reached, noise=noise)


def _forces(random: Generator) -> Case:
    return forces_of(random_drive(random))


def _up(machine: lw.Machine) -> lw.RunUp:
    return accurate_run_up(machine, lw.steady_state(machine, accuracy=1e-13), 1e-13)


def _down(machine: lw.Machine) -> lw.RunDown:
    return accurate_run_down(machine, float(lw.steady_state(machine, n=8, accuracy=1e-13).speed[0]), 1e-13)


def running_of(drive: Table, kind: str) -> Case:
    """A run-up or a run-down."""
    names = ["turns", "time", *(["speed_peak"] if kind == "up" else [])]
    measure = _scalars(_up if kind == "up" else _down)
    return Case(
        lw.Machine.model_validate(drive), [f"run_{kind}.{name}" for name in names], measure, steepest=1e3
    )


def _running(kind: str, random: Generator) -> Case:
    drive = random_drive(random)
    # Away from dead centres: from rest at one a run-up is smooth towards one side only.
    drive["run_up"] = {"angle_start": float(random.uniform(0.1, 6.0))}
    return running_of(drive, kind)


def linkage_of(machine: lw.Machine) -> Case:
    """Strokes, swings, time ratios and transmission angles."""

    def scalars(machine: lw.Machine) -> dict[str, float]:
        elements = lw.linkage(machine).to_dict()["elements"]
        return {f"linkage.{name}.{key}": x for name, one in elements.items() for key, x in one.items()}

    here = scalars(machine)

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        near = scalars(machine)
        changes = np.array([near[name] - here[name] for name in names])
        turned = np.array(["angle" in name.rpartition("_")[2] for name in names], dtype=bool)
        # Crank angles are those of one revolution.
        changes[turned] = (changes[turned] + np.pi) % (2 * np.pi) - np.pi
        return np.array([here[name] for name in names]) + changes

    return Case(machine, ["linkage"], measure)


def _mechanism(random: Generator) -> Case:
    return linkage_of(lw.Machine.model_validate(random_drive(random)))


def _train(random: Generator) -> Case:
    """Natural frequencies and shapes of modes."""
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

    return Case(machine, ["free_vibration.natural_frequencies", "free_vibration.mode_shapes"], measure)


def _excited(random: Generator) -> Case:
    """Torques of shafts at the speeds at which they are largest."""
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

    return Case(machine, ["forced_vibration"], measure)


def _cam(random: Generator) -> Case:
    machine = random_cam(random)
    if faults := lw.cam_faults(lw.cam_profile(machine, "c")):
        raise FindingError(str(faults[0]))

    return Case(machine, ["cam"], _scalars(lambda machine: lw.cam_profile(machine, "c", n=180)))


def _loaded_cam(random: Generator) -> Case:
    """Normal force and pressure of a cam that moves a mass against a spring."""
    described = random_cam(random).model_dump(exclude_unset=True)
    described["mechanism"]["cams"]["c"]["width"] = float(random.uniform(8e-3, 20e-3))
    described["bodies"] = {"c": {"mass": log_uniform(random, 0.1, 3.0)}}
    described["drive"]["speed"] = log_uniform(random, 3.0, 60.0)
    machine = lw.Machine.model_validate(described)
    if faults := lw.cam_faults(lw.cam_profile(machine, "c")):
        raise FindingError(str(faults[0]))

    return Case(machine, ["cam_force"], _scalars(lambda machine: cam_force(machine, "c")))


def _turning(of: Callable[[Generator], str], random: Generator) -> Case:
    machine = lw.loads(f'format = 1\nname = "shaft"\n[turning_moment]\nspeed = 25\n{of(random)}\n')

    def ways(machine: lw.Machine, names: tuple[str, ...]) -> Iterator[Way]:
        # Areas balance together alone.
        return closing(machine, tuple(name for name in names if ".areas." not in name))

    return Case(machine, ["turning_moment"], _scalars(partial(lw.turning_moment, n=1)), ways)


def _unit(geometry: str, random: Generator) -> Case:
    def ways(machine: lw.Machine, names: tuple[str, ...]) -> Iterator[Way]:
        # The last position is the end of the stroke, beyond which none may be.
        ends = [name for name in names if ".position." in name and lw.get(machine, name) == 1.0]
        return closing(machine, tuple(name for name in names if name not in ends))

    machine = random_unit(random, geometry)
    return Case(machine, ["pumping_unit"], _scalars(partial(lw.pumping_unit, n=8)), ways)


def _rotator(regime: str, lengths: str, random: Generator) -> Case:
    machine = random_rotator(random, regime, lengths)
    # Each of its entries has derivatives.
    refused = source(machine, "rod_rotator", list(lw.addresses(machine))).refused
    assert not [name for name in refused if name.startswith(("drive.speed", "pumping_unit.", "rod_rotator."))]
    return Case(machine, ["rod_rotator"], _scalars(partial(lw.rod_rotator, n=8)))


def _tolerance(response: str) -> float:
    name = response.partition(".")[2]
    return _OF_THE_MEAN if name == "uncut_share_mean" else _OF_PLACES if name in _PLACES else TOLERANCE


def _topper(kind: str, random: Generator) -> Case:
    return Case(random_topper(random, kind), ["topper"], _scalars(lw.topper), tolerance=_tolerance)


QUICK: dict[str, Callable[[Generator], Case]] = {
    "steady": _steady,
    "struck": _struck,
    "up": partial(_running, "up"),
    "down": partial(_running, "down"),
    "forces": _forces,
    "mechanism": _mechanism,
    "train": _train,
    "excited": _excited,
    "cam": _cam,
    "loaded cam": _loaded_cam,
    **{f"{of.__name__} of torques": partial(_turning, of) for of in (formula, table, areas)},
    **{geometry: partial(_unit, geometry) for geometry in GEOMETRIES},
    **{
        f"{regime} rotator, lengths {lengths}": partial(_rotator, regime, lengths)
        for regime in ("continuous", "intermittent")
        for lengths in ("given", "made")
    },
    **{f"{kind} topper": partial(_topper, kind) for kind in MOTIONS[:3]},
}
SLOW: dict[str, Callable[[Generator], Case]] = {
    "jumping": _jumping,
    **{f"{kind} topper": partial(_topper, kind) for kind in MOTIONS[3:]},
}


def _reason(error: LinkwrightError) -> str:
    """Why a machine is refused: one of the known reasons, else the test fails by it."""
    reasons = [reason for reason in _REFUSALS if reason in str(error)]
    if not reasons:
        raise AssertionError("refused for no known reason") from error
    return reasons[0]


@pytest.mark.parametrize(("kinds", "rounds"), [(QUICK, 6), (SLOW, 2)])
def test_derivatives_are_those_of_the_analyses(
    kinds: dict[str, Callable[[Generator], Case]], rounds: int
) -> None:
    counts = all_agree(kinds, random_cases(41, rounds * len(kinds), 400 * len(kinds)))
    assert set(+counts) == set(kinds)


_LINKAGES = (
    *("four_bar_coupler_curve", "six_bar_chains", "quick_returns", "jansen_leg", "klann_leg"),
    *("three_circle_triad", "gears_and_guides", "geared_five_bar", "knuckle_press_drawing", "press_motion"),
)


@pytest.mark.parametrize("name", _LINKAGES)
def test_derivatives_are_those_of_the_linkage(name: str) -> None:
    tally = compared(linkage_of(lw.read(EXAMPLES / name / "machine.toml")), generator(53))
    assert not tally.wrong, tally.wrong
    assert tally.count > 3


# The smallest radius of a cam lies a third of a thousandth of a radian behind a joint; what jumps leave of
# derivatives that are zero, or found by moving ends of steps in turn, which took turns.
_FOUND = [(_cam, 7, 5025), *((_jumping, 11, case) for case in (1, 23, 164, 222, 349))]


@pytest.mark.parametrize(("kind", "key", "number"), _FOUND)
def test_derivatives_of_cases_that_campaigns_found(
    kind: Callable[[Generator], Case], key: int, number: int
) -> None:
    tally = compared(kind(random := generator(key, number)), random)
    assert tally.count
    assert not tally.wrong, tally.wrong


def test_random_drives_are_refused_for_known_reasons() -> None:
    refused = Counter[str]()
    for _, random in random_cases(3, 12, 1000):
        try:
            machine = lw.Machine.model_validate(random_drive(random))
            lw.gradient(machine, ["steady_state"])
        except LinkwrightError as error:
            refused[_reason(error)] += 1
    # One in 25 of these drives has no load: of more, derivatives must not be refused.
    assert refused[_STANDS_ON_A_KINK] <= max(1, cases(12, 1000) // 10), refused


def test_steps_of_rounding_are_no_wrong_derivatives() -> None:
    """Of a sine that is known to steps of 1e-10: a difference over one length may seem exact by chance."""
    random, names = np.random.default_rng(1), [f"sine {n}" for n in range(2000)]
    described = 'format = 1\nname = "sines"\n[mechanism.cranks.A]\nradius = 1.0\n'

    def measure(machine: lw.Machine, names: list[str]) -> Floats:
        steps = np.round(random.standard_normal(len(names)))
        return np.sin(lw.get(machine, "mechanism.cranks.A.radius")) + 1e-10 * steps

    case = Case(lw.loads(described), [], measure)
    limits = np.full(len(names), TOLERANCE), np.zeros(len(names))
    for off, wrong in ((0.0, 0), (1e-5, len(names))):
        tally, exact = along_directions.Tally(), np.full(len(names), np.cos(1.0) + off)
        along_directions._compare(case, names, exact, {"mechanism.cranks.A.radius": 1.0}, limits, tally)
        assert len(tally.wrong) == wrong
