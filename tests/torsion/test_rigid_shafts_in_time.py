"""Manoeuvres with shafts as good as rigid: the train whose discs are one, and exact modal motion."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest
from numpy.typing import NDArray
from test_torsion_transient import chain

from linkwright import ConvergenceError
from linkwright.torsion import DecayingTorque, TorsionTransient, TrainTorque, follow_train

Floats = NDArray[np.float64]

W, M = 90.0, 80.0
J, GROUND = [1.5, 2.0, 3.0], [0.5, 0.3, 0.1]
K, C, DURATION, RATIO = 2e4, 5.0, 0.5, 2.5


def raised_cosine() -> list[TrainTorque]:
    """M(1 − cos Ωt): nothing jumps, so that a rigid shaft is not struck."""
    wave = DecayingTorque(0.0, np.inf, 0.0, W, np.pi / 2)
    return [TrainTorque("mean", 0, M), TrainTorque("wave", 0, -M, wave)]


def moved(
    k: float,
    c: float,
    accuracy: float,
    speed: float = 1.0,
    method: Literal["auto", "explicit", "implicit"] = "implicit",
    duration: float = DURATION,
) -> TorsionTransient:
    """Three discs; beyond the soft shaft a rigid one, at `speed` times that of the first disc."""
    n = np.array([1.0, speed, speed])
    train = chain(
        np.array(J) / n**2,
        [K, k / speed**2],
        damping=[C, c / speed**2],
        ground=np.array(GROUND) / n**2,
        speed=[1.0, speed, speed],
        torques=raised_cosine(),
    )
    return follow_train(train, duration=duration, accuracy=accuracy, method=method, sample_time=7e-4)


@pytest.fixture(scope="module")
def one() -> tuple[Floats, Floats, Floats]:
    """Where the last two discs are one: torques of the soft and the rigid shaft, and speed of that disc."""
    return as_one(DURATION)


def as_one(duration: float) -> tuple[Floats, Floats, Floats]:
    train = chain(
        [J[0], J[1] + J[2]], [K], damping=[C], ground=[GROUND[0], sum(GROUND[1:])], torques=raised_cosine()
    )
    found = follow_train(train, duration=duration, accuracy=1e-13, method="explicit", sample_time=7e-4)
    speed = found.speed[1]
    acceleration = (found.torque[0] - sum(GROUND[1:]) * speed) / (J[1] + J[2])
    return found.torque[0], J[2] * acceleration + GROUND[2] * speed, speed


@pytest.mark.parametrize("accuracy", [1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize("k", [1e12, 1e15, 1e18])
@pytest.mark.parametrize("damped", [0.0, 1e-3])
@pytest.mark.parametrize("speed", [1.0, RATIO])
def test_rigid_shaft_makes_two_discs_one(
    one: tuple[Floats, Floats, Floats], accuracy: float, k: float, damped: float, speed: float
) -> None:
    found = moved(k, damped * k, accuracy, speed)
    soft, rigid, turning = one
    # A shaft of k twists: the frequency changes by K/k of itself, over swings of 0.5 s the phase by some
    # times that. J δω/h is left of the rounding of speeds, 4e-8 N m of 120 N m in steps of 1e-4 s.
    allowed = accuracy + 3 * K / k + 4e-10
    assert np.abs(found.torque[1] * speed - rigid).max() <= allowed * np.abs(rigid).max()
    assert np.abs(found.torque[0] - soft).max() <= allowed * np.abs(soft).max()
    assert np.abs(found.speed[2] / speed - turning).max() <= allowed * np.abs(turning).max()
    # Extremes are those of the motion, not of rounding: at least the largest sample, hardly more.
    assert found.torque_max[1] >= found.torque[1].max()
    # Samples 7e-4 s apart miss the peak by (Ω·7e-4/2)²/2 of its wave at most, of the swing some times that.
    assert found.torque_max[1] * speed <= rigid.max() * (1 + 5e-3)


# A tenth of the time, so that steps that follow the swings of the rigid shaft are some ten thousand.
SHORT = 0.05


def off_one(found: TorsionTransient) -> float:
    rigid = as_one(SHORT)[1]
    return float(np.abs(found.torque[1] - rigid).max() / np.abs(rigid).max())


@pytest.mark.parametrize(
    ("k", "accuracy"), [(1e9, 1e-4), (1e9, 1e-6), (1e11, 1e-4), (1e11, 1e-6), (1e12, 1e-4)]
)
def test_steps_that_follow_a_stiff_shaft_know_its_torque(k: float, accuracy: float) -> None:
    """Its twist is 1e-8 to 1e-11 rad: an accuracy of the angles says nothing about it."""
    found = moved(k, 0.0, accuracy, method="explicit", duration=SHORT)
    assert off_one(found) <= accuracy + 3 * K / k


@pytest.mark.parametrize("k", [1e12, 1e13])
@pytest.mark.parametrize("accuracy", [1e-6, 1e-8])
def test_a_torque_lost_in_rounding_is_not_told(k: float, accuracy: float) -> None:
    """Steps that gather rounding of angles, 1e-18 rad each, are refused; "auto" takes others."""
    with pytest.raises(ConvergenceError, match=r"shaft s1, 1e\+1[23] N m/rad, .* lost in the rounding"):
        moved(k, 0.0, accuracy, method="explicit", duration=SHORT)
    found = moved(k, 0.0, accuracy, method="auto", duration=SHORT)
    assert found.method == "implicit"
    assert off_one(found) <= accuracy + 3 * K / k + 4e-10


def test_rigid_shafts_in_parallel_share_by_stiffness() -> None:
    """Two shafts between the same discs, 3 to 1, one drawn the other way."""
    train = chain(J, [K, 3e17], damping=[C, 0.0], ground=GROUND, torques=raised_cosine())
    entries = {name: getattr(train, name) for name in train.__dataclass_fields__}
    entries["shafts"] = ("s0", "s1", "beside")
    entries["tip"] = np.vstack([train.tip, [[2, 1]]]).astype(np.int32)
    entries["stiffness"] = np.append(train.stiffness, 1e17)
    entries["shaft_damping"] = np.append(train.shaft_damping, 0.0)
    entries["curves"] = (None,) * 3
    found = follow_train(
        type(train)(**entries), duration=DURATION, accuracy=1e-8, method="implicit", sample_time=7e-4
    )
    alone = moved(4e17, 0.0, 1e-8)
    size = np.abs(alone.torque[1]).max()
    assert np.abs(found.torque[1] - 0.75 * alone.torque[1]).max() <= 1e-7 * size
    assert np.abs(found.torque[2] + 0.25 * alone.torque[1]).max() <= 1e-7 * size


class ModalMotion:
    """Free motion of undamped discs in a row, exactly: each mode for itself.

    The singular values of k^½ B J^-½ are the natural frequencies, known to rounding of the fastest, where
    squares from an eigenvalue problem would lose the square of the ratio of frequencies. The rigid rotation
    is no twist at all.
    """

    def __init__(self, inertia: Floats, stiffness: Floats, angle: Floats, speed: Floats) -> None:
        n = len(inertia)
        self.root_J, self.root_k = np.sqrt(inertia), np.sqrt(stiffness)
        twist = np.eye(n)[:-1] - np.eye(n)[1:]
        self.U, self.omega, modes = np.linalg.svd(self.root_k[:, None] * twist / self.root_J)
        self.modes = modes[:-1]
        self.turning = np.array([inertia @ angle, inertia @ speed]) / inertia.sum()
        # The mean rotation first: it is many times the swings.
        self.q = self.modes @ (self.root_J * (angle - self.turning[0]))
        self.v = self.modes @ (self.root_J * (speed - self.turning[1]))

    def at(self, t: Floats) -> tuple[Floats, Floats, Floats]:
        """Angles, speeds, torques of the shafts, each (…, times)."""
        phase, omega = np.outer(self.omega, t), self.omega[:, None]
        c, s = np.cos(phase), np.sin(phase)
        q = self.q[:, None] * c + self.v[:, None] / omega * s
        v = self.v[:, None] * c - self.q[:, None] * omega * s
        angle, speed = (self.modes.T @ each / self.root_J[:, None] for each in (q, v))
        torque = self.root_k[:, None] * (self.U @ (omega * q))
        return self.turning[0] + self.turning[1] * t + angle, self.turning[1] + speed, torque


@pytest.mark.parametrize("accuracy", [1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("method", ["explicit", "implicit"])
def test_free_motion_is_that_of_the_modes(method: str, seed: int, accuracy: float) -> None:
    """Any chain, from any start, at instants that no step ends at: no integrator is the reference."""
    rng = np.random.default_rng(100 + seed)
    n = int(rng.integers(2, 6))
    inertia, stiffness = rng.uniform(0.1, 2, n), 10 ** rng.uniform(3.5, 5.5, n - 1)
    angle, speed = 0.01 * rng.normal(size=n), rng.uniform(20, 150) + rng.normal(size=n)
    duration = 0.2
    found = follow_train(
        chain(inertia, stiffness),
        duration=duration,
        angle=angle,
        speed=speed,
        accuracy=accuracy,
        method=method,  # type: ignore[arg-type]
        sample_time=duration / int(rng.integers(53, 97)),
    )
    wanted = ModalMotion(inertia, stiffness, angle, speed).at(found.time)
    for values, right in zip((found.angle, found.speed), wanted, strict=False):
        assert np.abs(values - right).max() <= accuracy * np.abs(right).max()
    off = np.abs(found.torque - wanted[2]).max(axis=1) / np.abs(wanted[2]).max(axis=1)
    # Accuracy is that of a step; without damping the phase gathers those of some tens of swings.
    assert (off <= 2 * accuracy).all()


def test_modal_motion_starts_and_goes_on_as_the_equations_say() -> None:
    """J θ̈ = −Bᵀ T by central differences of the speeds, and the start is what was given."""
    J, k = np.array([0.4, 1.1, 0.7]), np.array([3e4, 8e4])
    angle, speed = np.array([0.01, -0.02, 0.005]), np.array([50.0, 52.0, 49.0])
    motion, h = ModalMotion(J, k, angle, speed), 1e-6
    found = motion.at(np.array([0.0, 0.1 - h, 0.1, 0.1 + h]))
    np.testing.assert_allclose(found[0][:, 0], angle, atol=1e-16)
    np.testing.assert_allclose(found[1][:, 0], speed, rtol=1e-15)
    bend = (found[1][:, 3] - found[1][:, 1]) / (2 * h)
    carried = np.concatenate([[0.0], found[2][:, 2], [0.0]])
    # Differences err by (ωh)²/6 and by rounding of the speeds over h.
    np.testing.assert_allclose(J * bend, -np.diff(carried), atol=1e-6 * np.abs(carried).max())
    np.testing.assert_allclose(found[2][:, 2], k * -np.diff(found[0][:, 2]), rtol=1e-9)
