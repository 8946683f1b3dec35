r"""A driveline whose shafts twist: its train, and the torque of the mechanism that excites it.

In a train a mechanism is a disc, and what it asks of the crank at constant speed acts on that disc as a
torque over the revolution,

.. math:: M(\varphi) = -M_r(\varphi, \omega) - \tfrac12 J'(\varphi)\,\omega^2
    = \operatorname{Re} \sum_\nu M_\nu e^{i\nu\varphi}, \qquad \varphi = \omega t

The disc has the mean of the reduced inertia over the revolution. This is the motion's linear part: what J(φ)
− J̄ does to the swinging itself is left out, and is small as long as either is small against its mean.

Where torques follow the speed, they damp: :math:`c = -\partial M/\partial\omega`.

References
----------
.. [1] Biezeno and Grammel, Engineering Dynamics, vol. 4, 1954: mean inertia of a crank drive, excitation by
   its variable part.
.. [2] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963: inertia torque of
   reciprocating masses.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from linkwright.drive.load_checks import require_same_turns, require_sound_loads
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.reduction import law_harmonics, mean_laws, mean_over_turn
from linkwright.drive.steady_state import steady_state
from linkwright.kernel.arrays import Bools, Complexes, Floats
from linkwright.kernel.errors import AssemblyError, InputError
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import RANGES
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units.kinds import SPEED
from linkwright.kernel.units.marks import positive
from linkwright.linkages.closure import require_full_turn
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.own_motors import on_crankshaft, without_drive
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.torsion.excitation.harmonics import Source
from linkwright.torsion.model.drive_train import CRANK, MOTOR, STIFFNESS_KEYS, drive_train
from linkwright.torsion.model.train import Train
from linkwright.torsion.model.whole_train import whole_train

# Relative step of a central difference: its error is of second order, 1e-10, rounding over it likewise.
_STEP = 1e-5


def train_of(machine: Machine) -> Train:
    """The train of a machine, as discs, shafts and gears: that of its file, or that of its driveline.

    A mechanism counts with its mean inertia.
    """
    if machine.train is None:
        return whole_train(drive_line(machine))
    whole = whole_train(machine.train)
    discs = dict(whole.discs)
    for name, mechanism in machine.train.mechanisms.items():
        disc = discs[mechanism.on]
        inertia = disc.inertia + _mean_inertia(mounted_mechanism(machine, name))
        discs[mechanism.on] = disc.model_copy(update={"inertia": inertia})
    return whole.model_copy(update={"discs": discs}) if machine.train.mechanisms else whole


def mounted_mechanism(machine: Machine, name: str) -> CompiledMachine:
    """A mechanism of a train without its drive, if its revolutions can be determined. In the core's terms.

    That of its file, or the mechanism beside the train.
    """
    try:
        return mechanism_alone(mounted_machine(machine, name))
    except AssemblyError as error:
        raise AssemblyError(f"train.mechanisms.{name}: {error}") from None


def mounted_machine(machine: Machine, name: str) -> Machine:
    """The machine whose mechanism stands on a train: that of its file, or what stands beside the train."""
    assert machine.train is not None
    mounted: Machine | None = machine.train.mechanisms[name].machine
    return machine.with_entries({"train": None}) if mounted is None else mounted


@public
def drive_line(machine: Machine) -> Train:
    """The train of a machine's driveline, from the motor to the crank.

    Parameters
    ----------
    machine : Machine
        With a mechanism, and a [drive] of which something twists.

    Returns
    -------
    Train
        Discs ``"motor"``, ``"gearbox"``, ``"wheel"``, ``"crank"``, as far as they turn on their own.

    Raises
    ------
    InputError
        Nothing of the drive twists, or a disc has no inertia.
    AssemblyError
        The mechanism does not close all round.
    """
    if machine.drive is None or not machine.drive.twists:
        raise InputError(
            f"{machine.name} has no [train], and its driveline is rigid: expected [train.discs] and "
            f"[train.shafts], or one of {', '.join(STIFFNESS_KEYS)}"
        )
    return drive_train(machine.drive, mean_inertia(machine))


def mean_inertia(machine: Machine) -> float:
    """Mean reduced inertia of the mechanism at the crank, without that of the drive [kg m²]."""
    return _mean_inertia(mechanism_alone(machine))


def _mean_inertia(compiled: CompiledMachine) -> float:
    turn = turn_curve(lambda phi: compiled.reductions(phi).inertia[None], compiled.kinks(), "reduced inertia")
    return float(turn.mean()[0])


@public
def mechanism_harmonics(machine: Machine, speed: ArrayLike, orders: ArrayLike) -> Complexes:
    r"""Harmonics of the torque with which a mechanism acts on its crank at constant speed.

    Parameters
    ----------
    machine : Machine
        The machine; its drive does not count.
    speed : array_like, shape () or (speeds,)
        Of the crank [rad/s].
    orders : array_like, shape (n,)
        Per revolution of the crank, multiples of ½, or of 1/n for a motion that repeats after n revolutions.
        In one that repeats after every revolution the harmonics of halves are zero.

    Returns
    -------
    ndarray of complex, shape (n,) or (n, speeds)
        M_ν, positive where the torque drives [N m]; of order 0 the mean.

    Raises
    ------
    InputError
        An order is negative or no such multiple, or a speed is not positive.
    AssemblyError
        The mechanism does not close all round, or does not repeat after 24 revolutions or fewer.

    Notes
    -----
    The torque is a series between the dead centres of its frictions, and its harmonics are integrals of that
    series, so that no sample is lost to a jump.
    """
    omega, compiled = _positive(speed), mechanism_alone(machine)
    M = harmonics_of(compiled, omega, _orders(orders, compiled.turns))
    return M[:, 0] if np.ndim(speed) == 0 else M


def harmonics_of(compiled: CompiledMachine, omega: Floats, nu: Floats) -> Complexes:
    """Harmonics of the torque of a mechanism, (orders, speeds)."""
    size = np.where(nu == 0, 1.0, 2.0) * _is_whole(nu * compiled.turns)
    M: Complexes = -size[:, None] * _resistance_harmonics(compiled, nu, omega)
    M[nu == 0] -= compiled.speed_load(omega)
    return M


@public
def station_damping(machine: Machine, speed: ArrayLike) -> dict[str, Floats]:
    r"""Damping of a driveline by the speed-dependent torques of motor and loads.

    Parameters
    ----------
    machine : Machine
    speed : array_like, shape () or (speeds,)
        Of the crank [rad/s].

    Returns
    -------
    dict of str to ndarray, shape () or (speeds,)
        −∂M/∂ω of ``"motor"`` at its own speed, and of ``"crank"``, mean over the revolution [N m s/rad].
        Negative where a torque grows with the speed it drives. That of the motor holds the gearbox's
        efficiency, by which its torque reaches the crank.

    Raises
    ------
    InputError
        A speed is not positive.
    AssemblyError
        The mechanism does not close all round.
    """
    omega = _positive(speed)
    compiled = mechanism_alone(machine)
    damping = {CRANK: damping_of(compiled, omega)}
    motor = None if machine.drive is None else machine.drive.motor
    if machine.drive is not None and motor is not None and not isinstance(motor, ConstantSpeedMotor):
        driven = compile_machine(machine)
        slope = slope_of(lambda at: driven.motor_torques(at).crank, omega)
        damping[MOTOR] = -slope / machine.drive.gearbox.ratio**2
    return {station: c.reshape(np.shape(speed)) for station, c in damping.items()}


def mechanism_alone(machine: Machine) -> CompiledMachine:
    """The mechanism without its drive, if its revolutions can be determined. In the core's terms."""
    alone = without_drive(on_crankshaft(machine))
    compiled = compile_machine(alone)
    require_same_turns(alone)
    require_full_turn(compiled, alone)
    require_sound_loads(compiled, alone)
    return over_whole_cycle(compiled)


