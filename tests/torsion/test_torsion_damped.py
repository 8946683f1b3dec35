"""Free vibration with damping: closed forms, laws, and SciPy's solver on random trains."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eig
from sizes import cases

import linkwright as lw
from linkwright import InputError
from linkwright.kernel.result import finite
from linkwright.torsion.core.train import refer
from linkwright.torsion.modes.damped import DampedVibration, damped_modes

# Rounding of closed forms over a few operations.
ROUNDING = 1e-12

# Ends, stiffness, damping, loss factor.
Shaft = tuple[str, str, float, float, float]


def machine(discs: Mapping[str, tuple[float, float]], shafts: Sequence[Shaft], **tables: Any) -> lw.Machine:
    train = {
        "discs": {name: {"inertia": J, "damping": c} for name, (J, c) in discs.items()},
        "shafts": {
            f"s{n}": {"between": [a, b], "stiffness": k, "damping": c, "loss_factor": eta}
            for n, (a, b, k, c, eta) in enumerate(shafts)
        },
    }
    return lw.Machine.model_validate({"format": 1, "name": "A train", "train": train | tables})


def damped(
    discs: Mapping[str, tuple[float, float]], shafts: Sequence[Shaft], **tables: Any
) -> DampedVibration:
    return lw.damped_vibration(machine(discs, shafts, **tables))


def matrices(discs: Mapping[str, tuple[float, float]], shafts: Sequence[Shaft]) -> tuple[np.ndarray, ...]:
    """J, C, K, H written down by themselves."""
    place = {name: n for n, name in enumerate(discs)}
    J, C = (np.diag(column) for column in np.array(list(discs.values())).T)
    K, H = np.zeros_like(J), np.zeros_like(J)
    for a, b, k, c, eta in shafts:
        row = np.zeros(len(discs))
        for end, sign in ((a, 1.0), (b, -1.0)):
            if end != "ground":
                row[place[end]] = sign
        shape = np.outer(row, row)
        C, K, H = C + c * shape, K + k * shape, H + eta * k * shape
    return J, C, K, H


@pytest.mark.parametrize("c", [0.0, 0.7, 5.0, 40.0])
def test_one_disc(c: float) -> None:
    """J s² + c s + k = 0, beyond critical damping with two real solutions."""
    J, k = 2.0, 18.0
    found = damped({"a": (J, 0.0)}, [("ground", "a", k, c, 0.0)])
    zeta = c / (2 * np.sqrt(J * k))
    if zeta < 1:
        s = 3.0 * (-zeta + 1j * np.sqrt(1 - zeta**2))
        assert found.eigenvalues == pytest.approx([s], rel=ROUNDING)
        assert found.natural_frequencies == pytest.approx([3 / (2 * np.pi)], rel=ROUNDING)
        assert found.damping_ratios == pytest.approx([zeta], abs=ROUNDING)
        decrement = 2 * np.pi * zeta / np.sqrt(1 - zeta**2)
        assert found.logarithmic_decrements == pytest.approx([decrement], abs=ROUNDING)
    else:
        s = 3.0 * np.array([-zeta + np.sqrt(zeta**2 - 1), -zeta - np.sqrt(zeta**2 - 1)])
        assert found.eigenvalues == pytest.approx(s, rel=ROUNDING)
        assert (found.damping_ratios == 1).all()
        assert np.isinf(found.logarithmic_decrements).all()


def test_trains_of_several_kinds_together_have_each_its_closed_form() -> None:
    """Underdamped, overdamped, free without damping and with hysteresis, solved by one call."""
    J, k, eta = 2.0, 18.0, 0.3
    free = np.sqrt(2 * k / J)
    wanted = {
        (1.2, 0.0): [-0.3 + 1j * np.sqrt(9 - 0.09)],
        (40.0, 0.0): [-10 + np.sqrt(91), -10 - np.sqrt(91)],
        (0.0, 0.0): [0, 1j * free],
        (0.0, eta): [0, 1j * free * np.sqrt(1 + 1j * eta)],
    }
    described = [
        machine({"a": (J, 0.0)} | ({} if c else {"b": (J, 0.0)}), [("a", "ground" if c else "b", k, c, loss)])
        for c, loss in wanted
    ]
    trains = [refer(one.train) for one in described if one.train is not None]
    for (s, shapes), expected in zip(damped_modes(trains), wanted.values(), strict=True):
        assert s == pytest.approx(expected, rel=ROUNDING, abs=ROUNDING)
        assert len(shapes) == len(expected)


@pytest.mark.parametrize("eta", [0.01, 0.3, 2.0])
def test_one_disc_with_hysteresis(eta: float) -> None:
    """ω*² = (k/J)(1 + iη): ζ = sin(½ arctan η), about η/2; |s| = ω (1 + η²)^¼."""
    found = damped({"a": (2.0, 0.0)}, [("ground", "a", 18.0, 0.0, eta)])
    assert -(found.eigenvalues**2) == pytest.approx([9 * (1 + 1j * eta)], rel=ROUNDING)
    assert found.damping_ratios == pytest.approx([np.sin(0.5 * np.arctan(eta))], rel=ROUNDING)
    assert found.natural_frequencies == pytest.approx([3 * (1 + eta**2) ** 0.25 / (2 * np.pi)], rel=ROUNDING)


def test_one_disc_with_both() -> None:
    """The solution of J s² + c s + k (1 + iη) = 0 with ω_d > 0."""
    found = damped({"a": (2.0, 0.6)}, [("ground", "a", 18.0, 0.9, 0.2)])
    s = max(np.roots([2.0, 1.5, 18 * (1 + 0.2j)]), key=lambda s: s.imag)
    assert found.eigenvalues == pytest.approx([s], rel=ROUNDING)
    assert s.real < 0
    # By the energy: 2σJ = c + c₀ + ηk/ω_d.
    parts = np.array([0.9 + 0.2 * 18 / s.imag, 0.6])
    assert parts.sum() == pytest.approx(-2 * s.real * 2.0, rel=ROUNDING)
    assert found.shaft_shares[0, 0] == pytest.approx(parts[0] / parts.sum(), rel=ROUNDING)
    assert found.disc_shares[0, 0] == pytest.approx(parts[1] / parts.sum(), rel=ROUNDING)


def test_two_discs() -> None:
    """One against the other: J₁J₂/(J₁ + J₂) s² + c s + k = 0, beside the motion as a whole."""
    found = damped({"a": (2.0, 0.0), "b": (5.0, 0.0)}, [("a", "b", 3e4, 20.0, 0.0)])
    J = 10 / 7
    s = complex(-20, np.sqrt(4 * J * 3e4 - 400)) / (2 * J)
    assert found.eigenvalues[0] == 0
    assert found.eigenvalues[1] == pytest.approx(s, rel=ROUNDING)
    assert found.mode_shapes == pytest.approx(np.array([[1, 1], [1, -0.4]]), abs=ROUNDING)
    assert found.shaft_shares[:, 0].tolist() == [0.0, 1.0]


def test_two_discs_that_the_ground_damps_alike() -> None:
    """c₀ in proportion to J: s² + (c₀/J) s = 0 of the whole; the rest with α = c₀/J."""
    found = damped({"a": (2.0, 0.6), "b": (5.0, 1.5)}, [("a", "b", 3e4, 0.0, 0.0)])
    omega = np.sqrt(3e4 * 0.7)
    vibrating = -0.15 + 1j * np.sqrt(omega**2 - 0.15**2)
    assert found.eigenvalues == pytest.approx([0, -0.3, vibrating], rel=ROUNDING)
    assert found.mode_shapes[1] == pytest.approx([1, 1], rel=1e-9)


@st.composite
def trains(draw: st.DrawFn) -> tuple[dict[str, tuple[float, float]], list[Shaft]]:
    """Trains, held or free, some with a loop, damped anywhere or nowhere."""
    n = draw(st.integers(1, 8))
    number = st.floats(0.05, 20.0)

    def some(scale: float) -> float:
        return scale * draw(number) if draw(st.booleans()) else 0.0

    discs = {f"d{j}": (draw(number), some(0.3)) for j in range(n)}
    shafts = [
        (f"d{j}", f"d{draw(st.integers(0, j - 1))}", 1e3 * draw(number), some(1.0), some(0.02))
        for j in range(1, n)
    ]
    if draw(st.booleans()):
        shafts.append(
            (f"d{draw(st.integers(0, n - 1))}", "ground", 1e3 * draw(number), some(1.0), some(0.02))
        )
    if n > 2 and draw(st.booleans()):
        shafts.append((f"d{n - 1}", "d0", 1e3 * draw(number), some(1.0), some(0.02)))
    return discs, shafts


@given(trains())
@settings(max_examples=cases(150, 1500), deadline=None)
def test_laws_on_any_train(case: tuple[dict[str, tuple[float, float]], list[Shaft]]) -> None:
    found = damped(*case)
    J, C, K, H = matrices(*case)
    s, theta = found.eigenvalues, found.mode_shapes
    # Each mode solves the equation, the rest measured against the torques that meet in it.
    loss = np.where((s.imag > 0)[:, None, None], H, 0.0)
    terms = [s[:, None, None] ** 2 * J, s[:, None, None] * C, np.broadcast_to(K, loss.shape), 1j * loss]
    rest = np.einsum("mij,mj->mi", sum(terms), theta)
    size = np.abs(terms[0] @ theta[:, :, None]).max(axis=(1, 2)) + np.einsum(
        "ij,mj->mi", np.abs(K), np.abs(theta)
    ).max(axis=1)
    # Of what creeps beside stiff shafts, rounding of the fastest mode is left.
    assert (
        np.abs(rest).max(axis=1) <= 1e-9 * size + 1e-10 * np.abs(s).max() * np.abs(s) * np.diag(J).max()
    ).all()
    # All are there: two solutions for every disc, less the speeds of motions that nothing damps.
    pairs = 2 * np.count_nonzero(s.imag > 0) + np.count_nonzero(s.imag == 0)
    undamped = np.count_nonzero(s == 0) - np.count_nonzero(_ground_damps(*case))
    assert pairs + undamped == 2 * len(J)
    # Nothing grows.
    assert (s.real <= 0).all()
    # Shares are shares.
    total = found.shaft_shares.sum(axis=1) + found.disc_shares.sum(axis=1)
    assert total == pytest.approx((s.real < 0).astype(float), abs=1e-9)


def _ground_damps(discs: Mapping[str, tuple[float, float]], shafts: Sequence[Shaft]) -> list[bool]:
    free = not any("ground" in shaft[:2] for shaft in shafts)
    return [free and any(c > 0 for _, c in discs.values())]


@given(trains())
@settings(max_examples=cases(100, 1000), deadline=None)
def test_the_eigenvalues_of_scipy(case: tuple[dict[str, tuple[float, float]], list[Shaft]]) -> None:
    """Linearised in angles and speeds, viscous damping alone."""
    discs, shafts = case[0], [(*shaft[:4], 0.0) for shaft in case[1]]
    found = damped(discs, shafts).eigenvalues
    J, C, K, _ = matrices(discs, shafts)
    zero, one = np.zeros_like(J), np.eye(len(J))
    wanted = eig(np.block([[zero, one], [-K, -C]]), np.block([[one, zero], [zero, J]]), right=False)
    top = np.abs(wanted).max()
    # Where solutions fall together, as s = 0 does for a free train, rounding ε moves them by √ε.
    tolerance = 1e-6 * top
    for each in found:
        assert np.abs(wanted - each).min() <= tolerance
    for each in wanted[wanted.imag > tolerance]:
        assert np.abs(found - each).min() <= tolerance


@given(trains(), st.just(0.0) | st.floats(0.01, 0.5), st.floats(0.0, 1e-4))
@settings(max_examples=cases(50, 500), deadline=None)
def test_proportional_damping(
    case: tuple[dict[str, tuple[float, float]], list[Shaft]], alpha: float, beta: float
) -> None:
    """C = αJ + βK: the shapes are those without damping, s² + (α + βω²) s + ω² = 0 (Rayleigh)."""
    discs = {name: (J, alpha * J) for name, (J, _) in case[0].items()}
    shafts = [(a, b, k, beta * k, 0.0) for a, b, k, _, _ in case[1]]
    found, free = damped(discs, shafts), lw.free_vibration(machine(discs, shafts))
    omega = free.angular_frequencies
    wanted = np.concatenate(
        [np.roots([1.0, alpha + beta * ω**2, ω**2]).astype(complex) for ω in omega.tolist()]
    )
    wanted = wanted[(wanted.imag > 0) | ((wanted.imag == 0) & (wanted != 0))]
    vibrating = found.eigenvalues[found.eigenvalues != 0]
    key = np.lexsort((wanted.imag.round(6), np.abs(wanted).round(6)))
    mine = np.lexsort((vibrating.imag.round(6), np.abs(vibrating).round(6)))
    # Two solutions near critical damping move by √ε; others by rounding of the highest frequency.
    assert vibrating[mine] == pytest.approx(wanted[key], rel=1e-6, abs=1e-9 * omega.max(initial=1.0))


def test_without_damping_it_is_free_vibration() -> None:
    discs = {name: (J, 0.0) for name, J in (("a", 0.4), ("b", 0.05), ("c", 1.1), ("d", 9.0))}
    shafts: list[Shaft] = [("a", "b", 2e4, 0, 0), ("b", "c", 7e4, 0, 0), ("c", "d", 9e4, 0, 0)]
    found, free = damped(discs, shafts), lw.free_vibration(machine(discs, shafts))
    assert found.natural_frequencies == pytest.approx(free.natural_frequencies, rel=ROUNDING)
    assert found.damping_ratios == pytest.approx(np.zeros(4), abs=1e-14)
    assert found.mode_shapes == pytest.approx(free.mode_shapes, abs=1e-9)
    assert not found.shaft_shares.any()


def test_a_gear_counts_by_its_square() -> None:
    """Behind a rigid stage of ratio i inertia, stiffness and damping count by 1/i²."""
    i = 3.0
    gears = {"g": {"between": ["b", "c"], "ratio": i}}
    geared = machine(
        {"a": (0.4, 0.2), "b": (0.05, 0.0), "c": (1.1, 0.4), "d": (9.0, 0.7)},
        [("a", "b", 2e4, 3.0, 0.01), ("c", "d", 9e4, 8.0, 0.05)],
        gears=gears,
    )
    straight = machine(
        {"a": (0.4, 0.2), "b": (0.05 + 1.1 / i**2, 0.4 / i**2), "d": (9.0 / i**2, 0.7 / i**2)},
        [("a", "b", 2e4, 3.0, 0.01), ("b", "d", 9e4 / i**2, 8.0 / i**2, 0.05)],
    )
    one, other = lw.damped_vibration(geared), lw.damped_vibration(straight)
    assert one.eigenvalues == pytest.approx(other.eigenvalues, rel=ROUNDING)
    assert one.shaft_shares == pytest.approx(other.shaft_shares, abs=1e-9)
    discs = one.disc_shares
    assert discs[:, [0, 3]] == pytest.approx(other.disc_shares[:, [0, 2]], abs=1e-9)
    # Behind the stage every amplitude is smaller by the ratio.
    assert one.mode_shapes[:, 2] == pytest.approx(one.mode_shapes[:, 1] / i, abs=1e-12)


@pytest.mark.parametrize("c", [1e-6, 1e7])
def test_a_viscous_ring_turns_freely_or_with_its_disc(c: float) -> None:
    """Hardly damped it stays behind, with its own zero frequency; in stiff oil it is part of the disc."""
    discs = {"a": (2.0, 0.0), "b": (1.0, 0.0)}
    dampers = {"ring": {"on": "b", "ring_inertia": 0.5, "damping": c}}
    found = damped(discs, [("a", "b", 1000.0, 0.0, 0.0)], dampers=dampers)
    J = 1.0 if c < 1 else 1.5
    vibrating = found.eigenvalues.imag > 0
    omega = np.sqrt(1000 * (1 / 2.0 + 1 / J))
    assert found.damped_frequencies[vibrating] == pytest.approx([omega / (2 * np.pi)], rel=1e-6)
    # As a whole, and the ring against the rest; the latter dies out with c/J.
    assert np.count_nonzero(found.eigenvalues == 0) == 2
    creeping = found.eigenvalues[(found.eigenvalues.imag == 0) & (found.eigenvalues != 0)].real
    fast = -c * (1 / 0.5 + 1 / 1.0) if c > 1 else -c * (1 / 0.5 + 1 / 3.0)
    assert creeping == pytest.approx([fast], rel=1e-5)


def test_hysteresis_of_a_shaft_beside_a_viscous_ring() -> None:
    """What creeps has none: as many modes as without, and the same creep."""
    discs = {"a": (2.0, 0.3), "b": (1.0, 0.0)}
    dampers = {"ring": {"on": "b", "ring_inertia": 0.5, "damping": 30.0}}
    plain = damped(discs, [("a", "b", 1000.0, 0.0, 0.0)], dampers=dampers)
    lossy = damped(discs, [("a", "b", 1000.0, 0.0, 0.01)], dampers=dampers)
    creeping = plain.eigenvalues.imag == 0
    assert (lossy.eigenvalues.imag == 0).tolist() == creeping.tolist()
    assert lossy.eigenvalues[creeping] == pytest.approx(plain.eigenvalues[creeping], rel=ROUNDING)
    # To first order ω*² grows by iη times the share of the potential energy, all of it in this shaft.
    assert (lossy.decay_rates > plain.decay_rates)[~creeping].all()


def test_a_propeller_damps_by_the_slope_of_its_torque() -> None:
    """M = M₀ (ω/ω₀)²: c = 2M/ω, by which a single disc comes to its speed as e^(−ct/J)."""
    loads = {"propeller": {"on": "a", "torque": 1000.0, "speed": 20.0, "exponent": 2.0}}
    single = machine({"a": (50.0, 0.0)}, [], loads=loads)
    found = lw.damped_vibration(single, speed=10.0)
    assert found.eigenvalues == pytest.approx([0.0, -2 * 250 / 10 / 50], rel=ROUNDING)
    assert lw.damped_vibration(single).eigenvalues.tolist() == [0.0]


def test_a_coupling_stiffens_under_its_mean_torque() -> None:
    """M = aΔ + bΔ³: at the speed its slope under the load's torque counts."""
    twist = np.linspace(0, 0.5, 2001)
    coupling = {
        "between": ["a", "b"],
        "twist": twist.tolist(),
        "torque": (1e3 * twist + 4e4 * twist**3).tolist(),
    }
    loads = {"pump": {"on": "b", "torque": 300.0, "speed": 50.0, "exponent": 0.0}}
    discs = {"a": (2.0, 0.0), "b": (1.0, 0.0)}
    found = damped_at(discs, coupling, loads, 50.0)
    delta = max(np.roots([4e4, 0, 1e3, -300]), key=lambda x: -abs(x.imag)).real
    k = 1e3 + 3 * 4e4 * delta**2
    # The curve is a table of 2000 steps.
    assert found.natural_frequencies[-1] == pytest.approx(np.sqrt(k * 1.5) / (2 * np.pi), rel=1e-3)


