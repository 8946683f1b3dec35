"""Forced vibration of trains: laws, closed forms, and the matrices solved otherwise."""

import math
from typing import Any

import numpy as np
import pytest
from scipy.linalg import solve

import linkwright as lw
from linkwright import InputError, MachineError, forced_vibration
from linkwright.torsion import excited_train, orders_together, span
from linkwright.torsion.excitation.harmonics import coefficients, waveform
from linkwright.torsion.response.forced import angular_deflection


def machine(**train: Any) -> lw.Machine:
    run = {"speed_min": 5.0, "speed_max": 200.0, "points": 23}
    return lw.Machine.model_validate({"format": 1, "name": "train", "train": {"run": run, **train}})


def two_discs(**shaft: Any) -> lw.Machine:
    return machine(
        discs={"a": {"inertia": 2.0}, "b": {"inertia": 3.0}},
        shafts={"s": {"between": ["a", "b"], "stiffness": 4e4, **shaft}},
        excitations={"e": {"on": "a", "harmonics": [{"order": 2.0, "torque": 10.0, "phase": 0.3}]}},
    )


def geared() -> lw.Machine:
    """Branches, a rigid and an elastic stage, every kind of damping, coupling, dampers, load."""
    return machine(
        discs={
            "a": {"inertia": 1.0, "damping": 0.7},
            "b": {"inertia": 2.0},
            "g": {"inertia": 0.3},
            "h": {"inertia": 0.1},
            "m": {"inertia": 0.2},
            "p": {"inertia": 3.0},
        },
        shafts={
            "ab": {"between": ["a", "b"], "stiffness": 1e5, "loss_factor": 0.02},
            "bg": {"between": ["b", "g"], "stiffness": 2e5, "damping": 3.0},
            "hold": {"between": ["ground", "m"], "stiffness": 50.0, "damping": 0.2},
        },
        gears={
            "rigid": {"between": ["g", "h"], "ratio": 0.4},
            "mesh": {"between": ["g", "m"], "teeth": [20, 30], "stiffness": 3e4, "loss_factor": 0.05},
        },
        couplings={
            "c": {
                "between": ["h", "p"],
                "twist": [0.0, 0.02, 0.05, 0.1],
                "torque": [0.0, 90.0, 300.0, 900.0],
                "loss_factor": 0.1,
            }
        },
        dampers={
            "v": {"on": "a", "ring_inertia": 0.3, "damping": 20.0},
            "r": {"on": "b", "kind": "tuned", "ring_inertia": 0.2, "stiffness": 2e3, "loss_factor": 0.2},
        },
        loads={
            "fan": {"on": "p", "torque": 300.0, "speed": 150.0, "harmonics": [{"order": 4, "share": 0.1}]}
        },
        excitations={
            "e": {"on": "a", "harmonics": [{"order": 1.5, "torque": 30.0}, {"order": 3, "torque": 100.0}]},
            "f": {
                "on": "m",
                "speed": 100.0,
                "exponent": 2.0,
                "harmonics": [{"order": 2, "torque": 5.0, "phase": 1.0}],
            },
        },
    )


def looped() -> lw.Machine:
    return machine(
        discs={name: {"inertia": J} for name, J in (("a", 1.0), ("b", 2.0), ("c", 1.5))},
        shafts={
            pair: {"between": list(pair), "stiffness": k, "damping": 2.0, "loss_factor": 0.01}
            for pair, k in (("ab", 1e4), ("bc", 2e4), ("ca", 3e4))
        },
        excitations={"e": {"on": "b", "harmonics": [{"order": 1, "torque": 7.0}]}},
    )


