"""Vibration of the follower: closed forms, integration in time, energy, Parseval, and the polydyne lift."""

from __future__ import annotations

import numpy as np
import pytest
from cam_laws import (
    CYCLOIDAL,
    HARMONIC,
    PARABOLIC,
    POLYNOMIAL_345,
    POLYNOMIAL_4567,
    POLYNOMIAL_56789,
    SKEW,
    UNEQUAL,
    UNIFORM,
    turn,
)
from scipy.integrate import quad, solve_ivp

from linkwright import (
    FindingError,
    InputError,
    OneMass,
    follower_vibration,
    polydyne,
    residual_over_speed,
    residual_spectrum,
    vibration_over_speed,
)
from linkwright.cam import MotionLaw
from linkwright.cam.dynamics.oscillator import continuity, steps
from linkwright.cam.dynamics.residual_vibration import residual_amplitude

# Everything at once: damper in the train and to the frame, closing spring, preload.
FULL = OneMass(0.8, 3e5, 0.04, 0.03, 2e4, 150.0)
LIFT = turn(POLYNOMIAL_345, 0.012)

# Off the zeros of numerator and denominator of the closed forms.
TAU = np.linspace(0.2, 30.0, 150) + 0.00123

# Of three motions at once, the first is that under the lift.
FORCED = np.array([1.0, 0.0, 0.0])

CLOSED = {
    "cycloidal": (CYCLOIDAL, lambda t: np.abs(np.sin(np.pi * t)) / (np.pi * t * np.abs(1 - t**2))),
    "harmonic": (HARMONIC, lambda t: np.abs(np.cos(np.pi * t)) / np.abs(4 * t**2 - 1)),
    "parabolic": (PARABOLIC, lambda t: 4 * np.sin(np.pi * t / 2) ** 2 / (np.pi * t) ** 2),
    # Two impulses of 1/T, half a period of the beat apart: 2|sin πτ|/(2πτ).
    "uniform": (UNIFORM, lambda t: np.abs(np.sin(np.pi * t)) / (np.pi * t)),
}


