"""Rhombi, kites and what is nearly one: closed forms, positions in 110 digits, refusals, batches.

Linkages are taken as they are, turned, mirrored and scaled; crank angles lie over two revolutions from 1e-14
rad on beside the points where links come into line.
"""

from __future__ import annotations

from decimal import Decimal, localcontext

import numpy as np
import pytest

import linkwright as lw
from linkwright import AssemblyError
from linkwright.linkages.dyads import dyads_of
from linkwright.machine import compile_machine

# Nothing here is to be computed with what is not finite.
pytestmark = pytest.mark.filterwarnings("error::RuntimeWarning")

# How far a parallelogram is from a rhombus, over its side.
EXCESSES = [0.0, 1e-15, 1e-14, 3e-13, 1e-12, 1e-10, 1e-8, 1e-6, 1e-5, 2e-4, 1e-3, 1e-2, 0.3]


def four_bar(
    lengths: tuple[float, ...], side: str = "left", *, turned: float = 0.0, more: str = ""
) -> lw.Machine:
    crank, coupler, rocker, frame = lengths
    x, y = float(frame * np.cos(turned)), float(frame * np.sin(turned))
    return lw.loads(f"""
        format = 1
        name = "four-bar"
        [mechanism.points]
        D = {{ x = {x!r}, y = {y!r} }}
        [mechanism.cranks]
        A = {{ radius = {crank!r} }}
        [mechanism.rockers]
        R = {{ crank = "A", pivot = "D", coupler = {coupler!r}, rocker = {rocker!r}, assembly = "{side}" }}
        {more}
        [bodies]
        "R.rocker" = {{ mass = 1 }}
    """)


def angles(*centres: float) -> np.ndarray:
    near = np.concatenate([[0.0], 10.0 ** np.arange(-14, 0.1, 0.5)])
    beside = [at + turn + way * near for at in centres for turn in (0, 2 * np.pi) for way in (-1, 1)]
    return np.sort(np.concatenate([np.linspace(0, 4 * np.pi, 289), *beside]))


def left_or_right(turned: float, is_parallel: bool = True) -> str:
    """Side of a parallelogram's joint just after crank angle zero, or of the antiparallelogram's."""
    return "left" if (np.sin(1e-7 - turned) > 0) == is_parallel else "right"


def check_rates(link, wanted: tuple[float, float, float], scale: float = 1.0) -> None:
    """Three transfer functions of a link; just beyond the series at 0.03 rad each loses 1/δ² at most."""
    for found, exact, limit in zip((link.d1, link.d2, link.d3), wanted, (2e-12, 2e-10, 1e-7), strict=True):
        np.testing.assert_allclose(found, exact, atol=limit * scale)


@pytest.mark.parametrize("excess", EXCESSES)
@pytest.mark.parametrize("turned", [0.0, np.pi, 0.7])
def test_a_parallelogram_stays_one(excess: float, turned: float) -> None:
    """Its coupler does not turn, however near it is to a rhombus."""
    for size in (1.0, 3e-3):
        lengths = (size, size * (1 + excess), size, size * (1 + excess))
        machine = four_bar(lengths, left_or_right(turned), turned=turned)
        motion = lw.kinematics(machine, angles(turned, turned + np.pi), third=True)
        coupler, rocker = motion.links["R.coupler"], motion.links["R.rocker"]
        np.testing.assert_allclose(np.exp(1j * (coupler.angle - turned)), 1.0, atol=1e-12)
        check_rates(coupler, (0.0, 0.0, 0.0))
        check_rates(rocker, (1.0, 0.0, 0.0))
        found = lw.closure(machine)
        assert (found.turns_fully, found.turns) == (True, 1)
        assert lw.reduction(machine).inertia_min > 0


@pytest.mark.parametrize("turned", [0.0, np.pi, 0.7])
def test_the_other_assembly_of_a_rhombus(turned: float) -> None:
    """Its joint stays on the pivot of the crank: the coupler turns with the crank, the rocker stands."""
    machine = four_bar((1.0,) * 4, left_or_right(turned, False), turned=turned)
    motion = lw.kinematics(machine, angles(turned, turned + np.pi), third=True)
    np.testing.assert_allclose(motion.points["R"].position, 0.0, atol=1e-13)
    check_rates(motion.links["R.coupler"], (1.0, 0.0, 0.0))
    check_rates(motion.links["R.rocker"], (0.0, 0.0, 0.0))