@pytest.mark.parametrize("train", [geared(), looped()])
def test_against_matrices_of_the_discs(train: lw.Machine) -> None:
    # Lagrange multipliers hold rigid stages, in the discs' own coordinates, so that nothing is referred.
    at = excited_train(train)
    found = forced_vibration(train)
    n = len(found.discs)
    place = {name: k for k, name in enumerate(found.discs)}
    whole = at.train
    speeds = at.torques.speeds
    # What couplings have become under their mean torque; fluids have no stiffness.
    own = np.where(at.referred.stiffness > 0, at.referred.stiffness, 1.0)
    stiffness = at.operating.stiffness / own[:, None]
    for w in range(0, len(speeds), 5):
        for m, order in enumerate(found.orders):
            omega = order * speeds[w]
            A = np.zeros((n, n), complex)
            for name, disc in whole.discs.items():
                damping = disc.damping + at.torques.damping[place[name], w]
                A[place[name], place[name]] += -(omega**2) * disc.inertia + 1j * omega * damping
            rows = []
            for name in found.shafts:
                part = whole.shafts.get(name) or whole.gears[name]
                s = found.shafts.index(name)
                k = part.rate if name in whole.shafts else part.stiffness
                row = _row(part, place, n)
                z = k * stiffness[s, w] * (1 + 1j * part.loss_factor) + 1j * omega * part.damping
                A += z * np.outer(row, row)
                rows.append(z * (row @ found.amplitudes[m, :, w]))
            rigid = [_row(g, place, n) for g in whole.gears.values() if g.stiffness is None]
            B = np.array(rigid).reshape(len(rigid), n)
            full = np.block([[A, B.T * 1e4], [B * 1e4, np.zeros((len(B), len(B)))]])
            M = np.concatenate([at.torques.harmonics[m, :, w], np.zeros(len(B))])
            theta = solve(full, M)[:n]
            # Conditions of 1e6 leave ten digits of a general solver.
            np.testing.assert_allclose(
                found.amplitudes[m, :, w], theta, rtol=1e-9, atol=1e-10 * abs(theta).max()
            )
            np.testing.assert_allclose(found.shaft_torques[m, :, w], rows, rtol=1e-9, atol=1e-9)


def _row(part: Any, place: dict[str, int], n: int) -> np.ndarray:
    """Twist at the first end as a row over the discs."""
    row = np.zeros(n)
    ratio = abs(getattr(part, "speed_ratio", 1.0))
    for end, factor in zip(part.between, (1.0, -ratio), strict=True):
        if end != "ground":
            row[place[end]] = factor
    return row


@pytest.mark.parametrize("train", [geared(), looped(), two_discs(damping=1.0, loss_factor=0.01)])
def test_power_in_is_power_dissipated(train: lw.Machine) -> None:
    found = forced_vibration(train)
    # Far below resonance power is a ten-thousandth of what oscillates.
    np.testing.assert_allclose(found.shaft_heat.sum(0) + found.disc_heat.sum(0), found.power, rtol=1e-9)


def test_two_discs_in_closed_form() -> None:
    found = forced_vibration(two_discs())
    J1, J2, k = 2.0, 3.0, 4e4
    omega = 2 * found.speeds
    # Den Hartog, section 3.2: absorber's equations.
    D = (k - J1 * omega**2) * (k - J2 * omega**2) - k**2
    theta = 10.0 * np.exp(0.3j) * np.array([k - J2 * omega**2, np.full_like(omega, k)]) / D
    np.testing.assert_allclose(found.amplitudes[0], theta, rtol=1e-11)
    np.testing.assert_allclose(found.shaft_torques[0, 0], k * (theta[0] - theta[1]), rtol=1e-10)
    np.testing.assert_allclose(found.shaft_torque_max[0], abs(k * (theta[0] - theta[1])), rtol=1e-10)


def test_unevenness_parts_of_two_discs() -> None:
    found = forced_vibration(two_discs())
    omega = 2 * found.speeds
    rigid = 10.0 / (5.0 * omega**2)
    # One order: δ = 2 ν |θ|, its rigid part from M over the whole inertia.
    np.testing.assert_allclose(found.unevenness, 4 * abs(found.amplitudes[0]), rtol=1e-11)
    np.testing.assert_allclose(found.unevenness_rigid[1], 4 * rigid, rtol=1e-9)
    whole = -rigid * np.exp(0.3j)
    np.testing.assert_allclose(found.unevenness_torsional, 4 * abs(found.amplitudes[0] - whole), rtol=1e-8)


