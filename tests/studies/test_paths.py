"""Paths of studies: errors of a point timed and in order, their derivatives, `synthesise path --study`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke as run

import linkwright as lw
from linkwright import AssemblyError, FindingError, InputError, MachineError, MachineFileError
from linkwright.linkages.nearest_places import ClosedCurves, disorder, nearest_in_order
from linkwright.studies.slopes import _differences, slopes

EXAMPLES = Path(__file__).parents[2] / "examples"
TURN = 2 * np.pi
ANGLES = np.radians([10.0, 70.0, 130.0, 190.0, 250.0, 310.0])

STUDY = """
machine = "four_bar_coupler_curve"
[variables.crank]
address = "mechanism.cranks.A.radius"
range = ["45 mm", "55 mm"]
[variables.coupler]
address = "mechanism.rockers.C.coupler"
range = ["100 mm", "130 mm"]
[variables.across]
address = "mechanism.rigid_points.K.across"
range = ["30 mm", "50 mm"]
[paths.tool]
point = "K"
x = {x}
y = {y}
{timing}
[responses]
rms = "path.tool.error_rms"
most = "path.tool.error_max"
second = {{ curve = "path.tool.error", index = 1 }}
spread = {{ curve = "path.tool.error", extreme = "range" }}
mean = {{ curve = "path.tool.error", extreme = "mean" }}
x = {{ curve = "motion.K.x", at = "30 deg" }}
y = {{ curve = "motion.K.y", extreme = "rms" }}
"""


def points(noise: float = 2e-3) -> np.ndarray:
    """Points beside the path of the machine, (6, 2) [m]."""
    drawn = lw.kinematics(lw.read("four_bar_coupler_curve"), ANGLES).points["K"].position
    return drawn + np.random.default_rng(5).normal(0.0, noise, drawn.shape)


def text(*, is_timed: bool, noise: float = 2e-3) -> str:
    x, y = points(noise).T.tolist()
    timing = f"crank_angle = {ANGLES.tolist()}" if is_timed else ""
    return STUDY.format(x=x, y=y, timing=timing)


def plan_of(tmp_path: Path, study: str) -> lw.StudyPlan:
    (tmp_path / "study.toml").write_text(study, encoding="utf-8")
    return lw.read_study(tmp_path / "study.toml")


def test_timed_errors_are_distances_at_the_crank_angles() -> None:
    machine, w = lw.read("four_bar_coupler_curve"), points()
    found = lw.path_error(machine, "K", *w.T, ANGLES)
    distances = np.hypot(*(lw.kinematics(machine, ANGLES).points["K"].position - w).T)
    np.testing.assert_allclose(found.error, distances, rtol=1e-12)
    assert found.error_rms == pytest.approx(np.sqrt(np.mean(distances**2)), rel=1e-12)
    assert found.error_max == distances.max()


@pytest.mark.parametrize("way", [1, -1])
def test_errors_in_order_are_those_of_the_nearest_places(way: int) -> None:
    """Against two hundred thousand places of the curve."""
    machine, w = lw.read("four_bar_coupler_curve"), points()[::way]
    found = lw.path_error(machine, "K", *w.T)
    curve = lw.kinematics(machine, np.linspace(0, TURN, 200_001)).points["K"].position
    nearest = [np.hypot(*(curve - each).T).min() for each in w]
    # Steps of 3e-5 rad miss a foot by half of one, at most 1e-6 m along the curve: its square is added.
    assert (found.error <= nearest).all()
    np.testing.assert_allclose(found.error**2, np.square(nearest), atol=1e-12)
    place = lw.kinematics(machine, found.crank_angle).points["K"].position
    np.testing.assert_allclose(np.stack([found.x, found.y], axis=1), place, atol=1e-14)


def test_points_out_of_order_share_places() -> None:
    """The minimum of all places in order: by dynamic programming over fine steps, in either direction."""
    machine, steps = lw.read("four_bar_coupler_curve"), 720
    curve = lw.kinematics(machine, np.linspace(0, TURN, steps, endpoint=False)).points["K"].position
    rng = np.random.default_rng(2)
    for _ in range(3):
        w = points(5e-3)[rng.permutation(6)]
        found = lw.path_error(machine, "K", *w.T)
        assert disorder(found.crank_angle[None], TURN)[0] == 0
        squares = ((curve[:, None] - w) ** 2).sum(axis=-1)
        least = min(_in_order(way) for way in (squares, squares[::-1]))
        rms = np.sqrt(least / len(w))
        assert rms * (1 - 3e-4) <= found.error_rms <= rms


def _in_order(squares: np.ndarray) -> float:
    """Minimum sum over places that do not go back within a revolution, (steps, points)."""
    best = np.inf
    for first in range(len(squares)):
        turned = np.roll(squares, -first, axis=0)
        turned = np.vstack([turned, turned[:1]])
        sums = np.full(len(turned), turned[0, 0])
        for column in turned.T[1:]:
            sums = column + np.minimum.accumulate(sums)
        best = min(best, sums.min())
    return best


def test_nearest_places_of_a_circle() -> None:
    phi = np.linspace(0, TURN, 360, endpoint=False)
    e = np.exp(1j * phi)[None]
    angles = np.array([0.1, 0.9, 2.5, 2.5, 6.2])
    found = nearest_in_order(ClosedCurves(e, 1j * e, -e), 1.3 * np.exp(1j * angles))
    np.testing.assert_allclose(np.mod(found[0], TURN), angles, atol=1e-12)


@pytest.mark.parametrize("is_timed", [True, False])
def test_derivatives_are_exact(is_timed: bool, tmp_path: Path) -> None:
    plan = plan_of(tmp_path, text(is_timed=is_timed))
    at, steps = np.array([0.0502, 0.1199, 0.0403]), np.full(3, 2e-6)
    found = slopes(plan, at, steps)
    assert found.exact == set(plan.responses)
    for name, tangent in _differences(plan, at, steps, np.arange(3)).items():
        # Differences of fourth order over 2e-6 of lengths of 0.1 leave rounding of 1e-17 over 2e-6.
        np.testing.assert_allclose(found.slopes[name], tangent.d, rtol=1e-8, atol=1e-9, err_msg=name)


def test_points_that_share_a_place_leave_single_distances_to_differences(tmp_path: Path) -> None:
    w = points(5e-3)[[0, 2, 1, 3, 5, 4]]
    plan = plan_of(tmp_path, STUDY.format(x=w[:, 0].tolist(), y=w[:, 1].tolist(), timing=""))
    at, steps = np.array([0.0502, 0.1199, 0.0403]), np.full(3, 2e-6)
    found = slopes(plan, at, steps)
    assert "rms" in found.exact
    differences = _differences(plan, at, steps, np.arange(3))
    np.testing.assert_allclose(found.slopes["rms"], differences["rms"].d, rtol=1e-7)


def test_a_point_on_its_path_has_a_kink(tmp_path: Path) -> None:
    plan = plan_of(tmp_path, text(is_timed=True, noise=0.0))
    at = np.array([lw.get(plan.machine, axis.addresses[0]) for axis in plan.axes])
    ties = slopes(plan, at, np.full(3, 1e-6)).ties
    assert "lies on the path" in ties["rms"]
    assert "x" not in ties


@pytest.mark.parametrize("is_timed", [True, False])
def test_rows_are_those_of_single_machines(is_timed: bool, tmp_path: Path) -> None:
    plan = plan_of(tmp_path, text(is_timed=is_timed))
    rng = np.random.default_rng(1)
    columns = {axis.name: rng.uniform(axis.low, axis.high, 5) for axis in plan.axes}
    rows = lw.evaluate(plan, columns)
    places = {axis.name: axis.addresses[0] for axis in plan.axes}
    for row in range(5):
        machine = lw.replace(plan.machine, {places[name]: columns[name][row] for name in places})
        alone = lw.path_error(machine, "K", *points().T, *([ANGLES] if is_timed else []))
        assert rows.columns["rms"][row] == pytest.approx(alone.error_rms, rel=1e-10)
        assert rows.columns["second"][row] == pytest.approx(alone.error[1], rel=1e-9)


def test_a_six_bar_against_its_driving_crank(tmp_path: Path) -> None:
    """Any point of any machine: the foot of Klann's leg, of links in two loops."""
    machine = lw.read("klann_leg")
    (crank,) = machine.mechanism.cranks
    name = list(lw.kinematics(machine, [0.0]).points)[-1]
    x, y = lw.kinematics(machine, ANGLES).points[name].position.T
    study = f"""
machine = "klann_leg"
[variables.crank]
address = "mechanism.cranks.{crank}.radius"
tolerance = "± 0.5 %"
[paths.step]
point = "{name}"
x = {x.tolist()}
y = {y.tolist()}
crank_angle = {ANGLES.tolist()}
[responses]
error = "path.step.error_rms"
"""
    plan = plan_of(tmp_path, study)
    found = lw.tolerance(plan, 200)
    assert found.responses["error"]["middle"] < 1e-15
    assert found.responses["error"]["mean"] > 1e-6
    assert found.exact == ("error",)


