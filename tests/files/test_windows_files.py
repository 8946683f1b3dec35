"""Files as Windows has them: names that a program holds open, directories, links that are files.

The calls of Windows are stood in for; what they answer is that of their documentation.
"""

from __future__ import annotations

import ctypes
import errno
import os
import sys
from pathlib import Path

import pytest

from linkwright import InputError
from linkwright.kernel import system
from linkwright.kernel.files import library, output
from linkwright.kernel.files.output import write_file
from linkwright.kernel.files.text_file import TextError, data_of
from linkwright.kernel.limits import FILE_BYTES

pytestmark = pytest.mark.skipif(os.name == "nt", reason="stands in for Windows")


@pytest.fixture(autouse=True)
def _windows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(system, "WINDOWS", True)
    monkeypatch.setattr(system, "_PAUSE", 0.0)


def held(monkeypatch: pytest.MonkeyPatch, times: int) -> list[Path]:
    """Let a name be held open for so many tries; the names that were tried."""
    replace, tried = Path.replace, list[Path]()

    def refused(part: Path, place: Path) -> Path:
        tried.append(place)
        if len(tried) <= times:
            raise PermissionError(errno.EACCES, "Access is denied", str(place))
        return replace(part, place)

    monkeypatch.setattr(Path, "replace", refused)
    return tried


def test_a_name_that_is_held_for_a_moment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(output.system, "is_alive", lambda process: True)
    tried = held(monkeypatch, 3)
    write_file(tmp_path / "rows.csv", "1")
    assert (tmp_path / "rows.csv").read_text() == "1"
    assert len(tried) == 4


def test_a_name_that_stays_held(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(output.system, "is_alive", lambda process: True)
    (tmp_path / "rows.csv").write_text("old")
    held(monkeypatch, 1000)
    with pytest.raises(
        InputError, match=r"rows.csv: cannot be written \(Access is denied\); close it in other"
    ):
        write_file(tmp_path / "rows.csv", "new")
    assert [path.name for path in tmp_path.iterdir()] == ["rows.csv"]
    assert (tmp_path / "rows.csv").read_text() == "old"


def test_a_file_without_permission_leaves_no_part(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A part with the mark of its place, to be read only, could not be removed there."""
    monkeypatch.setattr(Path, "chmod", lambda *_: pytest.fail("the mark was copied"))
    (tmp_path / "rows.csv").write_text("old")
    write_file(tmp_path / "rows.csv", "new")
    assert (tmp_path / "rows.csv").read_text() == "new"


def test_what_a_killed_run_left_and_is_held_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    part = tmp_path / f".linkwright-part-{output._computer()}-1-0badcafe"
    part.write_text("unfinished")
    monkeypatch.setattr(system, "is_alive", lambda process: False)
    unlink = Path.unlink

    def refused(path: Path, *, missing_ok: bool = False) -> None:
        if path == part:
            raise PermissionError(errno.EACCES, "Access is denied")
        unlink(path, missing_ok=missing_ok)

    monkeypatch.setattr(Path, "unlink", refused)
    write_file(tmp_path / "a", "new")
    assert (tmp_path / "a").read_text() == "new"


class Kernel32:
    """The library of Windows with one process; `code` is its exit code, 259 while it runs."""

    def __init__(self, code: int) -> None:
        self.code, self.closed = code, 0
        self.last_error = 0
        # A function of ctypes takes the type of its result as an attribute.
        self.OpenProcess = type("Function", (), {"__call__": staticmethod(self._open)})()

    def _open(self, rights: int, inherits: bool, process: ctypes.c_ulong) -> int | None:
        assert (rights, inherits) == (0x1000, False)
        if process.value == 4711:
            return 8
        # ERROR_ACCESS_DENIED of the system's own; ERROR_INVALID_PARAMETER of none.
        self.last_error = 5 if process.value == 4 else 87
        return None

    def GetExitCodeProcess(self, handle: ctypes.c_void_p, code: object) -> bool:
        assert handle.value == 8
        ctypes.cast(code, ctypes.POINTER(ctypes.c_ulong))[0] = self.code  # type: ignore[arg-type]
        return True

    def CloseHandle(self, handle: ctypes.c_void_p) -> bool:
        self.closed += 1
        return True


@pytest.mark.parametrize(
    ("process", "code", "alive"), [(4711, 259, True), (4711, 1, False), (4, 259, True), (5, 259, False)]
)
def test_which_process_is_alive(
    process: int, code: int, alive: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    kernel = Kernel32(code)
    monkeypatch.setattr(ctypes, "WinDLL", lambda name, use_last_error: kernel, raising=False)
    monkeypatch.setattr(ctypes, "get_last_error", lambda: kernel.last_error, raising=False)
    assert system.is_alive(process) is alive
    assert kernel.closed == (process == 4711)


def test_a_directory_is_told_though_windows_denies_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def denied(path: Path, mode: str) -> None:
        raise PermissionError(errno.EACCES, "Permission denied", str(path))

    monkeypatch.setattr(Path, "open", denied)
    with pytest.raises(TextError, match=r"^a directory$"):
        data_of(tmp_path, FILE_BYTES)
    (tmp_path / "machine.toml").touch()
    with pytest.raises(TextError, match="without permission"):
        data_of(tmp_path / "machine.toml", FILE_BYTES)


def test_links_that_git_writes_as_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Git on Windows does so unless its user may make links."""
    package = tmp_path / "python" / "linkwright"
    package.mkdir(parents=True)
    for name, folder in (("library", "machines"), ("examples", "examples")):
        (package / name).write_text(f"../../{folder}")
        (tmp_path / folder / "press").mkdir(parents=True)
    (tmp_path / "machines" / "crank.toml").touch()
    (tmp_path / "examples" / "press" / "machine.toml").touch()
    monkeypatch.setattr(library, "_PACKAGE", package)
    assert set(library._files.__wrapped__()) == {"crank", "press"}


@pytest.mark.parametrize(
    "name", sorted(sys.stdlib_module_names & {"fcntl", "resource", "grp", "pwd", "termios"})
)
def test_no_module_of_unix_alone_is_imported(name: str) -> None:
    package = Path(system.__file__).parents[1]
    for path in package.rglob("*.py"):
        assert f"import {name}" not in path.read_text(encoding="utf-8"), path
