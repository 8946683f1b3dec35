"""Variants of a knife over the same roots."""

from __future__ import annotations

import numpy as np
import pytest
from topper_fields import CRANK, machine

import linkwright as lw
from linkwright import FindingError, InputError, sweep_field, topper_field
from linkwright.topping import cap_volume
from linkwright.topping.sweep import edges_with

RANDOM = '[topper.field]\nkind = "random"\nroots = 2000\nspacing = "0.31 m"\n'


def on_a_crank(text: str = RANDOM, **entries: float) -> lw.Machine:
    return lw.loads(CRANK + text, entries)


def test_each_variant_is_the_field_of_its_own_machine() -> None:
    axes = {"edge_angle": np.radians([0.0, 30.0]), "forward_speed": [1.6, 1.9, 2.2]}
    done: list[float] = []
    swept = sweep_field(machine(RANDOM), axes, seed=5, watch=done.append)
    assert swept.shape == (2, 3)
    for i, (angle, speed) in enumerate([(a, v) for a in axes["edge_angle"] for v in axes["forward_speed"]]):
        own = topper_field(machine(RANDOM, edge_angle=angle, forward_speed=speed), seed=5)
        assert swept.entries["edge_angle"][i] == angle
        for name in ("share_complete", "haulm_mean_low", "length_for_95", "slicing_ratio_mean"):
            assert getattr(swept, name)[i] == getattr(own, name)
    assert done == sorted(done)
    assert done[-1] == pytest.approx(1.0)


def test_longer_edges_leave_less() -> None:
    swept = sweep_field(machine(RANDOM), {"edge_length": np.linspace(0.05, 0.25, 9)})
    # Over the same roots this holds of each step, not on average alone.
    assert (np.diff(swept.share_complete) >= 0).all()
    assert (np.diff(swept.haulm_mean) <= 0).all()
    assert np.ptp(swept.loss_mean) == np.ptp(swept.length_for_95) == 0
    found = topper_field(machine(RANDOM))
    for length, share in zip(swept.entries["edge_length"], swept.share_complete, strict=True):
        assert share == np.mean(found.length_needed <= length)


def test_a_crank_that_turns_faster_moves_the_knife_faster() -> None:
    topped = on_a_crank()
    assert topped.topper is not None
    (own,) = edges_with(topped, topped.topper, None)
    speed = own.knife.mean_speed
    # Twice the stroke of 60 mm a revolution, but for the rod.
    assert speed == pytest.approx(2 * 0.06 * 275 / 60, rel=1e-6)
    swept = sweep_field(topped, {"knife_speed": [0.0, speed, 2 * speed]})
    for place, rpm in ((1, 275), (2, 550)):
        faster = topper_field(on_a_crank(**{"drive.speed": rpm * np.pi / 30}))
        assert swept.share_complete[place] == faster.share_complete
        assert swept.haulm_mean[place] == pytest.approx(faster.haulm_mean, rel=1e-9)
    rest = topper_field(machine(RANDOM, knife_speed=0.0))
    assert swept.length_for_95[0] == pytest.approx(rest.length_for_95, rel=1e-12)


def test_heights_are_shifted_to_their_mean() -> None:
    text = RANDOM + 'cut_height = { kind = "normal", mean = "30 mm", deviation = "5 mm" }\n'
    swept = sweep_field(machine(text), {"cut_height": [-0.05, 0.02, 0.04]})
    assert swept.share_complete[0] == 0
    assert swept.haulm_mean[0] == 1
    assert swept.loss_mean[0] == 0
    constant = sweep_field(machine(RANDOM), {"cut_height": [0.02, 0.04]})
    assert constant.loss_mean.tolist() == pytest.approx(
        cap_volume(0.11, np.array([0.02, 0.04])).tolist(), rel=1e-12
    )
    assert swept.loss_mean[2] == pytest.approx(constant.loss_mean[1], rel=0.02)


def test_an_edge_that_barely_advances_is_left_out() -> None:
    # Far oblique the edge runs back with each stroke: tan 88° times the speed of the knife is 13 v.
    small = RANDOM.replace("2000", "200")
    swept = sweep_field(machine(small), {"edge_angle": np.radians([20.0, 88.0])})
    assert np.isfinite(swept.share_complete).tolist() == [True, False]
    for run in (lambda: sweep_field(machine(small), {"edge_angle": [1.536]}), far_aslant):
        with pytest.raises(FindingError, match="barely advances"):
            run()


def far_aslant() -> None:
    topper_field(machine(RANDOM, edge_angle="88 deg"))


@pytest.mark.parametrize(
    ("over", "words"),
    [
        ({"edge_lenght": [1]}, 'did you mean "edge_length"'),
        ({}, "found 0 entries"),
        ({"edge_length": [1], "edge_angle": [0], "knife_speed": [1]}, "found 3 entries"),
        ({"edge_length": [0.0, 0.1]}, "found edge_length 0 m, expected more than 0"),
        ({"forward_speed": [0.0]}, "expected more than 0"),
        ({"knife_speed": [-1.0]}, "expected 0 or more"),
        ({"edge_angle": [np.pi / 2]}, "between -90 and 90 deg"),
        ({"edge_angle": [np.nan]}, "finite"),
        ({"edge_length": []}, "finite"),
        (
            {"edge_length": np.full(1000, 0.1), "edge_angle": np.zeros(1000)},
            "found 1 000 000, expected at most 100 000 variants",
        ),
    ],
)
def test_what_cannot_be_varied(over: dict[str, list[float]], words: str) -> None:
    with pytest.raises(InputError, match=words):
        sweep_field(machine(RANDOM), over)
