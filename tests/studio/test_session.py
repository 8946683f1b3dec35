"""A tab computes what the command line computes, keeps comments of files, and disturbs no other tab."""

from __future__ import annotations

import re
import time
import tomllib
from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import kinematics, loads
from linkwright.kernel.files.library import template
from linkwright.studio.controls import controls
from linkwright.studio.document import changed, merged
from linkwright.studio.drag import drag

from .conftest import Served, Tab

ROOT = Path(__file__).parents[2]
CARTS = ROOT / "machines" / "roller_two_carts.toml"
TOLERANCED = ROOT / "examples" / "coupler_path_tolerances" / "machine.toml"


def scalar(answer: dict, result: str, name: str) -> float:  # type: ignore[type-arg]
    found = next(each for each in answer["results"] if each["name"] == result)
    return float(next(each["value"] for each in found["scalars"] if each["name"] == name))


def entries(group: dict) -> dict[str, dict]:  # type: ignore[type-arg]
    """All entries of a group of controls and of those in it, by address."""
    own = {entry["address"]: entry for entry in group["entries"]}
    return own | {address: entry for part in group["groups"] for address, entry in entries(part).items()}


def test_numbers_are_those_of_the_package(tab: Tab) -> None:
    text = CARTS.read_text()
    answer = tab.ask(ask="compute", text=text, set={"mechanism.cranks.A1.radius": 0.21})
    machine = lw.read(CARTS, {"mechanism.cranks.A1.radius": 0.21})
    steady = lw.steady_state(machine)
    # The studio asks for curves at other angles; measures are exact extremes at any.
    assert scalar(answer, "steady_state", "unevenness") == pytest.approx(steady.unevenness, rel=1e-9)
    assert answer["text"] == text.replace('radius = "0.2 m"', 'radius = "0.21 m"', 1)
    assert [each["name"] for each in answer["chips"] if "obstacle" in each] == ["run_down", "torsion"]


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


def test_a_file_that_changed_elsewhere_is_not_written_over(tab: Tab, folder: Path) -> None:
    text = CARTS.read_text()
    assert tab.ask(ask="save", name="shared.toml", text=text)["of"] == "saved"
    assert tab.ask(ask="save", name="shared.toml", text=text + "# a\n", replace=text)["of"] == "saved"
    (folder / "shared.toml").write_text(text + "# by another program\n")
    refused = tab.ask(ask="save", name="shared.toml", text=text + "# b\n", replace=text + "# a\n")
    assert refused["of"] == "refused"
    assert "was changed elsewhere" in refused["words"]
    assert (folder / "shared.toml").read_text().endswith("# by another program\n")
    # By all means, and where the file is gone.
    assert tab.ask(ask="save", name="shared.toml", text=text, replace=True)["of"] == "saved"
    (folder / "shared.toml").unlink()
    assert tab.ask(ask="save", name="shared.toml", text=text, replace=text)["of"] == "saved"
    (folder / "shared.toml").unlink()


def test_files_are_saved_and_opened_again(tab: Tab, folder: Path) -> None:
    text = template("four-bar") + "# mine\n"
    assert tab.ask(ask="save", name="new.toml", text=text)["of"] == "saved"
    assert (folder / "new.toml").read_text() == text
    assert tab.ask(ask="save", name="new.toml", text=text)["of"] == "refused"
    assert tab.ask(ask="open", place="folder", name="new.toml")["text"] == text
    listed = tab.ask(ask="gallery")["machines"]
    assert {"place": "library", "name": "roller_two_carts", "title": lw.read(CARTS).name} in listed
    assert [each["name"] for each in listed if each["place"] == "folder"] == ["bar.toml", "new.toml"]


def test_names_of_machines_stay_in_every_language(tab: Tab) -> None:
    english = tab.ask(ask="gallery")["machines"]
    tab.send(ask="language", code="uk")
    listed = tab.ask(ask="gallery")["machines"]
    tab.send(ask="language", code="en")
    assert [each for each in listed if each["place"] != "template"] == [
        each for each in english if each["place"] != "template"
    ]
    # What a template is, is a text of ours.
    assert not [
        each for each in listed if each["place"] == "template" and re.search("[A-Za-z]{3}", each["title"])
    ]


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
    raw = tomllib.loads(template(name))

    def leaves(node: object, place: tuple[str, ...] = ()) -> list[tuple[str, ...]]:
        if isinstance(node, dict) and node:
            return [leaf for key, value in node.items() for leaf in leaves(value, (*place, key))]
        return [place]

    assert len(entries(controls(raw))) == len(leaves(raw))


