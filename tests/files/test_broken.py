"""Every file in `broken/` gives the message that lies beside it.

After a change of wording, ``python tests/files/test_broken.py`` writes the messages anew; read the
difference.
"""

from __future__ import annotations

from contextlib import chdir
from pathlib import Path

import pytest

from linkwright import MachineFileError, read

BROKEN = sorted((Path(__file__).parent / "broken").glob("*.toml"))


def fault(path: Path) -> MachineFileError:
    with chdir(path.parent), pytest.raises(MachineFileError) as caught:
        read(path.name)
    return caught.value


def message(path: Path) -> str:
    return "\n\n".join(map(str, fault(path).problems)) + "\n"


@pytest.mark.parametrize("path", BROKEN, ids=lambda path: path.stem)
def test_message(path: Path) -> None:
    assert message(path) == path.with_suffix(".txt").read_text(encoding="utf-8")


@pytest.mark.parametrize("path", BROKEN, ids=lambda path: path.stem)
def test_no_word_of_the_library_underneath(path: Path) -> None:
    text = message(path)
    for word in ("pydantic", "Input should", "validation error", "http", "type="):
        assert word not in text


@pytest.mark.parametrize("path", BROKEN, ids=lambda path: path.stem)
def test_every_problem_has_its_place(path: Path) -> None:
    points = path.with_suffix(".csv")
    for problem in fault(path).problems:
        assert problem.path in (path.name, points.name)
        n_lines = len((path.parent / problem.path).read_text(encoding="utf-8").splitlines())
        assert problem.line is not None
        assert 1 <= problem.line <= max(n_lines, 1)
        assert problem.found
        assert problem.expected


if __name__ == "__main__":
    for each in BROKEN:
        each.with_suffix(".txt").write_text(message(each), encoding="utf-8")