@pytest.mark.parametrize("excess", [1e-6, 1e-4, 1e-2, 0.3])
def test_an_antiparallelogram_stays_one(excess: float) -> None:
    """ψ′ = −(l² − r²)/(l² + r² − 2lr cos φ): it goes round while the pin passes its pivot."""
    short, long = 1.0, 1.0 + excess
    motion = lw.kinematics(four_bar((short, long, short, long), "right"), at := angles(0.0, np.pi))
    apart = (long - short) ** 2 + 4 * long * short * np.sin(at / 2) ** 2
    exact = -(long - short) * (long + short) / apart
    # The direction from pin to pivot, and their distance, are known to rounding over the excess.
    np.testing.assert_allclose(motion.links["R.rocker"].d1, exact, rtol=1e-13 / excess, atol=2e-12)


@pytest.mark.parametrize("excess", [1e-12, 1e-10, 5e-9])
def test_an_antiparallelogram_that_whirls_is_refused(excess: float) -> None:
    with pytest.raises(
        AssemblyError, match=r"R comes within .* m of a change point at crank angle 0\.0000"
    ) as caught:
        lw.kinematics(four_bar((1.0, 1 + excess, 1.0, 1 + excess), "right"))
    assert caught.value.crank_angle == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("long", [1 + 1e-7, 1.001, 1.5, 40.0])
@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("turned", [0.0, np.pi, -2.1])
def test_a_kite_is_galloways_linkage(long: float, side: str, turned: float) -> None:
    """The rocker turns once in two of the crank: ψ is (φ + θ)/2 and the angle at the rhombus' half."""
    machine = four_bar((1.0, long, long, 1.0), side, turned=turned)
    motion = lw.kinematics(machine, at := angles(turned), third=True)
    # u = D − A = w n with n smooth: w = 2 sin((φ − θ)/2), n = −i exp(i (φ + θ)/2).
    half, n = (at - turned) / 2, -1j * np.exp(0.5j * (at + turned))
    w = 2 * np.sin(half)
    q = np.sqrt((long - w / 2) * (long + w / 2))
    # Left of u while w > 0: just after a pivot at angle zero, else w is positive or negative there.
    sign = (1 if side == "left" else -1) * (1 if np.sin((1e-7 - turned) / 2) > 0 else -1)
    arm = 0.5 * w * n + sign * 1j * q * n
    joint = motion.points["R"].position
    np.testing.assert_allclose(joint[:, 0] + 1j * joint[:, 1], np.exp(1j * at) + arm, atol=2e-13 * long)
    # The arm's angle is that of n and ± arccos(w/2b): its rate ½ ∓ w′/2q.
    np.testing.assert_allclose(
        motion.links["R.coupler"].d1, 0.5 - sign * 0.5 * np.cos(half) / q, atol=2e-12 / (long - 1) ** 0.5
    )
    assert lw.period_turns(machine) == 2
    assert lw.closure(machine).turns_fully


def test_a_kite_with_a_long_crank_has_limits() -> None:
    """It passes its change point, and stops where coupler and rocker are stretched: 2 sin(φ/2) = 1.2."""
    found = lw.closure(four_bar((1.0, 0.6, 0.6, 1.0)))
    limit = 2 * np.arcsin(0.6)
    assert not found.turns_fully
    ((low, high),) = {
        (round(low % (2 * np.pi), 9), round(high % (2 * np.pi), 9)) for low, high in found.ranges
    }
    assert (low, high) == pytest.approx((2 * np.pi - limit, limit), abs=1e-8)
    with pytest.raises(AssemblyError, match="coupler and rocker of R"):
        lw.kinematics(four_bar((1.0, 0.6, 0.6, 1.0)), [3.0])


# -- lengths that differ -------------------------------------------------------------------------------------


