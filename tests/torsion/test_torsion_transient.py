"""Transient motion of trains: laws, closed forms, and SciPy's integrators on the same equations."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.special import ellipk

from linkwright import ConvergenceError, InputError, ShapeError
from linkwright.kernel.core.curve import Curve, odd, smooth, straight
from linkwright.kernel.core.periodic_table import waves
from linkwright.torsion import (
    DecayingTorque,
    MovingTrain,
    TorsionTransient,
    TrainTorque,
    follow_train,
    variable_inertia,
)
from linkwright.torsion.core.torque import GovernorTorque, Power, short_circuit
from linkwright.torsion.core.transient import VariableInertia, viscous

Floats = NDArray[np.float64]

TURN = 2 * np.pi * np.arange(64) / 64


def chain(
    inertia: Sequence[float],
    stiffness: Sequence[float],
    *,
    damping: Sequence[float] | float = 0.0,
    ground: Sequence[float] | float = 0.0,
    speed: Sequence[float] | None = None,
    curves: Sequence[Curve | None] | None = None,
    inertias: Sequence[VariableInertia] = (),
    torques: Sequence[TrainTorque] = (),
) -> MovingTrain:
    n = len(inertia)
    place = np.arange(n, dtype=np.int32)
    return MovingTrain(
        discs=tuple(f"d{k}" for k in range(n)),
        speed=np.ones(n) if speed is None else np.array(speed),
        mass=place,
        inertia=np.array(inertia, dtype=float),
        damping=np.broadcast_to(np.asarray(ground, dtype=float), n),
        swing_damping=np.zeros(n),
        shafts=tuple(f"s{k}" for k in range(n - 1)),
        tip=np.column_stack([place[:-1], place[1:]]),
        stiffness=np.array(stiffness, dtype=float),
        shaft_damping=np.broadcast_to(np.asarray(damping, dtype=float), n - 1),
        curves=(None,) * (n - 1) if curves is None else tuple(curves),
        inertias=tuple(inertias),
        torques=tuple(torques),
    )


def sine(on: int, size: float, omega: float) -> TrainTorque:
    return TrainTorque("sine", on, size, DecayingTorque(0.0, np.inf, 0.0, omega))


@pytest.mark.parametrize("method", ["explicit", "implicit"])
def test_settles_to_the_harmonic_response(method: str) -> None:
    """(K − ω²J + iωC) θ = M, solved directly, is what is left when the start has died out."""
    J, k, c = np.array([0.4, 0.1, 0.2, 1.5]), np.array([3e4, 5e4, 2e4]), np.array([9.0, 15.0, 6.0])
    ground = 1.5 * J
    B = np.eye(4)[:3] - np.eye(4)[1:]
    K, C = B.T @ np.diag(k) @ B, B.T @ np.diag(c) @ B + np.diag(ground)
    # Near the second mode.
    omega = 0.97 * float(np.sqrt(eigh(K, np.diag(J), eigvals_only=True)[2]))
    theta = np.linalg.solve(K - omega**2 * np.diag(J) + 1j * omega * C, np.array([0, 50.0, 0, 0]))
    train = chain(J, k, damping=c, ground=ground, torques=[sine(1, 50.0, omega)])
    # The rigid motion decays slowest; damped in proportion to the inertias it does not twist the shafts.
    # The slowest swing decays with 6 1/s.
    found = follow_train(train, duration=3.2, accuracy=1e-10, method=method, sample_time=1e-3)
    late = found.time > 3.0
    wave = np.exp(1j * omega * found.time[late]) / 1j
    wanted = ((k + 1j * omega * c) * (B @ theta))[:, None] * wave
    size = np.abs(wanted).max()
    # e⁻¹⁸ of the start is left; samples between implicit steps are read from cubics.
    assert np.abs(found.torque[:, late] - wanted.real).max() < (1e-6 if method == "explicit" else 1e-4) * size


@pytest.mark.parametrize("method", ["explicit", "implicit"])
def test_free_spin_of_throws_keeps_its_energy(method: str) -> None:
    """Six throws with inertias that change with the angle, on elastic shafts, without any loss."""
    J = 0.03 + 0.012 * np.sin(TURN) ** 2 * (1 + 0.2 * np.cos(TURN))
    throws = [variable_inertia(n, J, phase=n * np.pi / 3) for n in range(6)]
    train = chain([1e-9] * 6 + [0.9], [4e5] * 5 + [6e5], inertias=throws)
    train = MovingTrain(**{**vars_of(train), "inertia": np.array([0.0] * 6 + [0.9])})
    found = follow_train(train, duration=1.0, speed=150.0, accuracy=1e-9, method=method)
    total = found.kinetic_energy + found.potential_energy
    # A step errs by 1e-9; some thousand of them, of either sign.
    assert total == pytest.approx(np.full_like(total, total[0]), rel=1e-7)
    assert abs(found.energy_error) < 1e-7
    # It does swing: shafts are loaded by inertia alone.
    assert found.potential_energy.max() > 1e-6 * total[0]
    assert np.ptp(found.speed[0]) > 1.0


def vars_of(train: MovingTrain) -> dict[str, object]:
    return {name: getattr(train, name) for name in MovingTrain.__dataclass_fields__}


def test_one_throw_follows_its_energy() -> None:
    """J(θ) ω² stays, so the speed is known at every angle: by the inertia itself, not by a table of it."""
    J = 1.0 + 0.35 * np.cos(2 * TURN) + 0.1 * np.sin(TURN)
    train = chain([0.0], [], inertias=[variable_inertia(0, J, -0.7 * np.sin(2 * TURN) + 0.1 * np.cos(TURN))])
    found = follow_train(train, duration=2.0, speed=40.0, accuracy=1e-11)
    inertia = 1.0 + 0.35 * np.cos(2 * found.angle[0]) + 0.1 * np.sin(found.angle[0])
    assert found.speed[0] == pytest.approx(40.0 * np.sqrt(1.35 / inertia), rel=1e-9)
    # The largest speed lies between the samples: where J(θ) is smallest, at one of the angles near ±π/2.
    fine = np.linspace(0, 2 * np.pi, 100_001)
    least = (1.0 + 0.35 * np.cos(2 * fine) + 0.1 * np.sin(fine)).min()
    assert found.speed_max[0] == pytest.approx(40.0 * np.sqrt(1.35 / least), rel=1e-8)
    assert found.speed_max[0] > found.speed[0].max()


def test_resonance_passed_as_by_scipy() -> None:
    """A disc with J(θ) and order 2 runs up through its resonance: SciPy on equations written out anew."""
    gain, M2, k, c, J2 = 30.0, 60.0, 2.5e4, 4.0, 1.6
    inertia = 0.5 + 0.06 * np.cos(2 * TURN)
    torques = [
        TrainTorque("order", 0, shape=waves([2.0], [M2], [0.4])),
        TrainTorque("drive", 1, law=GovernorTorque(gain, straight([0.0, 3.0], [80.0, 200.0]))),
    ]
    train = chain([0.0, J2], [k], damping=c, inertias=[variable_inertia(0, inertia)], torques=torques)
    found = follow_train(train, duration=3.0, speed=80.0, accuracy=1e-11, sample_time=2e-3)

    def rates(t: float, y: Floats) -> list[float]:
        a, b, v, w = y.tolist()
        J, slope = 0.5 + 0.06 * cos(2 * a), -0.12 * sin(2 * a)
        shaft = k * (a - b) + c * (v - w)
        first = (M2 * cos(2 * a + 0.4) - shaft - 0.5 * slope * v * v) / J
        return [v, w, first, (gain * (80 + 40 * t - w) + shaft) / J2]

    peaks = []
    # A method of one step and one of many, which agree to 1e-8 of the peak.
    for method, rtol in (("DOP853", 1e-10), ("LSODA", 1e-12)):
        exact = solve_ivp(
            rates, (0, 3), [0, 0, 80, 80], method=method, t_eval=found.time, rtol=rtol, atol=0.1 * rtol
        )
        torque = k * (exact.y[0] - exact.y[1]) + c * (exact.y[2] - exact.y[3])
        peaks.append(np.abs(torque).max())
        # SciPy's error of 1e-10 a step, and angles of 400 rad from which it takes twists.
        assert found.torque[0] == pytest.approx(torque, abs=2e-6 * peaks[-1])
    greatest = max(found.torque_max[0], -found.torque_min[0])
    # Between the samples, a fiftieth of a radian of order 2 apart, it is greater by a half per cent at most.
    assert peaks[0] <= greatest <= 1.005 * peaks[0]
    # The resonance was passed: far above what the torque does at rest, and quiet again at the end.
    assert peaks[0] > 10 * M2
    assert np.abs(found.torque[0, found.time > 2.8] - found.torque[0, -400:].mean()).max() < 0.4 * peaks[0]


def test_load_step_doubles_the_static_twist() -> None:
    """Two discs, a torque that sets in: twice M J₂/(J₁ + J₂), first at half a period."""
    J1, J2, k, M = 0.7, 2.1, 4e4, 350.0
    omega = np.sqrt(k * (J1 + J2) / (J1 * J2))
    torque = TrainTorque("step", 0, M, DecayingTorque(0.01, np.inf, 0.0, 0.0, np.pi / 2))
    found = follow_train(chain([J1, J2], [k], torques=[torque]), duration=0.01 + 6 / omega, accuracy=1e-10)
    assert found.torque_max[0] == pytest.approx(2 * M * J2 / (J1 + J2), rel=1e-8)
    assert found.torque_max_time[0] == pytest.approx(0.01 + np.pi / omega, abs=1e-6)
    assert found.torque_min[0] == pytest.approx(0.0, abs=1e-6)
    assert found.work["step"] == pytest.approx(M * found.angle[0, -1], rel=1e-9)


def test_momentum_of_a_geared_train() -> None:
    """J₁ω₁ + J₂ω₂/i grows by the torque at the first disc and that at the second over the ratio."""
    J, i, M1, M2 = (0.3, 4.0), 2.5, 20.0, -30.0
    torques = [TrainTorque("a", 0, M1), TrainTorque("b", 1, M2)]
    train = chain(J, [8e3], speed=[1.0, 1 / i], damping=2.0, torques=torques)
    found = follow_train(train, duration=0.5, speed=60.0)
    momentum = J[0] * found.speed[0] + J[1] * found.speed[1] / i
    start = 60.0 * (J[0] + J[1] / i**2)
    # A linear sum of the state: only rounding of some hundred steps is lost.
    assert momentum == pytest.approx(start + (M1 + M2 / i) * found.time, rel=1e-12)


@pytest.mark.parametrize("amplitude", [0.002, 0.05, 0.12])
def test_stiffening_coupling_as_duffing(amplitude: float) -> None:
    """Frequency over amplitude of J ẍ + αx + βx³ = 0: √(α + βA²)/J π/(2K(m)), m = βA²/(2(α + βA²))."""
    J, alpha, beta = 0.8, 9e3, 2.4e6
    # Two discs of 2J swing against each other as one of J.
    x = np.linspace(0, 0.15, 4)
    curve = odd(x, alpha * x + beta * x**3, alpha + 3 * beta * x**2)
    train = chain([2 * J, 2 * J], [0.0], curves=[curve])
    square = beta * amplitude**2
    m = square / (2 * (alpha + square))
    period = 4 * ellipk(m) / np.sqrt((alpha + square) / J)
    start = np.array([0.5, -0.5]) * amplitude
    found = follow_train(train, duration=10 * period, angle=start, accuracy=1e-11, sample_time=period / 4)
    twist = found.angle[0] - found.angle[1]
    wanted = amplitude * np.tile([1.0, 0.0, -1.0, 0.0], 10)
    assert twist[:40] == pytest.approx(wanted, abs=1e-7 * amplitude)
    assert found.torque_max[0] == pytest.approx(alpha * amplitude + beta * amplitude**3, rel=1e-9)


def backlash(gap: float, stiffness: float) -> Curve:
    """Torque over twist: none within a gap [rad] from side to side, outside it a stiffness [N m/rad]."""
    half = 0.5 * gap
    return straight(
        [-1.0 - half, -half, half, 1.0 + half], [-stiffness, 0.0, 0.0, stiffness], beyond="straight"
    )


def test_backlash_lengthens_the_period() -> None:
    """Two gaps at the relative speed v, and a whole swing: 2g/v + 2π/ω."""
    J, k, gap, v = 2.0, 3e4, 0.02, 1.7
    train = chain([2 * J, 2 * J], [0.0], curves=[backlash(gap, k)])
    period = 2 * gap / v + 2 * np.pi / np.sqrt(k / J)
    found = follow_train(
        train, duration=5 * period, speed=[v / 2, -v / 2], accuracy=1e-10, sample_time=period
    )
    # At a kink a step errs by more than its estimate says.
    assert found.speed[0] - found.speed[1] == pytest.approx(np.full(6, v), rel=1e-6)


def test_hysteresis_as_viscous_damping() -> None:
    """c = ηk/ω loses 2πη of the largest energy in a cycle: the swing of two discs falls by e^(−πη) each."""
    J, k, eta = np.array([1.0, 3.0]), 5e4, 0.02
    omega = np.sqrt(k * J.sum() / J.prod())
    train = chain(J, [k], damping=viscous(np.array([k]), eta, omega))
    zeta = eta / 2
    period = 2 * np.pi / (omega * np.sqrt(1 - zeta**2))
    found = follow_train(train, duration=20 * period, angle=[0.01, 0.0], accuracy=1e-11, sample_time=period)
    twist = found.angle[0] - found.angle[1]
    assert twist[1:] / twist[:-1] == pytest.approx(
        np.full(20, np.exp(-2 * np.pi * zeta / np.sqrt(1 - zeta**2))), rel=1e-8
    )
    lost = found.potential_energy[0] - found.kinetic_energy[-1] - found.potential_energy[-1]
    assert found.loss["s0"] == pytest.approx(lost, rel=1e-9)


def test_two_phase_short_circuit_from_flux_linkages() -> None:
    """Phases hold their flux linkage while the rotor turns: torque as its product with the current."""
    x, omega, M = 0.16, 2 * np.pi * 50, 900.0
    three, two = (
        short_circuit("x", 1, torque=M, reactance=x, speed=omega, decay=np.inf, phases=phases)
        for phases in (3, 2)
    )
    t = np.linspace(0, 0.04, 801)
    theta = omega * t - np.pi / 2
    # Stator axes α and β of the shorted pair; the flux 1 of the rotor revolves, the stator's β stays.
    current = (np.sin(theta) - np.sin(theta[0])) / x
    by_flux = -M * np.cos(theta) * current
    assert over_time(two, t) == pytest.approx(by_flux, abs=1e-9 * M)
    # Three phases hold both.
    i = np.array([np.cos(theta) - np.cos(theta[0]), np.sin(theta) - np.sin(theta[0])]) / x
    by_flux = -M * (np.cos(theta[0]) * i[1] - np.sin(theta[0]) * i[0])
    assert over_time(three, t) == pytest.approx(by_flux, abs=1e-9 * M)
    assert np.abs(over_time(two, t)).max() == pytest.approx(0.75 * np.sqrt(3) * M / x, rel=1e-4)


def over_time(torques: Sequence[TrainTorque], t: Floats) -> Floats:
    train = chain([1.0, 1.0], [1.0], torques=torques)
    return np.array([train.net_torques(at, np.zeros((1, 2)), np.zeros(2)).torque[0, 1] for at in t.tolist()])


def test_short_circuit_decays_and_is_cleared() -> None:
    torques = short_circuit("x", 1, torque=100.0, reactance=0.2, speed=314.0, decay=0.03, start=0.1, end=0.15)
    t = np.array([0.05, 0.12, 0.2])
    wanted = [0.0, -500 * np.exp(-0.02 / 0.03) * np.sin(314 * 0.02), 0.0]
    assert over_time(torques, t) == pytest.approx(wanted, abs=1e-9)


def test_start_stops_against_its_load() -> None:
    """A constant resistance goes through zero at rest: the disc comes to rest after Jω/M and stays."""
    train = chain([2.0], [], torques=[TrainTorque("brake", 0, -40.0, Power(50.0, 0.0))])
    found = follow_train(train, duration=4.0, speed=50.0)
    falling = found.time < 2.3
    # Softened below a thousandth of 50 rad/s, (ε/u)²/2 off elsewhere.
    assert found.speed[0, falling] == pytest.approx(50 - 20 * found.time[falling], abs=1e-3)
    assert abs(found.speed[0, -1]) < 1e-6
    assert found.work["brake"] == pytest.approx(-0.5 * 2.0 * 50**2, rel=1e-6)


def test_stiff_shafts_take_implicit_steps() -> None:
    """A flange as good as rigid: the method changes by itself, and the slow swing is that of one disc."""
    J, k = [0.6, 0.004, 0.9], [5e4, 4e11]
    torque = TrainTorque("step", 0, 100.0)
    found = follow_train(chain(J, k, torques=[torque]), duration=0.5, sample_time=1e-3)
    assert found.method == "implicit"
    # Three swings, some two hundred steps each; the explicit method would take two million.
    assert found.steps < 5000
    rigid = follow_train(chain([0.6, 0.904], k[:1], torques=[torque]), duration=0.5, sample_time=1e-3)
    assert rigid.method == "explicit"
    assert found.torque[0] == pytest.approx(rigid.torque[0], abs=1e-4 * rigid.torque_max[0])
    with pytest.raises(
        ConvergenceError, match=r"stopped at .* after 2000 steps: .* d1 vibrates .* \"implicit\""
    ):
        follow_train(chain(J, k, torques=[torque]), duration=0.5, method="explicit", steps_max=2000)


def test_loaded_start_is_quiet() -> None:
    """Under constant torques a loaded start has nothing to swing: over a soft curve, a gap, a fluid."""
    x = np.linspace(0, 0.2, 9)
    curve = odd(x, 2e3 * x + 4e5 * x**3, 2e3 + 1.2e6 * x**2)
    torques = [TrainTorque("engine", 0, 900.0), TrainTorque("load", 3, -900.0)]
    curves = [curve, backlash(0.03, 6e4), None, None]
    train = chain(
        [0.5, 0.2, 0.3, 2.0, 0.1],
        [0.0, 0.0, 3e5, 0.0],
        damping=[1, 1, 1, 8.0],
        curves=curves,
        torques=torques,
    )
    found = follow_train(train, duration=1.0, speed=100.0, loaded=True)
    assert found.torque[:3] == pytest.approx(np.full((3, len(found.time)), 900.0), rel=1e-6)
    assert np.ptp(found.speed) < 1e-6
    hard = follow_train(train, duration=1.0, speed=100.0)
    assert hard.torque_max[0] > 1500.0


def test_loaded_start_of_what_speeds_up() -> None:
    """Not balanced: each shaft carries what speeds up the discs behind it."""
    train = chain([0.5, 0.2, 2.0], [3e4, 6e4], torques=[TrainTorque("engine", 0, 270.0)])
    found = follow_train(train, duration=0.2, speed=10.0, loaded=True)
    assert found.torque[0] == pytest.approx(np.full(len(found.time), 270 * 2.2 / 2.7), rel=1e-7)
    assert found.torque[1] == pytest.approx(np.full(len(found.time), 200.0), rel=1e-7)


def test_work_of_a_known_motion() -> None:
    """Steps and evaluations are pinned, so that more of them are noticed."""
    found = follow_train(
        chain([0.4, 0.1, 0.2], [3e4, 5e4], damping=4.0, torques=[sine(1, 50.0, 300.0)]),
        duration=0.5,
        accuracy=1e-9,
    )
    assert isinstance(found, TorsionTransient)
    assert (found.steps, found.steps_rejected, found.evaluations) == (1195, 81, 21694)


def test_wrong_numbers_are_told() -> None:
    train = chain([1.0, 1.0], [1e4])
    for entry, value in (("duration", 0.0), ("duration", np.inf), ("accuracy", 0.5), ("settle", -1.0)):
        with pytest.raises(InputError, match=rf"^{entry}: found"):
            follow_train(train, **{"duration": 1.0, entry: value})
    with pytest.raises(InputError, match=r"^sample_time: found 1e-07 s, expected at least 5e-06 s"):
        follow_train(train, duration=1.0, sample_time=1e-7)
    with pytest.raises(InputError, match=r"^inertia of d1: found 0 kg m²"):
        follow_train(chain([1.0, 0.0], [1e4]), duration=1.0)
    with pytest.raises(InputError, match=r"finite numbers above zero"):
        variable_inertia(0, [1.0, -1.0])
    with pytest.raises(InputError, match=r"differs by .* sample the revolution more finely"):
        variable_inertia(0, 1 + 0.1 * np.cos(TURN), np.cos(TURN))
    with pytest.raises(ShapeError, match=r"expected \(64,\)"):
        variable_inertia(0, 1 + 0.1 * np.cos(TURN), [0.0])


def test_a_torque_that_is_no_number_is_told() -> None:
    curve = smooth([0.0, 1.0], [0.0, 1e308], [1e308, 1e308])
    train = chain([1.0, 1e-300], [1e4], curves=[curve])
    with pytest.raises(ConvergenceError, match=r"stopped at 0 s after 0 steps"):
        follow_train(train, duration=1.0, angle=[9.0, 0.0])
