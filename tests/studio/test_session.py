"""A tab computes what the command line computes, keeps comments of files, and disturbs no other tab."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.kernel.files.library import template
from linkwright.linkages.kinematics import kinematics
from linkwright.machine.read import loads
from linkwright.studio.controls import controls
from linkwright.studio.document import changed
from linkwright.studio.drag import drag

from .conftest import Served, Tab

CARTS = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"


def scalar(answer: dict, result: str, name: str) -> float:  # type: ignore[type-arg]
    found = next(each for each in answer["results"] if each["name"] == result)
    return float(next(each["value"] for each in found["scalars"] if each["name"] == name))


def test_numbers_are_those_of_the_package(tab: Tab) -> None:
    text = CARTS.read_text()
    answer = tab.ask(ask="compute", text=text, set={"mechanism.cranks.A1.radius": 0.21})
    machine = lw.read(CARTS, {"mechanism.cranks.A1.radius": 0.21})
    steady = lw.steady_state(machine)
    # The studio asks for curves at other angles; measures are exact extremes at any.
    assert scalar(answer, "steady_state", "unevenness") == pytest.approx(steady.unevenness, rel=1e-9)
    assert answer["text"] == text.replace('radius = "0.2 m"', 'radius = "0.21 m"', 1)
    assert [each["name"] for each in answer["chips"] if "obstacle" in each] == ["run_down"]


def test_a_held_slider_changes_no_text(tab: Tab) -> None:
    tab.ask(ask="compute", text=CARTS.read_text())
    answer = tab.ask(ask="compute", held=True, set={"mechanism.cranks.A1.radius": 0.21})
    assert "text" not in answer
    assert "controls" not in answer
    assert answer["set"] == {"mechanism.cranks.A1.radius": 0.21}


def test_slow_analyses_follow_and_belong_to_the_newest(tab: Tab) -> None:
    tab.ask(ask="compute", text=template("slider-crank"))
    last = tab.send(ask="compute", text=template("four-bar"))
    while True:
        number, answer = tab.hear()
        if answer["of"] == "beside":
            break
    assert number == last
    assert "linkage" in [each["name"] for each in answer["results"]]


def test_slow_analyses_can_be_stopped(tab: Tab) -> None:
    text = (Path(__file__).parents[2] / "examples" / "topper_cam" / "machine.toml").read_text()
    tab.ask(ask="compute", text=text)
    time.sleep(0.5)
    tab.send(ask="stop")
    answer = tab.hear()[1]
    assert answer == {"of": "stopped", "lane": "study"}
    assert "problems" not in tab.ask(ask="compute", held=True, text=template("four-bar"))


def test_tabs_do_not_disturb_each_other(served: Served, tab: Tab) -> None:
    other = served.tab()
    tab.ask(ask="compute", text=template("four-bar"))
    other.ask(ask="compute", text=CARTS.read_text())
    first, second = (
        tab.ask(ask="compute", held=True)["machine"],
        other.ask(ask="compute", held=True)["machine"],
    )
    assert first != second
    other.socket.close()


def test_files_are_saved_and_opened_again(tab: Tab, folder: Path) -> None:
    text = template("four-bar") + "# mine\n"
    assert tab.ask(ask="save", name="new.toml", text=text)["of"] == "saved"
    assert (folder / "new.toml").read_text() == text
    assert tab.ask(ask="save", name="new.toml", text=text)["of"] == "refused"
    assert tab.ask(ask="open", place="folder", name="new.toml")["text"] == text
    listed = tab.ask(ask="gallery")["machines"]
    assert {"place": "library", "name": "roller_two_carts", "title": lw.read(CARTS).name} in listed
    assert [each["name"] for each in listed if each["place"] == "folder"] == ["bar.toml", "new.toml"]


def test_changes_keep_comments_order_and_units() -> None:
    text = (
        '# head\nname = "a"  # who\n[mechanism.cranks.A]\nradius = "20 cm"  # long\nphase = 0.5\n'
        '[bodies]\nA = { mass = "1 kg" } # m\n'
    )
    new = changed(
        text,
        {
            "mechanism.cranks.A.radius": 0.25,
            "mechanism.cranks.A.phase": 0.75,
            "bodies.A.mass": 2.0,
            "bodies.B": {"mass": "3 kg"},
        },
    )
    assert 'radius = "25 cm"  # long' in new
    assert "phase = 0.75" in new
    assert 'A = { mass = "2 kg" } # m' in new
    assert new.startswith('# head\nname = "a"  # who\n')
    assert changed(new, {"mechanism.cranks.A.phase": None}).count("phase") == 0


@pytest.mark.parametrize("name", ["four-bar", "two-carts", "press", "topper", "flywheel"])
def test_every_entry_has_its_control(name: str) -> None:
    import tomllib

    raw = tomllib.loads(template(name))
    listed: list[str] = []

    def walk(group: dict) -> None:  # type: ignore[type-arg]
        listed.extend(each["address"] for each in group["entries"])
        for each in group["groups"]:
            walk(each)

    def leaves(node: object, place: tuple[str, ...] = ()) -> list[tuple[str, ...]]:
        if isinstance(node, dict) and node:
            return [leaf for key, value in node.items() for leaf in leaves(value, (*place, key))]
        return [place]

    walk(controls(raw))
    assert len(listed) == len(leaves(raw))


def test_a_drag_brings_the_joint_to_its_place() -> None:
    machine, place = lw.read(CARTS), (0.18, 0.12)
    found = drag(machine, "A1", place, 0.4)
    moved = lw.replace(machine, found.entries)
    at = kinematics(moved, np.array([0.4])).points["A1"].position[0]
    # Entries have seven digits, as the file has.
    assert at == pytest.approx(place, abs=1e-6)
    assert not found.reason


def test_a_locked_entry_holds() -> None:
    machine = lw.read(CARTS)
    found = drag(machine, "A1", (0.18, 0.12), 0.4, frozenset({"mechanism.cranks.A1.phase"}))
    assert list(found.entries) == ["mechanism.cranks.A1.radius"]


def test_a_drag_stops_where_the_linkage_no_longer_turns() -> None:
    machine = loads(template("four-bar"))
    point = next(iter(machine.mechanism.cranks))
    found = drag(machine, point, (50.0, 0.0), 0.0)
    assert "closes only" in found.reason
    assert lw.closure(lw.replace(machine, found.entries)).turns_fully
