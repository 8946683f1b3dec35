"""What needs a package that is not installed says so, with the command that installs it from the clone."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from collections.abc import Callable
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from command_line import invoke

import linkwright as lw
from linkwright import InputError
from linkwright.app.report.moving import mp4
from linkwright.kernel import extras, system
from linkwright.kernel.extras import install_command, require
from linkwright.kernel.page.typeset import _compiler
from linkwright.studies.parquet import require_pyarrow
from linkwright.studies.workers import _client

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "python" / "linkwright"


def hide(monkeypatch: pytest.MonkeyPatch, package: str) -> None:
    for name in [each for each in sys.modules if each.startswith(f"{package}.")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, package, None)


def _frame() -> Any:
    return lw.steady_state(lw.read("roller_two_carts")).to_frame()


def _batch_frame() -> Any:
    return lw.steady_states(lw.read("roller_two_carts"), {"drive.gearbox.ratio": [9.0, 9.5]}).to_frame()


NEEDS: list[tuple[str, str, Callable[[], Any], str]] = [
    ("pandas", "frame", _frame, "to_frame needs pandas"),
    ("pandas", "frame", _batch_frame, "to_frame needs pandas"),
    ("pyarrow", "studies", require_pyarrow, "Parquet files need pyarrow"),
    ("distributed", "cluster", lambda: _client("tcp://127.0.0.1:1"), "a cluster needs distributed"),
    ("typst", "report", _compiler, "a PDF needs Typst"),
    ("imageio_ffmpeg", "video", lambda: mp4({}, 1.0), "an MP4 needs an encoder, imageio-ffmpeg"),
]


@pytest.mark.parametrize(("package", "extra", "call", "need"), NEEDS, ids=lambda each: str(each)[:20])
def test_what_is_missing_is_told(
    package: str, extra: str, call: Callable[[], Any], need: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    hide(monkeypatch, package)
    words = f"{need}, which is not installed; in the clone of Linkwright: pip install '.[{extra}]'"
    with pytest.raises(InputError, match=f"^{re.escape(words)}$"):
        call()


@pytest.mark.parametrize("package", ["starlette", "uvicorn", "websockets"])
def test_the_studio_tells_each_package(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """websockets too, which the server would ask for only once a page is open."""
    hide(monkeypatch, package)
    done = invoke("studio", "--no-browser")
    assert done.exit_code == 2
    assert f"the studio needs {package}, which is not installed" in done.output
    assert "pip install '.[studio]'" in done.output


def test_a_package_that_is_broken_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    class Broken:
        """An importer of one module, whose library of the system is missing."""

        def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
            return ModuleSpec(name, self) if name == "broken_kernel" else None  # type: ignore[arg-type]

        def create_module(self, spec: ModuleSpec) -> ModuleType:
            raise ImportError("libGL.so.1:\ncannot open shared object file")

        def exec_module(self, module: ModuleType) -> None: ...

    monkeypatch.setattr(sys, "meta_path", [Broken(), *sys.meta_path])
    with pytest.raises(
        InputError, match=r"cannot be imported \(libGL.so.1: cannot open shared object file\)"
    ):
        require("broken_kernel", "step", "a solid needs a kernel")


def test_quotes_of_the_command_are_those_of_the_shell(monkeypatch: pytest.MonkeyPatch) -> None:
    assert install_command("step") == "pip install '.[step]'"
    monkeypatch.setattr(system, "WINDOWS", True)
    assert install_command("step") == 'pip install ".[step]"'


def _required() -> set[str]:
    found = set()
    for path in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            name = getattr(getattr(node, "func", None), "id", "")
            if isinstance(node, ast.Call) and name == "require" and len(node.args) == 3:
                found.add(ast.literal_eval(node.args[1]))
    return found


def test_every_extra_exists() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert len(_required()) >= 7
    assert _required() <= set(project["optional-dependencies"])


def test_one_place_has_the_command() -> None:
    own = Path(extras.__file__)
    others = [path for path in PACKAGE.rglob("*.py") if path != own]
    assert [path.name for path in others if "pip install" in path.read_text(encoding="utf-8")] == []
