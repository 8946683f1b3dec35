"""Dampers: closed forms against brute force on two masses, designs against the matrices of whole trains."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq
from trains import Gear, Shaft, matrices, text

import linkwright as lw
from linkwright import FindingError, InputError, forced_vibration
from linkwright.torsion.damper.damper_rules import (
    DamperRule,
    hysteretic_heat,
    magnification,
    rubber_rule,
    tuned_rule,
    viscous_heat,
    viscous_rule,
)
from linkwright.torsion.tables.engine import damper_lines

Floats = NDArray[np.float64]

RATIOS = [0.02, 0.1, 0.5, 1.0, 3.0]


def two_masses(mu: float, g: Floats, k: complex = 0.0, zeta: float = 0.0) -> NDArray[np.complex128]:
    """Amplitudes of a mass of 1 on a spring of 1 and of its ring, under a unit torque, by their matrices."""
    joint = k + 2j * zeta * mu * g
    dynamic = np.empty((len(g), 2, 2), complex)
    dynamic[:, 0, 0] = 1 - g**2 + joint
    dynamic[:, 0, 1] = dynamic[:, 1, 0] = -joint
    dynamic[:, 1, 1] = joint - mu * g**2
    return np.linalg.solve(dynamic, np.array([1.0, 0.0])[:, None])[..., 0]


def joint_of(rule: DamperRule) -> complex:
    return rule.mass_ratio * rule.tuning**2 * (1 + 1j * rule.loss_factor)


@pytest.mark.parametrize("mu", RATIOS)
def test_viscous_rule_is_the_least_of_the_largest(mu: float) -> None:
    rule = viscous_rule(mu)
    # The peak is between the frequencies with the ring held fast and with the ring free.
    g = np.linspace(0.95 / np.sqrt(1 + mu), 1.02, 20001)
    peaks = {s: np.abs(two_masses(mu, g, 0.0, s * rule.damping_ratio)[:, 0]).max() for s in (0.97, 1.0, 1.03)}
    # A grid of 20001 points misses a peak by the square of its step.
    assert peaks[1.0] == pytest.approx(rule.magnification, rel=1e-5)
    assert peaks[1.0] == pytest.approx(1 + 2 / mu, rel=1e-5)
    # Away from the best, the peak leaves the fixed point by the square of the change.
    assert peaks[0.97] > peaks[1.0] * (1 + 1e-6)
    assert peaks[1.03] > peaks[1.0] * (1 + 1e-6)
    at = g[np.argmax(np.abs(two_masses(mu, g, 0.0, rule.damping_ratio)[:, 0]))]
    assert at == pytest.approx(rule.fixed_points[0], rel=1e-3)


@pytest.mark.parametrize("mu", RATIOS)
@pytest.mark.parametrize("rule_of", [viscous_rule, tuned_rule, rubber_rule])
def test_all_curves_go_through_the_fixed_points(mu: float, rule_of: object) -> None:
    rule = rule_of(mu)  # type: ignore[operator]
    g = np.array(rule.fixed_points)
    assert len(g) == (1 if rule.tuning == 0 else 2)
    for amount in (1e-3, 0.2, 1.0, 50.0):
        real = mu * rule.tuning**2
        viscous = np.abs(two_masses(mu, g, real, amount)[:, 0])
        assert viscous == pytest.approx([rule.magnification] * len(g), rel=1e-9)
        if real:
            rubber = np.abs(two_masses(mu, g, real * (1 + 1j * amount))[:, 0])
            assert rubber == pytest.approx([rule.magnification] * len(g), rel=1e-9)


@pytest.mark.parametrize("mu", RATIOS)
def test_tuned_rules_are_means_of_the_levels(mu: float) -> None:
    """Squares of the dampings that make the curve level at P and at Q, found by their slopes, averaged."""
    points = tuned_rule(mu).fixed_points
    real = mu / (1 + mu) ** 2
    h = 1e-6

    def slope(at: float, zeta: float, eta: float) -> float:
        low, high = np.abs(two_masses(mu, at + np.array([-h, h]), real * (1 + 1j * eta), zeta)[:, 0])
        return float(high - low)

    viscous = [brentq(lambda z, at=at: slope(at, z, 0.0), 1e-3, 3.0) for at in points]
    assert np.mean(np.square(viscous)) == pytest.approx(tuned_rule(mu).damping_ratio ** 2, rel=1e-5)
    # By the frequency of the ring alone it is Brock's 3μ/(8(1 + μ)).
    own = tuned_rule(mu).damping_ratio / tuned_rule(mu).tuning
    assert own**2 == pytest.approx(3 * mu / (8 * (1 + mu)), rel=1e-12)
    rubber = [brentq(lambda e, at=at: slope(at, 0.0, e), 1e-3, 30.0) for at in points]
    assert np.mean(np.square(rubber)) == pytest.approx(rubber_rule(mu).loss_factor ** 2, rel=1e-5)


@pytest.mark.parametrize(("rule_of", "mu", "above"), [(tuned_rule, 1.0, 0.015), (rubber_rule, 0.2, 0.055)])
def test_how_far_the_tuned_rules_are_from_the_points(rule_of: object, mu: float, above: float) -> None:
    """What the page says: the largest lies a little above the fixed points."""
    rule = rule_of(mu)  # type: ignore[operator]
    g = np.linspace(0.2, 2.0, 20001)
    peak = np.abs(two_masses(mu, g, joint_of(rule), rule.damping_ratio)[:, 0]).max()
    assert rule.magnification < peak < (1 + above) * rule.magnification
    # No other damping or tuning is better by more than that.
    for f, d in ((0.97, 1.0), (1.03, 1.0), (1.0, 0.85), (1.0, 1.3)):
        k = mu * (f * rule.tuning) ** 2 * (1 + 1j * d * rule.loss_factor)
        other = np.abs(two_masses(mu, g, k, d * rule.damping_ratio)[:, 0]).max()
        assert other > rule.magnification


@pytest.mark.parametrize("mu", RATIOS)
def test_magnification_is_that_of_two_masses(mu: float) -> None:
    g = np.linspace(0.05, 2.5, 97)
    for rule in (viscous_rule(mu), tuned_rule(mu), rubber_rule(mu)):
        wanted = np.abs(two_masses(mu, g, joint_of(rule), rule.damping_ratio)[:, 0])
        assert magnification(rule, g) == pytest.approx(wanted, rel=1e-11)


def test_magnification_without_damping_is_infinite_at_resonance() -> None:
    assert magnification(DamperRule(0.1, 0.0, 0.0, 0.0, 0.0, ()), [1.0]) == [np.inf]


def test_heat_is_the_power_that_goes_in() -> None:
    """Two masses have no other loss: ½ Re(M · conj(iωθ)); and the mean of c Δ̇² over a period."""
    mu, g = 0.3, np.array([0.5, 0.9, 1.4])
    theta, ring = two_masses(mu, g, 0.0, 0.2).T
    power = 0.5 * (1j * g * theta).real
    c = 2 * 0.2 * mu
    assert viscous_heat(c, g, theta - ring) == pytest.approx(power.sum(), rel=1e-12)
    t = np.linspace(0, 2 * np.pi / g[1], 1000, endpoint=False)
    rate = (1j * g[1] * (theta - ring)[1] * np.exp(1j * g[1] * t)).real
    assert viscous_heat(c, g[1], (theta - ring)[1]) == pytest.approx((c * rate**2).mean(), rel=1e-12)
    theta, ring = two_masses(mu, g, 0.2 * (1 + 0.4j)).T
    power = 0.5 * (1j * g * theta).real
    assert hysteretic_heat(0.2, 0.4, g, theta - ring) == pytest.approx(power.sum(), rel=1e-12)


# -- designs for trains -----------------------------------------------------------------------------------

ONE = text({"a": 2.0}, [("ground", "a", 5e4)])

DISCS = {"hub": 0.8, "t1": 1.4, "t2": 1.4, "t3": 1.4, "t4": 1.4, "flywheel": 30.0, "wheel": 4.0, "load": 80.0}
SHAFTS: list[Shaft] = [
    ("hub", "t1", 3e6),
    ("t1", "t2", 4e6),
    ("t2", "t3", 4e6),
    ("t3", "t4", 4e6),
    ("t4", "flywheel", 6e6),
    ("wheel", "load", 9e5),
]
GEARS: list[Gear] = [("flywheel", "wheel", 2.0, 5e6)]
TRAIN = text(DISCS, SHAFTS, GEARS)


@pytest.mark.parametrize("ring", [0.04, 0.4, 2.0])
@pytest.mark.parametrize(("kind", "flat"), [("viscous", 1e-5), ("tuned", 0.01), ("rubber", 0.15)])
def test_one_mass_gets_the_closed_form(kind: str, ring: float, flat: float) -> None:
    found = lw.design_damper(lw.loads(ONE), "a", ring, mode=0, kind=kind)
    rule = {"viscous": viscous_rule, "tuned": tuned_rule, "rubber": rubber_rule}[kind](ring / 2)
    omega = np.sqrt(5e4 / 2)
    assert found.mass_ratio == pytest.approx(ring / 2)
    assert found.damping == pytest.approx(2 * ring * omega * rule.damping_ratio)
    assert found.stiffness == pytest.approx(ring * (rule.tuning * omega) ** 2)
    assert found.magnification == rule.magnification
    # The search can do a little better than the fixed points' rule, and not worse.
    assert found.magnification_best <= found.magnification_rule * (1 + 1e-7)
    assert found.magnification_best == pytest.approx(found.magnification_rule, rel=flat)
    if kind == "viscous":
        # Samples of 1500 frequencies and a parabola.
        assert found.magnification_best == pytest.approx(1 + 4 / ring, rel=1e-5)
        assert found.damping_best == pytest.approx(found.damping, rel=1e-2)


def twist_with_ring(on: str, ring: float, joint: complex, c: float, mode: int, omega: Floats) -> Floats:
    """Largest twist over that at rest in the mode, by matrices in which the ring is a disc."""
    J, K = matrices(DISCS, SHAFTS, GEARS)
    free = lw.free_vibration(lw.loads(TRAIN))
    n, at = len(J), list(DISCS).index(on)
    shape = free.mode_shapes[mode]
    J = np.pad(J, (0, 1))
    J[n, n] = ring
    row = np.zeros(n + 1)
    row[at], row[n] = 1.0, -1.0
    M = np.append(np.diag(J)[:n] * shape, 0.0) * free.angular_frequencies[mode] ** 2
    shaft = int(np.argmax(free.potential_shares[mode]))
    ends = np.zeros(n + 1)
    joined = [(a, b, 1.0) for a, b, _ in SHAFTS] + [(a, b, i) for a, b, i, _ in GEARS]
    first, second, ratio = joined[shaft]
    ends[list(DISCS).index(first)], ends[list(DISCS).index(second)] = 1.0, -ratio
    dynamic = np.pad(K, (0, 1)) + 0j - omega[:, None, None] ** 2 * J
    dynamic = dynamic + (joint + 1j * omega * c)[:, None, None] * np.outer(row, row)
    theta = np.linalg.solve(dynamic, M[:, None])[..., 0]
    return np.abs(theta @ ends) / abs(free.twists[mode, shaft])


@pytest.mark.parametrize("mode", [1, 2, 3])
@pytest.mark.parametrize("kind", ["viscous", "tuned", "rubber"])
def test_a_design_is_that_of_the_whole_train(kind: str, mode: int) -> None:
    found = lw.design_damper(lw.loads(TRAIN), "hub", 0.7, mode=mode, kind=kind)
    omega = 2 * np.pi * found.frequencies
    k, c, eta = found.stiffness_best, found.damping_best, found.loss_factor_best
    wanted = twist_with_ring("hub", 0.7, k * (1 + 1j * eta), c, mode, omega)
    # Receptances cancel beside the mode's frequency, where they have their pole: a digit for each decade.
    assert found.response_best == pytest.approx(wanted, rel=1e-8)
    assert found.magnification_best == pytest.approx(wanted.max(), rel=1e-4)
    # A tenth to any side is worse, or as good where the response is flat.
    for dc, dk in ((0.9, 1.0), (1.1, 1.0), (1.0, 0.9), (1.0, 1.1)):
        other = twist_with_ring("hub", 0.7, k * dk * (1 + 1j * eta * dc), c * dc, mode, omega)
        assert other.max() > wanted.max() * (1 - 1e-5)
    assert found.magnification_best <= found.magnification_rule * (1 + 1e-9)


def test_modal_inertia_is_at_the_disc_that_carries() -> None:
    free = lw.free_vibration(lw.loads(TRAIN))
    J = np.array(list(DISCS.values()))
    for on in ("hub", "t3", "load"):
        found = lw.design_damper(lw.loads(TRAIN), on, 0.3, mode=2)
        shape = free.mode_shapes[2] / free.mode_shapes[2][list(DISCS).index(on)]
        assert found.modal_inertia == pytest.approx(float(J @ shape**2), rel=1e-12)
        assert found.natural_frequency == free.natural_frequencies[2]


def test_behind_a_gear_everything_counts_by_the_square_of_the_ratio() -> None:
    """A rigid stage of 3: a ring and a damping nine times as large there do the same."""
    discs = {"a": 1.0, "b": 2.7, "c": 9.0}
    machine = lw.loads(text(discs, [("a", "ground", 4e4), ("b", "c", 2e5)], [("a", "b", 3.0, None)]))
    here = lw.design_damper(machine, "a", 0.1, mode=0, kind="tuned")
    there = lw.design_damper(machine, "b", 0.9, mode=0, kind="tuned")
    assert there.damping_best == pytest.approx(9 * here.damping_best, rel=1e-9)
    assert there.stiffness_best == pytest.approx(9 * here.stiffness_best, rel=1e-9)
    assert there.magnification_best == pytest.approx(here.magnification_best, rel=1e-9)


def test_rubber_at_hand() -> None:
    """With its loss given, only the stiffness is sought."""
    found = lw.design_damper(lw.loads(TRAIN), "hub", 0.7, mode=1, kind="rubber", loss_factor=0.1)
    assert found.loss_factor == found.loss_factor_best == 0.1
    assert found.damping_best == 0
    free = lw.design_damper(lw.loads(TRAIN), "hub", 0.7, mode=1, kind="rubber")
    assert free.magnification_best < found.magnification_best < found.magnification_rule


@pytest.mark.parametrize("kind", ["viscous", "tuned", "rubber"])
def test_the_written_damper_does_what_was_promised(kind: str) -> None:
    """As a part of the machine file, under a torque on the disc, with what the forced vibration finds."""
    found = lw.design_damper(lw.loads(ONE), "a", 0.4, mode=0, kind=kind)
    file = ONE + damper_lines(found) + "[train.excitations.pulse]\n"
    file += 'on = "a"\nharmonics = [{ order = 1, torque = 50 }]\n'
    speeds = 2 * np.pi * found.frequencies
    forced = forced_vibration(lw.loads(file), speeds)
    theta = np.abs(forced.amplitudes[0, forced.discs.index("a")]) * 5e4 / 50
    # Numbers in the file have six digits; where the response is steep that counts tenfold.
    assert theta == pytest.approx(found.response_best, rel=1e-4)
    # A damper that the train has is left out of the next design.
    again = lw.design_damper(lw.loads(file), "a", 0.4, mode=0, kind=kind)
    assert again.damping_best == found.damping_best
    # The heat of its ring is the closed form's.
    twist = forced.amplitudes[0, forced.discs.index("damper")] - forced.amplitudes[0, 0]
    n = int(np.argmax(theta))
    heat = viscous_heat(found.damping_best, speeds[n], twist[n])
    heat += hysteretic_heat(found.stiffness_best, found.loss_factor_best, speeds[n], twist[n])
    assert forced.shaft_heat[forced.shafts.index("damper"), n] == pytest.approx(heat, rel=1e-4)


def test_a_disc_at_rest_carries_no_damper() -> None:
    machine = lw.loads(text({"hub": 1.0, "a": 2.0, "b": 2.0}, [("hub", "a", 18.0), ("hub", "b", 18.0)]))
    with pytest.raises(FindingError, match=r"hub is at rest in mode 1.*has no effect"):
        lw.design_damper(machine, "hub", 0.1)


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ({"on": "hubb"}, 'on: found "hubb".*did you mean "hub"'),
        ({"mode": 0}, "mode: found 0, expected one of 1 to 7"),
        ({"mode": 8}, "mode: found 8, expected one of 1 to 7"),
        ({"ring_inertia": 0.0}, "ring_inertia: found 0"),
        ({"ring_inertia": float("nan")}, "ring_inertia: found nan"),
        ({"kind": "magnetic"}, "kind: found"),
        ({"loss_factor": 0.1}, "loss_factor: found 0.1"),
        ({"kind": "rubber", "loss_factor": -0.1}, "loss_factor: found -0.1"),
    ],
)
def test_wrong_input(entries: dict[str, object], words: str) -> None:
    given: dict[str, object] = {"on": "hub", "ring_inertia": 0.3, "mode": 1, **entries}
    with pytest.raises(InputError, match=words):
        lw.design_damper(lw.loads(TRAIN), **given)  # type: ignore[arg-type]


@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf")])
@pytest.mark.parametrize("rule_of", [viscous_rule, tuned_rule, rubber_rule])
def test_wrong_mass_ratio(value: float, rule_of: object) -> None:
    with pytest.raises(InputError, match="mass_ratio"):
        rule_of(value)  # type: ignore[operator]


def test_the_first_mode_that_twists_is_taken() -> None:
    """Of a train that is held it is mode 0, of a free one mode 1."""
    for file, on, first in ((ONE, "a", 0), (TRAIN, "hub", 1)):
        machine = lw.loads(file)
        assert lw.design_damper(machine, on, 0.4).mode == first
    with pytest.raises(InputError, match="found 1, expected 0, its only mode"):
        lw.design_damper(lw.loads(ONE), "a", 0.4, mode=1)