def test_rows_that_do_not_close_say_so(tmp_path: Path) -> None:
    study = text(is_timed=False).replace('["45 mm", "55 mm"]', '["45 mm", "90 mm"]')
    rows = lw.evaluate(
        plan_of(tmp_path, study),
        {"crank": np.array([0.05, 0.09]), "coupler": np.full(2, 0.12), "across": np.full(2, 0.04)},
    )
    assert rows.status.tolist() == [0, 1]
    assert "do not close at every crank angle" in rows.why(1)
    machine = lw.read("four_bar_coupler_curve", {"mechanism.cranks.A.radius": "90 mm"})
    with pytest.raises(AssemblyError, match="closes only at crank angles"):
        lw.path_error(machine, "K", *points().T)


def test_a_curve_of_several_revolutions_needs_crank_angles() -> None:
    """A wheel that turns half as fast as the crank closes its curve after two revolutions."""
    sizes = {"mechanism.gears.wheel.size": 40, "mechanism.gears.idler.size": 20}
    machine = lw.read(EXAMPLES / "geared_five_bar" / "machine.toml", sizes)
    with pytest.raises(FindingError, match="does not close after one revolution of the crank; give"):
        lw.path_error(machine, "D", [0.0], [0.1])
    assert lw.path_error(machine, "D", [0.0], [0.1], [7.0]).error_max > 0


