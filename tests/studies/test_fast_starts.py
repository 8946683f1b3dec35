"""Every study says which variants run away from fast starts, in the words of a single machine."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke
from tests.samples.fast_starts import FILE

import linkwright as lw
from linkwright.drive import FAST_STARTS
from linkwright.studies import columns_of

SWEPT = """
[study.variables.dry]
address = "loads.D.torque"
values = [0.2, 0.5, 0.8, 1.3, 1.6]
"""
RANGED = """
[study.variables.dry]
address = "loads.D.torque"
range = [0.2, 0.8]
[study.goals]
y = "minimise"
"""
SCATTERS = """
[study.variables.dry]
address = "loads.D.torque"
tolerance = "± 0.1 N m"
cost = 1
[study.constraints.y]
max = 40
"""
AT_ONCE, ALONE = "steady_state.speed_max", "steady_state.torque_motor_max"
RUNS_AWAY = FAST_STARTS[1]


def file_of(folder: Path, study: str, response: str = AT_ONCE) -> Path:
    path = folder / "machine.toml"
    # The responses of a study stand in front of its variables.
    path.write_text(f'{FILE}[study.responses]\ny = "{response}"\n{study}', "utf-8")
    return path


def warnings(*arguments: str) -> list[str]:
    done = invoke(*arguments, "--json")
    assert done.exit_code == 0, done.output
    told: list[str] = json.loads(done.stdout)["warnings"]
    return told


@pytest.mark.parametrize("response", [AT_ONCE, ALONE, "forces.torque_drive_max"])
def test_a_row_that_runs_away_from_fast_starts_is_told(response: str, tmp_path: Path) -> None:
    path, folder = file_of(tmp_path, SWEPT, response), tmp_path / "rows"
    swept = lw.sweep(lw.read_study(path), folder)
    table = columns_of(folder / "part-000000.parquet")
    assert table["status"].tolist() == [0] * 5
    for dry, told in zip(table["dry"], table["fast_starts"], strict=True):
        alone = lw.steady_state(lw.loads(FILE.replace("torque = 0.5", f"torque = {dry}")))
        assert told == len(alone.start_limits)
    assert table["fast_starts"].tolist() == [1, 1, 1, 0, 0]
    assert swept.fast_starts == swept.to_dict()["fast_starts"] == {RUNS_AWAY: 3}
    assert f"3 rows: {RUNS_AWAY}" in warnings("sweep", "show", str(folder))
    text = invoke("sweep", "show", folder).output
    assert "runs away" in text


def test_a_response_without_steady_motion_does_not_hide_it(tmp_path: Path) -> None:
    path = file_of(tmp_path, f'{SWEPT}[study.responses.J]\nquantity = "reduction.inertia_max"\n')
    rows = lw.evaluate(lw.read_study(path), {"dry": np.array([0.2, 1.3])})
    assert rows.fast_starts.tolist() == [1, 0]


# Above 25 rad/s the load falls to nothing, and from 36 rad/s on nothing drives.
RANGE = (
    FILE[: FILE.index("[loads.L]")].replace(", inertia = 0 }", " }")
    + """[loads.L]
kind = "formula"
on = "A"
torque = "-(15 + 7*cos(phi) - where(omega > 25, 15, 0))"
"""
)


@pytest.mark.parametrize(("text", "way"), [(FILE, "runs away"), (RANGE, "accelerates into")])
def test_the_words_hold_for_each_machine(text: str, way: str) -> None:
    """A range of periodic motions is reached: the machine does not gain speed without limit."""
    machine = lw.loads(text)
    assert lw.steady_states(machine, {"bodies.A.inertia": [0.3]}).fast_starts.tolist() == [1]
    (alone,) = [warning for warning in lw.study(machine).warnings if way in warning]
    assert way in RUNS_AWAY
    assert alone.rpartition("; ")[2] == RUNS_AWAY.rpartition("; ")[2]


def test_a_row_that_fails_says_nothing_of_starts(tmp_path: Path) -> None:
    path = file_of(tmp_path, f'{SWEPT}[study.responses.q]\nformula = "1/(dry - 0.5)"\n')
    rows = lw.evaluate(lw.read_study(path), {"dry": np.array([0.2, 0.5, 1.3])})
    assert rows.status.tolist() == [0, 1, 0]
    assert rows.fast_starts.tolist() == [1, 0, 0]


@pytest.mark.parametrize(
    ("study", "command", "words"),
    [
        (SCATTERS, ("tolerance", "--rows", "100"), f"100 rows: {RUNS_AWAY}"),
        (SCATTERS, ("tolerance", "--rows", "100", "--allocate", "0.5"), f"15 rows: {RUNS_AWAY}"),
        (RANGED, ("optimise", "--evaluations", "20"), RUNS_AWAY),
        (
            RANGED + 'z = "minimise"\n[study.responses.z]\nquantity = "steady_state.period"\n',
            ("optimise", "--evaluations", "20", "--points", "3"),
            f"Machine 1: {RUNS_AWAY}",
        ),
    ],
)
def test_every_study_tells_it(study: str, command: tuple[str, ...], words: str, tmp_path: Path) -> None:
    path = file_of(tmp_path, study)
    assert words in warnings(command[0], str(path), *command[1:])


def test_a_search_that_goes_on_from_its_log_tells_it(tmp_path: Path) -> None:
    plan, log = lw.read_study(file_of(tmp_path, RANGED)), tmp_path / "search.log"
    first, second = (lw.optimise(plan, 20, log=log) for _ in range(2))
    assert first.fast_starts == second.fast_starts == RUNS_AWAY
