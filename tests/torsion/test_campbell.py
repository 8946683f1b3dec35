"""Campbell's diagram: critical speeds where ω = νΩ, severities against closed forms and forced vibration."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError, forced_vibration
from linkwright.torsion.figures.modes import campbell_figure

J1, J2, K = 2.0, 5.0, 3e4
OMEGA = np.sqrt(K * (J1 + J2) / (J1 * J2))


def two_discs(c: float = 0.0, eta: float = 0.0, **tables: Any) -> lw.Machine:
    shaft = {"between": ["a", "b"], "stiffness": K, "damping": c, "loss_factor": eta}
    train = {"discs": {"a": {"inertia": J1}, "b": {"inertia": J2}}, "shafts": {"s": shaft}}
    return lw.Machine.model_validate({"format": 1, "name": "Two discs", "train": train | tables})


def chain(n: int, c: float, excitations: dict[str, Any] | None = None, **tables: Any) -> lw.Machine:
    random = np.random.default_rng(n)
    discs = {f"d{j}": {"inertia": J} for j, J in enumerate(random.uniform(0.5, 2.0, n).tolist())}
    shafts = {
        f"s{j}": {"between": [f"d{j}", f"d{j + 1}"], "stiffness": k, "damping": c}
        for j, k in enumerate(random.uniform(1e4, 4e4, n - 1).tolist())
    }
    train = {"discs": discs, "shafts": shafts, "excitations": excitations or {}}
    return lw.Machine.model_validate({"format": 1, "name": "A chain", "train": train | tables})


def test_every_mode_and_order_in_the_range() -> None:
    """Ω = ω/ν, by speed, none outside, none of the motion as a whole."""
    machine, orders = chain(6, 0.0), [0.5, 1.0, 2.5, 4.0, 6.0, 13.5]
    free = lw.free_vibration(machine)
    omega = free.angular_frequencies
    low, high = 20.0, 130.0
    wanted = sorted(
        (w / order, order, mode)
        for mode, w in enumerate(omega.tolist())
        for order in orders
        if w > 0 and low <= w / order <= high
    )
    assert len(wanted) > 8
    for source in (machine, free):
        found = lw.campbell(source, orders, (low, high))
        assert [each.speed for each in found.critical] == pytest.approx([each[0] for each in wanted])
        assert [(each.order, each.mode) for each in found.critical] == [each[1:] for each in wanted]
        assert [each.frequency for each in found.critical] == pytest.approx(
            [each[0] * each[1] / (2 * np.pi) for each in wanted], rel=1e-12
        )
        assert found.frequencies[:, 0] == pytest.approx(free.natural_frequencies)


def test_a_critical_speed_at_an_end_of_the_range_counts_once() -> None:
    free = lw.free_vibration(two_discs())
    omega = float(free.angular_frequencies[1])
    for ends in ((omega / 2, omega), (omega / 4, omega / 2)):
        found = lw.campbell(free, [2.0], ends)
        assert [each.speed for each in found.critical] == pytest.approx([omega / 2], rel=1e-14)


def test_severity_of_two_discs() -> None:
    """θ = (1, −J₁/J₂); Σ M θ; ω² Σ J θ² = K (1 + J₁/J₂)²; ζ = c (1 + J₁/J₂)²/(2ω Σ J θ²) + η/2."""
    excitation = np.array([[3.0 + 4.0j, 0.0], [2.0, 5.0]])
    found = lw.campbell(two_discs(c=20.0, eta=0.01), [1.0, 2.0], (10.0, 200.0), excitation=excitation)
    second, first = found.critical
    assert (second.order, first.order) == (2.0, 1.0)
    ratio = 1 + J1 / J2
    zeta = 20.0 * ratio**2 / (2 * OMEGA * (J1 + J1**2 / J2)) + 0.005
    for each, work in ((first, 5.0), (second, abs(2.0 - 5.0 * J1 / J2))):
        assert each.vector_sum == pytest.approx(work, abs=1e-12)
        assert each.equilibrium_amplitude == pytest.approx(work / (K * ratio**2), abs=1e-15)
        assert each.damping_ratio == pytest.approx(zeta, rel=1e-12)
        assert each.resonance_amplitude == pytest.approx(work / (K * ratio**2) / (2 * zeta), abs=1e-15)


def test_torques_that_cancel_in_a_mode_are_harmless() -> None:
    """As many in phase at the node's both sides as the shape asks for: the sum is zero."""
    found = lw.campbell(two_discs(), [1.0], (10.0, 200.0), excitation=np.array([[2.0, 5.0]]))
    (each,) = found.critical
    assert each.vector_sum == pytest.approx(0.0, abs=1e-12)
    assert lw.campbell(two_discs(), [1.0], (10.0, 200.0)).critical[0].vector_sum is None


