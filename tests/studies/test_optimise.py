"""The best machine: known places, limits that are active, choices, and what cannot be kept."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
from command_line import invoke
from sizes import cases

import linkwright as lw
from linkwright import FindingError, InputError
from linkwright.studies import engine, search_log, slopes
from linkwright.studies.optimise import Optimum, searched

# The pin of a crank of 0.2 m at angle a: x = 0.2 cos a, y = 0.2 sin a.
TEXT = """
machine = "roller_two_carts"
[variables.a]
address = "mechanism.cranks.A1.phase"
range = ["10 deg", "170 deg"]
[variables.r]
address = "mechanism.cranks.A1.radius"
range = ["0.1 m", "0.3 m"]
[responses]
x = { curve = "motion.A1.x", at = "0 deg" }
y = { curve = "motion.A1.y", at = "0 deg" }
far = { formula = "(x + 0.1)^2 + (y - 0.15)^2" }
[goals]
far = "minimise"
"""


def optimum(
    tmp_path: Path, text: str, evaluations: int = 700, method: str = "global", starts: int = 8
) -> Optimum:
    (tmp_path / "study.toml").write_text(text)
    return lw.optimise(lw.read_study(tmp_path / "study.toml"), evaluations, method=method, starts=starts)


def test_a_place_that_is_known(tmp_path: Path) -> None:
    found = optimum(tmp_path, TEXT)
    # A square bottoms out where it is lost in rounding, √ε of the place.
    assert found.responses["x"] == pytest.approx(-0.1, abs=1e-6)
    assert found.variables["a"] == pytest.approx(np.pi - np.arctan(1.5), abs=1e-6)
    assert lw.get(found.machine, "mechanism.cranks.A1.radius") == found.variables["r"]
    assert found.active == ()


def test_a_limit_that_is_active(tmp_path: Path) -> None:
    """The nearest point of the line y = 0.1 is straight below."""
    found = optimum(tmp_path, TEXT + '[constraints]\ny = { max = "0.1 m" }\n')
    assert found.responses["y"] <= 0.1
    assert found.responses["far"] == pytest.approx(0.05**2, rel=1e-3)
    assert "y is at its maximum" in found.active[0]


def test_tables_among_choices_are_shown_as_in_a_file(tmp_path: Path) -> None:
    text = TEXT.replace('"mechanism.cranks.A1.radius"', '"mechanism.cranks.A1"')
    text = text.replace('range = ["0.1 m", "0.3 m"]', "values = [{ radius = 0.1 }, { radius = 0.2 }]")
    (tmp_path / "study.toml").write_text(text.replace("A1.phase", "A2.phase"))
    told = invoke("optimise", tmp_path / "study.toml", "--evaluations", "20")
    assert "radius = 0.1" in told.stdout
    assert "{" not in told.stdout


@pytest.mark.parametrize("place", ["taken.toml", "nowhere/best.toml", "link.toml"])
def test_a_file_that_cannot_be_written_is_refused_before_the_search(
    place: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After an hour of search the best machine would be lost."""
    monkeypatch.setattr("linkwright.studies.optimise.searched", pytest.fail)
    (tmp_path / "study.toml").write_text(TEXT)
    (tmp_path / "taken.toml").write_text("mine")
    (tmp_path / "link.toml").symlink_to(tmp_path / "taken.toml")
    words = ["optimise", str(tmp_path / "study.toml"), "--out", str(tmp_path / place)]
    told = invoke(*words)
    assert told.exit_code == 2, told.output
    assert place in told.output
    assert (tmp_path / "taken.toml").read_text() == "mine"
    assert {path.name for path in tmp_path.iterdir()} == {"study.toml", "taken.toml", "link.toml"}


def test_a_goal_that_nothing_changes_is_told(tmp_path: Path) -> None:
    text = TEXT.replace("[goals]\nfar", 'fixed = { entry = "drive.gearbox.ratio" }\n[goals]\nfixed')
    found = optimum(tmp_path, text, 100)
    assert found.is_flat
    told = invoke("optimise", tmp_path / "study.toml", "--evaluations", "100")
    assert "fixed is 9.8 for all machines" in " ".join(told.stdout.split())
    assert not optimum(tmp_path, TEXT, 100).is_flat