@pytest.mark.parametrize(
    ("old", "new", "key", "told"),
    [
        ('point = "K"', 'point = "L"', "paths.tool.point", "a point of the machine"),
        ('point = "K"', "", "paths.tool.point", "nothing"),
        ('"path.tool.error_rms"', '"path.tol.error_rms"', "responses.rms.quantity", 'did you mean "tool"'),
        ('"path.tool.error_rms"', '"path.error_rms"', "responses.rms.quantity", "path.NAME.QUANTITY"),
        ('"path.tool.error_rms"', '"path.tool.error"', "responses.rms.quantity", "which is a list"),
        ('"path.tool.error_rms"', '"path.tool.eror_rms"', "responses.rms.quantity", "error_rms"),
        ("index = 1", "index = 6", "responses.second.index", "the path has 6 points"),
        ("index = 1", "extreme = 'max', level = 0.9", "responses.second.level", "nothing beside a path"),
        ("[paths.tool]", "[paths.tool]\nspeed = 1", "paths.tool.speed", "unknown key"),
        ("crank_angle = [", "crank_angle = [0.1, ", "paths.tool.crank_angle", "6 values, one a point"),
        ("y = [", "y = [0.1, ", "paths.tool.y", "6 values, one a point"),
        ("crank_angle = [", 'crank_angle = ["3 mm", ', "paths.tool.crank_angle", "angle"),
        ("y = [", 'y = ["3 deg", ', "paths.tool.y", "length"),
        ("x = [", "x = []  # [", "paths.tool.x", "at least 1 value"),
    ],
)
def test_what_is_wrong_with_a_path(old: str, new: str, key: str, told: str, tmp_path: Path) -> None:
    study = text(is_timed=True)
    assert old in study
    with pytest.raises(MachineFileError) as caught:
        plan_of(tmp_path, study.replace(old, new, 1))
    message = str(caught.value)
    assert "study.toml:" in message
    assert key in message
    assert told in message


