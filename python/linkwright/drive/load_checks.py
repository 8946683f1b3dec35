"""Whether the loads of a machine can be computed all round, and repeat every cycle."""

from __future__ import annotations

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, SteadyStateError
from linkwright.kinetostatics.model.loads.between import GasSpring, TorsionalSpring
from linkwright.kinetostatics.model.loads.force import FormulaLoad, Load
from linkwright.linkages.closure import require_full_turn, turn_angles
from linkwright.linkages.law_jumps import require_finite_accelerations
from linkwright.linkages.whole_cycle import cycle_of, over_known_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.own_motors import require_separate_axes
from linkwright.machine.program.compiled import CompiledMachine, compile_machine

# Angles at which loads are examined; a hole narrower than half a degree is met by the solver, which says so.
_ANGLES = 720


# How far, as a share of its speed, steps that go back and forth across a jump leave the motion; and the
# share of a load that counts as a jump between both sides, far above what a slope makes of that.
_NEAR, _JUMPS = 1e-5, 1e-4

# Loads that may have no value at some place, or jump.
_DOUBTFUL = (FormulaLoad, GasSpring, TorsionalSpring)


def require_turn(machine: Machine) -> CompiledMachine:
    """The machine over its cycle; `FindingError` if it does not close or a load has no value."""
    compiled = compile_machine(machine)
    require_full_turn(compiled, machine)
    require_same_turns(machine)
    compiled = over_known_cycle(compiled)
    require_sound_loads(compiled, machine)
    return compiled


def require_same_turns(machine: Machine) -> None:
    """Raise `SteadyStateError`, which names the load, if one changes with time itself."""
    for name, load in machine.all_loads.items():
        if isinstance(load, FormulaLoad) and load.knows_time:
            raise SteadyStateError(
                f'no steady motion: the formula of {name}, "{load.text}", depends on time t: no revolution '
                "repeats another; write it with the crank angle phi, or use transient"
            )


def require_sound_loads(compiled: CompiledMachine, machine: Machine) -> None:
    """Raise if a load has no value at some angle, or a torsional spring is turned beyond half a revolution.

    So it does if a law with a corner moves masses. The `FindingError` names load or law, angle and remedy.
    """
    require_separate_axes(machine)
    require_finite_accelerations(machine)
    doubtful = {name: load for name, load in machine.all_loads.items() if isinstance(load, _DOUBTFUL)}
    if not doubtful:
        return
    phi = turn_angles(_ANGLES, compiled.turns)
    require_half_turns(compiled, machine)
    if np.isfinite(_torques(compiled, phi)).all():
        return
    for name, load in doubtful.items():
        alone = compile_machine(machine.with_entries({"loads": {name: load}}))
        torques = _torques(alone, phi)
        if not np.isfinite(torques).all():
            raise FindingError(_no_value(name, load, float(phi[np.argmin(np.isfinite(torques))])))


def sliding(machine: Machine, angle: float, speed: float) -> SteadyStateError:
    """The error for a motion that a jump of a load holds at an angle and a speed, with the load that jumps.

    The torques of both sides drive the crank back to that speed (Filippov, *Differential Equations with
    Discontinuous Righthand Sides*, 1988, § 4).
    """
    where = f"at {speed:.6g} rad/s (φ = {np.degrees(angle % cycle_of(machine)):.4g}°)"
    what = f"a load jumps {where}"
    for name, load in machine.all_loads.items():
        if not isinstance(load, FormulaLoad):
            continue
        alone = compile_machine(machine.with_entries({"loads": {name: load}}))
        below, above = (
            float(alone.law_torques(np.array([angle]), speed * (1 + side))[0, 0]) for side in (-_NEAR, _NEAR)
        )
        if abs(above - below) > _JUMPS * (abs(above) + abs(below)):
            what = (
                f'the formula of {name}, "{load.text}", jumps {where} from {below:.4g} to {above:.4g} N m of '
                "load torque at the crank"
            )
    error = SteadyStateError(
        f"the motion slides along a jump: {what}, and the torques on both sides drive the crank back to "
        "it, so that the effective load lies between them and is undefined; write the jump as a steep "
        "slope over speed, such as min(max((omega - w0)/width, 0), 1)"
    )
    # Steady motion and run-up reach the jump at different angles.
    error.cause = f"slides along a jump at {speed:.4g} rad/s"
    return error


def require_half_turns(compiled: CompiledMachine, machine: Machine) -> None:
    """Raise if a torsional spring is turned beyond half a revolution from its free angle."""
    for name, load in machine.all_loads.items():
        if isinstance(load, TorsionalSpring):
            _require_half_turns(name, load, compiled, turn_angles(_ANGLES, compiled.turns))


def _torques(compiled: CompiledMachine, phi: Floats) -> Floats:
    """Torque of all loads at the angles, at the speed from which steady motion is sought [N m]."""
    at = compiled.reductions(phi)
    torques: Floats = at.load + at.dry + at.viscous + compiled.law_torques(phi, compiled.speed_guess)[0]
    return torques


def _no_value(name: str, load: Load, phi: float) -> str:
    where = f"at crank angle {np.degrees(phi):.1f}°"
    if isinstance(load, GasSpring):
        return (
            f"the gas spring {name} is compressed beyond its gas volume {where}; choose one with a "
            "longer stroke, a smaller progression, or other points"
        )
    text = load.text if isinstance(load, FormulaLoad) else ""
    return (
        f'the formula of {name}, "{text}", has no finite value {where}: look for a division by zero, and '
        "for a root or logarithm of a negative number"
    )


def _require_half_turns(name: str, load: TorsionalSpring, compiled: CompiledMachine, phi: Floats) -> None:
    turned = _angle(compiled, load.on, phi) - load.free_angle
    if load.against is not None:
        turned = turned - _angle(compiled, load.against, phi)
    turned = turned - 2 * np.pi * np.round(turned[0] / (2 * np.pi))
    if np.nanmax(np.abs(turned), initial=0.0) >= np.pi:
        at = np.degrees(phi[np.argmax(np.abs(turned) >= np.pi)])
        raise FindingError(
            f"the torsional spring {name} is twisted by more than 180° from its free angle at crank angle "
            f"{at:.1f}°; it must stay below: put it on an oscillating link, or change free_angle"
        )


def _angle(compiled: CompiledMachine, link: str, phi: Floats) -> Floats:
    """Angle of a link without jumps [rad]."""
    cos, sin = compiled.link_motion(compiled.links[link], np.ascontiguousarray(phi)).direction
    angle: Floats = np.unwrap(np.arctan2(sin, cos))
    return angle
