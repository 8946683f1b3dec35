r"""A running train starts as in steady running: its mean torques balance, and its shafts carry them.

| the train has | what gives |
| --- | --- |
| a motor that drives | the speed: the motor's curve, and the loads over theirs, meet at one |
| an engine | its combustion, as a governor would have it |
| neither | the drivers: constant torques, what the loads need, by their shares |

Loads never change, unless that is asked for.

In steady running mean torques and the mean acceleration of the whole balance on every mass,

.. math:: \bar M_i(\theta) = \bar J_i\,\frac{\sum\bar M}{\sum\bar J}

over two revolutions. The twists that do so are found by Newton's method, whatever the curves of couplings
are. Without them a motion would begin with the shock of torques that set in at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError
from linkwright.torsion.core.torque import TrainTorque
from linkwright.torsion.core.transient import MovingTrain
from linkwright.torsion.in_time.moving_train import COMBUSTION
from linkwright.torsion.model.train import Train
from linkwright.torsion.model.train_transient import TrainTransient

# Angles of two revolutions at which mean torques are taken: some twenty a wave of order 24.
_MEAN_ANGLES = 1024

# Speeds over that given, between which a steady one is sought, how many, and halvings: to rounding.
_LEAST, _MOST, _SPEEDS, _HALVINGS = 0.2, 2.0, 181, 50

# Share of the torques that is rounding, and no balance to be sought.
_ROUNDING = 1e-12


def mean_torques(train: MovingTrain, speed: float, angle: float = 0.0) -> Floats:
    """Mean torque on each mass over two revolutions of the first disc, without twist, (masses,).

    At the speed of the first disc, at the start of the motion [N m]. `speed`: [rad/s]; `angle`: [rad].
    """
    turns = angle + 4 * np.pi * np.arange(_MEAN_ANGLES) / _MEAN_ANGLES
    bare, turning = replace(train, controllers=()), train.turning
    at = np.zeros(train.masses)
    if train.has_losses:
        # What is lost depends on what the shafts carry.
        at = loaded_angles(bare, at, speed * turning)
    net = bare.net_torques(BEFORE, at + turns[:, None] * turning, speed * turning)
    mean: Floats = net.torque.mean(axis=0)
    return mean


def balanced_start(
    moving: MovingTrain, train: Train, manoeuvre: TrainTransient
) -> tuple[MovingTrain, float, str]:
    """A train whose mean torques balance at the start, if they shall.

    Gives `train`: with a drive, with another combustion, or with other loads where that is asked for;
    `speed`: at the start [rad/s]; `told`: what was changed, in words; empty where nothing was.
    """
    speed = manoeuvre.speed
    if not (manoeuvre.balanced and speed and moving.is_free) or manoeuvre.twists:
        return moving, speed, ""
    left = _left(moving, speed, manoeuvre.angle)
    if abs(left) <= _ROUNDING * _size(moving, speed, manoeuvre.angle):
        return moving, speed, ""
    if manoeuvre.loads_follow:
        return _with_loads(moving, train, manoeuvre, left)
    if any(motor.on_at_start for motor in manoeuvre.motors.values()):
        return _at_steady_speed(moving, manoeuvre)
    if not train.is_driven:
        return _with_combustion(moving, manoeuvre, left)
    if manoeuvre.motors:
        return moving, speed, f"no driving torque at the start: {left:.5g} N m slow the train down"
    if not train.shares:
        return moving, speed, f"drivers and loads do not balance at the start: {left:+.5g} N m are left over"
    total = -left * _balancing(
        moving, manoeuvre, lambda factor: _driven(moving, _drives(moving, train, -left * factor))
    )
    drives = _drives(moving, train, total)
    words = f"{_given(moving, drives)}, what the loads need at the start"
    return _with_offsets(moving, drives), speed, words


def _given(moving: MovingTrain, drives: list[TrainTorque]) -> str:
    """What drives at the start, in words; the torque of a controller changes afterwards."""
    if {drive.on for drive in drives} <= {one.on for one in moving.controllers}:
        return " and ".join(
            f"the controller of {moving.discs[drive.on]} begins with {drive.scale:.5g} N m"
            for drive in drives
        )
    given = " and ".join(f"{moving.discs[drive.on]} by a constant {drive.scale:.5g} N m" for drive in drives)
    return given.replace(" by", " is driven by", 1)


def _drives(moving: MovingTrain, train: Train, total: float) -> list[TrainTorque]:
    """Constant torques of the drivers by their shares of a sum at the speed of the first disc [N m]."""
    discs = ((moving.discs.index(name), share) for name, share in train.shares.items())
    return [TrainTorque("driver", disc, share * total / float(moving.speed[disc])) for disc, share in discs]


def _driven(moving: MovingTrain, drives: list[TrainTorque]) -> MovingTrain:
    return replace(moving, torques=(*moving.torques, *drives))


def _with_offsets(moving: MovingTrain, drives: list[TrainTorque]) -> MovingTrain:
    """A speed controller begins with the torque of its driver; the others are constant."""
    torque = {drive.on: drive.scale for drive in drives}
    led = {one.on for one in moving.controllers}
    controllers = tuple(
        replace(one, offset=one.offset + torque.pop(one.on, 0.0)) for one in moving.controllers
    )
    constant = [drive for drive in drives if drive.on not in led]
    return replace(_driven(moving, constant), controllers=controllers)


# Share of the torques within which what gives is found where stages lose power, and secants.
_FOUND, _SECANTS = 1e-12, 40


def _balancing(
    moving: MovingTrain, manoeuvre: TrainTransient, made: Callable[[float], MovingTrain], factor: float = 1.0
) -> float:
    """The factor that balances, beside one that does without losses."""
    if not moving.has_losses:
        return factor

    def left(at: float) -> float:
        return _left(made(at), manoeuvre.speed, manoeuvre.angle)

    before, here = 0.9 * factor, factor
    missed, misses = left(before), left(here)
    size = max(abs(missed), abs(misses))
    for _ in range(_SECANTS):
        if abs(misses) <= _FOUND * size or misses == missed:
            break
        following = here - misses * (here - before) / (misses - missed)
        before, missed, here = here, misses, following
        misses = left(here)
    return here


def _left(moving: MovingTrain, speed: float, angle: float) -> float:
    """Sum of the mean torques, at the speed of the first disc [N m]."""
    return float(mean_torques(moving, speed, angle).sum())


def _size(moving: MovingTrain, speed: float, angle: float) -> float:
    """Sum of the sizes of the mean torques [N m]."""
    return float(np.abs(mean_torques(moving, speed, angle)).sum())


def _at_steady_speed(moving: MovingTrain, manoeuvre: TrainTransient) -> tuple[MovingTrain, float, str]:
    """The stable equilibrium speed nearest to the given one."""
    given, angle = manoeuvre.speed, manoeuvre.angle
    speeds = given * np.linspace(_LEAST, _MOST, _SPEEDS)
    left = np.array([_left(moving, speed, angle) for speed in speeds.tolist()])
    # Above it torques brake, below they drive.
    stable = np.flatnonzero((left[:-1] > 0) & (left[1:] <= 0))
    if not len(stable):
        here = _left(moving, given, angle)
        words = (
            f"no speed near {_rpm(given)} balances the mean torques: {here:+.5g} N m are left at the start"
        )
        return moving, given, words
    at = stable[np.abs(speeds[stable] - given).argmin()]
    low, high = float(speeds[at]), float(speeds[at + 1])
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _left(moving, middle, angle) > 0 else (low, middle)
    words = f"the start is at {_rpm(low)}, where motor and loads balance, not at {_rpm(given)}"
    return moving, low, words if abs(low / given - 1) > 5e-5 else ""


def _with_combustion(
    moving: MovingTrain, manoeuvre: TrainTransient, left: float
) -> tuple[MovingTrain, float, str]:
    motored = replace(moving, torques=tuple(torque for torque in moving.torques if not _burns(torque)))
    given = left - _left(motored, manoeuvre.speed, manoeuvre.angle)
    factor = 1 - left / given if given > 0 else 0.0
    burning = [_burns(torque) for torque in moving.torques]
    if factor > 0:
        factor = _balancing(moving, manoeuvre, lambda at: _scaled(moving, burning, at), factor)
    if factor <= 0:
        words = f"no combustion balances the mean torques: {left:+.5g} N m are left over at the start"
        return moving, manoeuvre.speed, words
    words = f"combustion was scaled by {factor:.5g} at the start so that the mean torques balance"
    return _scaled(moving, burning, factor), manoeuvre.speed, words


def _with_loads(
    moving: MovingTrain, train: Train, manoeuvre: TrainTransient, left: float
) -> tuple[MovingTrain, float, str]:
    needed, speed = 0.0, manoeuvre.speed
    for load in train.loads.values():
        turning = float(moving.speed[moving.discs.index(load.on)])
        needed += turning * load.resistance(turning * speed)
    factor = 1.0 + left / needed if needed else 0.0
    loads = [torque.name in train.loads for torque in moving.torques]
    if factor > 0:
        factor = _balancing(moving, manoeuvre, lambda at: _scaled(moving, loads, at), factor)
    if factor <= 0:
        return moving, speed, f"no loads balance the mean torques: {left:+.5g} N m are left over at the start"
    words = f"loads were scaled by {factor:.5g} so that the mean torques balance (`loads_follow = true`)"
    return _scaled(moving, loads, factor), speed, words


def _burns(torque: TrainTorque) -> bool:
    return COMBUSTION.search(torque.name) is not None


def _scaled(moving: MovingTrain, which: list[bool], factor: float) -> MovingTrain:
    torques = tuple(
        replace(torque, scale=torque.scale * factor) if chosen else torque
        for torque, chosen in zip(moving.torques, which, strict=True)
    )
    return replace(moving, torques=torques)


def _rpm(speed: float) -> str:
    return f"{speed * 30 / np.pi:.5g} rpm"


# Angles of two revolutions: some twenty a wave of order 24.
_ANGLES = 1024

# A time before the start [s]: laws over time are what they are there, and nothing has set in that begins
# with it.
BEFORE = -1e6

# Twist by which stiffnesses are found [rad], and Newton's steps.
_STEP = 1e-7
_STEPS = 60

# Share of a coupling's steepest slope that it has at least, so that a gap is crossed: Newton then comes
# closer a thousandfold in each step at the worst.
_FLOOR = 1e-3

# Share of the torques that may be left, and of the stiffest shaft's torque per angle: rounding of two
# revolutions.
_TORQUE_LEFT, _TWIST_ROUNDING = 1e-9, 1e-14


def loaded_angles(train: MovingTrain, angle: Floats, speed: Floats) -> Floats:
    """Angles of the masses under mean torques, (masses,) [rad]; the first mass of a free train stays."""
    is_free, turning = train.is_free, train.turning
    # A train that is held does not turn: its torques are those at its angles.
    turns = 4 * np.pi * np.arange(_ANGLES) / _ANGLES if is_free else np.zeros(1)
    fixed = int(is_free)
    q = np.array(angle, dtype=float)
    # Masses that rigid stages join turn alike.
    alike = np.eye(int(train.groups.max()) + 1)[:, train.groups]
    steepest = train.lead**2 * (train.stiffness + _steepest(train))
    allowed = _TWIST_ROUNDING * steepest.max(initial=0.0)
    for _ in range(_STEPS):
        net = train.net_torques(BEFORE, q + turns[:, None] * turning, speed)
        torque, inertia = alike @ net.torque.mean(axis=0), alike @ (net.inertia.mean(axis=0) * turning)
        left = torque - inertia * (torque.sum() / inertia.sum()) if is_free else torque
        # What only a fluid holds follows without twist.
        stiffness = alike @ _stiffness(train, q, speed) @ alike.T
        joined = stiffness.diagonal() > _TORQUE_LEFT * steepest.max(initial=0.0)
        allowed = max(allowed, _TORQUE_LEFT * float(np.abs(torque).max()))
        if np.abs(left[joined]).max(initial=0.0) <= allowed:
            return q
        if train.has_losses and is_free:
            # What stages lose changes the acceleration of the whole.
            stiffness -= np.outer(inertia / inertia.sum(), stiffness.sum(axis=0))
        step = np.linalg.lstsq(stiffness[fixed:, fixed:], left[fixed:], rcond=1e-13)[0]
        q += np.concatenate([np.zeros(fixed), step]) @ alike
    raise ConvergenceError(
        "no twist of the shafts balances the mean torques at the start; start without them: loaded = false",
        method="Newton",
        iterations=_STEPS,
    )


def _steepest(train: MovingTrain) -> Floats:
    """Steepest slope of the curve of each shaft, (shafts,) [N m/rad]."""
    return np.array([0.0 if curve is None else float(np.abs(curve.after).max()) for curve in train.curves])


def _stiffness(train: MovingTrain, angle: Floats, speed: Floats) -> Floats:
    """Stiffness matrix of the masses, (masses, masses) [N m/rad]."""
    n = len(angle)
    # Both sides of the angle, so that bends of curves cancel.
    rows = np.concatenate([angle + _STEP * np.eye(n), angle - _STEP * np.eye(n)])
    ahead, back = np.split(train.net_torques(BEFORE, rows, speed).torque, 2)
    matrix: Floats = (back - ahead).T / (2 * _STEP)
    # Torques over the angle of a disc have no part in what its shafts do.
    least = train.lead**2 * _FLOOR * _steepest(train)
    ends = np.where(train.tip < 0, n, train.mass[train.tip])
    for (a, b), k in zip(ends.tolist(), least.tolist(), strict=True):
        for i, j in ((a, b), (b, a)):
            if i < n:
                matrix[i, i] += k
                if j < n:
                    matrix[i, j] -= k
    return matrix
