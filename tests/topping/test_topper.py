"""The knife of a topper: closed forms, limits, other ways to the same numbers, brute force."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from knife_sweep import Knife, Pass, needed_length, to_and_fro, uncut_by_slices

import linkwright as lw
from linkwright import study, topper
from linkwright.topping import TopperStudy, edges_of
from linkwright.topping.coverage import coverage

MACHINES = Path(__file__).parents[2] / "machines"
ONE_WAY = 'topper.motion={kind="constant"}'
TO_AND_FRO = 'topper.motion={kind="constant", stroke="60 mm"}'

# The file's own: D, h_p, Δ, α, v, v_h, S.
D, H, DELTA, ALPHA, V, V_H, S = 0.11, 0.03, 0.02, np.radians(20), 1.9, 0.55, 0.06
DISC = 2 * np.sqrt(H * (D - H))


def cut(*overrides: str, file: str = "topper.toml") -> TopperStudy:
    return topper(lw.read(MACHINES / file, overrides))


def segment(r: float, distance: float) -> float:
    x = np.clip(distance / r, -1, 1)
    return float(r**2 * (np.arccos(x) - x * np.sqrt(1 - x**2)))


@pytest.mark.parametrize("motion", ['topper.motion.kind="harmonic"', ONE_WAY, TO_AND_FRO])
@pytest.mark.parametrize("degrees", [0, 20, -35, 75, 89.9])
def test_a_knife_at_rest_needs_the_band(motion: str, degrees: float) -> None:
    """Across the row the edge takes L cos α: that has to be d + 2Δ. What it leaves are segments."""
    found = cut(motion, "topper.knife_speed=0", f"topper.edge_angle={degrees} deg", "topper.edge_length=0.1")
    cos = np.cos(np.radians(degrees))
    band = (DISC + 2 * DELTA) / cos
    for length in (found.length_exact, found.length_exact_constant_speed, found.length_at_rest):
        assert length == pytest.approx(band, rel=1e-12)
    sides = [segment(0.5 * DISC, 0.05 * cos + way * DELTA) for way in (-1, 1)]
    assert found.uncut_share == pytest.approx(sum(sides) / (0.25 * np.pi * DISC**2), abs=1e-9)
    assert abs(found.uncut_offset) == pytest.approx(DELTA)
    assert found.length_published == pytest.approx((DISC + 2 * DELTA) * np.sin(np.radians(abs(degrees))))


@pytest.mark.parametrize("motion", ["harmonic", "constant"])
@pytest.mark.parametrize(
    ("degrees", "offset", "stroke"),
    [(0, "35 mm", 0.12), (15, "0 mm", 0.06), (-30, "35 mm", 0.12), (-30, "5 mm", 0.004)],
)
def test_all_phases_need_the_stroke_and_the_band(
    motion: str, degrees: float, offset: str, stroke: float
) -> None:
    """At some head the knife is at its end as the edge comes to the point farthest to the other side."""
    law = f'topper.motion={{kind="{motion}", stroke={stroke}}}'
    found = cut(law, f"topper.offset={offset}", f"topper.edge_angle={degrees} deg")
    delta = float(offset.split()[0]) / 1000
    assert not found.edge_retreats
    expected = (stroke + DISC + 2 * delta) / np.cos(np.radians(degrees))
    assert found.length_exact == pytest.approx(expected, rel=1e-9)


def test_a_root_cut_at_its_middle() -> None:
    found = cut("topper.cut_height=55 mm")
    assert found.head_diameter == pytest.approx(D, rel=1e-15)
    assert found.cap_volume == pytest.approx(np.pi * D**3 / 12, rel=1e-14)


def test_the_other_end_that_leads_is_the_mirror_image() -> None:
    short = "topper.edge_length=0.12"
    one, other = cut(short), cut(short, "topper.edge_angle=-20 deg")
    for name in ("length_published", "length_consistent", "length_exact_constant_speed", "length_at_rest"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-14)
    for name in ("length_exact", "uncut_share", "length_best_phase", "slicing_ratio_mean"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-9)
    assert one.uncut_share_mean == pytest.approx(other.uncut_share_mean, rel=1e-9)
    # Mirrored, the knife starts to the right: half a revolution on.
    np.testing.assert_allclose(one.length_by_phase[:91], other.length_by_phase[90:], rtol=1e-12)


def test_a_very_short_edge_leaves_nearly_all() -> None:
    """Some heads it misses altogether; of the others it cuts a line of its own width."""
    found = cut("topper.edge_length=1 um")
    assert 1 - 1e-4 < found.uncut_share_mean < found.uncut_share <= 1
    assert found.uncut_share == pytest.approx(1, abs=1e-12)


def test_a_sufficient_edge_leaves_nothing_and_a_shorter_one_something() -> None:
    length = cut().length_exact
    assert cut(f"topper.edge_length={length * (1 + 1e-9)!r}").uncut_share < 1e-12
    shorter = lw.read(MACHINES / "topper.toml", [f"topper.edge_length={0.99 * length!r}"])
    found = study(shorter)
    assert found.topper is not None
    # What lies at one side beyond a hundredth of the length is a thin sliver.
    assert 0 < found.topper.uncut_share < 0.01
    assert len(found.findings) == 1


def test_constant_speed_without_stroke_is_the_closed_form() -> None:
    found = cut(ONE_WAY)
    expected = (DISC * np.hypot(V, V_H) + 2 * DELTA * V) / (V * np.cos(ALPHA) - V_H * np.sin(ALPHA))
    assert found.length_exact_constant_speed == pytest.approx(expected, rel=1e-14)
    assert found.length_exact == pytest.approx(expected, rel=1e-12)
    assert (found.stroke, found.strokes_per_head, found.knife_speed) == (0, 0, V_H)
    ratios = np.tan(ALPHA + np.arctan2(V_H, V)), abs(np.tan(ALPHA - np.arctan2(V_H, V)))
    assert found.slicing_ratio_max == pytest.approx(ratios[0])
    assert found.slicing_ratio_min == pytest.approx(ratios[1])


def test_strokes_that_hardly_matter_and_strokes_that_never_end() -> None:
    """A short stroke is a knife at rest; along a long one the speed over a head is constant."""
    assert cut(TO_AND_FRO, "topper.motion.stroke=4 mm").length_exact == pytest.approx(
        cut().length_at_rest + 4e-3 / np.cos(ALPHA), rel=1e-9
    )
    long = cut(TO_AND_FRO, "topper.motion.stroke=20 m", "topper.motion.phase=0 deg")
    left_going = (DISC * np.hypot(V, V_H) + 2 * DELTA * V) / (V * np.cos(ALPHA) - V_H * np.sin(ALPHA))
    assert long.length_exact == pytest.approx(left_going, rel=1e-9)


def test_turning_back_at_once_takes_infinite_acceleration() -> None:
    found = cut(TO_AND_FRO)
    assert found.knife_acceleration_max == np.inf
    assert found.knife_speed_max == pytest.approx(V_H)
    assert cut().knife_speed_max == pytest.approx(0.5 * np.pi * V_H)
    assert cut().knife_acceleration_max == pytest.approx(0.5 * S * (np.pi * V_H / S) ** 2)


@pytest.mark.parametrize("degrees", [0, 58.7, 90, 140, 300])
def test_a_given_phase_needs_no_more_than_the_worst(degrees: float) -> None:
    found, every = cut(f"topper.motion.phase={degrees} deg"), cut()
    assert found.length_exact <= every.length_exact * (1 + 1e-12)
    assert found.worst_phase == pytest.approx(np.radians(degrees))
    knife = to_and_fro(np.sin, S, V_H, ALPHA, V)
    brute = max(needed_length(Pass(knife, DISC, side * DELTA, np.radians(degrees))) for side in (-1, 1))
    # The cloud of points about the last one is halved 24 times.
    assert found.length_exact == pytest.approx(brute, rel=1e-6)


@pytest.mark.parametrize("length", [0.05, 0.13])
def test_no_head_in_a_given_phase_is_left_more_than_the_worst(length: float) -> None:
    found = cut(f"topper.edge_length={length}", "topper.motion.phase=70 deg")
    machine = lw.read(MACHINES / "topper.toml")
    assert machine.topper is not None
    edge = edges_of(machine, machine.topper)[0]
    offsets = np.linspace(-DELTA, DELTA, 161)
    shares = coverage(edge, DISC, offsets, np.radians(70), length=length).uncut / (0.25 * np.pi * DISC**2)
    # Between two of these offsets the share may be greater by a step's worth.
    assert shares.max() - 1e-12 <= found.uncut_share <= shares.max() + np.abs(np.diff(shares)).max()
    assert found.uncut_phase == pytest.approx(np.radians(70))


@pytest.mark.parametrize("degrees", [45, 30, 10, -60])
def test_an_edge_that_moves_along_itself_cuts_nothing(degrees: float) -> None:
    speed = V / np.tan(np.radians(abs(degrees)))
    changed = (f"topper.edge_angle={degrees} deg", f"topper.knife_speed={float(speed)!r}")
    found = study(lw.read(MACHINES / "topper.toml", [ONE_WAY, *changed]))
    assert found.topper is not None
    assert found.topper.length_exact == found.topper.length_exact_constant_speed == np.inf
    assert found.topper.uncut_share == 1
    assert "moves along itself" in found.findings[0]
    # Turning back, the same knife cuts on its way to the other side.
    assert np.isfinite(cut(TO_AND_FRO, "topper.motion.phase=0 deg", *changed[:1]).length_exact)


@pytest.mark.parametrize("degrees", [55, -55])
def test_a_retreating_edge_by_brute_force(degrees: float) -> None:
    """Any crossing counts: points swept one by one, slices of the head along the edge."""
    wide = (f"topper.edge_angle={degrees} deg", "topper.knife_speed=1.1", "topper.edge_length=0.08")
    machine = lw.read(MACHINES / "topper.toml", [*wide, "topper.motion.phase=200 deg", "topper.offset=0"])
    told = study(machine)
    found = told.topper
    assert found is not None
    assert found.edge_retreats
    assert found.least_advance < 0
    assert any("backwards" in text for text in told.warnings)
    over = Pass(to_and_fro(np.sin, S, 1.1, np.radians(degrees), V), DISC, 0.0, np.radians(200))
    shares, error = uncut_by_slices(over, 0.08)
    assert shares.sum() > 0.03
    assert found.length_exact == pytest.approx(needed_length(over), rel=1e-6)
    told_of = [found.uncut_right, found.uncut_left, found.uncut_between]
    assert told_of == pytest.approx(shares, abs=3 * error + 1e-5)
    assert found.uncut_share == pytest.approx(sum(told_of), rel=1e-9)


@pytest.mark.parametrize(
    ("change", "needed", "remedy"),
    [
        ("topper.edge_angle=89.9 deg", np.nan, "Reduce the edge angle"),
        # In all phases an edge that never retreats has its closed form.
        ("topper.motion.stroke=1 um", (1e-6 + DISC + 2 * DELTA) / np.cos(ALPHA), "longer stroke"),
        ('topper.motion={kind="harmonic", stroke="1 um", phase=0}', np.nan, "longer stroke"),
    ],
)
def test_a_knife_that_barely_advances_keeps_what_is_known(change: str, needed: float, remedy: str) -> None:
    found = study(lw.read(MACHINES / "topper.toml", [change]))
    assert found.topper is not None
    assert np.isfinite([found.topper.length_published, found.topper.length_exact_constant_speed]).all()
    assert found.topper.length_exact == pytest.approx(needed, rel=1e-12, nan_ok=True)
    assert np.isnan([found.topper.worst_phase, found.topper.uncut_share]).all()
    assert "barely advances" in found.findings[0]
    assert remedy in found.findings[0]


def test_a_very_long_rod_moves_the_knife_as_a_sine() -> None:
    """s = r cos φ + √(l² − r² sin² φ): the rod adds r²/4l at most. The sine starts 90° before."""
    rod = "mechanism.sliders.knife.rod=1 km"
    found = cut(rod, "topper.edge_length=0.13", file="topper_crank.toml")
    sine = cut("topper.edge_length=0.13")
    swing = 0.03**2 / 1000
    for name in ("length_exact", "length_best_phase", "knife_speed", "stroke"):
        assert getattr(found, name) == pytest.approx(getattr(sine, name), abs=swing + 1e-9)
    assert found.uncut_share == pytest.approx(sine.uncut_share, abs=1e-6)
    np.testing.assert_allclose(found.length_by_phase[:136], sine.length_by_phase[45:], atol=swing + 1e-9)


def test_inertia_force_is_that_of_the_slider_crank() -> None:
    """The largest acceleration is rω²(1 + r/l), at the outer dead centre."""
    found = cut(file="topper_crank.toml")
    omega = 275 * np.pi / 30
    assert found.knife_mass == 2.6
    assert found.inertia_force_max == pytest.approx(2.6 * 0.03 * omega**2 * (1 + 0.03 / 0.15), rel=1e-9)


def test_drive_torque_is_that_of_the_reduction() -> None:
    """M_d = ½J′ω² + M_r at constant speed; without the load that depends on the speed."""
    machine = lw.read(MACHINES / "topper_crank.toml")
    machine = lw.replace(machine, {"loads": {"guides": machine.loads["guides"]}})
    found, omega = topper(machine), 275 * np.pi / 30

    def torque(n: int) -> np.ndarray:
        reduced = lw.reduction(machine, n=n)
        return np.asarray(0.5 * reduced.inertia_reduced_d1 * omega**2 + reduced.torque_load)

    # The highest of 36 000 angles is below the top by the square of half a step, 1e-8 of it.
    assert found.drive_torque_max == pytest.approx(torque(36_000).max(), rel=1e-7)
    assert found.drive_torque_min == pytest.approx(torque(36_000).min(), rel=1e-7)
    assert found.drive_torque_mean == pytest.approx(torque(720)[:-1].mean(), rel=1e-9)
    # Dry friction takes 4 r F in a revolution.
    assert found.drive_torque_mean == pytest.approx(4 * 0.03 * 12 / (2 * np.pi), rel=1e-4)
    assert found.drive_power_mean == pytest.approx(found.drive_torque_mean * omega)


CAM = """
format = 1
name = "Knife on a cam"
[drive]
speed = "275 rpm"
[mechanism.cams.knife]
closure = "groove"
base_radius = "60 mm"
roller_radius = "10 mm"
phase = "35 deg"
rotation = "{rotation}"
sections = [
  {{ angle = "180 deg", lift = "60 mm", law = {{ kind = "combined", ramp = "{ramp}" }} }},
  {{ angle = "180 deg", lift = "-60 mm", law = {{ kind = "combined", ramp = "{ramp}" }} }},
]
[mechanism.sliders.blade]
crank = "knife"
rod = "200 mm"
angle = "30 deg"
offset = "20 mm"
[topper]
root_diameter = "110 mm"
cut_height = "30 mm"
offset = "20 mm"
edge_angle = "20 deg"
edge_length = "0.15 m"
forward_speed = "1.9 m/s"
motion = {{ kind = "member", of = "{of}", phase = "80 deg" }}
"""


def swept(machine: lw.Machine, of: str) -> Knife:
    """The member, counted from the middle of its stroke, by the mechanism's own motion."""
    assert machine.drive is not None
    assert machine.drive.speed is not None
    turn = lw.kinematics(machine, np.linspace(0, 2 * np.pi, 72_001)).slides[of].position
    middle, half = 0.5 * (turn.min() + turn.max()), 0.5 * np.ptp(turn)

    def law(phi: np.ndarray) -> np.ndarray:
        # No angles are no question.
        if not phi.size:
            return np.empty_like(phi)
        return np.asarray(lw.kinematics(machine, phi).slides[of].position - middle)

    return Knife(law, half, machine.drive.speed, ALPHA, V)