def test_slow_excitation_twists_as_statics() -> None:
    found = forced_vibration(two_discs(), np.array([1e-3]))
    # M splits by inertia: what drives b passes the shaft.
    torque = 10.0 * 3.0 / 5.0
    # Cancellation against q ~ M/(ω² J): ω² J/k = 4e-10 of 1e16.
    assert abs(found.shaft_torques[0, 0, 0]) == pytest.approx(torque, rel=1e-4)
    held = machine(
        discs={"a": {"inertia": 2.0}},
        shafts={"s": {"between": ["a", "ground"], "stiffness": 4e4}},
        excitations={"e": {"on": "a", "harmonics": [{"order": 1, "torque": 8.0}]}},
    )
    slow = forced_vibration(held, np.array([1e-3]))
    assert abs(slow.amplitudes[0, 0, 0]) == pytest.approx(8.0 / 4e4, rel=1e-10)
    assert slow.unevenness_rigid[0, 0] == 0.0


def test_modes_add_up_to_the_direct_solution() -> None:
    # Damping in proportion to the stiffness keeps the undamped shapes.
    beta = 2e-4
    stiffness = [1e4, 3e4, 2e4]
    train = machine(
        discs={name: {"inertia": J} for name, J in zip("abcd", (1.0, 2.0, 0.5, 3.0), strict=True)},
        shafts={
            f"s{n}": {"between": ["abcd"[n], "abcd"[n + 1]], "stiffness": k, "damping": beta * k}
            for n, k in enumerate(stiffness)
        },
        excitations={"e": {"on": "b", "harmonics": [{"order": 1, "torque": 7.0}]}},
    )
    found, free = forced_vibration(train), lw.free_vibration(train)
    omega = found.speeds
    w2 = free.angular_frequencies[:, None] ** 2
    M = 7.0 * free.mode_shapes[:, 1:2]
    x = M / (free.modal_inertia[:, None] * (w2 * (1 + 1j * omega * beta) - omega**2))
    np.testing.assert_allclose(found.amplitudes[0], free.mode_shapes.T @ x, rtol=1e-10, atol=1e-18)


def test_hysteresis_at_resonance() -> None:
    # Held disc: |θ| = M/(η k) at ω² = k/J.
    held = machine(
        discs={"a": {"inertia": 2.0}},
        shafts={"s": {"between": ["a", "ground"], "stiffness": 5e4, "loss_factor": 0.03}},
        excitations={"e": {"on": "a", "harmonics": [{"order": 1, "torque": 8.0}]}},
    )
    found = forced_vibration(held, np.array([math.sqrt(5e4 / 2.0)]))
    assert abs(found.amplitudes[0, 0, 0]) == pytest.approx(8.0 / (0.03 * 5e4), rel=1e-12)


def test_resonance_without_damping_is_no_number() -> None:
    held = machine(
        discs={"a": {"inertia": 1.0}},
        shafts={"s": {"between": ["a", "ground"], "stiffness": 64.0}},
        excitations={"e": {"on": "a", "harmonics": [{"order": 1, "torque": 8.0}]}},
    )
    found = forced_vibration(held, np.array([8.0, 9.0]))
    assert not np.isfinite(found.shaft_torque_max[0, 0])
    assert np.isfinite(found.shaft_torque_max[0, 1])


@pytest.mark.parametrize("table", ["loads", "excitations"])
def test_exponents_beyond_all_laws_are_refused(table: str) -> None:
    entry: dict[str, Any] = {"on": "a", "speed": 1e-4, "exponent": 400.0}
    entry |= {"torque": 1.0} if table == "loads" else {"harmonics": [{"order": 1, "torque": 1.0}]}
    with pytest.raises(MachineError, match=f"train.{table}.x.exponent"):
        machine(discs={"a": {"inertia": 1.0}}, **{table: {"x": entry}})


def test_mean_torques_balance() -> None:
    found = forced_vibration(geared())
    n = found.speeds / 150.0
    fan = 300.0 * (n / 0.4) ** 2
    s = found.shafts.index
    # The first disc drives; the coupling turns 2.5 times as fast.
    np.testing.assert_allclose(found.mean_torques[s("c")], fan, rtol=1e-10)
    np.testing.assert_allclose(
        found.mean_torques[s("ab")] - found.mean_torques[s("mesh")], fan / 0.4, rtol=1e-9
    )


