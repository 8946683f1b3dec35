"""``linkwright torsion diagnose``: the weak cylinder, JSON, wrong input."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import forced_vibration

ENGINE = Path(__file__).parents[2] / "examples" / "weak_cylinder" / "machine.toml"
SPEED = 50 * np.pi


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> str:
    found = forced_vibration(lw.read(ENGINE), np.array([SPEED]))
    waves = 1j * found.orders * SPEED * found.amplitudes[:, found.discs.index("flywheel"), 0]
    angle = 4 * np.pi * np.arange(721) / 720
    speed = SPEED + (np.exp(1j * np.outer(angle, found.orders)) @ waves).real
    speed += np.random.default_rng(3).normal(0, 0.02, len(speed))
    rows = [f"{np.degrees(a):.2f}, {w * 30 / np.pi:.4f}" for a, w in zip(angle, speed, strict=True)]
    path = tmp_path_factory.mktemp("measured") / "flywheel.csv"
    path.write_text("\n".join(["angle [deg], speed [rpm]", *rows]) + "\n", encoding="utf-8")
    return str(path)


run = partial(invoke, "torsion", "diagnose", ENGINE)


def test_json(measured: str) -> None:
    result = run(measured, "--on", "flywheel", "--noise", "0.02 rad/s", "--json")
    assert result.exit_code == 0
    told = json.loads(result.stdout)
    found = told["results"]["diagnosis"]
    assert found["cylinders"] == [str(n) for n in range(1, 9)]
    assert found["weak"] == ["3"]
    # Three standard deviations.
    assert found["factor"][2] == pytest.approx(0.6, abs=1.5 * found["half_width"][2])
    assert found["half_width"][2] == pytest.approx(1.96 * found["deviation"][2], rel=1e-3)
    assert found["speed"] == pytest.approx(SPEED, rel=1e-4)
    assert (told["findings"], told["warnings"]) == ([], [])


def test_table_and_sentence(measured: str) -> None:
    result = run(measured, "--on", "flywheel")
    assert result.exit_code == 0
    row = next(line for line in result.stdout.splitlines() if line.startswith("cylinder 3"))
    assert row.split()[-1] == "weak"
    assert "Weak, the weakest first: cylinder 3 at 0.6" in result.stdout


def test_wider_intervals_of_a_higher_level(measured: str) -> None:
    half = [
        json.loads(run(measured, "--on", "flywheel", "--level", level, "--json").stdout)["results"][
            "diagnosis"
        ]["half_width"][0]
        for level in ("0.9", "0.99")
    ]
    assert half[1] > 1.4 * half[0]


def test_rigid_train_is_another_answer(measured: str) -> None:
    told = json.loads(run(measured, "--on", "flywheel", "--noise", "0.02 rad/s", "--rigid", "--json").stdout)
    assert told["results"]["diagnosis"]["factor"][2] > 2
    assert any("times the noise" in each for each in told["warnings"])


@pytest.mark.parametrize(
    ("words", "part"),
    [
        (["--on", "fly"], 'found "fly"'),
        (["--on", "flywheel", "--noise", "2 m"], "--noise"),
        (["--on", "flywheel", "--noise", "0 rad/s"], "greater than 0"),
        (["--on", "flywheel", "--level", "2"], "--level: found 2"),
        (["--on", "flywheel", "--zero", "9"], "1 to 8"),
        (["--on", "flywheel", "--set", "train.engine.strokes=2"], "firing_order"),
    ],
)
def test_wrong_words(measured: str, words: list[str], part: str) -> None:
    result = run(measured, *words)
    assert result.exit_code == 2
    assert part in result.stderr


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("angle [deg], n [rpm]\n0, 1500\n", "no column speed"),
        ("angle [deg], speed [rpm]\n" + "".join(f"{a}, 1500\n" for a in range(360)), "whole cycles of 720"),
    ],
)
def test_wrong_measurement(tmp_path: Path, text: str, part: str) -> None:
    path = tmp_path / "wrong.csv"
    path.write_text(text, encoding="utf-8")
    result = run(str(path), "--on", "flywheel")
    assert result.exit_code == 2
    assert part in result.stderr
