r"""Whether a motor suffices: each check with its number and its limit.

| check | asks |
| --- | --- |
| `speed` | does the crank turn at the design speed when the motor turns at its rated one? |
| `rated_power` | is the rated power the required one, with a reserve? |
| `starting_torque` | does it move the machine from its start angle? |
| `starting_torque_worst` | and from the worst crank angle? |
| `run_up` | does the machine reach its steady motion? |
| `torque_rms` | does the motor stay cool: is the effective torque at most the rated one? |
| `torque_peak` | does it keep a reserve to the breakdown torque if the voltage drops? |
| `inertia_ratio` | of a servo motor: is the mechanism not too heavy to be controlled? |

The torques are those of the exact steady motion, not of a mean load.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from linkwright.drive.model.catalogue import OVERLOAD, CatalogueMotor
from linkwright.drive.model.motor import ConstantSpeedMotor, DcMotor, InductionMotor
from linkwright.drive.reduction import reduction_of
from linkwright.drive.run_up import RunUp, run_up
from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.kernel.check import Check
from linkwright.kernel.errors import FindingError
from linkwright.linkages.closure import turn_angles
from linkwright.linkages.whole_cycle import over_known_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.sizing.power import RequiredPower

# Share of the design speed by which the crank's speed at the rated point may differ from it: gearboxes come
# in ratios 12 % apart (series R20 of preferred numbers), so that the nearest one may be that far off.
SPEED_BAND = 0.12

# Torque goes with the square of the voltage: with 10 % less of it 0.9² = 0.81 of the breakdown torque is
# left. Handbooks of electric drives give 0.8 to 0.85.
PEAK_SHARE = 0.9**2

# What counts as breakdown torque where the source gives none.
LEAST_BREAKDOWN = f"the minimum of IEC 60034-1, {OVERLOAD:g} times the rated torque; the catalogue gives none"

# What counts as starting torque where the source gives none.
LEAST_START = "the minimum of IEC 60034-12 for design N; the catalogue gives none"

# Intervals of the revolution over which maximum torques are looked for: the largest of 1440 samples of a
# smooth curve misses its peak by some 1e-5.
_ANGLES = 1440

# Speed of the crank that counts as standing still [rad/s]: loads by formulas then say which way they hold.
_SLOW = 1e-9

# Inertia of the load over that of the rotor up to which servo drives are usually well controlled: a rule of
# thumb of makers of servo motors; it does not decide.
INERTIA_RATIO = 10.0

# A ratio chosen for the maximum speed meets it to rounding.
_ROUNDED = 1e-12

_RATING = ("speed", "rated_power")
_START = ("starting_torque", "run_up")
_TORQUE = ("starting_torque_worst", "torque_rms", "torque_peak")

# Which checks decide, by the way of choosing.
DECISIVE = {
    "power": _RATING + _START,
    "fixed-start": _RATING + _START + _TORQUE[1:],
    "all": _RATING + _START + _TORQUE,
}


@dataclass(frozen=True)
class MotorChecks:
    """All checks of a machine with its motor, and the analyses that they rest on."""

    checks: tuple[Check, ...]  # in the order of `DECISIVE`
    steady: SteadyState | None = None  # None if there is no steady motion
    run_up: RunUp | None = None  # None if the machine does not run up


def rating_checks(
    known: CatalogueMotor, ratio: float, required: RequiredPower, reserve: float
) -> tuple[Check, ...]:
    """Speed and power of a motor by its rating; `ratio` [–]; `reserve`: rated over required power [–]."""
    if known.kind == "servo":
        return _servo_rating(known, ratio, required, reserve)
    speed = known.speed_rated / ratio
    suits = abs(speed / required.speed - 1) <= SPEED_BAND
    note = "" if suits else f"a ratio of {known.speed_rated / required.speed:.4g} would suit"
    need = required.power * reserve
    return (
        _speed_check(speed, required.speed, suits, note),
        Check("rated_power", known.power_rated, need, "W", known.power_rated >= need),
    )


def _servo_rating(
    known: CatalogueMotor, ratio: float, required: RequiredPower, reserve: float
) -> tuple[Check, ...]:
    """A servo motor may run at any speed up to its maximum, with its rated torque."""
    speed, limit = required.speed * ratio, known.speed_max or known.speed_rated
    note = "" if speed <= limit else f"a ratio of {limit / required.speed:.4g} or less would suit"
    need, power = required.power * reserve, known.torque_rated * min(speed, known.speed_rated)
    return (
        Check("speed", speed, limit, "rad/s", speed <= limit * (1 + _ROUNDED), at_most=True, note=note),
        Check(
            "rated_power", power, need, "W", power >= need, note="rated torque at the speed that it runs at"
        ),
    )


def _speed_check(speed: float, wanted: float, suits: bool, note: str) -> Check:
    fast = speed > wanted
    limit = wanted * (1 + SPEED_BAND if fast else 1 - SPEED_BAND)
    return Check("speed", speed, limit, "rad/s", suits, at_most=fast, note=note)


def motion_checks(machine: Machine, known: CatalogueMotor | None = None) -> MotorChecks:
    """Check what only the machine's motion tells: start, run-up, heat and overload.

    `machine`: the machine with an induction, a DC or a servo motor in it; `known`: what the catalogue gives
    of it. Returns: the checks, with steady motion and run-up.

    Where the catalogue gives no starting torque, the minimum of a standard counts, or else Kloss's formula
    holds down to standstill. Both give less than real motors have, so a start by them is sure and a failure
    to start proves nothing.

    Source: Effective torque and overload: any handbook of electric drives, choice of motors for varying load.
    """
    assert machine.drive is not None
    motor = machine.drive.motor
    if isinstance(motor, ConstantSpeedMotor):
        assert known is not None
        return _servo_checks(machine, known)
    assert isinstance(motor, InductionMotor | DcMotor)
    doubt = _start_doubt(motor)
    starts = _start_checks(machine, doubt)
    try:
        steady = steady_state(machine, n=_ANGLES)
    except FindingError as error:
        lost = tuple(Check(name, None, None, "", False, note=str(error)) for name in DECISIVE["all"][3:])
        return MotorChecks((starts[0], lost[0], starts[1], *lost[2:]))
    up, check = _run_up_check(machine, steady, doubt)
    return MotorChecks((starts[0], check, starts[1], *torque_checks(motor, steady)), steady, up)


def torque_checks(motor: InductionMotor | DcMotor, steady: SteadyState) -> tuple[Check, Check]:
    """Check the torque of steady motion against the rated and the breakdown or maximum torque."""
    if isinstance(motor, DcMotor):
        return _torque_limits(steady, motor.torque_rated, motor.torque_max)
    peak = max(steady.torque_motor_max, -steady.torque_motor_min)
    rms = _at_most("torque_rms", steady.torque_motor_rms, motor.torque_rated, "no rated torque")
    limit = PEAK_SHARE * motor.torque_breakdown if motor.torque_breakdown else None
    check = _at_most("torque_peak", peak, limit, "no breakdown torque")
    note = f"the breakdown torque is {LEAST_BREAKDOWN}"
    return rms, replace(check, note=note) if motor.breakdown_is_minimum else check


def _torque_limits(steady: SteadyState, rated: float | None, most: float | None) -> tuple[Check, Check]:
    """Rms and peak torque of the motor against its continuous and short-time limits."""
    peak = max(steady.torque_motor_max, -steady.torque_motor_min)
    rms = _at_most("torque_rms", steady.torque_motor_rms, rated, "no rated torque")
    return rms, _at_most("torque_peak", peak, most, "no maximum torque, torque_max")


def _servo_checks(machine: Machine, known: CatalogueMotor) -> MotorChecks:
    assert machine.drive is not None
    try:
        steady = steady_state(machine, n=_ANGLES)
    except FindingError as error:
        lost = tuple(Check(name, None, None, "", False, note=str(error)) for name in DECISIVE["all"][2:])
        return MotorChecks(lost)
    starts = _start_checks(machine, "", known.torque_max)
    up = Check("run_up", None, None, "s", True, note="by the controller")
    torques = _torque_limits(steady, known.torque_rated, known.torque_max)
    own = float(machine.drive.motor.inertia) if machine.drive.motor else 0.0
    checks = (starts[0], up, starts[1], *torques, _inertia_ratio(machine, own))
    return MotorChecks(checks, steady)


def _inertia_ratio(machine: Machine, own: float) -> Check:
    assert machine.drive is not None
    if not own > 0:
        return Check(
            "inertia_ratio", None, INERTIA_RATIO, "", None, at_most=True, note="no inertia of the rotor"
        )
    mean = float(
        np.mean(reduction_of(over_known_cycle(compile_machine(machine)), _ANGLES).inertia_reduced[:-1])
    )
    ratio = mean / machine.drive.gearbox.ratio**2 / own - 1
    return Check("inertia_ratio", ratio, INERTIA_RATIO, "", ratio <= INERTIA_RATIO, at_most=True)


def _at_most(name: str, value: float, limit: float | None, lacking: str) -> Check:
    if limit is None:
        return Check(name, value, None, "N m", None, note=f"not determined: {lacking}")
    return Check(name, value, limit, "N m", value <= limit, at_most=True)


def _start_doubt(motor: InductionMotor | DcMotor) -> str:
    """Why only a lower bound of the starting torque is known; empty if it is known."""
    if not isinstance(motor, InductionMotor):
        return ""
    if motor.torque_start is None:
        return "the catalogue gives no starting torque, Kloss's formula is used"
    return f"the starting torque is {LEAST_START}" if motor.start_is_minimum else ""


def _start_checks(machine: Machine, doubt: str, torque: float | None = None) -> tuple[Check, Check]:
    compiled = over_known_cycle(compile_machine(machine))
    if torque is None:
        drive = float(compiled.motor_torques(0.0).crank[0])
    else:
        ratio, forward, _ = compiled.gear_factors
        drive = torque * ratio * forward
    still = float(np.sum(compiled.speed_load(0.0)))
    at = np.array([machine.run_up.angle_start])
    start = compiled.reductions(at)
    worst = reduction_of(compiled, _ANGLES).torque_load_max
    turn = turn_angles(_ANGLES, compiled.turns)
    laws = compiled.law_torques(np.append(at, turn), _SLOW)[0]
    here = _start("starting_torque", drive, float(start.load[0] + start.dry[0] + laws[0]) + still, doubt)
    if compiled.has_laws:
        there = compiled.reductions(turn)
        worst = float((there.load + there.dry + laws[1:]).max())
    return here, _start("starting_torque_worst", drive, worst + still, doubt)


def _start(name: str, drive: float, load: float, doubt: str) -> Check:
    passed, note = _unsure(drive > load, doubt)
    return Check(name, drive, load, "N m", passed, note=note)


def _unsure(passed: bool, doubt: str) -> tuple[bool | None, str]:
    """Start by a lower bound of the torque: certain if it succeeds, not checkable if it fails."""
    if not doubt:
        return passed, ""
    return (True, doubt) if passed else (None, f"not checkable: {doubt}")


def _run_up_check(machine: Machine, steady: SteadyState, doubt: str) -> tuple[RunUp | None, Check]:
    try:
        up = run_up(machine, steady=steady)
    except FindingError as error:
        passed, note = _unsure(False, doubt)
        return None, Check("run_up", None, None, "s", passed, note=note or str(error))
    note = f"{up.time:.3g} s, {up.turns:.3g} revolutions"
    return up, Check("run_up", up.time, None, "s", True, note=note)