def damped_at(
    discs: Mapping[str, tuple[float, float]],
    coupling: Mapping[str, Any],
    loads: Mapping[str, Any],
    speed: float,
) -> DampedVibration:
    return lw.damped_vibration(machine(discs, [], couplings={"k": coupling}, loads=loads), speed=speed)


def test_phases_of_a_lossy_chain() -> None:
    """Damped by the ground at one end, the discs do not pass zero together."""
    found = damped(
        {"a": (1.0, 8.0), "b": (1.0, 0.0), "c": (1.0, 0.0)}, [("a", "b", 1e3, 0, 0), ("b", "c", 1e3, 0, 0)]
    )
    last = found.mode_shapes[-1]
    assert np.abs(last).max() == pytest.approx(1.0)
    assert np.abs(found.phases[-1]).max() > 0.05
    assert found.amplitudes * np.exp(1j * found.phases) == pytest.approx(found.mode_shapes)


def test_it_goes_into_json() -> None:
    found = damped({"a": (2.0, 0.1), "b": (5.0, 0.0)}, [("a", "b", 3e4, 20.0, 0.0)])
    told = json.loads(json.dumps(finite(found.to_dict(curves=True)), allow_nan=False))
    assert told["natural_frequencies"] == pytest.approx(found.natural_frequencies.tolist())
    assert told["logarithmic_decrements"][1] is None


def test_speeds_and_machines_that_do_not_do() -> None:
    single = machine({"a": (50.0, 0.0)}, [])
    for speed in (0.0, -3.0, float("nan"), float("inf")):
        with pytest.raises(InputError, match="speed"):
            lw.damped_vibration(single, speed=speed)
    with pytest.raises(InputError, match=r"no \[train\]"):
        lw.damped_vibration(lw.loads('format = 1\nname = "x"\n[mechanism]\n'))
