"""A study is refused before it runs: with file, line, key, what was found and what to change."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError, MachineFileError
from linkwright.kernel.files.library import study_templates, template

Files = Callable[..., Path]

WRONG = {
    "no such entry": (('"mechanism.cranks.A2.phase"', '"mechanism.cranks.A2.fase"'), "phase.address", 5),
    "entry of a table left out": (
        ('"mechanism.cranks.A2.phase"', '"drive.flywheel.inertia"'),
        "phase.address",
        5,
    ),
    "wrong unit": (('"45 deg"', '"45 kg"'), "variables.phase.range", 6),
    "true in place of a number": (('"45 deg"', "true"), "variables.phase.range", 6),
    "a text in place of a count": (("steps = 5", 'steps = "5"'), "variables.phase.steps", 7),
    "true in place of a count": (("chunk = 4", "chunk = true"), "sweep.chunk", 26),
    "turned range": (('["45 deg", "135 deg"]', '["135 deg", "45 deg"]'), "variables.phase.range", 6),
    "no steps of a grid": (("steps = 5\n", ""), "variables.phase.steps", 4),
    "two ways": (("steps = 5", "values = [1]"), "values", 7),
    "no such quantity": (("steady_state.dynamism", "steady_state.dynamics"), "responses.H", 19),
    "no such analysis": (("steady_state.dynamism", "steady.dynamism"), "responses.H", 19),
    "no number to read": (('"steady_state.dynamism"', '{ entry = "drive.motor.kind" }'), "responses.H", 19),
    "no entry to read": (('"steady_state.dynamism"', '{ entry = "drive.motor.torque" }'), "responses.H", 19),
    "a motion of nothing": (('"steady_state.dynamism"', '"motion"'), "responses.H", 19),
    "a curve": (('"steady_state.dynamism"', '"steady_state.speed"'), "responses.H", 19),
    "unknown name": (("delta^2 + H", "delta^2 + h_max"), "responses.k_p.formula", 20),
    "no formula": (("delta^2 + H", "delta^2 + + * H"), "responses.k_p.formula", 20),
    "limit of nothing": (("delta = { max", "gamma = { max"), "constraints.gamma", 23),
    "contradiction": (("{ max = 0.3 }", "{ min = 0.4, max = 0.3 }"), "constraints.delta", 23),
    "rows of a grid": (("chunk = 4", "rows = 4"), "sweep.rows", 26),
    "one entry twice": (('"bodies.cart2.mass"]', '"mechanism.cranks.A2.phase"]'), "mass.address", 10),
    "name twice": (("half = ", "phase = "), "derived.phase", 15),
    "the name of a column": (("half = ", "fast_starts = "), "derived.fast_starts", 15),
    "goal of nothing": (("[sweep]", '[goals]\nnothing = "minimise"\n[sweep]'), "goals.nothing", 26),
    "no pair": (('["45 deg", "135 deg"]', '["45 deg", "90 deg", "135 deg"]'), "variables.phase.range", 6),
    "entry of a table": (
        (
            '"mechanism.cranks.A2.phase"\nrange = ["45 deg", "135 deg"]\nsteps = 5',
            '"bodies.cart1"\nvalues = [{ mass = "1 t" }]',
        ),
        "variables.phase.values",
        6,
    ),
    "no such type": (
        (
            '"mechanism.cranks.A2.phase"\nrange = ["45 deg", "135 deg"]\nsteps = 5',
            '"drive.motor"\nvalues = [{ kind = "induction", catalogue = "4A1" }]',
        ),
        "variables.phase.values.0",
        6,
    ),
    "a type without effect": (
        (
            '"mechanism.cranks.A2.phase"\nrange = ["45 deg", "135 deg"]\nsteps = 5',
            '"drive.motor.catalogue"\nvalues = ["4A250M6U3"]',
        ),
        "variables.phase.values.0",
        6,
    ),
    "no such file of rows": (("chunk = 4", 'method = "list"\nfile = "gone.parquet"'), "sweep.file", 27),
    "unknown key": (("chunk = 4", "chunks = 4"), "sweep.chunks", 26),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_study_is_refused(name: str, study_file: Files) -> None:
    change, key, line = WRONG[name]
    with pytest.raises(MachineFileError) as caught:
        lw.read_study(study_file(change))
    problem = caught.value.problems[0]
    assert key in problem.key, str(caught.value)
    assert problem.line == line, str(caught.value)
    assert problem.path.endswith("study.toml")
    assert problem.found
    assert problem.expected


def test_a_machine_that_does_not_exist(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text('# A study.\nmachine = "roller_two_cart"\n')
    with pytest.raises(MachineFileError, match="roller_two_carts") as caught:
        lw.read_study(tmp_path / "study.toml")
    assert (caught.value.problems[0].key, caught.value.problems[0].line) == ("machine", 2)


def test_a_limit_of_an_unknown_quantity_is_one_problem(study_file: Files) -> None:
    """Its unit is not known, so that nothing is wrong with the unit of the limit."""
    changes = (("steady_state.unevenness", "steady_state.speed_least"), ("max = 0.3", 'max = "3 rad/s"'))
    with pytest.raises(MachineFileError) as caught:
        lw.read_study(study_file(*changes))
    assert [problem.key for problem in caught.value.problems] == ["responses.delta.quantity"]


def test_rows_that_are_not_there(study_file: Files) -> None:
    with pytest.raises(MachineFileError) as caught:
        lw.read_study(study_file(("chunk = 4", 'method = "list"\nfile = "gone.csv"')))
    assert caught.value.problems[0].key == "sweep.file"
    assert caught.value.problems[0].found == '"gone.csv", no such file'


def test_a_table_that_the_machine_lacks_is_named(study_file: Files) -> None:
    """Entries of other tables are no remedy there."""
    with pytest.raises(MachineFileError, match=r"no table \[drive\.flywheel\]; write it first"):
        lw.read_study(study_file(('"mechanism.cranks.A2.phase"', '"drive.flywheel.inertia"')))


def test_all_problems_are_told_at_once(study_file: Files) -> None:
    with pytest.raises(MachineFileError) as caught:
        lw.read_study(study_file(('"45 deg"', '"45 kg"'), ("steady_state.dynamism", "steady_state.no")))
    assert len(caught.value.problems) >= 2


def test_too_many_rows_are_refused(study_file: Files) -> None:
    with pytest.raises(InputError, match="1 000 000 000 rows"):
        lw.read_study(study_file(("steps = 5", "steps = 500000"), ("steps = 3", "steps = 10000")))


@pytest.mark.parametrize("steps", [400_000_000, 2**63 - 1, 2**64])
def test_levels_are_counted_before_they_are_made(steps: int, study_file: Files) -> None:
    """Gigabytes of them, or more than can be indexed."""
    with pytest.raises((InputError, MachineFileError), match=r"rows|levels|steps"):
        lw.read_study(study_file(("steps = 5", f"steps = {steps}"), ("steps = 3", "steps = 2")))


def test_values_of_a_grid(study_file: Files) -> None:
    plan = lw.read_study(study_file())
    assert plan.n_rows == 15
    rows = plan.rows(0, 15)
    np.testing.assert_allclose(np.degrees(rows["phase"][::3]), [45, 67.5, 90, 112.5, 135])
    np.testing.assert_allclose(rows["mass"][:3], [900, 1000, 1100])
    # Ends of a range are met exactly.
    assert rows["phase"][0] == np.radians(45.0)
    assert plan.units["mass"] == "kg"


def test_overrides_of_machine_and_study(study_file: Files) -> None:
    changes = ["study.variables.phase.steps=7", "drive.gearbox.ratio=12"]
    plan = lw.read_study(study_file(), changes)
    assert plan.n_rows == 21
    assert lw.get(plan.machine, "drive.gearbox.ratio") == 12


@pytest.mark.parametrize(
    ("text", "mean", "deviation"),
    [
        ('{ kind = "normal", mean = "1 t", deviation = "20 kg" }', 1000, 20),
        ('{ kind = "lognormal", mean = 1000, deviation = 50 }', 1000, 50),
        ('{ kind = "uniform", min = 900, max = 1100 }', 1000, 200 / np.sqrt(12)),
        # Variance of a triangle: (a² + b² + c² - ab - ac - bc)/18.
        ('{ kind = "triangular", mean = 1000, min = 900, max = 1100 }', 1000, 100 / np.sqrt(6)),
    ],
)
def test_distributions(text: str, mean: float, deviation: float, study_file: Files) -> None:
    change = ('range = ["900 kg", "1100 kg"]\nsteps = 3', f"distribution = {text}\nsteps = 2000")
    masses = lw.read_study(study_file(change, ("steps = 5", "steps = 2"))).rows(0, 2000)["mass"]
    # Middles of 2000 strata miss the tails: 1 % of the deviation.
    assert masses.mean() == pytest.approx(mean, rel=1e-3)
    assert masses.std() == pytest.approx(deviation, rel=0.01)


def test_a_list_from_csv_and_parquet(study_file: Files, tmp_path: Path) -> None:
    (tmp_path / "rows.csv").write_text("phase [deg], mass [kg]\n80, 950\n90, 1000\n")
    change = ("chunk = 4", 'method = "list"\nfile = "rows.csv"')
    plan = lw.read_study(study_file(change))
    np.testing.assert_allclose(plan.rows(0, 2)["phase"], np.radians([80, 90]))
    import pandas as pd

    pd.DataFrame(plan.rows(0, 2)).to_parquet(tmp_path / "rows.parquet")
    again = lw.read_study(study_file(("chunk = 4", 'method = "list"\nfile = "rows.parquet"')))
    np.testing.assert_array_equal(again.listed, plan.listed)
    (tmp_path / "rows.csv").write_text("phase [deg]\n80\n")
    with pytest.raises(InputError, match="no column"):
        lw.read_study(study_file(change))


@pytest.mark.parametrize("name", study_templates())
def test_templates_are_sound(name: str, tmp_path: Path) -> None:
    path = tmp_path / "study.toml"
    path.write_text(template(name), encoding="utf-8")
    assert "delta" in [asked.name for asked in lw.read_study(path).asked]


def test_a_study_of_an_example_by_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert "phase" in [axis.name for axis in lw.read_study("crank_phase_map").axes]
    with pytest.raises(MachineFileError, match="crank_phase_map"):
        lw.read_study("crank_phase_mop")


def test_a_variable_of_a_fit_without_values_is_refused_elsewhere() -> None:
    """Its range is without end: there is no mean, and no place to begin."""
    tables = {
        "variables": {"mass": {"address": "bodies.cart1.mass"}},
        "responses": {"d": "steady_state.unevenness"},
        "goals": {"d": "minimise"},
        "fit": {"motion": "coast"},
    }
    plan = lw.new_study(lw.read("roller_two_carts"), tables)
    for analyse in (lw.tolerance, lw.optimise):
        with pytest.raises(InputError, match=r"variables\.mass: found nothing, expected"):
            analyse(plan)
