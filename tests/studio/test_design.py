"""A result that is pulled arrives within the limits of its entries, or says what holds it."""

from __future__ import annotations

import numpy as np
import pytest
from tests.samples.fast_starts import FILE

import linkwright as lw
from linkwright import InputError
from linkwright.drive import FAST_STARTS
from linkwright.studio.design import goals, reach, slopes
from linkwright.studio.search import search

from .conftest import Tab

DELTA, PHASE, RADIUS = "steady_state.unevenness", "mechanism.cranks.A2.phase", "mechanism.cranks.A1.radius"


@pytest.mark.parametrize("share", [0.95, 1.5, 3.0])
def test_entries_bring_the_result_to_its_value(share: float) -> None:
    machine = lw.read("roller_two_carts")
    wanted = share * lw.steady_state(machine).unevenness
    found = reach(machine, DELTA, wanted, {PHASE: (-3.1, 3.1), RADIUS: (0.1, 0.4)})
    assert not found.reason
    assert lw.steady_state(lw.replace(machine, found.entries)).unevenness == pytest.approx(wanted, rel=2e-6)


def test_limits_are_respected_and_told() -> None:
    machine = lw.read("roller_two_carts")
    found = reach(machine, DELTA, 0.1, {"bodies.cart1.mass": (900.0, 1001.0)})
    assert found.entries == {"bodies.cart1.mass": 1001.0}
    assert "limits of cart1.mass" in found.reason


def test_slopes_are_those_of_the_package() -> None:
    machine = lw.read("roller_two_carts")
    found = slopes(machine, DELTA)
    assert found["slopes"] == lw.gradient(machine).of(DELTA)
    with pytest.raises(InputError, match=r"forces\.nothing"):
        slopes(machine, "forces.nothing")


def test_results_of_the_motion_are_goals() -> None:
    """Strokes, transmission angles and speeds are pulled, swept and sought; none of them is numerics."""
    machine = lw.read("roller_two_carts")
    known = {goal.key: goal for goal in goals(machine)}
    stroke, fast = "linkage.cart1.stroke", "cycle_motion.cart1.place.velocity.maximum"
    assert {stroke, fast, "linkage.cart1.transmission_angle_worst"} <= known.keys()
    assert known[stroke].value == pytest.approx(0.4)
    assert not any("sweeps" in key for key in known)
    found = reach(machine, stroke, 0.36, {RADIUS: (0.1, 0.3)})
    assert found.entries[RADIUS] == pytest.approx(0.18, rel=1e-6)
    swift = lw.cycle_motion(machine).extremes["cart1.place.velocity"].maximum
    assert swift is not None
    found = reach(machine, fast, 0.9 * swift, {RADIUS: (0.1, 0.3)})
    moved = lw.cycle_motion(lw.replace(machine, found.entries)).extremes["cart1.place.velocity"].maximum
    assert moved == pytest.approx(0.9 * swift, rel=1e-5)
    by = slopes(machine, fast)
    beside = lw.cycle_motion(lw.replace(machine, {RADIUS: 0.2002})).extremes["cart1.place.velocity"].maximum
    assert by["slopes"][RADIUS] == pytest.approx((beside - swift) / 0.0002, rel=0.01)


def test_other_results_keep_their_limits() -> None:
    """A pull stops at the limit of another result, a sweep leaves gaps beyond it, a search keeps it."""
    machine = lw.read("roller_two_carts")
    stroke, angle = "linkage.cart1.stroke", "linkage.cart1.transmission_angle_worst"
    least = lw.linkage(lw.replace(machine, {RADIUS: 0.22})).element("cart1").transmission_angle_worst
    assert least is not None
    bounds = {angle: (least, None)}
    found = reach(machine, stroke, 0.6, {RADIUS: (0.1, 0.4)}, bounds)
    assert "at the limit of worst transmission angle of cart1" in found.reason
    assert 0.2 < found.entries[RADIUS] <= 0.22
    entries = [{"address": RADIUS, "low": 0.2, "high": 0.24, "steps": 5}]
    asked = {"response": stroke, "bounds": bounds, "entries": entries}
    swept = search(machine, {**asked, "kind": "sweep"}, lambda _: None)
    assert np.isnan(swept["values"]).tolist() == [False, False, False, True, True]
    assert any("beyond the limits" in words for words in swept["warnings"])
    del entries[0]["steps"]
    asked |= {"kind": "optimise", "direction": "maximise", "machines": 200}
    best = search(machine, asked, lambda _: None)
    assert best["entries"][RADIUS] == pytest.approx(0.22, rel=1e-4)


def test_a_map_holds_what_each_machine_has() -> None:
    machine = lw.read("roller_two_carts")
    entries = [
        {"address": PHASE, "low": 1.4, "high": 1.7, "steps": 2},
        {"address": RADIUS, "low": 0.18, "high": 9.0, "steps": 3},
    ]
    found = search(machine, {"kind": "sweep", "response": DELTA, "entries": entries}, lambda _: None)
    values = found["values"].reshape(2, 3)
    wanted = lw.steady_state(lw.replace(machine, {PHASE: 1.7, RADIUS: 0.18})).unevenness
    assert values[1, 0] == pytest.approx(wanted, rel=1e-8)
    assert np.isnan(values[:, 2]).all()
    counts = [int(text.split()[0]) for text in found["warnings"] if " without an answer: " in text]
    assert sum(counts) == np.isnan(values).sum()


def test_a_search_is_told_as_it_goes_on_and_can_be_ended(tab: Tab) -> None:
    text = (lw.kernel.files.library.library_path("roller_two_carts")).read_text()
    tab.ask(ask="compute", text=text)
    entries = [{"address": PHASE, "low": 0.8, "high": 2.3}]
    asked = {"kind": "optimise", "response": DELTA, "direction": "minimise", "machines": 20000}
    number = tab.send(ask="search", entries=entries, **asked)
    seen: list[dict] = []  # type: ignore[type-arg]
    while not seen or not seen[-1].get("ended"):
        of, answer = tab.hear()
        if of == number and answer["of"] == "search":
            seen.append(answer)
            if len(seen) == 1:
                tab.send(ask="end search")
    assert seen[0]["value"] > 0
    assert list(seen[0]["entries"]) == [PHASE]


def test_a_sweep_and_a_search_say_what_runs_away_from_fast_starts() -> None:
    machine, asked = lw.loads(FILE), {"response": "steady_state.speed_max"}
    entry = {"address": "loads.D.torque", "low": 0.2, "high": 1.4}
    found = search(machine, {**asked, "kind": "sweep", "entries": [{**entry, "steps": 3}]}, lambda _: None)
    assert found["warnings"] == [f"2 rows: {FAST_STARTS[1]}"]
    asked |= {"kind": "optimise", "direction": "maximise"}
    best = search(machine, {**asked, "machines": 20, "entries": [{**entry, "high": 0.8}]}, lambda _: None)
    assert best["warnings"] == [FAST_STARTS[1]]