@pytest.mark.parametrize(
    ("of", "rotation", "ramp"), [("knife", "same", "optimal_jerk"), ("blade", "opposite", "parabolic")]
)
def test_a_knife_on_a_cam_by_brute_force(of: str, rotation: str, ramp: str) -> None:
    """Lift of the cam, and a slider that its follower moves."""
    machine = lw.loads(CAM.format(of=of, rotation=rotation, ramp=ramp))
    found, knife = topper(machine), swept(machine, of)
    passes = [Pass(knife, DISC, side * DELTA, np.radians(80)) for side in (-1, 1)]
    assert found.length_exact == pytest.approx(
        max(needed_length(over, n=12, rounds=18) for over in passes), rel=1e-6
    )
    assert found.uncut_share > 0.001
    shares = [uncut_by_slices(over, 0.15, slices=3000) for over in passes]
    share, error = max((float(each.sum()), error) for each, error in shares)
    assert found.uncut_share == pytest.approx(share, abs=3 * error + 1e-7)


def test_a_cam_keeps_the_knife_at_one_speed() -> None:
    """Over the middle of the stroke alone; the mean is 2 S f whatever the law."""
    found = topper(lw.loads(CAM.format(of="knife", rotation="same", ramp="optimal_jerk")))
    assert found.stroke == pytest.approx(0.06, rel=1e-12)
    assert found.knife_speed == pytest.approx(2 * 0.06 * 275 / 60, rel=1e-12)
    assert 1 < found.knife_speed_max / found.knife_speed < 0.5 * np.pi


