"""How steady motion of an elastic driveline is found: its checks, where the search begins, why it fails."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.drive.load_checks import require_same_turns, require_sound_loads
from linkwright.drive.reduction import NO_INERTIA
from linkwright.driveline.chain import Chain, Driven, chain_of, fastest
from linkwright.driveline.coexisting import MULTIPLES, Followed, followed_motions, steady_of
from linkwright.driveline.train_chain import driven_train
from linkwright.kernel.arrays import Complexes
from linkwright.kernel.errors import ConvergenceError, InputError, SteadyStateError
from linkwright.kernel.reader.numbers import number
from linkwright.linkages.closure import require_full_turn, turn_angles
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.core import DrivelineMotion, NoDrivelineMotion
from linkwright.torsion.model.drive_train import STIFFNESS_KEYS

# Cycles of the crank that the motion is followed, at most, where Newton's method alone does not converge.
CYCLES = 300

# Cycles that it is followed before where the motion found is unstable: another may be stable.
AWAY = 100

# Factor by which neighbouring motions part in a cycle, from which on a motion is called chaotic: on a torus
# they part in proportion to the time, by 1.024 a cycle on average from the tenth cycle to the 110th.
CHAOTIC = 1.05

# Angles of a revolution at which the minimum inertia is looked for.
ANGLES = 36


def require_flexible(machine: Machine) -> None:
    """Raise if nothing of the driveline twists."""
    if not machine.has_mounted_mechanisms and (machine.drive is None or not machine.drive.twists):
        raise InputError(
            f"{machine.name}: the driveline is rigid; expected one of {', '.join(STIFFNESS_KEYS)}, or "
            "[train.mechanisms] and [train.motors]"
        )


def ready(machine: Machine) -> Driven:
    """A machine with an elastic driveline and a motor, in the core's terms, over its whole cycle."""
    if machine.has_mounted_mechanisms:
        return driven_train(machine)
    require_flexible(machine)
    if machine.drive is None or machine.drive.motor is None:
        raise InputError(f"{machine.name}: steady motion needs a motor; add [drive.motor]")
    compiled = compile_machine(machine)
    require_full_turn(compiled, machine)
    compiled = over_whole_cycle(compiled)
    require_same_turns(machine)
    require_sound_loads(compiled, machine)
    return Driven(compiled, chain_of(machine), compiled.speed_guess)


def search(driven: Driven, cycles: int) -> dict[str, Any]:
    """Where the search begins, and for how long it follows the motion."""
    compiled, chain, speed = driven
    period = compiled.cycle / speed
    inertia = compiled.reductions(turn_angles(ANGLES, compiled.turns)).inertia.min()
    return {
        "speed": speed,
        "fastest": fastest(chain, float(inertia), period),
        "cycles_first": cycles,
        "cycles_max": CYCLES,
        "multiples": MULTIPLES if cycles or not chain.is_linear else 1,
        "start": None,
    }


def solved(driven: Driven, accuracy: float) -> tuple[DrivelineMotion, list[Followed]]:
    """The motion, and what was found from other beginnings if these had to be asked."""
    compiled, chain, _ = driven
    asked = search(driven, 0)
    motion = steady_of(compiled, chain, accuracy, asked)
    if isinstance(motion, DrivelineMotion):
        return motion, []
    rest: list[Followed] = []
    if not chain.is_linear:
        rest = list(followed_motions(compiled, chain, None, accuracy, asked))
    for _, other, _ in rest:
        if other is not None:
            return other, rest
    raise _failure(motion, driven, accuracy)


def _failure(motion: NoDrivelineMotion, driven: Driven, accuracy: float) -> Exception:
    compiled, chain, speed = driven
    angles = turn_angles(360, compiled.turns)
    if not (compiled.reductions(angles).inertia - chain.links["apart"]).min() > 0:
        return SteadyStateError(NO_INERTIA)
    if motion.reason == "stops":
        turned = motion.crank_angle / (2 * np.pi)
        return SteadyStateError(
            f"no steady motion of the elastic driveline: started at {speed:.4g} rad/s, the "
            f"crank comes to rest or turns back after {turned:.4g} revolutions, at φ = "
            f"{np.degrees(motion.crank_angle) % 360:.4g}°; choose a stiffer or more damped coupling, a "
            "larger flywheel or motor, or follow the motion in time (elastic_transient)"
        )
    if motion.reason == "not found":
        off, parting = number(100 * motion.accuracy, 2), number(motion.parting, 3)
        seen = (
            f"the last cycles differ by {off} % at best; motions that begin close part by a factor of "
            f"{parting} per cycle"
        )
        if motion.parting > CHAOTIC:
            return SteadyStateError(
                f"no steady motion of the elastic driveline: its motion is chaotic; {seen}; reduce the "
                "backlash, add damping, or follow it in time (elastic_transient)"
            )
        # Nothing was seen of a motion that cannot be followed so exactly.
        regular = f"it repeats after more than {MULTIPLES} cycles, is quasi-periodic, or settles very slowly"
        seen = "" if np.isnan(motion.accuracy) else f"; {seen}; {regular}"
        return ConvergenceError(
            f"no periodic motion of the elastic driveline was found: in {CYCLES} cycles the motion does not "
            f"come to one that Newton's method converges to{seen}; follow it in time (elastic_transient)",
            method="Newton's method",
            iterations=CYCLES,
        )
    return ConvergenceError(
        "steady motion of the elastic driveline was found to a relative accuracy of "
        f"{motion.accuracy:.1e} only, {accuracy:g} is required, with at most 20 000 steps per cycle: leave "
        "out a stiffness that is rigid at this speed, give its shaft damping, smooth jumps of loads, or "
        "reduce the accuracy",
        method="collocation",
    )


def multipliers_of(motion: DrivelineMotion, chain: Chain) -> Complexes:
    """From the largest on; without that by which a motor of constant speed keeps its speed."""
    found: Complexes = np.linalg.eigvals(motion.monodromy).astype(complex)
    found = found[np.argsort(-np.abs(found), kind="stable")]
    multipliers: Complexes = found if chain.held is None else found[:-1]
    return multipliers
