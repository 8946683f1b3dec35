"""The elastic driveline in the study of a machine: its result, its check and its warnings."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.obstacles import no_run_up, no_shaft
from linkwright.drive.study import INTERVALS, has_motor
from linkwright.driveline.chain import chain_of
from linkwright.driveline.elastic_motion import ElasticMotion, elastic_motion
from linkwright.driveline.parametric import parametric_zones
from linkwright.driveline.run_up import ElasticRunUp, elastic_run_up, require_elastic_start
from linkwright.driveline.train_chain import driveline_chain
from linkwright.kernel.errors import FindingError, StartError
from linkwright.kernel.findings import Findings
from linkwright.kernel.reader.numbers import number, quantity
from linkwright.machine.analysis import Obstacle, Results
from linkwright.machine.machine import Machine
from linkwright.torsion.core.train import refer
from linkwright.torsion.excitation.drive_line import train_of

# Share by which a natural frequency may differ from an order of the crank speed and still be excited by it.
_NEAR = 0.05

# Orders of the crank that are looked at.
_ORDERS = 12

# Share of a disturbance that is left after a cycle from which on a resonance can build up.
_BUILDS_UP = 0.2

# Speed fluctuation of the crank over that of the rigid driveline from which on it is worth a sentence.
_GROWS = 1.1

# Share of the maximum torque from which on a torque of the other sign is worth a sentence.
_REVERSED = 0.01


def has_elastic_drive(machine: Machine) -> bool:
    """Whether a mechanism stands behind a torsionally flexible driveline, or on a train."""
    if machine.has_mounted_mechanisms:
        return True
    return machine.drive is not None and machine.drive.twists and machine.has_crank


def no_elastic_motion(machine: Machine) -> Obstacle | None:
    """A machine whose driveline is rigid, or without a motor."""
    if machine.train is None or not machine.has_mounted_mechanisms:
        return no_shaft(machine)
    is_driven = machine.train.motors or machine.train.drivers
    return None if is_driven else Obstacle("The train has no motor: give [train.motors].")


def made_elastic_motion(known: Results, findings: Findings) -> ElasticMotion | None:
    """Steady motion of an elastic driveline under a motor."""
    is_driven = no_elastic_motion(known.machine) is None
    if not known.machine.has_mounted_mechanisms:
        is_driven = known.reduction is not None and has_motor(known.machine)
    if not is_driven:
        return None
    return findings.of(elastic_motion, known.machine, n=INTERVALS, others=True)


def no_elastic_run_up(machine: Machine) -> Obstacle | None:
    """A machine whose driveline is rigid, or whose motor does not run up."""
    return no_shaft(machine) or no_run_up(machine)


def made_elastic_run_up(known: Results, findings: Findings) -> ElasticRunUp | None:
    """Run-up of an elastic driveline; that it settles late says nothing against the machine."""
    machine = known.machine
    if known.reduction is None or not has_motor(machine) or _never_runs_up(machine):
        return None
    if known.elastic_motion is None:
        # Without steady motion nothing says when it has run up, but it may be that it cannot even start.
        findings.of(require_elastic_start, machine)
        return None
    try:
        found = elastic_run_up(machine)
    except StartError as error:
        findings.add([str(error)])
        return None
    except FindingError as error:
        findings.warn([f"run-up of the elastic driveline: {error}"])
        return None
    findings.add(found.findings)
    return found


def _never_runs_up(machine: Machine) -> bool:
    drive = machine.drive
    return drive is None or isinstance(drive.motor, ConstantSpeedMotor) or drive.gearbox.locks


def check_driveline(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether every station of the driveline has an inertia, and every mechanism a full revolution."""
    findings.of(driveline_chain, machine)
    mounted = "mechanisms of the train close over the full revolution"
    what = mounted if machine.has_mounted_mechanisms else "inertia of every station"
    yield f"driveline: {what}"


def driveline_summary(machine: Machine) -> Iterator[tuple[str, str]]:
    """Names of stations and shafts; of a train, which has its own summary, those of motors and mechanisms."""
    if machine.train is not None:
        yield "mechanisms", ", ".join(machine.train.mechanisms)
        yield "motors", ", ".join([*machine.train.motors, *machine.train.drivers])
        return
    chain = chain_of(machine)
    yield "stations", ", ".join(chain.stations)
    yield "flexible shafts", ", ".join(chain.shafts)


def elastic_warnings(known: Results) -> Iterator[str]:
    """What the designer should know of the elastic motion."""
    motion = known.elastic_motion
    if motion is None:
        return
    yield from motion_warnings(known.machine, motion)
    yield from _fluctuation(known, motion)