def sine_cosine(x: Decimal) -> tuple[Decimal, Decimal]:
    """By halving the angle and its series."""
    halvings = 0
    while abs(x) > Decimal("0.01"):
        x, halvings = x / 2, halvings + 1
    sine, cosine, term = Decimal(0), Decimal(0), Decimal(1)
    for k in range(60):
        if k % 2:
            sine += term if k % 4 == 1 else -term
        else:
            cosine += term if k % 4 == 0 else -term
        term = term * x / (k + 1)
    for _ in range(halvings):
        sine, cosine = 2 * sine * cosine, cosine * cosine - sine * sine
    return sine, cosine


def exact_joint(lengths: tuple[float, ...], side: int, phi: Decimal) -> tuple[Decimal, Decimal] | None:
    """The joint where the circles about pin and pivot cross; None where they do not."""
    r, a, b, d = (Decimal(x) for x in lengths)
    sine, cosine = sine_cosine(phi)
    ux, uy = d - r * cosine, -r * sine
    U = ux * ux + uy * uy
    g = ((a + b) ** 2 - U) * (U - (a - b) ** 2)
    if g < 0:
        return None
    P, Q = Decimal("0.5") + (a * a - b * b) / (2 * U), side * g.sqrt() / (2 * U)
    return r * cosine + P * ux - Q * uy, r * sine + P * uy + Q * ux


def exact_motion(lengths: tuple[float, ...], side: int, phi: float) -> np.ndarray | None:
    """The joint and three derivatives, (4, 2), by differences in 110 digits; None where it is open."""
    with localcontext() as context:
        context.prec = 110
        step = Decimal(10) ** -18
        found = [exact_joint(lengths, side, Decimal(phi) + k * step) for k in (-2, -1, 0, 1, 2)]
        if None in found:
            return None
        rows = []
        for coordinate in zip(*found, strict=True):
            far, near, here, beyond, farthest = coordinate
            rows.append(
                [
                    here,
                    (beyond - near) / (2 * step),
                    (beyond - 2 * here + near) / step**2,
                    (farthest - 2 * beyond + 2 * near - far) / (2 * step**3),
                ]
            )
        return np.array(rows, dtype=float).T


def drawn(rng: np.random.Generator) -> tuple[tuple[float, ...], float]:
    """Crank, coupler, rocker, frame near a change point, and the share by which one of them is off."""
    a = float(rng.uniform(0.2, 2))
    b = float(a * rng.choice([rng.uniform(0.3, 3), 1 + 10 ** rng.uniform(-9, -2)]))
    shapes = [(a, a, a, a), (a, b, a, b), (a, b, b, a), (a, a, b, b), (b, a, a, b)]
    lengths = list(shapes[rng.integers(len(shapes))])
    off = float(10 ** rng.uniform(-12, -2) * rng.choice([-1, 1]))
    lengths[rng.integers(4)] *= 1 + off
    return tuple(lengths), off


def test_what_is_nearly_a_change_point_is_right_or_refused() -> None:
    """One side of a rhombus, a parallelogram or a kite is off: three transfer functions, or a finding.

    A machine with less to spare than its lengths tell is refused; all others keep seven digits, of rates that
    grow like one over the square root of what there is to spare.
    """
    rng = np.random.default_rng(5)
    refused, compared = [], 0
    for _ in range(120):
        lengths, off = drawn(rng)
        try:
            compiled = compile_machine(four_bar(lengths))
        except AssemblyError:
            refused.append(abs(off))
            continue
        assert abs(off) > 1e-12
        if compiled.two_turns.any() or any(each.change_points for each in dyads_of(compiled)):
            # The side that is off leaves another pair of sides equal: a kite's own change point is passed.
            continue
        at = np.array([c + s * 10.0 ** rng.uniform(-12, 0) for c in (0, np.pi) for s in (1, -1)])
        point = compiled.points["R"]
        found = np.array([*compiled.point_motion(point, at), compiled.third(at, points=[point]).points[0]])
        for k, phi in enumerate(at):
            exact = exact_motion(lengths, 1, float(phi))
            if exact is None:
                assert not np.isfinite(found[..., k]).any() or abs(compiled.gaps(at[k : k + 1])).min() < 1e-12
                continue
            compared += 1
            size = np.maximum(np.abs(exact).max(axis=1), max(lengths))
            assert (np.abs(found[..., k] - exact).max(axis=1) < 3e-7 * size).all(), (lengths, off, phi)
    assert compared > 100
    assert refused
    assert max(refused) < 1e-6