def test_a_size_with_a_tolerance_has_a_slider_and_keeps_it() -> None:
    text = TOLERANCED.read_text(encoding="utf-8").replace('rocker = "110 ± 0.1 mm"', 'rocker = "110 H7"')
    parts = entries(controls(tomllib.loads(text)))
    assert [parts["mechanism.cranks.A.radius"][key] for key in ("si", "tolerance")] == [0.05, "± 0.05 mm"]
    assert [parts["mechanism.rockers.C.rocker"][key] for key in ("si", "tolerance")] == [0.11, "H7"]
    assert "tolerance" not in parts["bodies.A.mass"]
    moved = changed(text, {"mechanism.cranks.A.radius": 0.052, "mechanism.rockers.C.rocker": 0.1125})
    assert 'radius = "52 mm ± 0.05 mm"' in moved
    assert 'rocker = "112.5 mm H7"' in moved
    assert lw.get(loads(moved), "mechanism.rockers.C.rocker") == pytest.approx(0.1125)


def test_a_drag_brings_the_joint_to_its_place() -> None:
    machine, place = lw.read(CARTS), (-0.12, 0.18)
    found = drag(machine, "A2", place, 0.4)
    moved = lw.replace(machine, found.entries)
    at = kinematics(moved, np.array([0.4])).points["A2"].position[0]
    # Entries have seven digits, as the file has.
    assert at == pytest.approx(place, abs=1e-6)
    assert not found.reason


def test_a_locked_entry_holds() -> None:
    machine = lw.read(CARTS)
    found = drag(machine, "A2", (-0.12, 0.18), 0.4, frozenset({"mechanism.cranks.A2.phase"}))
    assert list(found.entries) == ["mechanism.cranks.A2.radius"]


def test_a_drag_writes_what_a_pixel_is_worth_into_the_entries_that_are_there(tab: Tab) -> None:
    """Half a millimetre a pixel: tenths of a millimetre and of a degree; no entry that was not there."""
    text = CARTS.read_text()
    tab.ask(ask="compute", text=text)
    pull = {"x": -0.12345, "y": 0.18222, "angle": 0.4, "pixel": 5e-4}
    moved = tab.ask(ask="compute", drag={"point": "A2", **pull})["text"]
    crank = re.search(r'cranks.A2\]\nradius = "([\d.]+) m"\nphase = "([\d.]+) deg"', moved)
    assert crank is not None
    assert all(
        len(digits.partition(".")[2]) <= most for digits, most in zip(crank.groups(), (4, 1), strict=True)
    )
    at = kinematics(loads(moved), np.array([0.4])).points["A2"].position[0]
    assert np.hypot(*(at - (pull["x"], pull["y"]))) < 2 * pull["pixel"]
    # The first crank has no phase: its radius alone follows.
    other = tab.ask(ask="compute", drag={**pull, "point": "A1", "x": 0.2, "y": 0.1})["text"]
    assert other.count("phase") == text.count("phase")


def test_the_units_of_the_file_are_told_to_the_page(tab: Tab) -> None:
    """The table of units says which unit a page shows, with its size; without it nothing is said."""
    text = CARTS.read_text()
    assert tab.ask(ask="compute", text=text)["units"] == {}
    given = tab.ask(ask="compute", text=f'{text}\n[units]\nlength = "mm"\nforce = "kN"\n')["units"]
    assert given["m"] == ["mm", 0.001]
    assert given["m/s"] == ["mm/s", 0.001]
    assert given["N"] == ["kN", 1000]
    assert "N m" not in given


def test_forces_need_no_motor_where_a_design_speed_is_given(tab: Tab) -> None:
    """As on the command line, forces are those at the design speed of a drive without motor."""
    text = CARTS.read_text()
    start, end = text.index("[drive.motor]"), text.index("[drive.gearbox]")
    answer = tab.ask(ask="compute", text=text[:start] + text[end:])
    (forces,) = (one for one in answer["results"] if one["name"] == "forces")
    scalars = {one["name"]: one["value"] for one in forces["scalars"]}
    machine = loads(text[:start] + text[end:])
    assert scalars["torque_drive_max"] == pytest.approx(lw.forces(machine).torque_drive_max, rel=1e-9)
    assert "obstacle" not in next(chip for chip in answer["chips"] if chip["name"] == "forces")


def test_a_torque_in_front_of_a_law_is_called_so(tab: Tab) -> None:
    """A law acts as a cam on the crankshaft: the torque at the crank is named as in the tables."""
    text = """format = 1
name = "Indexing arm"
[drive]
speed = "6 rad/s"
[mechanism.cranks.A]
radius = "0.2 m"
law = "phi - 0.3 * sin(phi)"
[bodies]
A = { mass = "2 kg" }
"""
    answer = tab.ask(ask="compute", text=text)
    (forces,) = (one for one in answer["results"] if one["name"] == "forces")
    words = {one["name"]: one["word"] for one in forces["scalars"]}
    assert words["torque_drive_max"] == "torque referred to the master shaft"
    assert any(plot["title"] == "torque of the drive A" for plot in forces["plots"])


