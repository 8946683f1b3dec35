"""The time to read a text is linear in its length: twice the text takes about twice the work.

Texts are those that made expressions go back and forth: runs of blanks, digits and brackets, many columns.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright import LinkwrightError
from linkwright.kernel.description.formula import FormulaError
from linkwright.kernel.description.formula import parse as formula
from linkwright.kernel.description.place import split
from linkwright.kernel.files.points import columns_of
from linkwright.kernel.files.text_file import deep_line, long_number_line
from linkwright.kernel.units.kinds import LENGTH
from linkwright.kernel.units.reading import parse, parse_list
from linkwright.machine import size_and_limits
from linkwright.machine.overrides import parse as override
from linkwright.studio.controls import controls
from linkwright.studio.document import written

# Texts of n characters, and what reads them. `written` is read by the studio.
READERS: dict[str, tuple[Callable[[str], object], Callable[[int], str], int]] = {
    "brackets": (deep_line, lambda n: "x = [" + " " * n + "1]", 100_000),
    "open brackets": (deep_line, lambda n: "x = " + "[ " * 20 + "1," * n, 50_000),
    "blanks in keys": (deep_line, lambda n: "[" + "a ." * 10 + " " * n, 100_000),
    "digits": (lambda text: parse(text, LENGTH), lambda n: "1" * n + "!", 100_000),
    "blanks": (lambda text: parse(text, LENGTH), lambda n: "1" + " " * n + "!", 100_000),
    "commas": (lambda text: parse(text, LENGTH), lambda n: "1,1" * n + ";", 50_000),
    "list": (lambda text: parse_list(text, LENGTH), lambda n: "1 " * n + ",,", 20_000),
    "size of digits": (size_and_limits, lambda n: "1" * n + "!", 100_000),
    "size of blanks": (size_and_limits, lambda n: "1" + " " * n + "!", 100_000),
    "size of zeros": (size_and_limits, lambda n: "1" + " 0" * n + " + x", 50_000),
    "size of signs": (size_and_limits, lambda n: "1 mm" + "+1" * n, 50_000),
    "size of letters": (size_and_limits, lambda n: "1 " + "m" * n + " H", 100_000),
    "formula": (formula, lambda n: "1" * n, 5_000),
    "address": (split, lambda n: "a" + " " * n + '"', 100_000),
    "address of quotes": (split, lambda n: '"a"' + " " * n + '"', 100_000),
    "override": (override, lambda n: "a=" + "[" * n, 20_000),
    "override of keys": (override, lambda n: "a=1\n" + "a." * n + "b=1", 20_000),
    "number": (long_number_line, lambda n: "1" * 1000 + "x" + "1" * n, 100_000),
}


def seconds(read: Callable[[str], object], text: str) -> float:
    times = []
    for _ in range(5):
        begun = time.process_time()
        with contextlib.suppress(LinkwrightError, FormulaError):
            read(text)
        times.append(time.process_time() - begun)
    return min(times)


def ratio(read: Callable[[str], object], of: Callable[[int], str], n: int) -> float:
    """Time of four times the text over that of the text: 4 where it is linear, 16 where it is a square.

    A tenth of a millisecond is added: what a call takes besides.
    """
    return (seconds(read, of(4 * n)) + 1e-4) / (seconds(read, of(n)) + 1e-4)


@pytest.mark.parametrize("name", READERS)
def test_reading_is_linear(name: str) -> None:
    read, of, n = READERS[name]
    assert ratio(read, of, n) < 10


@pytest.mark.parametrize("kind", ["columns", "cell"])
def test_files_of_points_are_read_in_linear_time(kind: str, tmp_path: Path) -> None:
    def text(n: int) -> str:
        if kind == "cell":
            return "angle [deg], lift [mm]\n0,0\n180," + "1" * n + "!\n"
        return ",".join(f"a{k}" for k in range(n // 8)) + "\n" + ",".join(["1"] * (n // 8)) + "\n"

    def read(content: str) -> object:
        (tmp_path / "a.csv").write_text(content)
        return columns_of(tmp_path / "a.csv", "file")

    assert ratio(read, text, 30_000) < 10


def test_controls_of_many_tables_are_made_in_linear_time() -> None:
    def read(text: str) -> object:
        return controls({"a": {"b": {"c": {"d": [{} for _ in text]}}}})

    assert ratio(read, lambda n: "x" * n, 250) < 10
    assert written({"a": "1" * 5}, ("a",), "text") == "text"