def test_wrong_arguments_of_path_error() -> None:
    machine = lw.read("four_bar_coupler_curve")
    with pytest.raises(MachineError, match="one of O, B, A, C, K"):
        lw.path_error(machine, "k", [0.0], [0.0])
    with pytest.raises(
        InputError, match=r"crank_angle: found an array of shape \(2,\), expected a list of 1"
    ):
        lw.path_error(machine, "K", [0.0], [0.0], [0.0, 1.0])
    with pytest.raises(InputError, match="x: found an array of shape"):
        lw.path_error(machine, "K", [], [])


TASK = """
x = "500, 400, 300, 200, 100, 50 mm"
y = "1100, 1100, 1100, 1000, 900, 750 mm"
{timing}
linkage = "crank-rocker"
transmission_angle_min = "30 deg"
length_ratio_max = 8
population = 40
generations = 100
"""
REGION = '[pivots]\nx = "-1, 2 m"\ny = "-1, 2 m"\n'
PIVOTS = 'crank_pivot = { x = "0.8 m", y = "0.35 m" }\nrocker_pivot = { x = "1.95 m", y = "-0.3 m" }\n'


@pytest.mark.parametrize("timing", ['crank_angle = "0, 20, 40, 60, 80, 100 deg"', ""])
@pytest.mark.parametrize("pivots", [REGION, PIVOTS, 'length_max = "1.5 m"\n'])
def test_the_study_of_a_task_finds_no_worse_linkage(timing: str, pivots: str, tmp_path: Path) -> None:
    task, study = tmp_path / "task.toml", tmp_path / "study.toml"
    task.write_text(TASK.format(timing=timing) + pivots, encoding="utf-8")
    done = run("synthesise", "path", str(task), "--study", str(study), "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)["results"]["path_generator"]
    plan = lw.read_study(study)
    # The linkage itself is a machine of the study: within its ranges and limits, with the same numbers.
    at = {axis.name: np.array([lw.get(plan.machine, axis.addresses[0])]) for axis in plan.axes}
    for axis in plan.axes:
        assert axis.low <= at[axis.name][0] <= axis.high, axis.name
    assert ("phase" in at, "A0_x" in at) == (bool(timing), pivots != PIVOTS)
    rows = lw.evaluate(plan, at)
    assert rows.status.tolist() == [0], rows.reasons
    for name in ("error_rms", "error_max", "transmission_angle_min"):
        assert rows.columns[name][0] == pytest.approx(found[name], rel=1e-6, abs=1e-12), name
    for name, (low, high) in plan.limits.items():
        assert low - 1e-8 <= rows.columns[name][0] <= high + 1e-8, name
    best = lw.optimise(plan, 60, method="both")
    # An error of zero is rounding [m].
    assert best.responses["error_rms"] <= rows.columns["error_rms"][0] * (1 + 1e-9) + 1e-12
    for name, (low, high) in plan.limits.items():
        assert low - 1e-8 <= best.responses[name] <= high + 1e-8, name


def test_sweep_and_tolerance_take_the_study(tmp_path: Path) -> None:
    task, study = tmp_path / "task.toml", tmp_path / "study.toml"
    task.write_text(TASK.format(timing="") + REGION, encoding="utf-8")
    assert run("synthesise", "path", str(task), "--study", str(study)).exit_code == 0
    assert run("synthesise", "path", str(task), "--study", str(study)).exit_code == 2
    assert "--force" in run("synthesise", "path", str(task), "--study", str(study)).output
    done = run("sweep", str(study), "--out", str(tmp_path / "rows"), "--set", "study.sweep.rows=64", "--json")
    assert done.exit_code == 0, done.output
    words = study.read_text(encoding="utf-8").split("\n[")
    made = [part for part in words if not part.startswith(("variables.", "constraints", "goals", "sweep"))]
    lengths = '\nvariables.crank]\naddress = "mechanism.cranks.A.radius"\ntolerance = "± 0.1 mm"\n'
    derived = [part if not part.startswith("derived") else 'derived]\nframe = "1"' for part in made]
    kept = [part for part in derived if not part.startswith("responses")]
    scatter = "\n[".join([*kept, lengths.strip(), 'responses]\nerror = "path.given.error_rms"'])
    study.write_text(scatter, encoding="utf-8")
    done = run("tolerance", str(study), "--rows", "200", "--json")
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["results"]["tolerance"]["exact"] == ["error"]