# -- other descriptions --------------------------------------------------------------------------------------


def bars(
    lengths: tuple[float, ...], assembled_at: float, place: tuple[float, float], more: str = ""
) -> lw.Machine:
    crank, coupler, rocker, frame = lengths
    return lw.loads(f"""
        format = 1
        name = "four-bar of bars"
        [mechanism]
        assembled_at = {assembled_at!r}
        [mechanism.points]
        D = {{ x = {frame!r} }}
        [mechanism.cranks]
        A = {{ radius = {crank!r} }}
        [mechanism.joints]
        E = {{ x = {place[0]!r}, y = {place[1]!r} }}
        [mechanism.bars]
        a = {{ start = "A", end = "E", length = {coupler!r} }}
        b = {{ start = "D", end = "E", length = {rocker!r} }}
        {more}
    """)


@pytest.mark.parametrize("excess", [0.0, 1e-13, 1e-5, 1e-4, 0.5])
@pytest.mark.parametrize("assembled_at", [0.5, 2.9, 3.5, 6.0, 9.0])
def test_a_joint_is_on_its_side_where_it_is_given(excess: float, assembled_at: float) -> None:
    """Also where change points lie between that angle and zero."""
    long = 0.2 * (1 + excess)
    place = (float(0.2 * np.cos(assembled_at) + long), float(0.2 * np.sin(assembled_at)))
    motion = lw.kinematics(bars((0.2, long, 0.2, long), assembled_at, place), angles(0.0, np.pi), third=True)
    np.testing.assert_allclose(np.exp(1j * motion.links["a"].angle), 1.0, atol=1e-12)
    check_rates(motion.links["a"], (0.0, 0.0, 0.0))
    check_rates(motion.links["b"], (1.0, 0.0, 0.0))


@pytest.mark.parametrize("excess", [0.0, 1e-14, 1e-5, 1e-3])
def test_three_cranks_and_a_stack_of_parallelograms(excess: float) -> None:
    """A third crank held by a redundant bar, and a second parallelogram on the rocker of the first."""
    long = 0.2 * (1 + excess)
    third = f"""
        c = {{ start = "E", end = "F", length = {long!r} }}
        d = {{ start = "G", end = "F", length = 0.2 }}
        e = {{ start = "A", end = "F", length = {2 * long!r}, redundant = true }}
        [mechanism.joints.F]
        x = {float(0.2 * np.cos(1.0) + 2 * long)!r}
        y = {float(0.2 * np.sin(1.0))!r}
        [mechanism.points.G]
        x = {2 * long!r}
    """
    place = (float(0.2 * np.cos(1.0) + long), float(0.2 * np.sin(1.0)))
    motion = lw.kinematics(bars((0.2, long, 0.2, long), 1.0, place, third), angles(0.0, np.pi))
    apart = motion.points["F"].position - motion.points["A"].position
    np.testing.assert_allclose(apart, np.broadcast_to([2 * long, 0.0], apart.shape), atol=1e-12)
    np.testing.assert_allclose(motion.links["d"].d1, 1.0, atol=2e-11)
    np.testing.assert_allclose(motion.links["d"].d2, 0.0, atol=2e-8)


@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_a_slider_whose_rod_is_as_long_as_its_crank(mirror: float) -> None:
    """s = 2r cos φ through ±90°, where the slider passes over the crank's pivot."""
    machine = lw.loads(f"""
        format = 1
        name = "isosceles slider-crank"
        [mechanism.cranks]
        A = {{ radius = 0.3 }}
        [mechanism.sliders]
        S = {{ crank = "A", rod = 0.3, assembly = "{"positive" if mirror > 0 else "negative"}" }}
    """)
    at = angles(0.5 * np.pi, 1.5 * np.pi)
    slide = lw.kinematics(machine, at, third=True).slides["S"]
    factor = 0.6 * (mirror > 0)
    np.testing.assert_allclose(slide.position, factor * np.cos(at), atol=1e-15)
    check_rates(slide, (-factor * np.sin(at), -factor * np.cos(at), factor * np.sin(at)))