def test_whole_numbers_and_choices(tmp_path: Path) -> None:
    text = TEXT.replace('range = ["0.1 m", "0.3 m"]', 'values = ["0.1 m", "0.18 m", "0.3 m"]')
    found = optimum(tmp_path, text, 260)
    assert found.variables["r"] == 0.18
    assert [each["r"] for each in found.tried] == [0.1, 0.18, 0.3]
    # The circle of 0.18 m passes the place at √(0.1² + 0.15²) - 0.18.
    assert found.responses["far"] == pytest.approx((np.hypot(0.1, 0.15) - 0.18) ** 2, rel=1e-6)


@pytest.mark.parametrize("method", ["both", "global", "gradient"])
@pytest.mark.parametrize("given", ["range = [2, 40]\nwhole = true", "values = [2, 17, 40]"])
@pytest.mark.parametrize("limits", ["", "[constraints]\nsize = { max = 17 }\n"])
def test_a_study_without_a_continuous_variable(
    given: str, method: Literal["both", "global", "gradient"], limits: str, tmp_path: Path
) -> None:
    """There is nothing to take derivatives by, neither on the way nor for what limits cost."""
    if method == "gradient" and "whole" in given:
        return
    text = f"""
machine = "roller_two_carts"
[variables.n]
address = "drive.gearbox.ratio"
{given}
[responses]
x = {{ curve = "motion.A1.x", at = "0 deg" }}
size = {{ formula = "n + 0*x" }}
far = {{ formula = "(n - 18)^2 + 0*x" }}
[goals]
far = "minimise"
{limits}"""
    found = optimum(tmp_path, text, 200, method)
    assert found.variables["n"] == (17 if limits or "values" in given else 18)
    assert found.multipliers == {}
    assert bool(found.active) == bool(limits)


def test_what_cannot_be_kept_is_told(tmp_path: Path) -> None:
    with pytest.raises(FindingError, match=r"the nearest has y = 0\.3"):
        optimum(tmp_path, TEXT + '[constraints]\ny = { min = "0.4 m" }\n', 500)
    with pytest.raises(InputError, match="goals"):
        optimum(tmp_path, TEXT.replace('[goals]\nfar = "minimise"\n', ""))


# δ of two carts over their phase has its minimum on an edge, where two maxima of the speed tie.
PHASE = """
machine = "roller_two_carts"
[variables.phase]
address = "mechanism.cranks.A2.phase"
range = ["60 deg", "120 deg"]
[responses]
delta = "steady_state.unevenness"
[goals]
delta = "minimise"
"""


def test_the_best_phase_by_grid_by_evolution_and_by_gradient(tmp_path: Path) -> None:
    """To 1e-6 of the phase; each grid of 41 is a twentieth of the one before."""
    by_gradient = optimum(tmp_path, PHASE, method="gradient", starts=1)
    by_evolution = optimum(tmp_path, PHASE, 350)
    plan = lw.read_study(tmp_path / "study.toml")
    low, high = plan.axes[0].low, plan.axes[0].high
    while high - low > 2e-7:
        grid = np.linspace(low, high, 41)
        best = int(lw.evaluate(plan, {"phase": grid}).columns["delta"].argmin())
        low, high = grid[max(best - 1, 0)], grid[min(best + 1, 40)]
    assert by_gradient.variables["phase"] == pytest.approx((low + high) / 2, rel=1e-6)
    assert by_evolution.variables["phase"] == pytest.approx((low + high) / 2, rel=1e-6)
    assert by_gradient.responses["delta"] == pytest.approx(by_evolution.responses["delta"], rel=1e-6)
    # An edge has no multipliers.
    assert by_gradient.multipliers == {}


