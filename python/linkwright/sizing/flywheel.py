r"""The flywheel that keeps the speed within a wanted speed fluctuation.

The classical estimate (Mertsalov) keeps the driving torque at its mean and the speed in the inertia's terms
at its mean,

.. math::

    \Delta A(\varphi) = \int_0^\varphi (\bar M_r - M_r)\,d\varphi
        - \tfrac12 J_\mathrm{red}(\varphi)\,\omega_m^2, \qquad
    J_f + J_0 = \frac{\Delta A_\max - \Delta A_\min}{\delta\,\omega_m^2}

with :math:`J_0` the inertia that turns in a constant ratio to the crank already: of the drive, and of bodies
on the crank and on gears. The answer is not this estimate: it is the
root of δ(J_f) − δ over the exact steady motion, which the estimate only starts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.run_up import RunUp, run_up
from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError, FindingError, InputError, SteadyStateError
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import RATIO
from linkwright.kernel.units.marks import Bound, Quantity
from linkwright.linkages.closure import turn_angles
from linkwright.linkages.whole_cycle import force_turns, over_whole_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.own_motors import on_crankshaft, without_drive
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.drive_line import drive_inertia
from linkwright.sizing.motor_change import with_flywheel

# Relative accuracy of the flywheel's speed fluctuation; four digits better than anything it is compared with.
_CLOSE = 1e-9

# Doublings of the bracket before the search is given up: beyond 2^40 of the estimate nothing is a flywheel.
_DOUBLINGS = 40

_ITERATIONS = 60

# Angles at which a body's reduced inertia is compared, a prime number so that no symmetry hides a variation,
# and the share by which a constant varies with rounding.
_ANGLES = 37
_CONSTANT = 1e-12


# δ = (ω_max − ω_min)/ω_m with the mean of the extremes is 2 where the crank comes to rest.
UNEVENNESS = Quantity(
    RATIO,
    Bound(" between 0 and 2,", {"exclusiveMinimum": 0, "exclusiveMaximum": 2}, lambda value: 0 < value < 2),
)


@dataclass(frozen=True)
class FlywheelChoice(Result):
    """A flywheel on the crankshaft."""

    inertia: Annotated[
        float, Label("moment of inertia of the flywheel", "J_f", "kg m²", "Zero if none is needed.")
    ]
    unevenness_wanted: Annotated[float, Label("required coefficient of speed fluctuation", "", "")]
    unevenness: Annotated[
        float,
        Label(
            "coefficient of speed fluctuation", "δ", "", "Of the machine with the flywheel, analysed again."
        ),
    ]
    unevenness_without: Annotated[
        float | None,
        Label(
            "coefficient of speed fluctuation without any flywheel",
            "",
            "",
            "None if there is no steady motion then.",
        ),
    ]
    inertia_estimate: Annotated[
        float, Label("moment of inertia by the classical estimate", "", "kg m²", "Not below zero.")
    ]
    excess_work: Annotated[float, Label("largest excess of work per revolution", "", "J", "Of the estimate.")]
    run_up_time: Annotated[
        float | None, Label("time of the run-up", "", "s", "None if the machine does not run up.")
    ]
    run_up_time_without: Annotated[
        float | None,
        Label("time of the run-up without the flywheel", "", "s", "None if the machine does not run up."),
    ]
    iterations: Annotated[int, Label("steady motions that were solved", "", "")]
    warnings: Annotated[tuple[str, ...], About("Warnings.")]
    machine: Annotated[Machine, About("The machine with it.")]
    steady: Annotated[SteadyState, About("Its steady motion.")]
    run_up: Annotated[RunUp | None, About("Its run-up.")]
    kept: Annotated[
        bool,
        About("Whether it is the machine's own flywheel; the inertia is then referred to the crankshaft."),
    ] = False


@public
def choose_flywheel(machine: Machine, unevenness: float, *, keep: bool = False) -> FlywheelChoice:
    """Size the flywheel on the crankshaft for a required speed fluctuation.

    Parameters
    ----------
    machine : Machine
        The machine, with a motor. A flywheel that it has is taken off first.
    unevenness : float
        δ, with the mean of the extremes [–].
    keep : bool
        Keep the flywheel of the machine if δ is not above the wanted one with it.

    Returns
    -------
    FlywheelChoice
        The smallest flywheel, verified, beside the classical estimate.

    Raises
    ------
    InputError
        The speed fluctuation is not between 0 and 2, or the machine has no motor.
    AssemblyError
        The mechanism does not close all round.
    SteadyStateError
        There is no steady motion whatever the flywheel.
    ConvergenceError
        No flywheel was found.

    Notes
    -----
    1/δ grows almost linearly with J_f, so its root is found by regula falsi in a few steps.

    References
    ----------
    .. [1] Artobolevsky, Theory of Mechanisms and Machines: flywheel by Mertsalov's method.
    """
    in_range(unevenness=(unevenness, UNEVENNESS))
    if machine.drive is None or machine.drive.motor is None:
        raise InputError(f"{machine.name}: a flywheel is sized for a motor; add [drive.motor]")
    bare = with_flywheel(machine, 0.0)
    without = _unevenness(bare)
    estimate, work = classical_flywheel(bare, unevenness)
    if keep and keeps_flywheel(machine, unevenness):
        own = own_flywheel(machine)
        return _verified(bare, unevenness, without, own, (max(estimate, 0.0), work), 2, kept=machine)
    inertia, solved = flywheel_inertia(bare, unevenness, guess=estimate)
    return _verified(bare, unevenness, without, inertia, (max(estimate, 0.0), work), solved)


def own_flywheel(machine: Machine) -> float:
    """Inertia of the flywheel that the machine has, referred to the crankshaft [kg m²]; 0 without one."""
    drive = machine.drive
    if drive is None or drive.flywheel is None:
        return 0.0
    step = drive.gearbox.ratio if drive.flywheel.on == "motor" else 1.0
    return float(drive.flywheel.inertia) * step**2


def keeps_flywheel(machine: Machine, unevenness: float) -> bool:
    """Whether the machine has a flywheel with which δ is not above a wanted one [–]."""
    if not own_flywheel(machine) > 0:
        return False
    value = _unevenness(machine)
    return value is not None and value <= unevenness


def flywheel_inertia(machine: Machine, unevenness: float, *, guess: float = 0.0) -> tuple[float, int]:
    """The flywheel's inertia alone.

    `unevenness`: δ [–]; `guess`: where to begin [kg m²]. Returns: J_f [kg m²], 0 if none is needed; how many
    steady motions were solved. Raises SteadyStateError, ConvergenceError: as for `choose_flywheel`.
    """
    without = _unevenness(machine)
    if without is not None and without <= unevenness:
        return 0.0, 1
    return _searched(machine, unevenness, guess)


def classical_flywheel(machine: Machine, unevenness: float) -> tuple[float, float]:
    """Estimate a flywheel by Mertsalov's method.

    `unevenness`: δ [–]. Returns: inertia on the crankshaft [kg m²], negative if none is needed; largest
    excess work ΔA [J].

    ω_m is the design speed, or the speed without load where none is given. The extremes of ΔA are exact: they
    are where the mean torque equals the torque of load and inertia, and at kinks.

    Source: Artobolevsky, Theory of Mechanisms and Machines: flywheel by Mertsalov's method.
    """
    assert machine.drive is not None
    compiled = over_whole_cycle(compile_machine(machine))
    omega_m = machine.drive.speed or compiled.speed_guess
    turn = turn_curve(lambda phi: _load_and_inertia(compiled, phi, omega_m), compiled.kinks(), "excess work")
    # The curve of −ΔA.
    stored = turn.excess(0, 1, 0.5 * omega_m**2)
    work = stored.extreme(+1)[0] - stored.extreme(-1)[0]
    return work / (unevenness * omega_m**2) - constant_inertia(machine), work


def constant_inertia(machine: Machine) -> float:
    """Inertia at the crank [kg m²] of drive and bodies that turn in a constant ratio to it."""
    total = 0.0 if machine.drive is None else float(drive_inertia(machine.drive))
    for name, body in on_crankshaft(machine, has_motor=True).bodies.items():
        alone = without_drive(machine).with_entries({"loads": {}, "bodies": {name: body}})
        compiled = compile_machine(alone)
        J = compiled.reductions(turn_angles(_ANGLES, force_turns(compiled))).inertia
        total += float(J.max()) if np.ptp(J) <= _CONSTANT * J.max() else 0.0
    return total


def _load_and_inertia(compiled: CompiledMachine, phi: Floats, omega: float) -> Floats:
    """Load torque at a speed, and reduced inertia, (2, n)."""
    at = compiled.reductions(phi)
    M_r = at.load + at.dry + at.viscous * omega + compiled.law_torques(phi, omega)[0]
    return np.stack([M_r, at.inertia])


def _unevenness(machine: Machine) -> float | None:
    """δ of steady motion; None if there is none."""
    try:
        return _steady(machine).unevenness
    except SteadyStateError:
        # silent: no steady motion is an answer there: δ counts as infinite
        return None


def _steady(machine: Machine) -> SteadyState:
    return steady_state(machine, accuracy=1e-11, n=720)


def _searched(bare: Machine, wanted: float, guess: float) -> tuple[float, int]:
    """The flywheel whose 1/δ is the wanted one, and how many steady motions it took."""
    count = 0

    def lacking(inertia: float) -> float:
        nonlocal count
        count += 1
        unevenness = _unevenness(with_flywheel(bare, inertia))
        # Without steady motion the speed fluctuation counts as infinite.
        return (1 / unevenness if unevenness else 0.0) - 1 / wanted

    assert bare.drive is not None
    least = 1e-3 * float(drive_inertia(bare.drive)) or 1e-3
    high = max(guess, least)
    for _ in range(_DOUBLINGS):
        if lacking(high) > 0:
            return _root(lacking, 0.0, high, _CLOSE / wanted), count
        high *= 2
    # With whatever flywheel: either there is no steady motion, and the error says why, or δ does not fall.
    _steady(with_flywheel(bare, high))
    raise ConvergenceError(f"no flywheel up to {high:.3g} kg m² brings the speed fluctuation to {wanted:g}")


def _root(f: Callable[[float], float], low: float, high: float, close: float) -> float:
    """Root of an increasing function by regula falsi, Illinois variant."""
    # Dowell, Jarratt, A modified regula falsi method, BIT 11 (1971) 168–174.
    f_low, f_high = f(low), f(high)
    side = 0
    for _ in range(_ITERATIONS):
        x = (low * f_high - high * f_low) / (f_high - f_low)
        value = f(x)
        if abs(value) <= close:
            return x
        if value > 0:
            high, f_high = x, value
            f_low = 0.5 * f_low if side > 0 else f_low
            side = 1
        else:
            low, f_low = x, value
            f_high = 0.5 * f_high if side < 0 else f_high
            side = -1
    raise ConvergenceError("the flywheel was not found", method="regula falsi", iterations=_ITERATIONS)


def _verified(
    bare: Machine,
    wanted: float,
    without: float | None,
    inertia: float,
    classical: tuple[float, float],
    iterations: int,
    kept: Machine | None = None,
) -> FlywheelChoice:
    """The result, with the machine analysed anew; `kept`: the machine whose own flywheel suffices."""
    note = f"Flywheel for a speed fluctuation of {wanted:g} by linkwright size." if inertia > 0 else ""
    machine = kept or with_flywheel(bare, inertia, note=note)
    steady = _steady(machine)
    up, why_not = _run_up(machine, steady)
    up_without, why_not_without = _run_up(bare) if inertia > 0 else (up, why_not)
    return FlywheelChoice(
        inertia=inertia,
        unevenness_wanted=wanted,
        unevenness=steady.unevenness,
        unevenness_without=without,
        inertia_estimate=classical[0],
        excess_work=classical[1],
        run_up_time=up.time if up else None,
        run_up_time_without=up_without.time if up_without else None,
        iterations=iterations,
        warnings=tuple(_costs(inertia, up or why_not, up_without or why_not_without)),
        machine=machine,
        steady=steady,
        run_up=up,
        kept=kept is not None,
    )


def _run_up(machine: Machine, steady: SteadyState | None = None) -> tuple[RunUp | None, str]:
    """The run-up, or why there is none; neither for a motor of constant speed, which has no run-up."""
    assert machine.drive is not None
    if isinstance(machine.drive.motor, ConstantSpeedMotor):
        return None, ""
    try:
        return run_up(machine, steady=steady), ""
    except FindingError as error:
        return None, str(error)


def _costs(inertia: float, after: RunUp | str, before: RunUp | str) -> list[str]:
    if not isinstance(after, RunUp):
        machine = f"with the flywheel of {inertia:.4g} kg m² the machine" if inertia else "the machine"
        return [f"{machine} does not run up: {after}"] if after else []
    if not inertia:
        return []
    takes = f"the run-up takes {after.time:.3g} s"
    if not isinstance(before, RunUp):
        return [f"{takes}; without the flywheel the machine does not run up: {before}"]
    return [f"the flywheel lengthens the run-up from {before.time:.3g} s to {after.time:.3g} s"]