@pytest.mark.parametrize("off", [1e-11, 1e-9])
def test_a_rod_that_all_but_reaches_is_refused(off: float) -> None:
    """Whether the slider passes over the pivot, or turns back just before, its lengths do not tell."""
    for rod in (0.3 * (1 + off), 0.3 * (1 - off)):
        machine = lw.loads(f"""
            format = 1
            name = "slider-crank"
            [mechanism.cranks]
            A = {{ radius = 0.3 }}
            [mechanism.sliders]
            S = {{ crank = "A", rod = {rod!r} }}
        """)
        with pytest.raises(AssemblyError, match=r"S comes within .* at crank angle (90|270)\.0000"):
            lw.kinematics(machine)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 2 * np.pi])
def test_a_lever_whose_pin_passes_over_its_pivot_is_refused_there(angle: float) -> None:
    """It turns about at once, by 180°: neither that nor what it does at the point is made up."""
    machine = lw.loads("""
        format = 1
        name = "lever"
        [mechanism.points]
        D = { x = 0.1 }
        [mechanism.cranks]
        A = { radius = 0.1 }
        [mechanism.slotted_levers]
        L = { pin = "A", pivot = "D" }
    """)
    for ask in (lambda: lw.pose(machine, angle), lambda: lw.kinematics(machine, [angle - 0.5, angle + 0.5])):
        with pytest.raises(AssemblyError, match="L reaches a change point at crank angle 0"):
            ask()
    # On one side of it the lever turns at half the speed of the crank.
    link = lw.kinematics(machine, [angle + 0.5, angle + 5.5]).links["L"]
    np.testing.assert_allclose(link.d1, 0.5, atol=1e-14)


# -- batches -------------------------------------------------------------------------------------------------

DRIVE = """
[bodies.A]
mass = 1
[loads.weight]
kind = "gravity"
[loads.brake]
kind = "torque_speed"
speed = ["0 rpm", "100 rpm"]
torque = ["0 N m", "5 N m"]
[drive.motor]
kind = "dc"
torque_stall = "20 N m"
speed_no_load = "120 rpm"
"""


def test_rows_of_a_batch_are_the_single_machines() -> None:
    """Parallelograms, rhombi, kites' lack of a change point, crank-rockers; a row that is not told is NaN."""
    coupler = np.array([1.5, 1.0, 1.0 + 1e-4, 1.0 + 1e-14, 1.2, 1.0 + 1e-10, 1.8])
    frame = np.array([1.5, 1.0, 1.0 + 1e-4, 1.0 + 1e-14, 1.2 * (1 + 1e-10), 1.0 + 1e-10, 1.7])
    many = lw.replace(
        four_bar((1.0, 1.5, 1.0, 1.5)),
        {"mechanism.rockers.R.coupler": coupler, "mechanism.points.D.x": frame},
    )
    at = angles(0.0, np.pi)[::3].copy()
    batch = lw.kinematics(many, at)
    for row, (b, d) in enumerate(zip(coupler.tolist(), frame.tolist(), strict=True)):
        joint, rocker = batch.points["R"], batch.links["R.rocker"]
        try:
            compiled = compile_machine(four_bar((1.0, b, 1.0, d)))
        except AssemblyError:
            assert row == 4
            assert np.isnan(joint.position[row]).all()
            continue
        alone = compiled.point_motion(compiled.points["R"], at)
        # The row without change points is computed with those of the others out of reach.
        np.testing.assert_allclose(joint.position[row], alone.place.T, atol=1e-13)
        np.testing.assert_allclose(joint.d2[row], alone.d2.T, atol=1e-11)
        if row != 6:
            np.testing.assert_allclose(rocker.d1[row], 1.0, atol=2e-12)


def test_steady_motion_of_a_batch_is_that_of_each_machine() -> None:
    """Parallelograms, near-rhombi, a kite of two revolutions; a status where lengths do not tell."""
    coupler = np.array([1.5, 1.0, 1.0 + 1e-4, 1.2, 1.5])
    frame = np.array([1.5, 1.0, 1.0 + 1e-4, 1.2 * (1 + 1e-10), 1.0])
    rocker = np.array([1.0, 1.0, 1.0, 1.0, 1.5])
    addresses = ("mechanism.rockers.R.coupler", "mechanism.points.D.x", "mechanism.rockers.R.rocker")
    machine = four_bar((1.0, 1.5, 1.0, 1.5), more=DRIVE)
    found = lw.steady_states(machine, dict(zip(addresses, (coupler, frame, rocker), strict=True)))
    assert found.status.tolist() == [0, 0, 0, 1, 0]
    assert np.isnan(found.speed_max[3])
    for row in (0, 1, 2, 4):
        values = (float(coupler[row]), float(frame[row]), float(rocker[row]))
        alone = lw.steady_state(lw.replace(machine, dict(zip(addresses, values, strict=True))))
        np.testing.assert_allclose(found.speed_max[row], alone.speed_max, rtol=1e-7)
        np.testing.assert_allclose(found.acceleration_max[row], alone.acceleration_max, rtol=1e-6)


