"""Derivatives of strokes, swings, time ratios and transmission angles: closed forms, differences, ties."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import invoke
from random_drives import random_drive
from sizes import cases, random_cases

import linkwright as lw
from linkwright import FindingError, LinkwrightError
from linkwright.linkages.gradient import linkage_tangents
from linkwright.machine import exchanged

EXAMPLES = Path(__file__).parents[2] / "examples"

# Extremes are located to rounding of the curve's slope; h⁶ of what is left by extrapolation beside it.
_STEP, _TOLERANCE = 1e-4, 1e-7

R, L, E = 0.1, 0.28, 0.03
SLIDER = f"""
format = 1
name = "slider-crank"
[mechanism.cranks.A]
radius = {R}
[mechanism.sliders.S]
crank = "A"
rod = {L}
offset = {E}
"""


def test_an_offset_slider() -> None:
    """Stroke √((l+r)²−e²) − √((l−r)²−e²); μ_min = arccos((r+e)/l); both dead centres for the time ratio."""

    def closed(r: float, rod: float, e: float) -> dict[str, float]:
        far, near = math.asin(e / (rod + r)), math.asin(e / (rod - r))
        between = near - far
        return {
            "stroke": math.sqrt((rod + r) ** 2 - e**2) - math.sqrt((rod - r) ** 2 - e**2),
            "transmission_angle_worst": math.acos((r + abs(e)) / rod),
            "time_ratio": (math.pi + between) / (math.pi - between),
        }

    entries = [f"mechanism.{name}" for name in ("cranks.A.radius", "sliders.S.rod", "sliders.S.offset")]
    found = lw.gradient(lw.loads(SLIDER), ["linkage.S"], entries)
    at, h = np.array([R, L, E]), 1e-4
    for name in closed(R, L, E):
        for column, unit in enumerate(np.eye(3)):
            near = {n: closed(*(at + n * h * unit))[name] for n in (-2, -1, 1, 2)}
            difference = (8 * (near[1] - near[-1]) - near[2] + near[-2]) / (12 * h)
            exact = found.of(f"linkage.S.{name}")[entries[column]]
            # Differences of fourth order over 1e-4.
            assert exact == pytest.approx(difference, rel=1e-8, abs=1e-10), (name, entries[column])


def test_of_an_inline_slider_the_stroke_is_twice_the_crank() -> None:
    found = linkage_tangents(lw.loads(SLIDER.replace(str(E), "0")), ["mechanism.cranks.A.radius"])
    assert found.tangents["S.stroke"].d.item() == pytest.approx(2.0, rel=1e-13)
    # Both ends of the cycle have the same μ, which an offset would part.
    along = linkage_tangents(lw.loads(SLIDER.replace(str(E), "0")), ["mechanism.sliders.S.offset"])
    assert "deviate equally from 90°" in along.ties["S.transmission_angle_worst"]
    assert np.isnan(along.tangents["S.transmission_angle_worst"].d).all()
    assert along.missing["S.time_ratio"] == "both ways take the same crank angle"


def _scalars(machine: lw.Machine) -> dict[str, float]:
    elements = lw.linkage(machine).to_dict()["elements"]
    return {f"{name}.{key}": x for name, one in elements.items() for key, x in one.items()}


def _difference(machine: lw.Machine, address: str, names: list[str], step: float) -> np.ndarray:
    """Central differences over h, 2h and 4h, extrapolated to sixth order, by the share of an entry."""
    value = lw.get(machine, address)
    size = abs(value) or 0.1
    near = {}
    for n in (-4, -2, -1, 1, 2, 4):
        scalars = _scalars(exchanged(machine, {address: value + n * step * size}))
        near[n] = np.array([scalars[name] for name in names])

    def between(n: int) -> Any:
        change = near[n] - near[-n]
        turned = np.array(["angle" in name.rpartition("_")[2] for name in names])
        # Crank angles are those of one revolution.
        return np.where(turned, (change + np.pi) % (2 * np.pi) - np.pi, change) / (2 * n * step)

    found: np.ndarray = (64 * between(1) - 20 * between(2) + between(4)) / 45
    return found


def _wrong(machine: lw.Machine, every: int) -> tuple[int, list[str]]:
    """How many derivatives were compared, and which are wrong."""
    entries = [name for name in lw.addresses(machine) if name.startswith("mechanism.")]
    found = linkage_tangents(machine, entries)
    names = [name for name in found.tangents if name not in found.ties]
    d = np.array([found.tangents[name].d for name in names]).reshape(len(names), len(found.variables))
    sizes = np.array([abs(lw.get(machine, entry)) or 0.1 for entry in found.variables])
    exact = d * sizes
    values = np.array([abs(found.tangents[name].value) for name in names])
    scales = np.maximum(np.abs(exact).max(axis=1, initial=0.0), values) + 1e-300
    compared, wrong = 0, []
    for column in range(0, len(sizes), every):
        least = np.full(len(names), np.inf)
        try:
            # Differences over short steps know crank angles of flat extremes to the root of rounding.
            for step in (_STEP, 0.1 * _STEP):
                rough = _difference(machine, found.variables[column], names, step)
                least = np.minimum(least, np.abs(rough - exact[:, column]) / scales)
                if (least <= _TOLERANCE).all():
                    break
        except (LinkwrightError, KeyError):
            # Beside it the mechanism does not close, or the element turns on.
            continue
        wrong += [
            f"{names[k]} by {found.variables[column]}: {least[k]:.1e}"
            for k in np.flatnonzero(~(least <= _TOLERANCE))
        ]
        compared += len(names)
    return compared, wrong


_LINKAGES = (
    *("four_bar_coupler_curve", "six_bar_chains", "quick_returns", "jansen_leg", "klann_leg"),
    *("three_circle_triad", "gears_and_guides", "geared_five_bar", "knuckle_press_drawing", "press_motion"),
)


@pytest.mark.parametrize("name", _LINKAGES)
def test_derivatives_are_those_of_the_linkage(name: str) -> None:
    compared, wrong = _wrong(lw.read(EXAMPLES / name / "machine.toml"), cases(3, 1))
    assert not wrong, wrong
    assert compared > 3


def test_derivatives_of_random_mechanisms() -> None:
    compared = 0
    for case, random in random_cases(53, 10, 1000):
        try:
            machine = lw.Machine.model_validate(random_drive(random))
            one, wrong = _wrong(machine, cases(3, 1))
        except LinkwrightError:
            # It does not close, or all its links turn on.
            continue
        assert not wrong, (case, wrong)
        compared += one
    assert compared > 50


def test_what_has_no_derivative_says_why() -> None:
    leg = linkage_tangents(lw.read(EXAMPLES / "jansen_leg" / "machine.toml"), ["mechanism.cranks.A.radius"])
    assert leg.missing["C.transmission_angle_min"] == "it is the same at all crank angles"
    with pytest.raises(FindingError, match="no link or slide"):
        linkage_tangents(
            lw.read(EXAMPLES / "cam_on_the_shaft" / "machine.toml"), ["mechanism.cams.valve.phase"]
        )


def test_from_the_command_line(tmp_path: Path) -> None:
    (tmp_path / "slider.toml").write_text(SLIDER)
    given = ["sensitivity", str(tmp_path / "slider.toml"), "--of", "linkage.S.stroke"]
    said = invoke(*given)
    assert said.exit_code == 0, said.output
    assert "stroke of the slide of S" in said.output