def test_what_limits_cost(tmp_path: Path) -> None:
    """Nearest to (−0.1, 0.15) below y = 0.1: (0.15 − y)² gives 2·0.05 for each metre."""
    found = optimum(tmp_path, TEXT + '[constraints]\ny = { max = "0.1 m" }\n', method="gradient", starts=2)
    assert found.variables["r"] == pytest.approx(np.hypot(0.1, 0.1), rel=1e-6)
    assert found.responses["y"] <= 0.1
    assert found.multipliers == {"maximum of y": pytest.approx(0.1, rel=1e-5)}
    assert found.worth == ("0.001 m more at the maximum of y would make far 0.0001 smaller",)
    text = TEXT.replace('["10 deg", "170 deg"]', '["10 deg", "90 deg"]')
    found = optimum(tmp_path, text, method="gradient", starts=2)
    assert "a is at the upper end of its range, 1.5708 rad" in found.active
    # At 90° far = 0.1² + (r − 0.15)²: with r = 0.15, ∂far/∂a = 2·0.1·∂x/∂a = −2·0.1·0.15.
    assert found.multipliers == {"upper end of a": pytest.approx(0.03, rel=1e-4)}


# Squared distances to two places.
FRONT = TEXT.replace('far = "minimise"\n', 'far = "minimise"\nother = "minimise"\n').replace(
    "[goals]", 'other = { formula = "(x - 0.05)^2 + (y - 0.15)^2" }\n[goals]'
)


def test_what_a_limit_costs_on_a_kink(tmp_path: Path) -> None:
    """The smallest flywheel stands where two speeds tie; its price is that of moving the limit."""
    text = """
machine = "roller_two_carts"
[variables.phase]
address = "mechanism.cranks.A2.phase"
range = ["80 deg", "95 deg"]
[variables.J]
address = "drive.flywheel.inertia"
range = ["0.1 kg m^2", "400 kg m^2"]
[responses]
delta = "steady_state.unevenness"
inertia = {{ entry = "drive.flywheel.inertia" }}
[constraints]
delta = {{ max = {limit} }}
[goals]
inertia = "minimise"
"""

    def found(limit: float) -> Optimum:
        (tmp_path / "study.toml").write_text(text.format(limit=limit))
        wheel = {"drive.flywheel": {"inertia": 5.0}}
        plan = lw.read_study(tmp_path / "study.toml", wheel)
        return lw.optimise(plan, 700, method="gradient", starts=cases(2, 4))

    best, step = found(0.05), 1e-4
    slope = (found(0.05 - step).responses["inertia"] - found(0.05 + step).responses["inertia"]) / (2 * step)
    # By differences of second order in the step, over limits that differ by 0.4 %.
    assert best.multipliers["maximum of delta"] == pytest.approx(slope, rel=1e-3)
    assert "would make inertia" in best.worth[0]


def test_what_limits_cost_where_branches_meet() -> None:
    """Three branches of a limit meet in a point, or hardly differ: the multiplier is that of moving it."""
    machine = lw.read("roller_two_carts")
    entries = {"r": "bodies.cart1.mass", "q": "bodies.cart2.mass", "p": "drive.gearbox.ratio"}

    def multiplier(variables: str, goal: str, limited: str, limit: float) -> float:
        study = {
            "variables": {name: {"address": entries[name], "range": [0.5, 2.0]} for name in variables},
            "responses": {
                "y": {"formula": goal},
                "c": {"formula": limited},
                "mass": {"entry": "bodies.cart1.mass"},
            },
            "constraints": {"c": {"max": limit}},
            "goals": {"y": "minimise"},
        }
        return lw.optimise(lw.new_study(machine, study), 400).multipliers["maximum of c"]

    three = "max(r + 0.2*p, max(q - 0.2*p + 0.4, 0.3*r + 0.3*q + 0.05*p + 0.55))"
    assert multiplier("rqp", "-(0.42*r + 0.42*q + 0.02*p)", three, 1.15) == pytest.approx(1.0, rel=1e-6)
    for limit in (1.99, 2.0, 2.01):
        weak = multiplier("rq", "-(r + 1.04*q)", "max(r + q, r + 1.08*q - 0.08)", limit)
        assert weak == pytest.approx(1.0, rel=1e-6)