def _resistance_harmonics(compiled: CompiledMachine, nu: Floats, omega: Floats) -> Complexes:
    """Mean resistance at constant speeds, inertia included, times e^{−iνφ}, (orders, speeds) [N m]."""
    turn = turn_curve(lambda phi: _parts(compiled, phi), compiled.kinks(), "torque of the mechanism")
    # Each part has its power of the speed.
    M: Complexes = turn.harmonics(nu).T @ np.array([omega**0, omega, omega**2])
    M += law_harmonics(compiled, omega, nu).T
    return M


def _parts(compiled: CompiledMachine, phi: Floats) -> Floats:
    """Torque coefficients of speed to the power of 0, 1 and 2, (3, n)."""
    at = compiled.reductions(phi)
    return np.stack([at.load + at.dry, at.viscous, 0.5 * at.inertia_slope])


def _resistance(compiled: CompiledMachine, omega: Floats) -> Floats:
    """Mean torque of all but the viscous loads over the speed [N m]."""
    return mean_laws(compiled, omega) + compiled.speed_load(omega)


def damping_of(compiled: CompiledMachine, omega: Floats) -> Floats:
    """Mean damping of a mechanism at speeds of its crank [N m s/rad]."""
    damping: Floats = mean_over_turn(compiled)[1] + slope_of(lambda at: _resistance(compiled, at), omega)
    return damping


