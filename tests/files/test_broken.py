"""Every file in `broken/` gives the message that lies beside it.

After a change of wording, ``python tests/files/test_broken.py`` writes the messages anew; read the
difference.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.errors import MachineFileError
from linkwright.files import loads

BROKEN = sorted((Path(__file__).parent / "broken").glob("*.toml"))


def message(path: Path) -> str:
    """The message of a broken file."""
    with pytest.raises(MachineFileError) as caught:
        loads(path.read_text(encoding="utf-8"), path=path.name)
    return str(caught.value) + "\n"


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
    with pytest.raises(MachineFileError) as caught:
        loads(path.read_text(encoding="utf-8"), path=path.name)
    n_lines = len(path.read_text(encoding="utf-8").splitlines())
    for problem in caught.value.problems:
        assert problem.path == path.name
        assert problem.line is not None
        assert 1 <= problem.line <= max(n_lines, 1)
        assert problem.found
        assert problem.expected


if __name__ == "__main__":
    for each in BROKEN:
        each.with_suffix(".txt").write_text(message(each), encoding="utf-8")