@pytest.mark.parametrize("off", [-5e-8, -1.3e-7, -1e-5, 2.7e-7, 1e-5])
@pytest.mark.parametrize("turned", [0.0, -2.845964151595593])
def test_no_motion_leads_through_a_gap_however_narrow(off: float, turned: float) -> None:
    """A rhombus whose rocker is off: coupler and rocker do not reach a pin that passes so near the pivot.

    A rocker that is too short does not reach at the other side either, which must not hide the narrow gap.
    """
    machine = four_bar((1.0, 1.0, 1.0 + off, 1.0), turned=turned)
    # At distance |off| from the pivot: 2 sin(δ/2) = |off|.
    gap = 2 * np.arcsin(abs(off) / 2)
    found = lw.closure(machine)
    assert not found.turns_fully
    for low, high in found.ranges:
        turn = 2 * np.pi * np.round((low - turned) / (2 * np.pi))
        assert not low < turned + turn < high
    edges = np.array(found.ranges) - turned
    beside = np.abs((edges + np.pi) % (2 * np.pi) - np.pi)
    assert np.sort(beside.ravel())[:2] == pytest.approx(gap, rel=1e-6, abs=1e-14)
    with pytest.raises(AssemblyError, match="R at t = "):
        lw.motion(machine, lambda t: turned - 0.1 + 0.2 * t, [0.0, 0.4, 1.0])
    # Extreme positions are those of what closes.
    (rocker,) = lw.linkage(machine).elements
    assert np.isfinite([rocker.low, rocker.high]).all()


def test_random_linkages_give_answers_or_findings() -> None:
    """Every analysis of positions, of random and of special four-bars: no warning, no NaN."""
    rng = np.random.default_rng(3)
    for _ in range(4):
        a, b, c, d = (float(10 ** rng.uniform(-1, 1)) for _ in range(4))
        for lengths in ((a, b, c, d), (a, b, a, b), (a, b, b, a), (a, a, a, a)):
            machine = four_bar(lengths, turned=float(rng.uniform(-3, 3)))
            whole = lw.closure(machine).turns_fully
            try:
                assert np.isfinite(
                    lw.pose(machine, float(rng.choice([0.0, 1.0, np.pi]))).points["R"].position
                ).all()
                assert np.isfinite(lw.linkage(machine).transmission_angles["R"]).all()
            except AssemblyError:
                assert not whole


def test_coupler_curve_of_a_rhombus() -> None:
    """The joint of the parallelogram runs on a circle about the pivot."""
    found = lw.coupler_curve(four_bar((1.0,) * 4), "R")
    np.testing.assert_allclose(found.length, 2 * np.pi, atol=1e-9)


def test_rates_without_limit_are_no_numbers() -> None:
    """The rod stands across its guide at 0°: the slider turns back there at infinite speed of transfer."""
    text = (
        'format = 1\nname = "At its limit"\n[drive]\nspeed = 1.0\n[mechanism.cranks.A]\nradius = 1.0\n'
        '[mechanism.sliders.s]\ncrank = "A"\nrod = 0.5\noffset = 0.5\n'
    )
    found = lw.motions(lw.loads(text), [0.0, 0.1, -0.1], points=["A"], slides=["s"])[0]
    assert not np.isinf(found).any()
    assert np.isfinite(found[:6]).all()
    # The place is known at the limit, beyond it nothing is.
    assert found[6, 0] == pytest.approx(1.0)
    assert np.isnan(found[7:, 0]).all()
    assert np.isfinite(found[:, 1]).all()
    assert np.isnan(found[6:, 2]).all()