def test_a_front_of_two_goals(tmp_path: Path) -> None:
    """The front is the line between both places, √f₁ + √f₂ their distance."""
    (tmp_path / "study.toml").write_text(FRONT)
    found = lw.front(lw.read_study(tmp_path / "study.toml"), 4, method="gradient", starts=1)
    assert len(found.machines) == 4
    # 0.0225 (0.15 m)² in three equal steps.
    ends = np.array([[each.responses[name] for name in ("far", "other")] for each in found.machines])
    assert ends[:, 1] == pytest.approx(0.0225 * np.array([3, 2, 1, 0]) / 3, abs=2e-6)
    assert np.sqrt(ends).sum(axis=1)[1:3] == pytest.approx(0.15, rel=1e-5)
    assert found.machines[1].active == ("other is at its maximum, 0.015",)
    with pytest.raises(InputError, match="expected two"):
        lw.front(
            lw.read_study(tmp_path / "study.toml", ["study.goals.other=minimise", "study.goals.x=minimise"])
        )


def test_entries_of_a_catalogue(tmp_path: Path) -> None:
    """The weakest motor with enough torque; one that has not says so."""
    text = (
        TEXT[: TEXT.index("[responses]")]
        + """
[variables.motor]
address = "drive.motor.catalogue"
values = ["4A132M6U3", "4A160M6U3", "4A250M6U3"]
[responses]
power = { entry = "drive.motor.power_rated" }
torque = { entry = "drive.motor.torque_rated" }
radius = { entry = "mechanism.cranks.A1.radius" }
[constraints]
torque = { min = "85 N m" }
radius = { max = "0.2 m" }
[goals]
power = "minimise"
"""
    )
    found = optimum(tmp_path, text.replace("roller_two_carts", "roller_one_cart"), 20)
    assert found.variables["motor"] == "4A160M6U3"
    assert found.responses["power"] == 15e3
    assert found.variables["r"] == found.responses["radius"] <= 0.2
    assert [one["refused"] for one in found.tried] == ["torque 73.83 N m below 85", None, None]


def counted(calls: list[str], made: Callable[..., Any]) -> Callable[..., Any]:
    """A function that lists its calls."""

    def listed(*given: Any) -> Any:
        calls.append(made.__name__)
        return made(*given)

    return listed


