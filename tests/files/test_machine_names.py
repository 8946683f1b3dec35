"""Machines of library and examples are found by name, from any folder; a file of that name comes first."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import invoke

import linkwright as lw
from linkwright import MachineFileError
from linkwright.kernel.files.library import library, library_path

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("name", library())
def test_a_machine_is_found_by_its_name(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert lw.read(name) == lw.read(library_path(name))


def test_machines_and_examples_have_names_of_their_own() -> None:
    machines = {path.stem for path in (ROOT / "machines").glob("*.toml")}
    examples = {path.parent.name for path in (ROOT / "examples").glob("*/machine.toml")}
    assert not machines & examples
    assert set(library()) == machines | examples


def test_a_command_takes_a_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = invoke("check", "roller_two_carts")
    assert done.exit_code == 0, done.output


def test_a_file_comes_before_the_library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    text = library_path("roller_one_cart").read_text(encoding="utf-8")
    (tmp_path / "roller_two_carts").write_text(text, encoding="utf-8")
    assert lw.read("roller_two_carts") == lw.read(library_path("roller_one_cart"))


@pytest.mark.parametrize("name", ["roller_two_cart", "roller_two_carts.toml", "./roller_two_carts"])
def test_nothing_else_is_taken_for_a_name(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    if name.startswith("./"):
        # A path is a path, even if Python leaves its dot out.
        name = str(tmp_path / "roller_two_carts")
    with pytest.raises(MachineFileError, match="no such file"):
        lw.read(name)