def test_without_damping_resonance_is_infinite() -> None:
    (each,) = lw.campbell(two_discs(), [1.0], (10.0, 200.0), excitation=np.array([[2.0, 0.0]])).critical
    assert each.resonance_amplitude == np.inf
    given = lw.campbell(
        two_discs(), [1.0], (10.0, 200.0), excitation=np.array([[2.0, 0.0]]), damping_ratios=0.01
    ).critical[0]
    assert given.resonance_amplitude == pytest.approx(50 * given.equilibrium_amplitude)


def test_forced_vibration_at_a_critical_speed() -> None:
    """Lightly damped, the mode in resonance is nearly all: what the others add is of the order of ζ."""
    waves = [{"order": 2.0, "torque": 30.0, "phase": 0.3}, {"order": 3.5, "torque": 8.0, "phase": 1.0}]
    excitations = {"e": {"on": "d1", "harmonics": waves}, "f": {"on": "d3", "harmonics": waves[:1]}}
    run = {"speed_min": 15.0, "speed_max": 150.0}
    machine = chain(5, 0.02, excitations, run=run)
    found = lw.campbell(machine)
    assert found.orders.tolist() == [2.0, 3.5]
    assert (found.speeds[0], found.speeds[-1]) == (15.0, 150.0)
    assert len(found.critical) > 3
    shapes = lw.free_vibration(machine).mode_shapes
    for each in found.critical:
        forced = forced_vibration(machine, np.array([each.speed]))
        row = found.orders.tolist().index(each.order)
        amplitudes = np.abs(forced.amplitudes[row, :, 0])
        largest = int(np.argmax(np.abs(shapes[each.mode])))
        assert each.damping_ratio is not None
        assert amplitudes[largest] == pytest.approx(
            each.resonance_amplitude, rel=20 * each.damping_ratio + 1e-3
        )


def test_a_light_damping_ratio_is_that_of_the_damped_mode() -> None:
    """First order in c; the second is left out."""
    machine = chain(5, 0.5)
    damped = lw.damped_vibration(machine)
    for each in lw.campbell(machine, [1.0], (1.0, 400.0)).critical:
        exact = damped.damping_ratios[each.mode]
        assert each.damping_ratio == pytest.approx(exact, rel=exact + 1e-3)


