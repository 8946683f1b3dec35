"""What a command is made of: quantities, groups of options, parts of an answer made when asked for."""

from __future__ import annotations

import ast
import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import pytest
from click.testing import CliRunner, Result

from linkwright.app.application import COMMANDS, GROUPS
from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import FolderOutput, reports_errors, to_folder
from linkwright.kernel.command.parameter import Group, Option, Value, command
from linkwright.kernel.later import at_place, later
from linkwright.kernel.units.kinds import ANGLE, LENGTH
from linkwright.kernel.units.marks import positive

PACKAGE = Path(__file__).parents[2] / "python" / "linkwright"


@dataclass(frozen=True)
class Sizes:
    """Two lengths that go together."""

    width: Annotated[float | None, Value("--width", positive(LENGTH), "Width.")] = None
    is_thin: Annotated[bool, Option("--thin", help="Thin.")] = False


def call(words: str) -> tuple[Result, list[Any]]:
    """A command with a quantity, a group and an output; what it was called with."""
    taken: list[Any] = []

    def shape(
        sizes: Annotated[Sizes, Group(Sizes)],
        *,
        at: Annotated[float, Value("--at", ANGLE, "Angle.", "180 deg")],
        to: Annotated[FolderOutput, to_folder("Write there.")],
    ) -> None:
        """Draw a shape."""
        taken.extend((sizes, at))
        to.hand_over(Answer(machine="M", results={"at": at}))

    return CliRunner().invoke(command(shape, around=reports_errors), words.split()), taken


def test_quantities_and_groups_reach_the_function_in_si() -> None:
    """An option that is a quantity is given with its unit, and arrives as a number in SI."""
    done, taken = call("--width 20mm --thin --json")
    assert done.exit_code == 0, done.output
    assert taken == [Sizes(0.02, True), pytest.approx(3.14159265)]
    assert json.loads(done.stdout)["results"] == {"at": taken[1]}
    assert call("")[1][0] == Sizes(None, False)


def test_help_lists_the_options_of_a_group_in_its_place() -> None:
    """Options stand in the order of the parameters; a quantity is called by its kind."""
    text = call("--help")[0].stdout
    places = [
        text.index(words) for words in ("--width LENGTH", "--thin", "--at ANGLE", "--json", "--out DIR")
    ]
    assert places == sorted(places)
    assert "[default: 180 deg]" in text


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--width 3s", "--width: found"),
        ("--width -1mm", "--width: found"),
        ("--at 30", "which may be deg or rad"),
    ],
)
def test_a_wrong_quantity_is_an_error_of_input(words: str, message: str) -> None:
    """What is no such quantity is refused before the command begins, with the name of its option."""
    done, taken = call(words)
    assert (done.exit_code, taken) == (2, [])
    assert message in done.stderr


def test_a_file_in_place_of_a_folder_is_refused_before_anything_is_computed(tmp_path: Path) -> None:
    """``--out`` is looked at before the command begins."""
    (tmp_path / "other.txt").write_text("another's")
    done, taken = call(f"--out {tmp_path / 'other.txt'}")
    assert (done.exit_code, taken) == (2, [])


def test_parts_of_an_answer_are_made_when_they_are_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    """A function by its place is imported when it is called, never for JSON."""
    module = "linkwright.sensitivity.figures"
    sys.modules.pop(module, None)
    answer = Answer(
        machine="M", results={"it": 1}, figures={"one": later("sensitivity.figures:influence_figure", 1)}
    )
    hand_over(answer, json=True)
    assert json.loads(capsys.readouterr().out)["results"] == {"it": 1}
    assert module not in sys.modules


def places() -> set[str]:
    """Places of functions that the package names."""
    found = {each.function for each in COMMANDS.values()}
    found |= {each.function for group in GROUPS.values() for each in group.commands.values()}
    for path in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("of", "later", "at_place"):
                first = node.args[0] if node.args else None
                if isinstance(first, ast.Constant) and ":" in str(first.value):
                    found.add(str(first.value))
    return found


def test_every_function_that_is_named_by_its_place_is_there() -> None:
    """Types are not checked through a place: a name that is moved is found here."""
    named = places()
    assert len(named) > 100
    assert all(callable(at_place(place)) for place in named)
