"""Fields of roots: shares, haulm and loss against closed forms and quadrature; draws; heads at the ends."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from topper_fields import TOPPER, machine

import linkwright as lw
from linkwright import InputError, MachineError, topper_field
from linkwright.kernel.files.library import template
from linkwright.machine import dumps
from linkwright.topping import cap_volume, constant_speed_lengths, draw_roots, edges_of, head_diameter, knives
from linkwright.topping import coverage as passes
from linkwright.topping.coverage import pass_over
from linkwright.topping.field import TopperField
from linkwright.topping.model.field import RandomField
from linkwright.topping.warnings import field_findings, field_warnings

Floats = NDArray[np.float64]

RANDOM = '[topper.field]\nkind = "random"\n'
SCATTER = (
    RANDOM
    + 'root_diameter = { kind = "normal", mean = "110 mm", deviation = "15 mm", min = "60 mm" }\n'
    + 'cut_height = { kind = "normal", mean = "30 mm", deviation = "5 mm", min = "10 mm", '
    + 'max = "50 mm" }\n'
)


def told(found: TopperField, described: lw.Machine) -> str:
    assert described.topper is not None
    knife = knives(described, described.topper)[0]
    return "\n".join(
        [*field_findings(found, described.topper), *field_warnings(found, described.topper, knife)]
    )


def needed_by_hand(alpha: float, phase: Floats, offset: float = 0.0) -> Floats:
    """2 max (|q| + √(d²/4 − p²)) over 40001 times, for the harmonic knife of the file."""
    v, half, rate = 1.9, 0.03, np.pi * 0.55 / 0.06
    radius = 0.5 * float(head_diameter(0.11, 0.03))
    t = np.linspace(-0.06, 0.06, 40001)
    found = []
    for theta in phase:
        y = half * np.sin(theta + rate * t) - offset
        q = v * t * np.sin(alpha) + y * np.cos(alpha)
        p = v * t * np.cos(alpha) - y * np.sin(alpha)
        on = np.abs(p) <= radius
        found.append(2 * np.max(np.abs(q[on]) + np.sqrt(radius**2 - p[on] ** 2)))
    return np.array(found)


def test_one_head_in_all_phases_by_quadrature() -> None:
    found = topper_field(machine(RANDOM, field__offset=0.0))
    # Even phases: the midpoint rule of a share has an error of a step of 1/500.
    needed = needed_by_hand(np.radians(20), (np.arange(500) + 0.5) * (2 * np.pi / 500))
    for length in (0.14, 0.15, 0.16, 0.17):
        share = np.interp(length, found.length, found.share)
        # Four deviations of a share of 20 000, the step, and the distance of the curve's points.
        assert share == pytest.approx(float(np.mean(needed <= length)), abs=4 * 0.5 / np.sqrt(20000) + 0.012)
    assert found.length_for_90 == pytest.approx(float(np.quantile(needed, 0.9)), abs=5e-4)
    assert found.length_needed.max() <= needed.max() * (1 + 1e-6)


def test_knife_at_rest_needs_the_band_of_its_head() -> None:
    topped = machine(SCATTER, knife_speed=0.0)
    assert topped.topper is not None
    found, roots = topper_field(topped), draw_roots(topped.topper)
    d = head_diameter(roots.root_diameter, roots.cut_height)
    np.testing.assert_allclose(
        found.length_needed, (d + 2 * np.abs(roots.offset)) / np.cos(np.radians(20)), rtol=1e-9
    )


def test_share_at_rest_is_a_convolution() -> None:
    topped = machine(SCATTER, knife_speed=0.0)
    found = topper_field(topped, level=0.999)
    # Distribution of d + 2|δ| by midpoint shares of D and h_p, and a uniform |δ| up to 20 mm in closed form.
    shares = (np.arange(400) + 0.5) / 400
    assert topped.topper is not None
    field = topped.topper.field
    assert isinstance(field, RandomField)
    assert field.root_diameter is not None
    assert field.cut_height is not None
    D, h = np.meshgrid(field.root_diameter.values(shares), field.cut_height.values(shares))
    d = head_diameter(D, h)
    for length in np.linspace(0.11, 0.17, 13):
        truth = np.clip((length * np.cos(np.radians(20)) - d) / 0.04, 0, 1).mean()
        low, high = (np.interp(length, found.length, each) for each in (found.share_low, found.share_high))
        assert low - 1e-3 <= truth <= high + 1e-3


def test_haulm_at_rest_is_a_segment_of_the_disc() -> None:
    # In the middle of the row an edge of length L leaves two segments beyond ±L cos α/2.
    topped = machine(RANDOM, knife_speed=0.0, edge_length=0.08, field__offset=0.0, field__roots=500)
    found = topper_field(topped)
    radius, half = 0.5 * float(head_diameter(0.11, 0.03)), 0.04 * np.cos(np.radians(20))
    angle = np.arccos(half / radius)
    share = 2 * (angle - np.sin(angle) * np.cos(angle)) / np.pi
    assert found.haulm_mean == pytest.approx(share, rel=1e-9)
    # All heads are alike: there is nothing to be uncertain of, but rounding.
    assert found.haulm_mean_high - found.haulm_mean_low < 1e-12
    assert found.share_complete == 0
    assert 0 < found.share_complete_high < 0.02


def test_loss_by_moments() -> None:
    text = RANDOM + 'cut_height = { kind = "normal", mean = "40 mm", deviation = "4 mm" }\n'
    found = topper_field(machine(text, field__root_density="1100 kg/m^3"), level=0.999)
    mean, deviation = 0.04, 0.004
    square, cube = mean**2 + deviation**2, mean**3 + 3 * mean * deviation**2
    volume = np.pi / 3 * (1.5 * 0.11 * square - cube)
    assert found.loss_mean_low <= volume <= found.loss_mean_high
    assert found.loss_mean == pytest.approx(volume, rel=0.005)
    assert found.loss_share == pytest.approx(found.loss_mean / (np.pi / 6 * 0.11**3), rel=1e-12)
    assert found.loss_mass_mean == pytest.approx(1100 * found.loss_mean, rel=1e-12)
    assert found.root_loss.mean() == pytest.approx(found.loss_mean, rel=1e-12)


def test_missed_and_lost_heads() -> None:
    text = RANDOM + 'cut_height = { kind = "uniform", min = "-30 mm", max = "130 mm" }\nroots = 16000\n'
    topped = machine(text, edge_length=1.0)
    found = topper_field(topped)
    # Of 160 mm, 30 lie below 0 and 20 above D = 110 mm; four deviations of a count of 16 000.
    assert found.n_missed == pytest.approx(3000, abs=4 * 50)
    assert found.n_lost == pytest.approx(2000, abs=4 * 42)
    assert np.isinf(found.length_needed).sum() == found.n_missed
    assert found.share_complete == 1 - found.n_missed / 16000
    assert found.haulm_mean == pytest.approx(found.n_missed / 16000, rel=1e-12)
    assert np.isinf(found.length_for_90)
    assert found.length_for_50 < 0.25
    assert found.root_loss.max() == pytest.approx(np.pi / 6 * 0.11**3, rel=1e-12)
    text = told(found, topped)
    assert "passes above 18" in text
    assert "passes below 12" in text


def test_a_knife_in_one_direction_is_met_half_going_left() -> None:
    topped = machine(RANDOM, motion={"kind": "constant"}, field__roots=4000)
    assert topped.topper is not None
    found, roots = topper_field(topped), draw_roots(topped.topper)
    left, right = constant_speed_lengths(roots.diameter, np.abs(roots.offset), np.radians(20), 1.9, 0.55)
    goes_left = np.isclose(found.length_needed, left, rtol=1e-9)
    goes_right = np.isclose(found.length_needed, right, rtol=1e-9)
    assert (goes_left ^ goes_right).all()
    # Four deviations of a half of 4000.
    assert goes_left.sum() == pytest.approx(2000, abs=4 * 32)


def test_a_given_phase_is_that_of_all_heads() -> None:
    topped = machine(RANDOM, motion__phase="40 deg", field__roots=300, field__offset="5 mm")
    found = topper_field(topped)
    assert np.ptp(found.length_needed) == 0
    by_hand = needed_by_hand(np.radians(20), np.radians([40.0]), 0.005)
    assert found.length_needed[0] == pytest.approx(by_hand[0], rel=1e-6)


def test_spacing_locked_to_the_stroke_gives_rows_one_phase() -> None:
    frequency = 0.55 / 0.12
    topped = machine(SCATTER, field__spacing=1.9 / frequency)
    assert topped.topper is not None
    roots = draw_roots(topped.topper)
    phase = roots.phase(2 * np.pi * frequency, 1.9)
    turns = np.exp(1j * phase).reshape(100, 200)
    np.testing.assert_allclose(turns, np.broadcast_to(turns[:, :1], turns.shape), atol=1e-9)
    locked, free = topper_field(topped), topper_field(machine(SCATTER))
    wide = locked.share_complete_high - locked.share_complete_low
    assert wide > 3 * (free.share_complete_high - free.share_complete_low)
    assert "roots of a row meet it in one phase" in told(locked, topped)
    half = machine(SCATTER, field__spacing=1.5 * 1.9 / frequency)
    assert "no more than 2 phases" in told(topper_field(half), half)
    usual = machine(SCATTER, field__spacing="0.3 m")
    assert told(topper_field(usual), usual) == ""


def test_table_of_the_page_is_what_comes_out() -> None:
    root = Path(__file__).parents[2]
    page = (root / "docs" / "theory" / "topper_field.md").read_text(encoding="utf-8")
    text = {"topper.edge_length": 0.18, "topper.field": {"kind": "random"}}
    bells = {
        "topper.field.root_diameter": {"kind": "normal", "mean": 0.11, "deviation": 0.015, "least": 0.06},
        "topper.field.cut_height": {"kind": "normal", "mean": 0.03, "deviation": 0.005, "least": 0.005},
    }
    for spacing in (None, 0.3, 1.9 * 0.12 / 0.55):
        apart = {} if spacing is None else {"topper.field.spacing": spacing}
        found = topper_field(lw.read(root / "machines" / "topper.toml", {**text, **bells, **apart}))
        ends = f"{100 * found.share_complete_low:.1f} to {100 * found.share_complete_high:.1f} %"
        assert f"| {100 * found.share_complete:.1f} % | {ends} |" in page


def test_spacing_moves_the_phase_on() -> None:
    text = SCATTER + 'spacing = { kind = "uniform", min = "0.2 m", max = "0.3 m" }\nrows = 7\nroots = 100\n'
    topped = machine(text)
    assert topped.topper is not None
    roots = draw_roots(topped.topper)
    assert (np.diff(roots.distance)[np.diff(roots.cluster) == 0] >= 0.2).all()
    assert (roots.distance[np.flatnonzero(np.diff(roots.cluster)) + 1] == 0).all()
    phase, rate = roots.phase(30.0, 1.9), 30.0
    step = np.diff(phase) - rate * np.diff(roots.distance) / 1.9
    same_row = np.diff(roots.cluster) == 0
    np.testing.assert_allclose(np.exp(1j * step[same_row]), 1, atol=1e-12)
    assert np.bincount(roots.cluster).tolist() == [15, 14, 14, 15, 14, 14, 14]


def test_the_same_seed_gives_the_same_bits(monkeypatch: pytest.MonkeyPatch) -> None:
    topped = machine(SCATTER, field__roots=3000)
    first = topper_field(topped)
    monkeypatch.setattr(passes, "_PORTION", 257)
    done: list[float] = []
    second = topper_field(topped, watch=done.append)
    for name, values in first.curves().items():
        assert np.array_equal(values, second.curves()[name])
    assert first.to_dict() == second.to_dict()
    assert first.to_dict() != topper_field(topped, seed=2).to_dict()
    assert topper_field(topped, seed=1).to_dict() == first.to_dict()
    assert done == sorted(done)
    assert done[-1] == 1.0


def test_roots_stay_when_the_knife_changes() -> None:
    one, other = machine(SCATTER), machine(SCATTER, edge_angle="40 deg", knife_speed="0.3 m/s")
    assert one.topper is not None
    assert other.topper is not None
    first, second = draw_roots(one.topper), draw_roots(other.topper)
    for name in ("root_diameter", "cut_height", "offset", "start"):
        assert np.array_equal(getattr(first, name), getattr(second, name))


def test_without_a_field_roots_are_alike() -> None:
    topped = machine()
    found = topper_field(topped)
    assert found.n_roots == 20000
    assert np.ptp(found.root_loss) == 0
    assert found.root_loss[0] == pytest.approx(float(cap_volume(0.11, 0.03)), rel=1e-15)
    assert "no [topper.field]" in told(found, topped)


def test_measured_roots_from_a_file(tmp_path: Path) -> None:
    rows = [(100, 25, -8), (120, 31, 3), (90, -2, 12), (131, 40, 0)]
    head = "root_diameter [mm], cut_height [mm], offset [mm]\n"
    (tmp_path / "roots.csv").write_text(head + "".join(f"{a},{b},{c}\n" for a, b, c in rows))
    text = TOPPER + '[topper.field]\nkind = "measured"\nfile = "roots.csv"\nphases = 100\n'
    (tmp_path / "topper.toml").write_text(text)
    topped = lw.read(tmp_path / "topper.toml")
    assert topped.topper is not None
    roots = draw_roots(topped.topper)
    assert roots.root_diameter.reshape(4, 100)[:, 0].tolist() == pytest.approx([0.1, 0.12, 0.09, 0.131])
    # The phases of each root are even over a revolution.
    gaps = np.diff(np.sort(roots.start.reshape(4, 100), axis=1), axis=1)
    np.testing.assert_allclose(gaps, 0.01, atol=1e-12)
    found = topper_field(topped)
    assert (found.clusters, found.n_roots, found.n_clusters, found.n_missed) == ("roots", 400, 4, 100)
    direct = pass_over(edges_of(topped, topped.topper), roots)
    shares = (direct.length_needed.reshape(4, 100) <= 0.18).mean(axis=1)
    assert found.share_complete == pytest.approx(shares.mean(), rel=1e-12)
    assert shares[2] == 0
    assert found.loss_mean == pytest.approx(
        float(np.mean(cap_volume(np.array([0.1, 0.12, 0.131, 0.1]), np.array([0.025, 0.031, 0.04, 0.0])))),
        rel=1e-12,
    )
    # The file that is written has the roots themselves, and reads back as the same machine.
    again = lw.loads(dumps(topped))
    assert topper_field(again).to_dict() == found.to_dict()


def test_measured_spacing_keeps_phases_together() -> None:
    text = '[topper.field]\nkind = "measured"\nphases = 8\nroot_diameter = [0.1, 0.1, 0.1]\n'
    text += "cut_height = [0.02, 0.02, 0.02]\noffset = [0, 0, 0]\nspacing = [9, 0.2, 0.25]\n"
    topped = machine(text)
    assert topped.topper is not None
    roots = draw_roots(topped.topper)
    phase = roots.phase(20.0, 1.9).reshape(3, 8)
    for i, way in ((1, 0.2), (2, 0.45)):
        np.testing.assert_allclose(
            np.exp(1j * (phase[i] - phase[0])), np.exp(1j * 20.0 * way / 1.9), atol=1e-12
        )


def test_limits_of_the_file_are_judged() -> None:
    text = SCATTER + "[topper.limits]\ncomplete_min = 0.97\nhaulm_max = 1e-4\nslicing_min = 1\n"
    topped = machine(text, limits__length_max="0.17 m")
    words = told(topper_field(topped), topped)
    for part in ("97 % are required", "% is permitted", "1 is required", "0.17 m is permitted"):
        assert part in words
    assert told(topper_field(machine(SCATTER)), machine(SCATTER)) == ""


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ({"field__spacing": 0.3, "motion__phase": 1.0}, "motion.phase gives all heads one phase"),
        ({"field__spacing": 0.3, "motion": {"kind": "constant"}}, "a stroke of the knife"),
        ({"field__rows": 30000}, "at most one for each of 20000 roots"),
        ({"field__root_diameter": -0.1}, "a length greater than 0"),
        ({"field__root_diameter": {"kind": "normal", "mean": 0.1, "deviation": 0.01}}, "no minimum value"),
        ({"field__spacing": {"kind": "uniform", "least": -0.1, "greatest": 0.1}}, "values down to -0.1 m"),
    ],
)
def test_fields_that_cannot_be(entries: dict[str, object], words: str) -> None:
    with pytest.raises(MachineError, match=words):
        machine(RANDOM, **entries)


def test_wrong_arguments() -> None:
    topped = machine(RANDOM)
    with pytest.raises(InputError, match="seed: found -1"):
        topper_field(topped, seed=-1)
    with pytest.raises(InputError, match="level: found 1,"):
        topper_field(topped, level=1.0)
    with pytest.raises(InputError, match=r"has no \[topper\]"):
        topper_field(lw.loads(template("slider-crank")))


def test_intervals_of_greater_shares_are_not_lower(tmp_path: Path) -> None:
    """With three roots, each in all phases, intervals are as wide as can be."""
    (tmp_path / "roots.csv").write_text(
        "root_diameter [mm], cut_height [mm], offset [mm]\n90, 25, -8\n110, 31, 3\n128, 35, 12\n",
        encoding="utf-8",
    )
    text = f'{TOPPER}\n[topper.field]\nkind = "measured"\nfile = "roots.csv"\n'
    (tmp_path / "machine.toml").write_text(text, encoding="utf-8")
    found = topper_field(lw.read(tmp_path / "machine.toml"))
    for ends in (found.quantile_length_low, found.quantile_length_high):
        assert (np.diff(np.asarray(ends, dtype=float)) >= 0).all()
