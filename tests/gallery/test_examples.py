"""Every example runs, gives what its expected.toml says, and draws."""

from __future__ import annotations

import importlib.util
import tomllib
from pathlib import Path
from types import ModuleType

import pytest

import linkwright as lw

EXAMPLES = Path(__file__).parents[2] / "examples"
FOLDERS = sorted(path.parent for path in EXAMPLES.glob("*/run.py"))


def load(folder: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"example_{folder.name}", folder / "run.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_example_gives_what_it_says(folder: Path, tmp_path: Path) -> None:
    example, machine = load(folder), lw.read(folder / "machine.toml")
    found = example.study(machine)
    expected = tomllib.loads((folder / "expected.toml").read_text(encoding="utf-8"))
    assert found.keys() == expected.keys()
    for name, wanted in expected.items():
        assert found[name] == pytest.approx(wanted["value"], abs=wanted["abs"], rel=0), name
    figure = example.figure(machine)
    figure.savefig(tmp_path / "figure.png")
    assert (tmp_path / "figure.png").stat().st_size > 5000


def test_every_example_is_listed() -> None:
    listed = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    assert FOLDERS
    for folder in FOLDERS:
        assert f"({folder.name}/run.py)" in listed
        assert len((folder / "run.py").read_text(encoding="utf-8").splitlines()) <= 60