MEMBER = """
format = 1
name = "Knife on any member"
drive = {{ speed = "275 rpm" }}
[mechanism.linear_drivers.k]
law = "{law}"
[topper]
root_diameter = "110 mm"
cut_height = "30 mm"
offset = "20 mm"
edge_angle = "20 deg"
edge_length = "0.28 m"
forward_speed = "1.9 m/s"
motion = {{ kind = "member", of = "k" }}
"""


@pytest.mark.parametrize(
    ("law", "stroke", "speed"),
    [
        ("0.03*sin(phi)", 0.06, 0.06 * 2),
        ("0.5 + 0.03*sin(2*phi)", 0.06, 0.06 * 4),
        ("0.06*abs(sin(phi))", 0.06, 0.06 * 4),
        ("0.01", 0.0, 0.0),
        ("0*phi", 0.0, 0.0),
    ],
)
def test_any_member_that_comes_back(law: str, stroke: float, speed: float) -> None:
    """A sum of harmonics, a law with corners, a member that rests: way in a revolution by hand."""
    found = topper(lw.loads(MEMBER.format(law=law)))
    assert found.stroke == pytest.approx(stroke, abs=1e-12)
    assert found.knife_speed == pytest.approx(speed * 275 / 60, abs=1e-12)
    assert found.length_exact == pytest.approx((stroke + DISC + 2 * DELTA) / np.cos(ALPHA), rel=1e-9)


