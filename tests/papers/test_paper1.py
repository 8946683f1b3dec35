"""The reproduction of paper 1: what it concludes follows from numbers that are checked here."""

from __future__ import annotations

import pytest

from linkwright import constant_energy, read, replace, steady_state
from linkwright.drive import InductionMotor
from linkwright.kernel.files.library import library, library_path
from linkwright.papers.claim import Cell
from linkwright.papers.paper1.drive import published_drives, recompute
from linkwright.papers.paper1.paper import Paper1, paper1
from linkwright.papers.paper1.scheme import limit_curves, motor_torque, scaled_to


@pytest.fixture(scope="module")
def paper() -> Paper1:
    return paper1()


def test_the_machines_are_found() -> None:
    for each in published_drives():
        assert each.machine in library()
        assert len(read(library_path(each.machine)).mechanism.cranks) == each.carts


def test_every_machine_moves_steadily_and_runs_up(paper: Paper1) -> None:
    for drive in paper.drives:
        assert drive.steady.is_stable
        assert 0 < drive.up.turns < 5


def test_rows_one_and_three_fit_the_limit_and_row_four_does_not(paper: Paper1) -> None:
    one, two, three, four = paper.drives
    assert one.fit.inertia == pytest.approx(37.9, abs=0.05)
    assert one.fit.misfit < 1e-4
    assert three.fit.inertia == pytest.approx(80, rel=0.05)
    assert three.fit.fits
    assert two.fit.fits
    assert not four.fit.fits
    assert four.fit.unevenness < 0.06 * four.published.values["unevenness"]


def test_the_fit_is_a_machine_that_gives_it(paper: Paper1) -> None:
    """A gearbox that brings the drive to the fitted inertia gives the fitted δ and H."""
    one = paper.drives[0]
    at_motor = (one.fit.inertia - one.drive_inertia) / 9.8**2
    gearbox = one.machine.drive.gearbox.inertia
    machine = replace(one.machine, {"drive.gearbox.inertia": gearbox + at_motor})
    found = constant_energy(machine)
    assert found.unevenness == pytest.approx(one.fit.unevenness, rel=1e-9)
    assert found.dynamism == pytest.approx(one.fit.dynamism, rel=1e-6)


def test_the_limit_in_speeds(paper: Paper1) -> None:
    """½ J ω² is the same at every angle, and ε is the slope of ω along the revolution."""
    for drive in paper.drives:
        omega, epsilon = limit_curves(drive.reduced, drive.published.values["speed_mean"])
        energy = drive.reduced.inertia_reduced * omega**2
        assert energy.max() / energy.min() == pytest.approx(1, rel=1e-12)
        step = drive.reduced.crank_angle[1]
        slope = (omega[2:] - omega[:-2]) / (2 * step)
        assert abs(epsilon[1:-1] - omega[1:-1] * slope).max() < 1e-4 * abs(epsilon).max()
        row = scaled_to(constant_energy(drive.machine), drive.reduced, 10.0)
        assert row["acceleration_max"] == pytest.approx(row["dynamism"] * 100, rel=1e-4)


def test_rankings(paper: Paper1) -> None:
    rankings = paper.rankings
    assert rankings["published"] == [2, 3, 4, 1]
    for way, order in rankings.items():
        if way != "published":
            assert (order[0], order[-1]) == (4, 1)


def test_the_printed_table_against_itself() -> None:
    wrong = {
        each.carts: [found.quantity for found in recompute(each.values) if not found.agrees]
        for each in published_drives()
    }
    assert wrong == {1: [], 2: [], 3: ["speed_mean"], 4: ["speed_mean", "motion_coefficient"]}


def test_one_degree_reproduces_the_speeds(paper: Paper1) -> None:
    assert min(paper.steps.values()) == min(paper.steps[0.5], paper.steps[1.0])
    assert paper.steps[1.0] < 4e-4
    assert paper.steps[10.0] > 5e-3


def test_values_on_the_way_are_reproduced(paper: Paper1) -> None:
    assert len(paper.rows) == 3
    for row in paper.rows:
        assert row.verdict == "reproduced", row.name


def test_the_motor_of_the_scheme() -> None:
    motor = read(library_path("roller_two_carts")).drive.motor
    assert isinstance(motor, InductionMotor)
    assert motor_torque(motor, 0.0) == pytest.approx(129.24)
    assert motor_torque(motor, 94.95 / 2) == pytest.approx((129.24 + 215.4) / 2)
    assert motor_torque(motor, 94.95) == pytest.approx(215.4)
    assert motor_torque(motor, 104.72) == pytest.approx(0.0, abs=1e-9)
    # Paper 1 (8) at the rated speed, s = 2.62/9.77.
    assert motor_torque(motor, 102.1) == pytest.approx(430.8 / (9.77 / 2.62 + 2.62 / 9.77), rel=1e-9)


def test_the_factor_of_the_scheme_is_not_in_the_package(paper: Paper1) -> None:
    """The solution of (1) for two carts stays far from the published row."""
    two = paper.drives[1]
    assert two.steady.unevenness == steady_state(two.machine, n=1440).unevenness
    assert two.cells["solution"]["unevenness"].kind == "far"
    assert two.cells["scheme"]["speed_max"].verdict == "reproduced"


def test_verdicts() -> None:
    assert Cell(100.0, 100.1, "x").verdict == "reproduced"
    assert Cell(100.0, 97.7, "x").verdict == "within 2.3 %"
    assert Cell(100.0, 50.0, "of y").verdict == "not reproduced because of y"
    assert Cell(100.0, None, "there is none").verdict == "no value: there is none"
    assert Cell(-2.0, -3.0, "x").deviation == pytest.approx(0.5)
    assert Cell(1.0, 1.0, "x", given=True).kind == "none"


def test_everything_is_told(paper: Paper1) -> None:
    found = paper.to_dict()
    assert len(found["conclusions"]) == len(paper.conclusions) == 8
    for drive in found["drives"]:
        for cells in drive["columns"].values():
            assert list(cells) == list(paper.published["quantities"])
            assert all(cell["verdict"] for cell in cells.values())