@pytest.mark.parametrize("stiff", [1e4, 1e10, 1e15])
def test_mean_torques_do_not_lose_digits_to_stiff_shafts(stiff: float) -> None:
    row = machine(
        discs={name: {"inertia": 1.0} for name in "abcde"},
        shafts={
            pair: {"between": list(pair), "stiffness": 1e4 if pair == "bc" else stiff}
            for pair in ("ab", "bc", "cd", "de")
        },
        loads={"fan": {"on": "e", "torque": 100.0, "speed": 50.0, "harmonics": [{"order": 2, "share": 0.1}]}},
    )
    # Statics of a row knows no stiffness.
    found = forced_vibration(row, np.array([50.0]))
    np.testing.assert_allclose(found.mean_torques, 100.0, rtol=1e-9)


def test_ways_in_parallel_share_the_mean_torque_by_stiffness() -> None:
    between = ["a", "b"]
    two = machine(
        discs={"a": {"inertia": 2.0}, "b": {"inertia": 3.0}},
        shafts={n: {"between": between, "stiffness": k} for n, k in (("s", 1e4), ("t", 3e4))},
        loads={"fan": {"on": "b", "torque": 100.0, "speed": 50.0, "harmonics": [{"order": 2, "share": 0.1}]}},
    )
    found = forced_vibration(two, np.array([50.0]))
    np.testing.assert_allclose(found.mean_torques[:, 0], [25.0, 75.0], rtol=1e-12)


def test_loads_on_one_disc_pulsate_by_their_own_torques() -> None:
    """The share of each counts its own mean torque: both together are the sum of each alone."""
    loads = {
        "pump": {"torque": 900.0, "speed": 100.0, "harmonics": [{"order": 7.0, "share": 0.05}]},
        "fan": {"torque": 200.0, "speed": 90.0, "exponent": 0, "harmonics": [{"order": 3.0, "share": 0.1}]},
    }
    found = excited_train(
        machine(
            discs={"a": {"inertia": 2.0}, "b": {"inertia": 3.0}},
            shafts={"s": {"between": ["a", "b"], "stiffness": 4e4}},
            loads={name: {"on": "b", **load} for name, load in loads.items()},
        )
    ).torques
    assert found.orders.tolist() == [3.0, 7.0]
    assert np.abs(found.harmonics[0, 1]) == pytest.approx(np.full(23, 0.1 * 200.0), rel=1e-14)
    assert np.abs(found.harmonics[1, 1]) == pytest.approx(
        0.05 * 900.0 * (found.speeds / 100.0) ** 2, rel=1e-14
    )


def test_coupling_stiffens_with_its_mean_torque() -> None:
    coupling = geared().train.couplings["c"]  # type: ignore[union-attr]
    x, y, slopes = coupling.curve()
    np.testing.assert_allclose(coupling.slope(y), slopes, rtol=1e-6)
    # Slope against differences of the inverse, which the integral of 1/slope is.
    torque = np.linspace(0.0, y[-1], 4001)
    middle = 0.5 * (torque[1:] + torque[:-1])
    twist = np.cumsum(np.diff(torque) / coupling.slope(middle))
    np.testing.assert_allclose(np.interp(y[1:], torque[1:], twist), x[1:], rtol=1e-4)


def test_sum_of_orders_in_phase() -> None:
    orders = orders_together(np.array([0.5, 1.0, 1.5, 4.0]))
    assert orders.turns == 2
    random = np.random.default_rng(5)
    c = random.normal(size=(4, 6)) + 1j * random.normal(size=(4, 6))
    greatest, least = span(orders, c, mean=np.arange(6.0))
    fine = waveform(orders, c, np.arange(6.0), points=20001)
    # The finest wave has 2500 points, which miss a top by ½(π/2500)² of it.
    np.testing.assert_allclose(greatest, fine.max(0), rtol=5e-6)
    np.testing.assert_allclose(least, fine.min(0), rtol=1e-5, atol=5e-6)
    assert coefficients(orders, c)[8, 0] == c[3, 0]


def test_orders_behind_a_stage_of_any_ratio_repeat() -> None:
    orders = orders_together(math.sqrt(2) * np.array([1.0, 2.0, 4.5]))
    assert orders.harmonic.tolist() == [2, 4, 9]
    assert orders.turns == pytest.approx(math.sqrt(2), rel=1e-12)


