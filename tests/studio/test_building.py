"""Every kind of element is added to a machine that has room for it; links that are drawn become elements."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import pytest

import linkwright as lw
from linkwright import InputError, loads
from linkwright.linkages.model.topology import TABLES
from linkwright.studio.building import KINDS, End, added, drawn

from .conftest import Tab

EMPTY = 'format = 1\nname = "New machine"\n\n[mechanism]\n'
PIXEL = 1e-3


def built(*kinds: str, path: str = "") -> str:
    text = EMPTY
    for kind in kinds:
        text = added(text, kind, 1.0, "", path)
    return text


@pytest.fixture
def beside(tmp_path: Path) -> str:
    """Path of a machine file with a catalogue of servo motors beside it."""
    head = "type, inertia [kg cm^2], torque_rated [N m], speed_rated [rpm], torque_max [N m], speed_max [rpm]"
    (tmp_path / "motors.csv").write_text(f"{head}\nS1, 0.9, 2.4, 3000, 7.1, 6000\n")
    return str(tmp_path / "machine.toml")


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_makes_a_sound_machine(kind: str, beside: str) -> None:
    """A crank and a slider give room for every kind of element; each reads as a machine file."""
    before = built("cranks", "sliders", *(["axes"] if "servo" in kind else []))
    after = added(before, kind, 1.0, "", beside)
    assert after != before
    loads(after, path=beside)


def test_every_table_of_the_mechanism_and_every_load_is_among_them(beside: str) -> None:
    """The menu leaves out no table of a mechanism and no kind of load."""
    others = [kind for kind in KINDS if kind not in ("cranks", "sliders", "axes", "catalogue servo")]
    text = built("cranks", "axes", "sliders", *others, path=beside)
    raw = tomllib.loads(text)
    assert set(TABLES) <= raw["mechanism"].keys()
    kinds = {load["kind"] for load in raw["loads"].values()}
    from linkwright import Machine
    from linkwright.kernel.description.schema_walk import annotation_at, kinds_at

    assert set(kinds_at(annotation_at(Machine, ("loads", "x"), {}))) <= kinds
    names = [name for table in TABLES for name in raw["mechanism"].get(table, {})]
    assert len(names) == len(set(names))


def test_what_cannot_be_built_says_what_it_needs() -> None:
    """A slider needs a moving point, gravity is there once."""
    with pytest.raises(InputError, match="Rod and slider needs a moving point"):
        added(EMPTY, "sliders", 1.0, "")
    with pytest.raises(InputError, match="there is one already"):
        added(built("cranks", "gravity"), "gravity", 1.0, "")


def test_the_point_that_was_picked_carries_the_element() -> None:
    """A rod hangs on the picked pin, not on the first."""
    text = added(built("cranks", "cranks"), "sliders", 1.0, "A2")
    assert tomllib.loads(text)["mechanism"]["sliders"]["S1"]["crank"] == "A2"


FOUR_BAR = [
    (End(0.0, 0.0, "O"), End(0.1, 0.05)),
    (End(0.1, 0.05), End(0.5, 0.3)),
    (End(0.5, 0.3), End(0.6, 0.0)),
]


def test_links_that_are_drawn_make_the_linkage_that_was_drawn() -> None:
    """Crank, coupler and rocker lie as they were drawn, to a pixel; two links wait for the third."""
    text, waits = drawn(EMPTY, FOUR_BAR[:2], 0.0, PIXEL)
    assert (text, waits) == (EMPTY, "J1 has one link: draw a second from it")
    text, waits = drawn(EMPTY, FOUR_BAR, 0.0, PIXEL)
    assert not waits
    points = lw.kinematics(loads(text), [0.0]).points
    for name, end in (("A1", FOUR_BAR[0][1]), ("J1", FOUR_BAR[1][1])):
        x, y = points[name].position[0]
        assert math.hypot(x - end.x, y - end.y) < 3 * PIXEL


def test_a_link_from_the_plane_to_a_waiting_joint_turns_about_the_frame() -> None:
    """The rocker may be drawn first or last, from either end."""
    crank = built("cranks")
    links = [(End(0.6, 0.0), End(0.5, 0.3)), (End(0.15, 0.0, "A1"), End(0.5, 0.3))]
    assert drawn(crank, links[:1], 0.0, PIXEL)[1]
    text, waits = drawn(crank, links, 0.0, PIXEL)
    assert not waits
    assert list(loads(text).mechanism.points) == ["P1"]


def test_a_link_that_locks_the_mechanism_is_refused(tab: Tab) -> None:
    """A third bar on a joint is one too many: the file stays as it is, with the reason."""
    text, _ = drawn(EMPTY, FOUR_BAR, 0.0, PIXEL)
    tab.ask(ask="compute", text=text)
    spots = [{"x": 0.5, "y": 0.3, "point": "J1"}, {"x": 0.9, "y": 0.0, "point": "O"}]
    answer = tab.ask(ask="compute", draw={"links": [[*spots, "link"]], "angle": 0.0, "pixel": PIXEL})
    assert answer["draft"] == "refused"
    assert "one constraint too many" in answer["words"]
    assert "text" not in answer
    answer = tab.ask(ask="compute", add={"kind": "bodies", "size": 1.0, "picked": "J1"})
    assert tomllib.loads(answer["text"])["bodies"]["J1"] == {"mass": "1 kg"}
