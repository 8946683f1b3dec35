"""Cases that tools got wrong: Linkwright gives the closed form of each, which the mistake does not."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import pytest
from docs_scripts import docs_script
from tests.cases.derivations import CASES

FOLDER = Path(__file__).parent
NAMES = [derive.__name__ for derive in CASES]

# Samples of the derivation find the flat maximum of the pressure angle to this.
TOLERANCES = {"cam_offset": 1e-8}


@cache
def known() -> dict[str, Any]:
    """The cases with their answers, by name."""
    return {case.name: case for case in docs_script("cases").cases()}


@pytest.mark.parametrize("name", NAMES)
def test_the_answer_is_the_closed_form(name: str) -> None:
    """Every number that a case shows is that of its derivation."""
    case = known()[name]
    right = [value for value, _ in case.right]
    assert case.found == pytest.approx(right, rel=TOLERANCES.get(name, 1e-10), abs=1e-13)


@pytest.mark.parametrize("name", NAMES)
def test_the_mistake_gives_something_else(name: str) -> None:
    """A case whose mistake gave the right numbers would show nothing: it differs by a thousandth at once."""
    differences = [
        abs(right - wrong) / abs(right) if wrong is not None else 1.0 for right, wrong in known()[name].right
    ]
    assert max(differences) > 1e-3


def test_there_is_a_derivation_for_every_file() -> None:
    """At least a dozen cases, each a file and a function."""
    assert sorted(NAMES) == sorted(path.stem for path in FOLDER.glob("*.toml"))
    assert len(NAMES) >= 12


def test_findings_state_numbers() -> None:
    """A dyad that does not close and a bar of the wrong length are findings with their numbers."""
    (limits,) = known()["open_dyad"].findings
    assert "-75.52° to 75.52°" in limits
    (locked,) = known()["redundant_bar"].findings
    assert "0.101 m" in locked
    assert "locked" in locked
    assert [name for name, case in known().items() if case.findings] == ["open_dyad", "redundant_bar"]


def test_the_page_is_that_of_the_cases() -> None:
    """The page in the docs is what `python docs/cases.py` writes."""
    script = docs_script("cases")
    assert script.PAGE.read_text(encoding="utf-8") == script.page(), "run: python docs/cases.py"