def test_drive_line_swings_as_its_rigid_steady_motion() -> None:
    stiff = lw.read("machines/roller_two_carts.toml", ["drive.crankshaft.stiffness=2e8 N m/rad"])
    steady = lw.steady_state(stiff)
    speed = np.array([steady.speed_mean_time * 9.8])
    found = forced_vibration(stiff, speed)
    # What the linear part leaves out is of the order of δ² (Biezeno and Grammel).
    assert found.unevenness[-1, 0] == pytest.approx(steady.unevenness, rel=0.06)
    assert found.unevenness_rigid[0, 0] == pytest.approx(found.unevenness[-1, 0], rel=1e-3)
    # The motor drives what the mechanism resists.
    assert found.mean_torques[0, 0] == pytest.approx(
        lw.mechanism_harmonics(stiff, speed[0] / 9.8, [0])[0].real * -1
    )


def test_orders_without_a_common_base_add_their_amplitudes() -> None:
    values = np.array([1.0, math.sqrt(2)])
    orders = orders_together(values)
    assert orders.together.tolist() == [True, False]
    greatest, least = span(orders, np.array([[2.0 + 0j], [0.5j]]))
    assert greatest[0] == pytest.approx(2.5, rel=1e-12)
    assert least[0] == pytest.approx(-2.5, rel=1e-12)


def test_amplitudes_of_one_order_and_of_all() -> None:
    found = forced_vibration(geared())
    single, total = angular_deflection(found, "p")
    assert (total <= single.sum(0) * (1 + 1e-12)).all()
    assert (total >= single.max(0) * (1 - 1e-12)).all()


@pytest.mark.parametrize("leave_out", ["excitations", "run"])
def test_nothing_to_compute(leave_out: str) -> None:
    train = two_discs()
    assert train.train is not None
    bare = replace_train(train, **{leave_out: {} if leave_out == "excitations" else None})
    with pytest.raises(InputError, match=r"train\.(excitations|run)"):
        forced_vibration(bare)


def replace_train(owner: lw.Machine, **entries: Any) -> lw.Machine:
    assert owner.train is not None
    return owner.model_copy(update={"train": owner.train.model_copy(update=entries)})


def test_lanes_do_not_mix() -> None:
    train = two_discs(damping=1.0)
    all_speeds = forced_vibration(train)
    for w in (0, 7, 22):
        alone = forced_vibration(train, all_speeds.speeds[w : w + 1])
        np.testing.assert_array_equal(alone.amplitudes[..., 0], all_speeds.amplitudes[..., w])


def test_referred_train_of_any_first_disc() -> None:
    train = geared()
    assert train.train is not None
    last_first = dict(reversed(train.train.discs.items()))
    turned = replace_train(train, discs=last_first, driver="a")
    one = forced_vibration(train)
    # The fan turns 1/0.4 times as fast as the first disc of the other file.
    other = forced_vibration(turned, one.speeds / 0.4)
    for name in one.discs:
        a, b = one.discs.index(name), other.discs.index(name)
        np.testing.assert_allclose(one.unevenness[a], other.unevenness[b], rtol=1e-8)


@pytest.mark.parametrize("listed", [[1e-9, 1.0], [1e-9, 1e9], [0.5, 1.0, 1e9], [1e9], [1e-3, 1e3]])
def test_orders_far_apart_ask_for_no_more_harmonics_than_there_may_be(listed: list[float]) -> None:
    orders = orders_together(np.array(listed))
    assert orders.harmonic.max() <= 512
    top, bottom = span(orders, np.ones((len(listed), 1), complex))
    # One alone repeats; what repeats and what does not reach their peaks together.
    assert top == pytest.approx(len(listed))
    assert -len(listed) - 1e-9 <= bottom <= 0


@pytest.mark.parametrize("speed", [1e200, 1e120, -5.0])
def test_speeds_are_those_of_machines(speed: float) -> None:
    with pytest.raises(InputError, match=r"speeds: found .* at index 1, expected an angular speed"):
        forced_vibration(two_discs(damping=1.0), np.array([10.0, speed]))
