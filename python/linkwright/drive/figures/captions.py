"""The figures of a drive with their captions."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.drive.characteristic import characteristic
from linkwright.drive.figures.motor import motor_figure
from linkwright.drive.figures.reduction import reduction_figure
from linkwright.drive.figures.run_up import attempt_figure, run_up_figure
from linkwright.drive.figures.steady import speed_figure, time_figure, torque_figure
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.study import DriveStudy
from linkwright.kernel.figure.captioned import Captioned
from linkwright.kernel.page.numbers import number

# The motor's curve is drawn beyond the fastest instant of the revolution by this share of it, and half the
# range of speeds: as far as the detail beside it looks.
_BEYOND = 0.012


def drive_figures(study: DriveStudy) -> Iterator[Captioned]:
    """The figures that a drive has results for: steady motion, motor, run-up, reduction."""
    yield from _steady(study)
    yield from _motor(study)
    yield from _run_up(study)
    yield from _reduction(study)


def _steady(study: DriveStudy) -> Iterator[Captioned]:
    steady = study.steady_state
    if steady is None:
        return
    low, high = number(steady.speed_min), number(steady.speed_max)
    caption = (
        f"The crank turns at {low} to {high} rad/s, δ = {number(steady.unevenness)}; a revolution takes "
        f"{number(steady.period)} s."
    )
    yield Captioned("speed", "Speed and acceleration over one revolution", caption, speed_figure(steady))
    caption = (
        "The speed follows the difference of driving and load torque and the change of the reduced inertia. "
        f"The work of the motor is {number(steady.energy_motor)} J per revolution."
    )
    yield Captioned("torque", "Torque and power over one revolution", caption, torque_figure(steady))
    caption = "The same motion over time, as a tachometer shows it."
    yield Captioned("time", "Speed and motor torque over time", caption, time_figure(steady))


def _motor(study: DriveStudy) -> Iterator[Captioned]:
    drive, steady, reduced = study.machine.drive, study.steady_state, study.reduction
    if drive is None or drive.motor is None or reduced is None or isinstance(drive.motor, ConstantSpeedMotor):
        return
    reach = (1.5 + _BEYOND) * steady.speed_max - 0.5 * steady.speed_min if steady else 0.0
    curve = characteristic(study.machine, reduced=reduced, speed_max=reach * drive.gearbox.ratio)
    caption = "Torque over speed at the motor's shaft, against the mean load of a revolution."
    if steady is not None:
        slow, fast = (number(speed * drive.gearbox.ratio) for speed in (steady.speed_min, steady.speed_max))
        caption += f" Shaded: the speeds of steady motion, {slow} to {fast} rad/s."
    yield Captioned("motor", "Motor and working range", caption, motor_figure(curve, steady))


def _run_up(study: DriveStudy) -> Iterator[Captioned]:
    if study.run_up is not None:
        run_up = study.run_up
        caption = (
            f"Steady motion, to within {100 * run_up.settled:.3g} %, is reached after {number(run_up.time)} "
            f"s and {number(run_up.turns)} revolutions."
        )
        yield Captioned("run_up", "Run-up", caption, run_up_figure(run_up, study.steady_state))
    elif study.attempt is not None and len(study.attempt.time) > 1:
        caption = f"The motion ends after {number(study.attempt.turns)} revolutions."
        yield Captioned("run_up", "Run-up that fails", caption, attempt_figure(study.attempt))


def _reduction(study: DriveStudy) -> Iterator[Captioned]:
    reduced = study.reduction
    if reduced is None:
        return
    low, high, mean = reduced.inertia_min, reduced.inertia_max, reduced.torque_load_mean
    caption = (
        f"Inertia reduced to the crank, from {number(low)} to {number(high)} kg m², and load torque referred "
        f"to the crank, {number(mean)} N m on average."
    )
    yield Captioned("reduction", "Reduced inertia and torque", caption, reduction_figure(reduced))
