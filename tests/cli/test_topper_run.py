"""`linkwright run` of toppers: the promised names, what follows each entry, exit codes."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import invoke

MACHINES = Path(__file__).parents[2] / "machines"

# The file's own: D, h_p, Δ, α, L, v, v_h, S.
ENTRIES = {
    "root_diameter": 0.11,
    "cut_height": 0.03,
    "offset": 0.02,
    "edge_angle": math.radians(20),
    "edge_length": 0.28,
    "forward_speed": 1.9,
    "knife_speed": 0.55,
    "motion.stroke": 0.06,
}

# Each on its own: what it becomes, as one would write it.
CHANGES = {
    "root_diameter": ("142 mm", 0.142),
    "cut_height": ("0.041 m", 0.041),
    "offset": ("33 mm", 0.033),
    "edge_angle": ("-31 deg", math.radians(-31)),
    "edge_length": ("12 cm", 0.12),
    "forward_speed": ("2.7 m/s", 2.7),
    "knife_speed": ("310 mm/s", 0.31),
    "motion.stroke": ("85 mm", 0.085),
}

LENGTHS = ("length_published", "length_consistent", "length_exact_constant_speed", "length_exact")


def run(*arguments: str, file: str = "topper.toml") -> tuple[int, dict[str, Any]]:
    done = invoke("run", MACHINES / file, "--json", *arguments)
    assert done.exception is None or isinstance(done.exception, SystemExit)
    return done.exit_code, json.loads(done.stdout, parse_constant=pytest.fail)


def closed_forms(entries: dict[str, float]) -> dict[str, float]:
    D, h, delta, alpha, _, v, v_h, stroke = (entries[name] for name in ENTRIES)
    d = 2 * math.sqrt(h * (D - h))
    sin, cos, band = abs(math.sin(alpha)), math.cos(alpha), d + 2 * delta
    return {
        "head_diameter": d,
        "length_published": band * (v_h / v * cos + sin),
        "length_consistent": band * (v_h / v * (1 + sin**2 / cos) + sin),
        "length_exact_constant_speed": (d * math.hypot(v, v_h) + 2 * delta * v) / (v * cos - v_h * sin),
        "length_exact": (stroke + band) / cos,
    }


def share_left(entries: dict[str, float]) -> float:
    """The largest share left of heads at both limits of the offset: 72 phases, chords by samples."""
    D, h, delta, alpha, length, v, v_h, stroke = (entries[name] for name in ENTRIES)
    r, sin, cos = math.sqrt(h * (D - h)), math.sin(alpha), math.cos(alpha)
    t = np.linspace(-1, 1, 4001) * (r + (stroke + delta) * abs(sin)) / (v * cos)
    found = []
    for phase in np.radians(np.arange(0, 360, 5)):
        y = 0.5 * stroke * np.sin(phase + math.pi * v_h / stroke * t) - delta
        p, q = v * t * cos - y * sin, v * t * sin + y * cos
        c = np.sqrt(np.clip(r**2 - p**2, 0, None))
        cut = np.clip(np.minimum(c, q + 0.5 * length) - np.maximum(-c, q - 0.5 * length), 0, None)
        found.append(np.trapezoid(2 * c - cut, p) / (math.pi * r**2))
    return max(found)


@pytest.mark.parametrize("name", CHANGES)
def test_results_follow_each_entry(name: str) -> None:
    text, value = CHANGES[name]
    code, found = run("--set", f"topper.{name}={text}")
    result, entries = found["results"]["topper"], {**ENTRIES, name: value}
    for key, expected in closed_forms(entries).items():
        assert result[key] == pytest.approx(expected, rel=1e-9), key
    is_short = entries["edge_length"] < result["length_exact"]
    assert code == (1 if is_short else 0)
    assert len(found["findings"]) == is_short
    # Phases every 5° miss the worst by little.
    assert result["uncut_share"] == pytest.approx(share_left(entries), abs=2e-3)
    assert (result["uncut_share"] > 0) == is_short


def test_short_edges_leave_what_they_do_not_reach() -> None:
    shares = []
    for name, (text, value) in CHANGES.items():
        short = ("--set", "topper.edge_length=0.11")
        _, found = run("--set", f"topper.{name}={text}", *(short if name != "edge_length" else ()))
        entries = {**ENTRIES, "edge_length": 0.11, name: value}
        shares.append(found["results"]["topper"]["uncut_share"])
        assert shares[-1] == pytest.approx(share_left(entries), abs=2e-3), name
    assert len({round(share, 6) for share in shares}) == len(shares)


def test_no_length_is_enough() -> None:
    code, found = run(
        *("--set", 'topper.motion={kind="constant"}'),
        *("--set", "topper.edge_angle=45 deg", "--set", "topper.knife_speed=1.9"),
    )
    result = found["results"]["topper"]
    assert code == 1
    assert result["length_exact"] is None
    assert result["length_exact_constant_speed"] is None
    assert result["uncut_share"] == 1
    assert result["length_published"] > 0
    assert found["findings"] == ["The edge moves along itself and cuts nothing: no length is enough."]


def test_a_retreating_edge_is_warned_of() -> None:
    _, found = run(
        "--set",
        "topper.edge_angle=58 deg",
        "--set",
        "topper.knife_speed=1.2",
        "--set",
        "topper.motion.phase=0",
        "--set",
        "topper.offset=0",
    )
    assert found["results"]["topper"]["edge_retreats"]
    assert any("backwards" in text for text in found["warnings"])


def test_what_is_not_computed_is_null() -> None:
    code, found = run("--set", "topper.edge_angle=89.9 deg")
    result = found["results"]["topper"]
    assert code == 1
    assert result["length_exact"] is result["uncut_share"] is None
    assert result["length_exact_constant_speed"] > result["length_published"] > 0
    assert found["findings"] == [result["obstacle"]]


def test_a_knife_that_turns_back_at_once_has_no_greatest_acceleration() -> None:
    code, found = run("--set", "topper.motion.kind=constant")
    assert code == 0
    assert found["results"]["topper"]["knife_acceleration_max"] is None


def test_a_mechanism_is_studied_beside() -> None:
    code, found = run(file="topper_crank.toml")
    assert code == 0
    assert {"topper", "linkage", "reduction", "steady_state", "forces"} <= set(found["results"])
    result = found["results"]["topper"]
    assert result["stroke"] == pytest.approx(0.06)
    assert result["knife_speed"] == pytest.approx(2 * 0.06 * 275 / 60)
    assert result["drive_torque_max"] == pytest.approx(
        found["results"]["forces"]["torque_drive_max"], rel=1e-3
    )


def test_a_rod_that_is_too_short_leaves_no_topper() -> None:
    code, found = run("--set", "mechanism.sliders.knife.rod=20 mm", file="topper_crank.toml")
    assert code == 1
    assert "topper" not in found["results"]
    assert "lengthen the rod" in found["findings"][0]


@pytest.mark.parametrize(
    "words", [("motion",), ("motion", "--at", "30 deg"), ("forces", "--speed", "100 rpm")]
)
def test_what_needs_a_crank_says_so(words: tuple[str, ...]) -> None:
    command, *options = words
    done = invoke(command, MACHINES / "topper.toml", *options)
    assert done.exit_code == 2
    assert "topper without a [mechanism]: no crank moves its knife" in done.output