def test_a_front_that_was_stopped_goes_on_from_its_log(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One file for all its searches."""
    (tmp_path / "study.toml").write_text(FRONT)
    plan, log = lw.read_study(tmp_path / "study.toml"), tmp_path / "front.log"
    whole = lw.front(plan, 4, method="gradient", starts=1)
    assert lw.front(plan, 4, method="gradient", starts=1, log=log).to_dict() == whole.to_dict()
    text = log.read_bytes()
    for share in (0.4, 1.0):
        log.write_bytes(text[: int(share * len(text))])
        kept = log.read_bytes().count(b"\n")
        calls: list[str] = []
        for name in ("evaluate", "slopes"):
            monkeypatch.setattr(search_log, name, counted(calls, getattr(search_log, name)))
        assert lw.front(plan, 4, method="gradient", starts=1, log=log).to_dict() == whole.to_dict()
        monkeypatch.undo()
        assert len(calls) == text.count(b"\n") - kept
        assert log.read_bytes() == text


def test_a_search_that_was_stopped_goes_on_from_its_log(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Stopped anywhere, also inside a line, it ends as one that was not, and computes the rest only."""
    (tmp_path / "study.toml").write_text(TEXT + '[constraints]\ny = { max = "0.1 m" }\n')
    plan, log = lw.read_study(tmp_path / "study.toml"), tmp_path / "search.log"
    whole = lw.optimise(plan, 200, method="both")
    logged = lw.optimise(plan, 200, method="both", log=log)
    text = log.read_bytes()
    lines = text.count(b"\n")
    assert logged.to_dict() == whole.to_dict()
    for share in (0.0, 0.31, 0.8, 1.0):
        log.write_bytes(text[: int(share * len(text))])
        kept = log.read_bytes().count(b"\n")
        calls: list[str] = []
        for name in ("evaluate", "slopes"):
            monkeypatch.setattr(search_log, name, counted(calls, getattr(search_log, name)))
        assert lw.optimise(plan, 200, method="both", log=log).to_dict() == whole.to_dict()
        monkeypatch.undo()
        assert len(calls) == lines - max(kept, 1)
        assert log.read_bytes() == text
    (tmp_path / "other.toml").write_text(TEXT)
    with pytest.raises(InputError, match="another search"):
        lw.optimise(lw.read_study(tmp_path / "other.toml"), 200, log=log)
    assert log.read_bytes() == text


def test_a_log_with_the_ends_of_lines_of_windows_loses_nothing(tmp_path: Path) -> None:
    """The place where it goes on is counted in bytes as they are in the file."""
    (tmp_path / "study.toml").write_text(TEXT)
    plan, log = lw.read_study(tmp_path / "study.toml"), tmp_path / "search.log"
    whole = lw.optimise(plan, 100, log=log).to_dict()
    text = log.read_bytes()
    log.write_bytes(text[: len(text) // 2].replace(b"\n", b"\r\n"))
    assert lw.optimise(plan, 100, log=log).to_dict() == whole
    assert log.read_bytes().replace(b"\r\n", b"\n") == text


@pytest.mark.parametrize("method", ["both", "global"])
@pytest.mark.parametrize("evaluations", [10, 11, 40, 100])
def test_no_more_machines_than_are_allowed(evaluations: int, method: str, tmp_path: Path) -> None:
    text = TEXT.replace("[goals]", 'low = { curve = "motion.A1.y", extreme = "min" }\n[goals]')
    found = optimum(tmp_path, text, evaluations, method)
    # Populations, and derivatives by differences, are computed as a whole.
    assert evaluations / 2 <= found.n_evaluations <= evaluations
    text = text.replace('range = ["0.1 m", "0.3 m"]', 'values = ["0.1 m", "0.2 m", "0.3 m"]')
    assert optimum(tmp_path, text, evaluations, method).n_evaluations <= 3 * evaluations


# A mean of samples, and a mass that may be zero, and no less.
AT_AN_END = """
machine = "roller_two_carts"
[variables.mass]
address = "bodies.cart1.mass"
range = ["0 kg", "1500 kg"]
[responses]
torque = { curve = "steady_state.torque_motor", extreme = "rms" }
far = { formula = "torque + mass" }
[goals]
far = "minimise"
"""

# Rods shorter than 0.2 m do not close.
BESIDE = (
    AT_AN_END.replace("bodies.cart1.mass", "mechanism.sliders.cart1.rod")
    .replace('["0 kg", "1500 kg"]', '["0.199999 m", "0.21 m"]')
    .replace("torque + mass", "mass")
)

# The same with exact derivatives.
AS_EXACT = '{ curve = "steady_state.torque_motor", extreme = "rms" }', '"steady_state.torque_motor_rms"'


def machines(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Numbers of machines that are computed from now on: derivatives take one, and those beside it."""
    counts: list[int] = []

    def watched(made: Any, many: Any) -> Any:
        def made_and_counted(*given: Any) -> Any:
            counts.append(many(given))
            return made(*given)

        return made_and_counted

    rows = watched(engine.evaluate, lambda given: len(next(iter(given[1].values()))))
    beside = watched(engine.evaluate, lambda given: len(next(iter(given[1].values()))) - 1)
    monkeypatch.setattr(search_log, "evaluate", rows)
    monkeypatch.setattr(slopes, "evaluate", beside)
    monkeypatch.setattr(search_log, "slopes", watched(slopes.slopes, lambda given: 1))
    return counts


@pytest.mark.parametrize("method", ["both", "gradient"])
@pytest.mark.parametrize("kind", ["differences", "exact", "limit", "no answer", "exact without answer"])
def test_all_machines_are_counted(
    kind: str, method: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of differences, of the cost of limits, and of places that have no answer."""
    text = {
        "differences": TEXT,
        "exact": AT_AN_END.replace(*AS_EXACT),
        "limit": TEXT + '[constraints]\ny = { max = "0.1 m" }\n',
        "no answer": BESIDE,
        "exact without answer": BESIDE.replace(*AS_EXACT),
    }[kind]
    counts = machines(monkeypatch)
    found = optimum(tmp_path, text, 300, method, starts=cases(1, 2))
    assert found.n_evaluations == sum(counts)
    assert bool(found.reasons) == ("answer" in kind)


# The smallest flywheel leaves the rod free, and the longest rod is the most even.
FREE_ENDS = """
machine = "motor_ratio_flywheel"
[variables.rod]
address = "mechanism.sliders.cart1.rod"
range = ["0.6 m", "1.2 m"]
[variables.flywheel]
address = "drive.flywheel.inertia"
range = ["1 kg m^2", "200 kg m^2"]
[responses]
delta = "steady_state.unevenness"
J = { entry = "drive.flywheel.inertia" }
[goals]
delta = "minimise"
J = "minimise"
"""


@pytest.mark.parametrize("seed", [0, 1])
def test_an_end_of_a_front_that_one_goal_leaves_free_is_the_best_by_the_other(
    seed: int, tmp_path: Path
) -> None:
    (tmp_path / "study.toml").write_text(FREE_ENDS)
    plan = lw.read_study(tmp_path / "study.toml")
    last = lw.front(plan, 3, 200, seed=seed).machines[-1]
    assert last.variables["flywheel"] == pytest.approx(1.0, rel=2e-6)
    sizes = {"mechanism.sliders.cart1.rod": 1.2, "drive.flywheel.inertia": last.variables["flywheel"]}
    best = lw.steady_state(lw.replace(plan.machine, sizes)).unevenness
    assert last.responses["delta"] == pytest.approx(best, rel=1e-6)


def test_searches_of_a_front_that_fail_are_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    counts, searches = machines(monkeypatch), iter(range(9))

    def failing(*given: Any) -> Optimum:
        best = searched(*given)
        # Two for each end stand before those between.
        if next(searches) == 5:
            raise FindingError("none of all machines keeps all constraints")
        return best

    monkeypatch.setattr("linkwright.studies.front.searched", failing)
    (tmp_path / "study.toml").write_text(FRONT)
    found = lw.front(lw.read_study(tmp_path / "study.toml"), 5, 30, method="global")
    assert len(found.failed) == 1
    assert found.n_evaluations == sum(counts)


def test_fewer_machines_than_a_population_are_refused_by_name(tmp_path: Path) -> None:
    many = "".join(
        f'[variables.v{i}]\naddress = "{place}"\nrange = [0.5, 1.0]\n'
        for i, place in enumerate(
            f"{table}.{key}"
            for table in ("mechanism.sliders.cart1", "mechanism.sliders.cart2")
            for key in ("rod", "offset")
        )
    )
    bodies = "".join(
        f'[variables.m{i}]\naddress = "bodies.cart{1 + i % 2}.{key}"\nrange = [100, 900]\n'
        for i, key in enumerate(("mass", "mass"))
    )
    loads = "".join(
        f'[variables.l{i}]\naddress = "loads.rolling{1 + i}.force"\nrange = [100, 900]\n' for i in range(2)
    )
    rest = """
[variables.ratio]
address = "drive.gearbox.ratio"
range = [9, 10]
"""
    text = TEXT.replace("[responses]", many + bodies + loads + rest + "[responses]")
    with pytest.raises(InputError, match="evaluations 10: expected at least 11, the first population of 11"):
        optimum(tmp_path, text, 10)
    assert optimum(tmp_path, text, 11).n_evaluations == 11


@pytest.mark.parametrize("method", ["both", "gradient"])
def test_the_best_machine_at_the_end_of_what_there_is(method: str, tmp_path: Path) -> None:
    """Derivatives are differences, for which there are no machines beyond that end."""
    found = optimum(tmp_path, AT_AN_END, 400, method, starts=2)
    assert found.variables["mass"] == 0
    assert found.active == ("mass is at the lower end of its range, 0 kg",)
    small = lw.steady_state(lw.replace(found.machine, {"bodies.cart1.mass": 1e-3}))
    none = lw.steady_state(found.machine)
    rms = [float(np.sqrt(np.mean(state.torque_motor**2))) for state in (none, small)]
    slope = 1 + (rms[1] - rms[0]) / 1e-3
    assert found.multipliers == {"lower end of mass": pytest.approx(slope, rel=1e-3)}


def test_a_best_machine_beside_which_there_is_none(tmp_path: Path) -> None:
    """Where there are no derivatives, what was found stands."""
    found = optimum(tmp_path, BESIDE, 400, "both")
    assert found.variables["mass"] == pytest.approx(0.2, abs=1e-5)
    assert found.variables["mass"] > 0.2
    assert any("at a neighbouring step" in reason for reason in found.reasons), found.reasons


@pytest.mark.parametrize("given", ["range = [2, 6]\nwhole = true", "values = [2, 4, 6]"])
def test_no_machine_is_computed_between_whole_numbers(
    given: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """There may be none, and nobody asks for derivatives by them."""
    text = AT_AN_END.replace(
        "[responses]", f'[variables.n]\naddress = "drive.gearbox.ratio"\n{given}\n[responses]'
    )
    seen: set[float] = set()

    def watched(plan: Any, values: Any) -> Any:
        seen.update(values["n"].tolist())
        return engine.evaluate(plan, values)

    monkeypatch.setattr(slopes, "evaluate", watched)
    optimum(tmp_path, text, 100, "both")
    assert seen
    assert all(number.is_integer() for number in seen)


@pytest.mark.parametrize("method", ["both", "global", "gradient"])
def test_no_result_is_worse_than_the_machine_of_the_study(method: str, tmp_path: Path) -> None:
    """A valley so narrow that a search of so few machines misses it, about the rods of the machine."""
    study = """
machine = "roller_two_carts"
[variables.a]
address = "mechanism.sliders.cart1.rod"
range = ["0.5 m", "2.0 m"]
[variables.b]
address = "mechanism.sliders.cart2.rod"
range = ["0.5 m", "2.0 m"]
scale = "log"
[responses]
deep = { formula = "1 - exp(-1e8*((a - 0.8)^2 + (b - 0.8)^2))" }
[goals]
deep = "minimise"
"""
    (tmp_path / "study.toml").write_text(study, encoding="utf-8")
    plan = lw.read_study(tmp_path / "study.toml")
    best = lw.optimise(plan, 20, method=method, starts=1)
    assert best.responses["deep"] == pytest.approx(0.0, abs=1e-12)
    # A machine outside of the ranges is none of the study.
    (tmp_path / "study.toml").write_text(study.replace('"0.5 m"', '"0.9 m"'), encoding="utf-8")
    assert (
        lw.optimise(lw.read_study(tmp_path / "study.toml"), 20, method=method, starts=1).responses["deep"]
        > 0.9
    )


@pytest.mark.parametrize(
    "entries", ["range = [1, 5]", 'range = [1, 5]\nscale = "log"', "range = [1, 5]\nwhole = true"]
)
def test_the_share_of_a_value_gives_it_back(entries: str, tmp_path: Path) -> None:
    study = 'machine = "roller_two_carts"\n[variables.r]\naddress = "drive.gearbox.ratio"\n'
    (tmp_path / "study.toml").write_text(f'{study}{entries}\n[responses]\ny = {{ formula = "r" }}\n')
    (one,) = lw.read_study(tmp_path / "study.toml").axes
    for value in (1.0, 3.0, 5.0):
        share = one.share(value)
        assert 0 <= share <= 1
        assert one.values(np.array([share]))[0] == pytest.approx(value, rel=1e-14)