def motion_warnings(machine: Machine, motion: ElasticMotion) -> Iterator[str]:
    """What should be known of an elastic motion, whatever else was computed of its machine."""
    yield from _stability(motion)
    yield from _resonance(machine, motion)
    yield from _parametric(machine, motion)
    yield from _others(motion)
    yield from _reversals(machine, motion)


def _stability(motion: ElasticMotion) -> Iterator[str]:
    if not motion.is_stable:
        yield (
            "The steady motion of the elastic driveline is unstable: after every cycle a small disturbance "
            f"is {number(motion.multiplier_max)} times as large; increase the damping or change the stiffness"
        )


def _resonance(machine: Machine, motion: ElasticMotion) -> Iterator[str]:
    """Natural frequencies by the mean inertia near orders of the crank, where disturbances last."""
    if motion.multiplier_max < _BUILDS_UP:
        return
    omega, _ = refer(train_of(machine)).modes()
    for one in omega[omega > 0]:
        order = float(one) / motion.speed_mean_time * motion.turns
        nearest = round(order)
        if 1 <= nearest <= _ORDERS * motion.turns and abs(order / nearest - 1) <= _NEAR:
            yield (
                "Resonance of the driveline: its natural frequency of "
                f"{quantity(float(one) / (2 * np.pi), 'Hz')} is close to order "
                f"{number(nearest / motion.turns)} of the crank speed"
            )


def _parametric(machine: Machine, motion: ElasticMotion) -> Iterator[str]:
    """Zones of parametric resonance by the linear modes, as long as links are linear."""
    if machine.has_mounted_mechanisms or not chain_of(machine).is_linear:
        return
    for zone in parametric_zones(machine, motion.speed_mean_time):
        low, high = zone.frequencies
        modes = quantity(low, "Hz") if low == high else f"{quantity(low, 'Hz')} and {quantity(high, 'Hz')}"
        yield (
            f"Parametric resonance: order {number(zone.order)} of the reduced inertia J(φ) excites natural "
            f"frequencies of {modes}; by the linear estimate a disturbance grows by "
            f"{number(100 * (np.exp(zone.growth * motion.period) - 1), 2)} % per cycle"
        )


def _others(motion: ElasticMotion) -> Iterator[str]:
    """Further steady motions, and beginnings from which the motion does not repeat."""
    for other in motion.other_motions:
        stable = "stable" if other.is_stable else "unstable"
        peak = max(float(np.abs(torque).max()) for torque in (other.torque_min, other.torque_max))
        yield (
            f"The elastic driveline has another steady motion, {stable}, that repeats after "
            f"{other.turns} revolutions, with torques up to {quantity(peak, 'N m')}; it is reached from "
            f"{other.start}"
        )
    yield from (text for text in motion.not_periodic)


def _reversals(machine: Machine, motion: ElasticMotion) -> Iterator[str]:
    wheels = {} if machine.train is None else machine.train.freewheels
    springs = {wheel.parts(name)[1]: name for name, wheel in wheels.items()}
    extremes = zip(motion.shafts, motion.torque_min, motion.torque_max, motion.backlash, strict=True)
    for name, low, high, gap in extremes:
        if name in springs:
            if low < 0:
                yield (
                    f"Freewheel {springs[name]} would be overrun: its torque falls to "
                    f"{quantity(low, 'N m')}, while the steady motion takes it as locked"
                )
        elif min(-low, high) > _REVERSED * max(-low, high):
            backlash = (
                "its backlash is crossed, and the flanks rattle"
                if gap
                else "backlash in gears and couplings would be crossed with impacts; give it as `backlash`"
            )
            yield (
                f"The torque of {name} changes sign, from {quantity(low, 'N m')} to {quantity(high, 'N m')}: "
                f"{backlash}"
            )
        elif gap and low * high == 0:
            yield f"The flanks of {name} part in every cycle: its torque falls to zero"


def _fluctuation(known: Results, motion: ElasticMotion) -> Iterator[str]:
    rigid = known.steady_state
    if rigid is None or not rigid.unevenness_time > 0:
        return
    own = float(motion.unevenness[motion.stations.index(motion.crank)])
    if own > _GROWS * rigid.unevenness_time:
        yield (
            f"With the elastic driveline the speed of the crank fluctuates by δ = {number(own)}, with a "
            f"rigid one by {number(rigid.unevenness_time)}: steady motion, forces and run-up are those of "
            "the rigid driveline"
        )
