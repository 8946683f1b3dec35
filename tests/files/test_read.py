"""Reading a machine file: the shipped machines are read, what cannot be read gives a message."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sizes import cases

from linkwright import InputError, MachineFileError, loads, read
from linkwright.drive import InductionMotor
from linkwright.kernel.files.library import template, templates

MACHINES = sorted((Path(__file__).parents[2] / "machines").glob("*.toml"))
TWO_CARTS = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"


@pytest.mark.parametrize("path", MACHINES, ids=lambda path: path.stem)
def test_shipped_machines_are_sound(path: Path) -> None:
    assert read(path).name


@pytest.mark.parametrize("name", templates())
def test_templates_are_sound(name: str) -> None:
    assert loads(template(name)).name


def test_two_carts_holds_the_printed_numbers() -> None:
    machine = read(TWO_CARTS)
    drive = machine.drive
    assert drive is not None
    assert isinstance(drive.motor, InductionMotor)
    # I_0 of the paper, at the motor shaft.
    total = drive.motor.inertia + drive.gearbox.inertia
    assert total == pytest.approx(0.504, rel=1e-12)
    assert drive.motor.speed_breakdown == 94.95
    assert machine.mechanism.build_order() == ["A1", "A2", "cart1", "cart2"]


def test_a_mark_in_front_of_the_text_is_passed_over(tmp_path: Path) -> None:
    path = tmp_path / "windows.toml"
    text = TWO_CARTS.read_text(encoding="utf-8").replace("\n", "\r\n")
    path.write_bytes(b"\xef\xbb\xbf" + text.encode())
    assert read(path) == read(TWO_CARTS)


def _message(path: Path) -> str:
    with pytest.raises(MachineFileError) as caught:
        read(path)
    assert caught.value.exit_code == 2
    assert str(path) in str(caught.value)
    return str(caught.value)


def test_what_is_no_machine_file(tmp_path: Path) -> None:
    cases = {"empty": b"", "blank": b" \n\n", "latin": b"name = '\xe9'", "huge": b"#" * 4_000_001}
    words = {"empty": "empty", "blank": "empty", "latin": "UTF-8", "huge": "at most 1 000 000 bytes"}
    for name, data in cases.items():
        path = tmp_path / name
        path.write_bytes(data)
        assert words[name] in _message(path)
    assert "a directory" in _message(tmp_path)
    assert "no such file" in _message(tmp_path / "missing.toml")


def test_a_misspelt_file_name_is_recognised(tmp_path: Path) -> None:
    (tmp_path / "press.toml").write_text("")
    assert 'did you mean "press.toml"?' in _message(tmp_path / "pres.toml")


def test_a_misspelt_machine_of_the_library_is_recognised() -> None:
    assert 'did you mean "roller_two_carts"' in _message(Path("roller_two_cart"))


def test_a_path_that_no_system_takes() -> None:
    for path in ("a\0b", "x" * 5000):
        with pytest.raises(InputError):
            read(path)


def test_deep_brackets_end_in_a_message() -> None:
    with pytest.raises(MachineFileError, match="at most 32 keys inside one another"):
        loads("a = " + "[" * 100_000)


WORDS = st.sampled_from(
    ["A1", "cart1", "cart1.rod", "O", "dry", "induction", "spring", "1 m", "90 deg", "x", ""]
)
VALUES = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), WORDS, st.text(max_size=5), st.dates()),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(WORDS, inner, max_size=3)),
    max_leaves=6,
)
ADDRESSES = st.sampled_from(
    [
        "format",
        "name",
        "drive",
        "drive.speed",
        "drive.motor",
        "drive.motor.kind",
        "drive.motor.catalogue",
        "drive.gearbox.reverse",
        "mechanism",
        "mechanism.points",
        "mechanism.cranks",
        "mechanism.cranks.A1",
        "mechanism.sliders.cart1.crank",
        "mechanism.rockers.R",
        "mechanism.rigid_points.K.link",
        "bodies",
        "bodies.cart1",
        "bodies.cart1.along",
        "bodies.cart1.on",
        "loads",
        "loads.rolling1",
        "loads.rolling1.kind",
        "loads.rolling1.on",
        "loads.spring.between",
        "run_up",
        "run_up.settled",
    ]
)


@settings(deadline=None, max_examples=cases(250, 5000))
@given(st.dictionaries(ADDRESSES, VALUES, min_size=1, max_size=3))
def test_any_value_anywhere_is_read_or_gives_problems(changes: dict[str, Any]) -> None:
    message = "read"
    try:
        read(TWO_CARTS, changes)
    except InputError as error:
        message = str(error)
    assert message
    assert "Input should" not in message
    assert "pydantic" not in message


def test_another_format_is_the_only_problem() -> None:
    with pytest.raises(MachineFileError) as caught:
        loads("format = 2\nnonsense = 3\n")
    assert [each.key for each in caught.value.problems] == ["format"]
    assert caught.value.problems[0].line == 1


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("format = 1\nname = 'x\n", 2),
        ("a = 1\nb = 2\n[c]\nb = 2\n[c]\nd = 1\n", 5),
        ("a = 1\n\nb = 08\n", 3),
        ("a = [1,\n2,\n", 2),
        ("nonsense", 1),
        ("a = '\x00'", 1),
    ],
)
def test_a_fault_in_the_syntax_has_its_line(text: str, line: int) -> None:
    with pytest.raises(MachineFileError) as caught:
        loads(text, path="x.toml")
    (problem,) = caught.value.problems
    assert (problem.path, problem.line) == ("x.toml", line)
    assert "TOML" in problem.expected
    assert "(at line" not in str(caught.value)