def periodic(lift: MotionLaw, model: OneMass, speed: float) -> np.ndarray:
    """x and ẋ that come back after a revolution: m ẍ = k(s − x) + c(ṡ − ẋ) − k_r x − c_f ẋ, piece by piece.

    The equation is linear, so that a revolution makes Φ y + d of y: integrated from rest, which gives d, and
    without the lift from (1, 0) and (0, 1), which gives Φ.
    """
    c = 2 * model.damping_ratio * np.sqrt((model.stiffness + model.spring_rate) * model.mass)
    c_f = c / model.damping_ratio * model.damping_ratio_frame

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        s, v = float(lift.at(speed * t)), float(lift.at(speed * t, 1)) * speed
        x, w = y[:3], y[3:]
        force = model.stiffness * (s * FORCED - x) + c * (v * FORCED - w) - model.spring_rate * x - c_f * w
        return np.concatenate([w, force / model.mass])

    # All three motions have errors of the same size: (1, 0) and (0, 1) are taken in the size of the first.
    size = np.array([0.012, 0.012 * model.natural_frequency])
    y = np.array([0.0, size[0], 0.0, 0.0, 0.0, size[1]])
    for low, high in zip(lift.breaks, lift.breaks[1:], strict=False):
        # A little inside, so that the piece is the one meant; the gap is below rounding of the answer.
        span = low / speed + 1e-15, high / speed - 1e-15
        y = solve_ivp(rate, span, y, method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    d, *columns = y.reshape(2, 3).T
    return np.linalg.solve(np.eye(2) - np.column_stack(columns) / size, d)


@pytest.mark.parametrize("name", CLOSED)
def test_residual_of_an_undamped_follower(name: str) -> None:
    law, closed = CLOSED[name]
    np.testing.assert_allclose(residual_amplitude(law, TAU), closed(TAU), rtol=0, atol=5e-14)
    # The spectrum says the same, with what the rise itself does, which takes longer.
    some = TAU[::15]
    np.testing.assert_allclose(residual_spectrum(law, some).residual, closed(some), rtol=0, atol=5e-14)


@pytest.mark.parametrize(
    ("name", "first", "step"), [("cycloidal", 2, 1), ("harmonic", 1.5, 1), ("uniform", 1, 1)]
)
def test_zeros_of_the_residual(name: str, first: float, step: float) -> None:
    quiet = residual_spectrum(CLOSED[name][0], [0.3, 8.2]).quiet
    expected = np.arange(first, 8.2, step)
    np.testing.assert_allclose([each.ratio for each in quiet], expected, rtol=1e-13)
    assert max(each.residual for each in quiet) < 1e-15


def test_zeros_of_the_parabolic_law_are_double() -> None:
    """sin²(πτ/2): the amplitude's square is flat to third order, a zero good to a cube root of rounding."""
    quiet = residual_spectrum(PARABOLIC, [0.3, 8.2]).quiet
    np.testing.assert_allclose([each.ratio for each in quiet], [2, 4, 6, 8], rtol=1e-5)


def test_a_law_without_symmetry_is_rarely_quiet() -> None:
    # One jump, at the end, is larger than all else: the residual only falls.
    assert residual_spectrum(SKEW, [0.3, 8.2]).quiet == ()
    found = residual_spectrum(UNEQUAL, [0.3, 8.2])
    near = np.array([each.ratio for each in found.quiet])
    left = np.array([each.residual for each in found.quiet])
    assert len(near) > 3
    # The transform is zero only where 0.4 ν and 0.6 ν are both whole revolutions: once, at τ = 5.
    whole = np.abs(near - 5) < 1e-4
    assert left[whole] == pytest.approx([0.0], abs=1e-9)
    assert (left[~whole] > 1e-6).all()
    # Minima indeed: the residual is larger on both sides.
    for aside in (-1e-3, 1e-3):
        assert (residual_amplitude(UNEQUAL, near + aside) > left).all()


@pytest.mark.parametrize(
    ("law", "order"),
    [(UNIFORM, 1), (PARABOLIC, 2), (HARMONIC, 2), (CYCLOIDAL, 3), (POLYNOMIAL_345, 3), (POLYNOMIAL_4567, 4)],
)
def test_residual_falls_by_the_first_derivative_that_jumps(law: MotionLaw, order: int) -> None:
    """The envelope falls like τ⁻ᵏ, k the order of the first derivative that jumps (integration by parts)."""
    near, far = (residual_amplitude(law, np.linspace(a, a + 4, 801)).max() for a in (40.0, 80.0))
    # The window moves along the envelope itself: a few percent over its 4 periods.
    assert np.log2(near / far) == pytest.approx(order, abs=0.1)
    assert continuity(law, "dwell") == order - 1


def test_parseval() -> None:
    """∫|F|² dν over all ν = 2π∫s″² du; F is ν times the residual. The tail beyond falls like ν⁻⁶."""
    tau = np.linspace(1e-6, 40.0, 8001)
    square = (2 * np.pi * tau * residual_amplitude(POLYNOMIAL_4567, tau)) ** 2
    total = 2 * np.trapezoid(square, 2 * np.pi * tau)
    assert total == pytest.approx(2 * np.pi * POLYNOMIAL_4567.integral_of_square(2), rel=1e-6)


def test_damped_residual_and_primary_against_integration() -> None:
    tau, zeta, zeta_f, share = 2.3, 0.07, 0.02, 0.9
    omega = 2 * np.pi * tau
    k, total = share * omega**2, omega**2

    def rate(u: float, y: np.ndarray) -> list[float]:
        s, v = float(SKEW.at(u)), float(SKEW.at(u, 1))
        force = k * s - total * y[0] + 2 * zeta * omega * (v - y[1]) - 2 * zeta_f * omega * y[1]
        return [y[1], force]

    out = solve_ivp(rate, (0, 1), [0, 0], method="DOP853", rtol=1e-12, atol=1e-14, dense_output=True)
    x, v = out.y[:, -1]
    z = x - share
    amplitude = np.hypot(z, (v + (zeta + zeta_f) * omega * z) / (omega * np.sqrt(1 - (zeta + zeta_f) ** 2)))
    found = residual_spectrum(SKEW, tau, damping_ratio=zeta, damping_ratio_frame=zeta_f, share=share)
    assert found.residual[0] == pytest.approx(amplitude, rel=1e-9)
    u = np.linspace(0, 1, 20001)
    path = out.sol(u)
    departure = np.abs(path[0] - share * SKEW.at(u)).max()
    damping = 2 * omega * (zeta * (SKEW.at(u, 1) - path[1]) - zeta_f * path[1])
    rates = k * SKEW.at(u) - total * path[0] + damping
    # The scan misses the tops by the square of its step, the integration errs by 1e-10.
    assert found.primary[0] == pytest.approx(departure, rel=1e-7)
    assert found.primary_acceleration[0] == pytest.approx(np.abs(rates).max(), rel=1e-7)


@pytest.mark.parametrize("law", [POLYNOMIAL_345, UNIFORM], ids=["smooth", "striking"])
@pytest.mark.parametrize("speed", [8.0, 60.0, 400.0, 3000.0])
def test_periodic_motion_against_integration(speed: float, law: MotionLaw) -> None:
    lift = turn(law, 0.012)
    x, v = periodic(lift, FULL, speed)
    found = follower_vibration(lift, FULL, speed)
    scale = np.abs(found.position).max()
    assert found.position[0] == pytest.approx(x, abs=1e-8 * scale)
    assert found.velocity[0] == pytest.approx(v, abs=1e-8 * np.abs(found.velocity).max())
    assert found.position[-1] == pytest.approx(found.position[0], abs=1e-13 * scale)


def test_equation_of_motion_holds_in_every_row() -> None:
    found = follower_vibration(LIFT, FULL, 90.0)
    c_f = 2 * FULL.damping_ratio_frame * FULL.natural_frequency * FULL.mass
    right = found.force - FULL.preload - FULL.spring_rate * found.position - c_f * found.velocity
    np.testing.assert_allclose(
        FULL.mass * found.acceleration, right, rtol=0, atol=1e-11 * np.abs(right).max()
    )
    train = FULL.stiffness * (found.lift - found.position)
    train += FULL.damping * (LIFT.at(found.cam_angle, 1) * 90.0 - found.velocity)
    np.testing.assert_allclose(found.force - FULL.preload, train, rtol=0, atol=1e-9 * np.abs(train).max())


def test_work_of_the_cam_goes_into_the_dampers() -> None:
    speed, n = 90.0, 7200
    found = follower_vibration(LIFT, FULL, speed, n)
    v = LIFT.at(found.cam_angle, 1) * speed
    c_f = 2 * FULL.damping_ratio_frame * FULL.natural_frequency * FULL.mass
    lost = FULL.damping * (v - found.velocity) ** 2 + c_f * found.velocity**2
    given, taken = (np.trapezoid(each, found.cam_angle / speed) for each in (found.force * v, lost))
    # The trapezoidal rule over the kinks of the jerk, square of the step.
    assert given == pytest.approx(taken, rel=1e-5)
    assert taken > 0


def test_a_stiff_train_follows_the_lift() -> None:
    """Force m s″ω² + F₀ + k_r s of the rigid follower, up to the order of (ω/Ω)."""
    model = OneMass(0.8, 1e10, 0.01, 0.0, 2e4, 150.0)
    found = follower_vibration(turn(POLYNOMIAL_4567, 0.012), model, 50.0)
    s, a = (turn(POLYNOMIAL_4567, 0.012).at(found.cam_angle, k) for k in (0, 2))
    rigid = 0.8 * 2500 * a + 150 + 2e4 * s
    assert np.abs(found.force - rigid).max() < 1e-2 * np.abs(rigid).max()


def test_extremes_are_not_those_of_the_rows() -> None:
    found = follower_vibration(LIFT, FULL, 90.0, 360)
    fine = follower_vibration(LIFT, FULL, 90.0, 360 * 64)
    assert fine.force_max == found.force_max
    assert found.force_max >= fine.force.max() >= found.force.max()
    assert found.force_max == pytest.approx(fine.force.max(), rel=1e-6)
    assert found.force_min == pytest.approx(fine.force.min(), rel=1e-5)
    assert found.acceleration_max == pytest.approx(np.abs(fine.acceleration).max(), rel=1e-6)
    s = LIFT.at(fine.cam_angle)
    assert found.departure_max == pytest.approx(np.abs(fine.position - FULL.share * s).max(), rel=1e-6)


def test_strikes_are_counted_and_told() -> None:
    found = follower_vibration(turn(UNIFORM, 0.01), FULL, 20.0)
    expected = [(0.0, 0.005), (2.0, -0.005), (2.8, -0.01 / 1.7), (4.5, 0.01 / 1.7)]
    assert [each.cam_angle for each in found.impulses] == pytest.approx([at for at, _ in expected])
    assert [each.velocity_step for each in found.impulses] == pytest.approx([20 * v for _, v in expected])
    assert sum("impact" in text for text in found.findings) == 4
    assert follower_vibration(LIFT, FULL, 20.0).impulses == ()


def test_contact_is_lost_where_the_preload_does_not_hold() -> None:
    found = follower_vibration(LIFT, FULL, 300.0)
    assert not found.keeps_contact
    assert "leaves" in found.findings[-1]
    more = OneMass(0.8, 3e5, 0.04, 0.03, 2e4, 150.0 - found.force_min + 1e-6)
    assert follower_vibration(LIFT, more, 300.0).keeps_contact
    sweep = vibration_over_speed(LIFT, FULL, [20.0, 300.0])
    assert sweep.keeps_contact.tolist() == [True, False]
    assert sweep.force_min[1] == found.force_min


def test_resonance_without_damping_is_told() -> None:
    model = OneMass(1.0, 100.0)
    with pytest.raises(FindingError, match="5 free vibrations in one revolution"):
        follower_vibration(LIFT, model, 2.0)


@pytest.mark.parametrize("speed", [40.0, 170.0])
def test_polydyne_lift_moves_the_follower_by_the_wanted_law(speed: float) -> None:
    model = OneMass(0.8, 3e5, 0.0, 0.06, 2e4, 150.0)
    wanted = turn(POLYNOMIAL_56789, 0.012)
    made = polydyne(wanted, model, speed, "turn")
    found = follower_vibration(made.lift, model, speed)
    np.testing.assert_allclose(found.position, wanted.at(found.cam_angle), rtol=0, atol=1e-14)
    assert made.continuity == 4
    assert not found.impulses


def test_polydyne_lift_leaves_nothing_at_its_speed_and_something_beside_it() -> None:
    model = OneMass(0.8, 3e5, 0.0, 0.05, 2e4)
    made = polydyne(POLYNOMIAL_56789.scaled(0.01).placed(0.3, 1.5), model, 120.0)
    speeds = np.array([100.0, 120.0, 150.0])
    found = residual_over_speed(made.lift, model, speeds)
    # The fourth derivative of x, in the thousands of the lift, is what rounding comes from.
    assert found.residual[1] < 1e-12
    assert (found.residual[[0, 2]] > 1e-6).all()
    tau = 1.5 * model.natural_frequency / (2 * np.pi * 120)
    assert min(abs(each.ratio - tau) for each in found.quiet) < 1e-9
    # Static end of the lift: the closing spring takes its share.
    assert float(made.lift.at(1.8, 0, "before")) == pytest.approx(0.01 / model.share, rel=1e-13)


def test_polydyne_asks_for_continuity() -> None:
    model = OneMass(1.0, 1e5)
    with pytest.raises(FindingError, match=r"derivative 2 .* jumps by"):
        polydyne(PARABOLIC, model, 10.0)
    assert "impact" in polydyne(POLYNOMIAL_345, model, 10.0).findings[0]
    assert "acceleration of the lift jumps" in polydyne(POLYNOMIAL_4567, model, 10.0).findings[0]
    assert not polydyne(POLYNOMIAL_56789, model, 10.0).findings
    assert steps(polydyne(POLYNOMIAL_345, model, 10.0).lift, 1, "dwell").any()
    with pytest.raises(InputError, match="damper in the train"):
        polydyne(POLYNOMIAL_56789, FULL, 10.0)


def test_a_dip_below_the_base_is_told() -> None:
    """Near the end x″ < 0, so s overshoots; where it begins s dips only for the return."""
    model = OneMass(1.0, 1e4)
    made = polydyne(POLYNOMIAL_56789.reversed(), model, 90.0)
    assert made.lift_min < 0 or made.lift_max > 1
    down = polydyne(POLYNOMIAL_56789.scaled(-0.01), model, 60.0)
    assert any("dips" in text for text in down.findings)


def test_lifts_that_make_no_sense_are_told() -> None:
    with pytest.raises(InputError, match="one revolution"):
        follower_vibration(CYCLOIDAL, FULL, 10.0)
    jump = turn(CYCLOIDAL, 0.01)
    with pytest.raises(InputError, match=r"jump by -?0\.01 m"):
        follower_vibration(MotionLaw(jump.breaks, (*jump.pieces[:-1], jump.pieces[1])), FULL, 10.0)
    with pytest.raises(InputError, match="less than 1"):
        OneMass(1.0, 1.0, 0.7, 0.4)
    with pytest.raises(InputError, match="stays at"):
        residual_spectrum(CYCLOIDAL.scaled(0.0), 1.0)


def test_quadrature_sees_fast_vibration() -> None:
    """A follower with 400 vibrations in the rise, against adaptive integration with a sine weight."""
    tau = 400.37
    nu = 2 * np.pi * tau
    a = POLYNOMIAL_345.derivative(2)
    sine, _ = quad(lambda u: float(a.at(u)), 0, 1, weight="sin", wvar=nu, epsabs=1e-15)
    cosine, _ = quad(lambda u: float(a.at(u)), 0, 1, weight="cos", wvar=nu, epsabs=1e-15)
    assert residual_amplitude(POLYNOMIAL_345, tau)[0] == pytest.approx(np.hypot(sine, cosine) / nu, abs=1e-16)
