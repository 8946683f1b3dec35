r"""The step method of Baranov, kept beside the exact solution so that its error can be seen.

From angle step to angle step, with I the reduced inertia, M_p the driving and M_0 the load torque:

.. math::

    \omega_{k+1} &= \frac{(M_p(\omega_k) - M_0(\varphi_k))\,\Delta\varphi}{I_k\,\omega_k}
        + \frac{3 I_k - I_{k+1}}{2 I_k}\,\omega_k \\
    t_{k+1} &= t_k + \frac{2\,\Delta\varphi}{\omega_{k+1} + \omega_k}, \qquad
    \varepsilon_k = \frac{\omega_{k+1} - \omega_k}{t_{k+1} - t_k}

It is Euler's method for the energy equation, of order 1 in the step, with one difference for dI/dφ. Source:
paper 1, equations (4), (11), (12), after Baranov.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.drive import evenness
from linkwright.drive.load_checks import require_same_turns
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, StartError, SteadyStateError, require_within
from linkwright.kernel.limits import STEPS
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import ANGLE
from linkwright.kernel.units.marks import positive
from linkwright.linkages.closure import require_full_turn, turn_angles
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# Relative change of the speed from revolution to revolution below which the motion counts as steady.
_STEADY = 1e-6

# Turns after which the method is given up.
_TURNS_MAX = 2000


@dataclass(frozen=True)
class StepMotion(Result, evenness.Evenness[float]):
    """Motion by the step method: all revolutions from rest, and the measures of the last."""

    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad", "Continuous over the revolutions.")]
    time: Annotated[Floats, Label("time", "t", "s")]
    speed: Annotated[Floats, Label("speed of the crank", "ω", "rad/s")]
    acceleration: Annotated[
        Floats,
        Label("acceleration of the crank", "ε", "rad/s²", "Of the interval that begins at the angle."),
    ]
    turns: Annotated[int, Label("whole revolutions until the speed repeats to 0.1 % at every step", "n", "")]
    step: Annotated[float, Label("step of the crank angle", "Δφ", "rad")]
    speed_min: Annotated[float, Label("minimum speed", "ω_min", "rad/s", "Over the last revolution.")]
    speed_max: Annotated[float, Label("maximum speed", "ω_max", "rad/s", "Over the last revolution.")]
    acceleration_min: Annotated[
        float, Label("minimum acceleration", "ε_min", "rad/s²", "Over the last revolution.")
    ]
    acceleration_max: Annotated[
        float, Label("maximum acceleration", "ε_max", "rad/s²", "Over the last revolution.")
    ]


@public
def step_method(machine: Machine, *, step: float = np.radians(1.0)) -> StepMotion:
    """Motion from rest to steady motion by the step method.

    Parameters
    ----------
    machine : Machine
        The machine, with a motor.
    step : float
        Step of the crank angle [rad]; must divide the revolution.

    Returns
    -------
    StepMotion
        All revolutions, and the measures of the last.

    Raises
    ------
    InputError
        The step does not divide the revolution, or the machine repeats after several.
    StartError
        The machine does not start, or comes to rest.
    SteadyStateError
        Steady motion is not reached within 2000 revolutions.
    """
    compiled = compile_machine(machine)
    require_full_turn(compiled, machine)
    if over_whole_cycle(compiled).turns > 1:
        raise InputError(
            f"{machine.name}: the step method covers one revolution, but loads or mechanism repeat only "
            "after several; use steady_state"
        )
    require_same_turns(machine)
    n = whole_steps(step)
    phi = turn_angles(n)[:-1]
    at = compiled.reductions(phi)
    still = at.load + at.dry

    def torque(k: int, omega: float) -> float:
        drive = float(compiled.motor_torques(omega).crank[0])
        laws = compiled.law_torques(phi[k], omega)[0, 0] if compiled.has_laws else 0.0
        resisting = float(still[k] + at.viscous[k] * omega) + float(compiled.speed_load(omega))
        return drive - resisting - float(laws)

    return by_steps(at.inertia, torque, step=2 * np.pi / n)


def whole_steps(step: float) -> int:
    """Steps in one revolution; an `InputError` if the step does not divide it."""
    in_range(step=(step, positive(ANGLE)))
    n = 2 * np.pi / step if step < np.pi else 0
    require_within(STEPS, n, f"step of {np.degrees(step):.3g}°", "use a longer step; 1° is usual")
    n = round(n)
    if n == 0 or abs(n * step - 2 * np.pi) > 1e-6:
        raise InputError(f"a step of {np.degrees(step):g}° does not divide the revolution; 1° is usual")
    return n


def by_steps(J: Floats, torque: Callable[[int, float], float], *, step: float) -> StepMotion:
    """The step method itself, from rest at φ = 0.

    `J`: (n,), reduced inertia at the steps of one revolution [kg m²]; `torque`: net torque at the crank [N m]
    at step k of the revolution and speed ω [rad/s]; `step`: 2π/n [rad]. The first step, where (4) divides by
    zero, is by the energy: ½ I ω² = M Δφ.
    """
    n = len(J)
    first = torque(0, 0.0)
    if first <= 0:
        raise StartError(f"does not start: at 0.0° {-first:.0f} N m are lacking at the crank")
    omega = [0.0, float(np.sqrt(2 * first * step / J[1]))]
    steady_after = 0
    while not steady_after:
        k = len(omega) - 1
        here, ahead = k % n, (k + 1) % n
        w = omega[-1]
        share = (3 * J[here] - J[ahead]) / (2 * J[here])
        omega.append(float(torque(here, w) * step / (J[here] * w) + share * w))
        if not omega[-1] > 0:
            raise StartError(f"stalls at {np.degrees((k + 1) * step) % 360:.1f}° of revolution {k // n + 1}")
        if ahead == 0:
            steady_after = _repeats(omega, n)
    return _measured(np.array(omega), J, step, steady_after)


def _repeats(omega: list[float], n: int) -> int:
    """Turns until the speed repeats to 0.1 %, once it repeats to 1e-6; 0 before that."""
    turns = (len(omega) - 1) // n
    if turns > _TURNS_MAX:
        raise SteadyStateError(f"no steady motion within {_TURNS_MAX} revolutions by the step method")
    if turns < 3:
        return 0
    last, before = np.array(omega[-n:]), np.array(omega[-2 * n : -n])
    if np.abs(last / before - 1).max() > _STEADY:
        return 0
    speeds = np.array(omega[1 : 1 + turns * n]).reshape(turns, n)
    off = np.abs(speeds / speeds[-1] - 1).max(axis=1)
    # 0.1 % is the last digit that the published tables print.
    return int(np.flatnonzero(off > 1e-3)[-1]) + 2


def _measured(omega: Floats, J: Floats, step: float, turns: int) -> StepMotion:
    """Times by (11), accelerations by (12), measures of the last revolution."""
    n = len(J)
    intervals = 2 * step / (omega[1:] + omega[:-1])
    epsilon = np.diff(omega) / intervals
    last, steep = omega[-n:], epsilon[-n:]
    return StepMotion(
        crank_angle=np.linspace(0.0, (len(omega) - 1) * step, len(omega)),
        time=np.concatenate([[0.0], np.cumsum(intervals)]),
        speed=omega,
        acceleration=np.append(epsilon, epsilon[-n]),
        turns=turns,
        step=step,
        speed_min=float(last.min()),
        speed_max=float(last.max()),
        acceleration_min=float(steep.min()),
        acceleration_max=float(steep.max()),
    )
