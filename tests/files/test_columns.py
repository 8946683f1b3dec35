"""Columns of quantities from files of comma-separated values."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from linkwright import MachineFileError, read
from linkwright.kernel.files.points import read_columns
from linkwright.kernel.units.kinds import ANGLE, SPEED

KINDS = {"angle": ANGLE, "speed": SPEED}


def written(folder: Path, text: str) -> Path:
    path = folder / "measured.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_units_stand_in_the_head(tmp_path: Path) -> None:
    """Other columns, comments and empty lines are passed over; without a unit numbers are SI."""
    text = "# a pick-up\nspeed [rpm], angle [deg], note\n600, 0, 1\n\n601.5, 90, 2\n"
    found = read_columns(written(tmp_path, text), KINDS)
    assert found["angle"] == pytest.approx([0, np.pi / 2], rel=1e-15)
    assert found["speed"] == pytest.approx([20 * np.pi, 601.5 * np.pi / 30], rel=1e-15)
    bare = read_columns(written(tmp_path, "angle, speed\n1.5, 60\n2.5, 61\n"), KINDS)
    assert bare["angle"].tolist() == [1.5, 2.5]


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("angle [deg], rpm\n0, 600\n", 1, "no column speed"),
        ("angle [deg], speed [m/s]\n0, 600\n", 2, '"m/s" is a unit of velocity'),
        ("angle [deg], speed [1/min]\n0, 600\n", 2, "revolutions or radians"),
        ("angle [deg], speed [rpm]\n0, 600\n1,\n", 3, "an empty cell"),
        ("angle [deg], speed [rpm]\n0, 600\n1, 2, 3\n", 3, "2 values, one for each column"),
        ("angle [deg], speed [rpm]\n", 1, "at least one row"),
    ],
)
def test_what_is_wrong_has_its_line(tmp_path: Path, text: str, line: int, words: str) -> None:
    path = written(tmp_path, text)
    with pytest.raises(MachineFileError) as caught:
        read_columns(path, KINDS)
    (problem,) = caught.value.problems
    assert (problem.path, problem.line) == (str(path), line)
    assert words in str(problem)


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(MachineFileError, match=r"nowhere\.csv\n  found:    no such file"):
        read_columns(tmp_path / "nowhere.csv", KINDS)


def test_files_of_points_lie_below_the_machine_file(tmp_path: Path) -> None:
    text = (Path(__file__).parent / "broken" / "topper_field_cell.toml").read_text(encoding="utf-8")
    points = "root_diameter [mm],cut_height [mm],offset [mm]\n100,30,0\n120,35,5\n"
    home = tmp_path / "home"
    (home / "data").mkdir(parents=True)
    for place in (tmp_path / "secret.csv", home / "data" / "roots.csv"):
        place.write_text(points, encoding="utf-8")
    (home / "link.csv").symlink_to(tmp_path / "secret.csv")

    def path(name: object) -> Path:
        file = home / "machine.toml"
        file.write_text(text.replace("topper_field_cell.csv", str(name)), encoding="utf-8")
        return file

    read(path("data/roots.csv"))
    read(path("data/../data/roots.csv"))
    for name in ("../secret.csv", "link.csv", tmp_path / "secret.csv", "data/../../secret.csv"):
        with pytest.raises(MachineFileError, match="--allow-outside"):
            read(path(name))
        assert read(path(name), allow_outside=True).topper is not None
