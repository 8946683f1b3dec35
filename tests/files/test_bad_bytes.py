"""Files that are no text, no numbers, or have no end: a message with file and line from every reader."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from linkwright import InputError, MachineFileError, read
from linkwright.kernel.files.points import read_columns
from linkwright.kernel.units.kinds import ANGLE, TIME
from linkwright.linkages.law import read_law_table

HEAD = "time [s], angle [rad]\n"
ROWS = "0,0\n1,1\n2,3\n"

READERS: dict[str, Callable[[Path], Any]] = {
    "columns": lambda path: read_columns(path, {"time": TIME, "angle": ANGLE}),
    "law": read_law_table,
    "machine": read,
}

NO_TEXT = {
    "utf-16": ((HEAD + ROWS).encode("utf-16"), "UTF-16"),
    "utf-16 without a mark": ((HEAD + ROWS).encode("utf-16-le"), "byte 2 is 0"),
    "latin-1": ((HEAD + ROWS + "# Exzenterhöhe\n").encode("latin-1"), "no UTF-8 text"),
    "zeros": (b"\0" * 100, "byte 1 is 0"),
}

# What stands in the last line.
NO_NUMBERS = (
    "3,nan",
    "nan,3",
    "3,inf",
    "3,1e400",
    "3,1_000",
    "3,0x10",
    "3,٣",
    "3,=1+1",
    "3,1e300",
    "3",
    "3,4,5",
)


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("name", NO_TEXT)
def test_no_text(reader: str, name: str, tmp_path: Path) -> None:
    data, said = NO_TEXT[name]
    path = tmp_path / "points.csv"
    path.write_bytes(data)
    with pytest.raises(MachineFileError, match=said) as caught:
        READERS[reader](path)
    assert "points.csv" in str(caught.value)
    assert caught.value.problems[0].remedy.startswith("save the file as UTF-8")


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no such device here")
def test_a_device_without_end(reader: str, tmp_path: Path) -> None:
    path = tmp_path / "points.csv"
    path.symlink_to("/dev/zero")
    with pytest.raises(MachineFileError, match="a larger file"):
        READERS[reader](path)


@pytest.mark.parametrize("reader", ["columns", "law"])
@pytest.mark.parametrize(
    "line", [*NO_NUMBERS, "3," + "9" * 200_000, '3,"' + "x" * 200_000], ids=lambda x: x[:9]
)
def test_no_numbers(reader: str, line: str, tmp_path: Path) -> None:
    path = tmp_path / "points.csv"
    path.write_text(HEAD + ROWS + line + "\n", encoding="utf-8")
    with pytest.raises(MachineFileError) as caught:
        READERS[reader](path)
    assert caught.value.problems[0].line == 5
    assert len(str(caught.value)) < 500


@pytest.mark.parametrize("reader", ["columns", "law"])
def test_a_mark_in_front_and_any_line_ends_change_nothing(reader: str, tmp_path: Path) -> None:
    path = tmp_path / "points.csv"
    path.write_text(HEAD + ROWS, encoding="utf-8")
    wanted = READERS[reader](path)
    for data in (
        b"\xef\xbb\xbf" + (HEAD + ROWS).encode(),
        (HEAD + ROWS).replace("\n", "\r\n").encode(),
        (HEAD + ROWS).replace("\n", "\r").encode(),
    ):
        path.write_bytes(data)
        assert repr(READERS[reader](path)) == repr(wanted)


def test_a_mark_in_front_of_a_law_without_head_keeps_its_first_point(tmp_path: Path) -> None:
    path = tmp_path / "law.csv"
    path.write_bytes(b"\xef\xbb\xbf" + ROWS.encode())
    assert read_law_table(path) == ([0.0, 1.0, 2.0], [0.0, 1.0, 3.0])


@pytest.mark.skipif(os.name == "nt", reason="names of files are Unicode there")
@pytest.mark.parametrize(
    "command", [["check"], ["run", "--out", "out"], ["motion", "--json"]], ids=lambda x: x[0]
)
def test_a_name_of_a_file_that_is_no_text(command: list[str], tmp_path: Path) -> None:
    machine = Path(__file__).parents[2] / "machines" / "roller_one_cart.toml"
    name = os.fsdecode(b"caf\xe9.toml")
    (tmp_path / name).write_text(machine.read_text(encoding="utf-8"), encoding="utf-8")
    words = [sys.executable, "-m", "linkwright", command[0]]
    for file, code in ((name, 0), (name + "x", 2)):
        done = subprocess.run([*words, file, *command[1:]], cwd=tmp_path, capture_output=True, check=False)
        assert done.returncode == code, done.stderr.decode(errors="replace")
        assert b"Traceback" not in done.stderr


def test_an_override_that_is_no_text() -> None:
    with pytest.raises(InputError, match="UTF-8 text"):
        read(Path(__file__).parents[2] / "machines" / "roller_one_cart.toml", [os.fsdecode(b"name=caf\xe9")])