def test_a_coupling_that_stiffens_bends_the_lines() -> None:
    """Under M ∝ Ω² the slope of M = aΔ + bΔ³ rises: Ω solves ω(Ω) = νΩ."""
    twist = np.linspace(0.0, 1.0, 201)
    couplings = {
        "k": {
            "between": ["a", "b"],
            "twist": twist.tolist(),
            "torque": (1e3 * twist + 4e4 * twist**3).tolist(),
        }
    }
    loads = {"fan": {"on": "b", "torque": 2000.0, "speed": 100.0, "exponent": 2.0}}
    train = {"discs": {"a": {"inertia": J1}, "b": {"inertia": J2}}, "couplings": couplings, "loads": loads}
    machine = lw.Machine.model_validate({"format": 1, "name": "Coupled", "train": train})
    found = lw.campbell(machine, [1.0, 2.0], (5.0, 100.0))
    assert np.ptp(found.frequencies[1]) > 1.0

    def omega(speed: float) -> float:
        mean = 2000.0 * (speed / 100) ** 2
        delta = float(max(np.roots([4e4, 0, 1e3, -mean]), key=lambda x: -abs(x.imag)).real)
        return float(np.sqrt((1e3 + 1.2e5 * delta**2) * (J1 + J2) / (J1 * J2)))

    assert found.critical
    for each in found.critical:
        # The curve is a table of 200 steps.
        assert omega(each.speed) == pytest.approx(each.order * each.speed, rel=1e-3)
        assert 2 * np.pi * each.frequency == pytest.approx(each.order * each.speed, rel=1e-9)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"orders": [], "speed_range": (1.0, 2.0)}, "orders"),
        ({"orders": [1.0, -2.0], "speed_range": (1.0, 2.0)}, "orders"),
        ({"orders": [1.0], "speed_range": (3.0, 2.0)}, "speed_range"),
        ({"orders": [1.0]}, r"speed"),
        ({"speed_range": (1.0, 2.0)}, "nothing excites"),
        ({"orders": [1.0], "speed_range": (1.0, 2.0), "excitation": np.zeros((2, 2))}, "excitation"),
        ({"orders": [1.0], "speed_range": (1.0, 2.0), "damping_ratios": np.zeros(7)}, "damping_ratios"),
        ({"orders": [1.0], "speed_range": (1.0, 2.0), "damping_ratios": -0.1}, "damping_ratios"),
    ],
)
def test_what_is_missing_is_told(arguments: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        lw.campbell(two_discs(), **arguments)


@pytest.mark.parametrize("exponent", [0.0, 1.0, 2.0])
@pytest.mark.parametrize("zeta", [0.0, 0.02, 0.1, 0.3])
def test_peak_of_the_mode_alone_beside_the_crossing(zeta: float, exponent: float) -> None:
    """Damping in proportion to the inertias leaves one mode: its largest twist, by dense speeds.

    Trains of several modes peak elsewhere: `test_critical_response.py`.
    """
    c = 2 * zeta * OMEGA
    discs = {"a": {"inertia": J1, "damping": c * J1}, "b": {"inertia": J2, "damping": c * J2}}
    pulse = {"on": "a", "harmonics": [{"order": 2.0, "torque": 50.0}], "speed": 50.0, "exponent": exponent}
    machine = two_discs(discs=discs, excitations={"e": pulse})
    (found,) = lw.campbell(machine, [2.0], (20.0, 200.0)).critical
    assert found.peak_speed is not None
    if zeta == 0:
        assert found.peak_speed == pytest.approx(found.speed, rel=1e-9)
        return
    beside = found.peak_speed * np.linspace(0.9, 1.1, 201)
    twist = np.abs(forced_vibration(machine, beside).shaft_torques[0, 0])
    # The speeds looked at are a thousandth apart.
    assert beside[twist.argmax()] == pytest.approx(found.peak_speed, rel=1.001e-3)


@pytest.mark.parametrize("exponent", [0.0, 2.0])
def test_no_peak_of_a_machine_whose_damping_is_strong(exponent: float) -> None:
    """From ζ = 1/√2 on; rounding of the exponent once made peaks at 0 and at 4e6 times the speed."""
    c = 2 * 0.8 * OMEGA
    discs = {"a": {"inertia": J1, "damping": c * J1}, "b": {"inertia": J2, "damping": c * J2}}
    pulse = {"on": "a", "harmonics": [{"order": 2.0, "torque": 50.0}], "speed": 47.0, "exponent": exponent}
    for top in (200.0, 210.0, 220.0, 230.0):
        machine = two_discs(discs=discs, excitations={"e": pulse})
        (found,) = lw.campbell(machine, [2.0], (20.0, top)).critical
        assert found.peak_speed is None


def test_no_peak_where_damping_is_strong() -> None:
    """From ζ = 1/√2 on the answer to a constant torque only falls with the speed."""
    free = lw.free_vibration(two_discs())
    (found,) = lw.campbell(free, [2.0], (20.0, 200.0), damping_ratios=0.71).critical
    assert found.peak_speed is None


def test_free_vibration_alone_asks_for_both() -> None:
    free = lw.free_vibration(two_discs())
    with pytest.raises(InputError, match="speed_range"):
        lw.campbell(free, [1.0])
    with pytest.raises(InputError, match="orders"):
        lw.campbell(free, speed_range=(1.0, 2.0))


def test_figure() -> None:
    """A line a mode above zero, a ray an order, points as large as they are severe."""
    waves = [{"order": n / 2, "torque": 30.0 / n} for n in range(1, 13)]
    machine = chain(
        6, 0.05, {"e": {"on": "d1", "harmonics": waves}}, run={"speed_min": 15.0, "speed_max": 150.0}
    )
    found = lw.campbell(machine)
    axes = campbell_figure(found).axes[0]
    assert len(axes.lines) == len(found.orders) + 5
    (points,) = axes.collections
    sizes = points.get_sizes()
    amplitudes = np.array([each.resonance_amplitude for each in found.critical])
    assert np.argmax(sizes) == np.argmax(amplitudes)
    assert sizes[amplitudes.argmax()] > 10 * sizes.min()
    plain = campbell_figure(lw.campbell(machine, [40.0], (15.0, 16.0))).axes[0]
    assert not plain.get_legend_handles_labels()[0] or not plain.collections


def test_orders_stand_free_of_the_legend() -> None:
    """Numbers on the upper edge and the legend above it share no place."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    found = lw.campbell(two_discs(), np.arange(0.5, 8.1, 0.5), (10.0, 200.0), excitation=np.ones((16, 2)))
    canvas = FigureCanvasAgg(campbell_figure(found))
    canvas.draw()
    axes = canvas.figure.axes[0]
    legend, renderer = axes.get_legend().get_window_extent(), canvas.get_renderer()
    words = [text for text in axes.texts if text.get_window_extent(renderer).overlaps(legend)]
    assert len(axes.texts) > 4
    assert [text.get_text() for text in words] == []
