"""What a check sees: every finding of geometry that a study has, on shipped machines and on broken ones."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sizes import DEEP

import linkwright as lw
from linkwright import FindingError, InputError, Machine
from linkwright.app.feasibility import feasibility

ROOT = Path(__file__).parents[2]
SHIPPED = sorted([*ROOT.glob("machines/*.toml"), *ROOT.glob("examples/*/machine.toml")])

# Findings that take solving for a motion or for forces: a check leaves them to the study.
SOLVED = re.compile(
    "leaves cam|no steady motion|steady motion was not found|has not settled|stalls|runs backwards|vibrat|"
    "strikes|loses contact|inertia|unbounded|equal peaks|conform|rod string|Goodman",
    re.IGNORECASE,
)


def name_of(path: Path) -> str:
    return path.parent.name if path.name == "machine.toml" else path.stem


def changed(path: Path, entries: dict[str, Any]) -> Machine:
    return lw.read(path, [f"{address}={value!r}" for address, value in entries.items()])


def told(machine: Machine) -> set[str]:
    if machine.is_train_alone:
        lw.free_vibration(machine)
        return set()
    return {without_heads(text) for text in lw.study(machine).findings if not SOLVED.search(text)}


def seen(machine: Machine) -> set[str]:
    return {without_heads(text) for text in feasibility(machine).findings}


def without_heads(text: str) -> str:
    """A check looks at a part of the heads that a study follows, so the worst of them may be another."""
    return re.sub("(does not cut through every head).*", r"\1", text)


@pytest.mark.parametrize("path", SHIPPED, ids=name_of)
def test_a_check_sees_what_is_wrong_with_shipped_machines(path: Path) -> None:
    machine = lw.read(path)
    assert told(machine) <= seen(machine)


# Shipped machines, what is changed in them, and what the check then says.
BROKEN = (
    ("cam_roller_undercut", {"mechanism.cams.follower.roller_radius": 0.04}, "undercut"),
    ("cam_constant_breadth", {"mechanism.cams.yoke.breadth": 0.03}, "undercut"),
    ("cam_conjugate_pair", {"mechanism.cams.sley.second.angle": 0.01}, "leaves no room"),
    ("roller_one_cart", {"mechanism.sliders.cart1.rod": 0.15}, "closes only at crank angles"),
    ("four_bar_coupler_curve", {"mechanism.cranks.A.radius": 0.5}, "close"),
    ("rod_rotator_continuous", {"pumping_unit.P": 1.0}, "close"),
    ("rod_rotator_intermittent", {"rod_rotator.swing": 3.139}, "No lever of the rotator"),
    ("rod_rotator_intermittent", {"rod_rotator.pin_distance": 4.5}, "No link and lever"),
    ("topper", {"topper.edge_length": 0.02}, "does not cut through every head"),
    ("topper", {"topper.edge_angle": 1.5705}, "barely|hardly|no length"),
    ("roller_one_cart", {"drive.motor.torque_start": 1.0, "drive.gearbox.ratio": 1.0}, "Does not start"),
)


@pytest.mark.parametrize(("name", "changes", "words"), BROKEN)
def test_a_check_says_what_is_broken(name: str, changes: dict[str, Any], words: str) -> None:
    path = next(each for each in SHIPPED if name_of(each) == name)
    machine = changed(path, changes)
    found = feasibility(machine).findings
    assert any(re.search(words, text) for text in found), found
    assert told(machine) <= {without_heads(text) for text in found}


def test_a_check_sees_what_a_field_of_roots_refuses() -> None:
    path = ROOT / "examples" / "topper_field" / "machine.toml"
    machine = changed(path, {"topper.knife_speed": 30.0})
    with pytest.raises(FindingError) as refused:
        lw.topper_field(machine)
    assert str(refused.value) in feasibility(machine).findings


# Machines with neither motor nor loads to solve for, whose lengths are drawn anew.
DRAWN = (
    "cam_roller_undercut",
    "cam_conjugate_pair",
    "cam_constant_breadth",
    "cam_oscillating_valve",
    "change_points",
    "klann_leg",
    "quick_returns",
    "rod_rotator_continuous",
    "rod_rotator_intermittent",
    "six_bar_chains",
    "topper",
)

LENGTHS = re.compile(".*radius|.*length|.*distance|breadth|rod|coupler|rocker|offset|[APCHIR]")


def lengths(machine: Machine) -> Iterator[tuple[str, float]]:
    parts = [("pumping_unit", machine.pumping_unit), ("rod_rotator", machine.rod_rotator)]
    parts += [("topper", machine.topper)]
    parts += [
        (f"mechanism.{table}.{name}", element)
        for table, elements in machine.mechanism
        if isinstance(elements, dict)
        for name, element in elements.items()
    ]
    for where, part in parts:
        # Numbers that cams leave out are made of others.
        for key, value in part or ():
            if isinstance(value, float) and value > 0 and LENGTHS.fullmatch(key):
                yield f"{where}.{key}", value


@pytest.mark.parametrize("name", DRAWN)
def test_a_check_never_says_ok_where_the_study_has_a_finding_of_geometry(name: str) -> None:
    rng = np.random.default_rng(sum(name.encode()))
    path = next(each for each in SHIPPED if name_of(each) == name)
    entries = dict(lengths(lw.read(path)))
    assert entries
    for _ in range(4):
        address = str(rng.choice(list(entries)))
        drawn = {address: entries[address] * float(rng.choice([0.05, 0.3, 0.6, 1.7, 4.0]))}
        try:
            other = changed(path, drawn)
        except InputError:
            continue
        assert told(other) <= seen(other), drawn


@pytest.mark.deep
@pytest.mark.parametrize("name", ["topper_field", "topper_cam"])
def test_a_check_of_a_knife_says_what_the_study_says(name: str) -> None:
    """Also where a few heads do not decide: about the length that the worst head needs."""
    path = ROOT / "examples" / name / "machine.toml"
    needed = lw.topper(lw.read(path)).length_exact
    beside = (needed - 1e-6, needed + 1e-6)
    # Heads under a knife of a cam take a second each time.
    away = (0.5 * needed, 1.02 * needed, 2.0 * needed) if DEEP or name != "topper_cam" else ()
    for length in (*beside, *away):
        machine = changed(path, {"topper.edge_length": length})
        assert told(machine) == seen(machine), length