def slope_of(torque: Callable[[Floats], Floats], omega: Floats) -> Floats:
    """Derivative by the speed, (speeds,) [N m s/rad]."""
    low, high = omega * (1 - _STEP), omega * (1 + _STEP)
    slope: Floats = (torque(high) - torque(low)) / (high - low)
    return slope


def _orders(orders: ArrayLike, turns: int) -> Floats:
    """Orders that are multiples of a half, or of one over the revolutions of a cycle."""
    nu = np.atleast_1d(np.asarray(orders, dtype=np.float64))
    if nu.ndim != 1:
        raise InputError(f"orders: found an array of shape {nu.shape}, expected a list of orders")
    is_order = (nu >= 0) & (nu <= RANGES["order"].greatest)
    is_order[is_order] = _is_whole(2 * nu[is_order]) | _is_whole(turns * nu[is_order])
    if not is_order.all():
        also = "" if turns <= 2 else f" or of 1/{turns}"
        expected = f"multiples of 0.5{also}, from 0 to {RANGES['order'].greatest:g}"
        raise InputError(f"orders: found {nu[~is_order][0]:g}, expected {expected}")
    return nu


def _is_whole(values: Floats) -> Bools:
    """Which numbers are whole within rounding."""
    is_whole: Bools = np.abs(values - np.round(values)) <= _WHOLE * np.maximum(values, 1.0)
    return is_whole


def _positive(speed: ArrayLike) -> Floats:
    omega = np.atleast_1d(np.asarray(speed, dtype=np.float64))
    if omega.ndim != 1 or not len(omega):
        raise InputError(f"speed: found an array of shape {omega.shape}, expected a list of speeds")
    in_range(speed=(omega, positive(SPEED)))
    return omega


# Orders of the crank that count, and the share of the largest below which one does not.
ORDERS = 24
NEGLIGIBLE = 1e-12

# Share by which rounding takes a fraction such as 1/3 off a whole number.
_WHOLE = 1e-12


def mechanism_sources(
    machine: Machine, turning: Floats, place: dict[str, int], speeds: Floats
) -> tuple[list[Source], Floats]:
    """Torque of a mechanism on its crank at constant speed.

    Gives `sources`: on the crank; `damping`: (discs, speeds) of motor and mechanism where their torques fall
    or rise with the speed; none where they would excite [N m s/rad]. `turning`: (discs,) speed of each disc
    over that of the first; `speeds`: (speeds,) [rad/s].
    """
    n = turning[place[CRANK]]
    turns = mechanism_alone(machine).turns
    of_crank = np.arange(ORDERS * turns + 1) / turns
    M = mechanism_harmonics(machine, n * speeds, of_crank)
    size = np.abs(M).max(axis=1)
    kept = (of_crank > 0) & (size > NEGLIGIBLE * size.max())
    damping = np.zeros((len(place), len(speeds)))
    for station, c in station_damping(machine, n * speeds).items():
        if station in place:
            damping[place[station]] += np.maximum(c, 0.0)
    return [Source(place[CRANK], n * of_crank[kept], M[kept], M[0].real)], damping


def steady_speed(machine: Machine) -> float:
    """Mean speed of the crank in rigid steady motion; without a motor its design speed [rad/s]."""
    drive = machine.drive
    if drive is not None and drive.motor is None and drive.speed is not None:
        return drive.speed
    return steady_state(machine).speed_mean_time