def test_a_drag_stops_where_the_linkage_no_longer_turns() -> None:
    machine = loads(template("four-bar"))
    point = next(iter(machine.mechanism.cranks))
    found = drag(machine, point, (50.0, 0.0), 0.0)
    assert "closes only" in found.reason
    assert lw.closure(lw.replace(machine, found.entries)).turns_fully


def test_a_stopped_drag_names_the_crank_angle_of_the_toggle_position() -> None:
    machine = loads(template("four-bar"))
    stopped = drag(machine, "A", (0.3, 0.0), 0.0)
    assert stopped.limit is not None
    limit = lw.replace(machine, stopped.entries)
    rocker, pivot = limit.mechanism.rockers["C"], limit.mechanism.points["B"]
    pin = kinematics(limit, np.array([stopped.limit])).points["A"].position[0]
    reach = np.hypot(pivot.x - pin[0], pivot.y - pin[1])
    # Coupler and rocker are in line there; the drag stops within 2⁻¹³ of its way.
    lines = (rocker.coupler + rocker.rocker, abs(rocker.coupler - rocker.rocker))
    assert min(abs(reach - line) for line in lines) < 1e-3 * rocker.coupler


LENGTHS = {
    "mechanism.cranks.A.radius": (0.03, 0.08),
    "mechanism.rockers.C.coupler": (0.08, 0.2),
    # A slider ends at nothing, and a link does not.
    "mechanism.rockers.C.rocker": (0.0, 0.2),
    "mechanism.rigid_points.K.across": (0.0, 0.1),
}


def test_a_point_of_a_curve_is_pulled_to_its_place_by_the_chosen_entries() -> None:
    machine = loads(template("four-bar"))
    start = kinematics(machine, np.array([1.0])).points["K"].position[0]
    place = (float(start[0]) + 0.004, float(start[1]) - 0.006)
    pulled = drag(machine, "K", place, 1.0, limits=LENGTHS)
    at = kinematics(lw.replace(machine, pulled.entries), np.array([1.0])).points["K"].position[0]
    assert pulled.entries.keys() == LENGTHS.keys()
    # Entries have seven digits, as the file has.
    assert at == pytest.approx(place, abs=1e-7)
    assert not pulled.reason


def test_a_pulled_point_respects_limits_and_says_which() -> None:
    machine = loads(template("four-bar"))
    limits = {"mechanism.cranks.A.radius": (0.045, 0.052), "mechanism.rockers.C.coupler": (0.119, 0.121)}
    pulled = drag(machine, "K", (0.2, 0.3), 1.0, limits=limits)
    assert "at the limits of" in pulled.reason
    for address, (low, high) in limits.items():
        assert low - 1e-9 <= pulled.entries[address] <= high + 1e-9


def test_a_joint_that_merges_hands_on_what_hangs_on_it() -> None:
    text = CARTS.read_text()
    new = merged(text, "A2", "A1")
    machine = loads(new)
    assert list(machine.mechanism.cranks) == ["A1"]
    assert {slider.crank for slider in machine.mechanism.sliders.values()} == {"A1"}
    # The comments of what is left stay.
    assert [line for line in new.splitlines() if "#" in line] == [
        line for line in text.splitlines() if "#" in line and line in new.splitlines()
    ]


def test_a_merge_that_makes_no_machine_is_refused_and_changes_nothing(tab: Tab) -> None:
    text = template("four-bar")
    tab.ask(ask="compute", text=text)
    answer = tab.ask(ask="compute", merge={"joint": "A", "into": "B"})
    assert answer["words"].startswith("A was not merged with B: ")
    assert "text" not in answer
    assert tab.ask(ask="compute", merge={"joint": "B", "into": "B"})["words"].endswith("expected two joints")


def test_lengths_that_are_pulled_stay_positive() -> None:
    machine = loads(template("four-bar"))
    limits = {"mechanism.cranks.A.radius": (0.0, 0.1), "mechanism.rockers.C.coupler": (0.0, 0.24)}
    pulled = drag(machine, "K", (-3.0, 0.0), 0.0, limits=limits)
    assert min(pulled.entries.values()) > 0
    assert drag(machine, "A", (0.0, 0.0), 0.0).entries["mechanism.cranks.A.radius"] > 0