@pytest.mark.parametrize("law", ["0.06*phi/(2*pi)", "0.03*sin(phi/2)", "0.03*sin(1.01*phi)"])
def test_a_member_that_does_not_come_back_is_refused(law: str) -> None:
    found = study(lw.loads(MEMBER.format(law=law)))
    assert found.topper is None
    assert "in each revolution" in found.findings[0]


def test_use_of_the_edge_adds_up_to_the_head() -> None:
    """Places times their way through a head: its area, to the step of the places."""
    found = cut()
    area = np.trapezoid(found.edge_use, found.edge_place)
    assert area == pytest.approx(0.25 * np.pi * DISC**2, rel=0.01)
    # No place is used beyond what the worst head needs.
    assert 0.9 < found.edge_place[-1] / (0.5 * found.length_exact) <= 1


def test_a_resting_knife_stands_where_its_phase_says() -> None:
    """At 30° a sine of stroke S stands S/4 beside the row, and the edge must reach over its far side."""
    law = 'topper.motion={kind="harmonic", stroke="60 mm", phase="30 deg"}'
    found = cut("topper.knife_speed=0", law)
    assert found.length_exact == pytest.approx((DISC + 2 * DELTA + 0.5 * S) / np.cos(ALPHA), rel=1e-12)
    assert cut("topper.knife_speed=0").length_exact == pytest.approx(found.length_at_rest, rel=1e-12)


def test_both_directions_slice_as_slow_strokes_do() -> None:
    """A stroke so long that turning back does not count: one way each half of the time."""
    one_way = cut(ONE_WAY, "topper.edge_angle=-24 deg", "topper.forward_speed=0.9")
    long = cut(
        'topper.motion={kind="constant", stroke="50 m"}',
        "topper.edge_angle=-24 deg",
        "topper.forward_speed=0.9",
    )
    assert one_way.slicing_ratio_mean == pytest.approx(long.slicing_ratio_mean, rel=1e-3)


def test_a_fast_knife_in_one_direction() -> None:
    """Far more across than along, the point reached last lies close to the end of the pass."""
    found = cut(ONE_WAY, "topper.knife_speed=1e4", "topper.edge_angle=0")
    assert found.length_exact == pytest.approx(found.length_exact_constant_speed, rel=1e-9)


def test_a_cut_below_the_middle_of_the_root_is_warned_of() -> None:
    warned = study(lw.read(MACHINES / "topper.toml", ["topper.cut_height=80 mm"])).warnings
    assert any("below the middle of the root" in text for text in warned)
