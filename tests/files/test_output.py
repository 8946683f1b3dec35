"""Files are whole or not there, whatever happens while they are written, and those of others stay."""

from __future__ import annotations

import ast
import errno
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from linkwright import InputError
from linkwright.kernel.files.output import MARKER, OutputFolder, file_name, file_names, trial, write_file

PACKAGE = Path(__file__).parents[2] / "python" / "linkwright"

# The one module that writes, and two whose libraries write to a path: that of a trial.
WRITERS = {"kernel/files/output.py", "cam/manufacture/dxf.py", "kernel/files/step.py"}


def seen(folder: Path) -> dict[str, str]:
    return {each.name: each.read_text() for each in folder.glob("[!.]*")}


def leftovers(folder: Path) -> list[str]:
    return [each.name for each in folder.iterdir() if each.name.startswith(".") and each.name != MARKER]


def test_one_module_writes() -> None:
    calls = {"write_text", "write_bytes", "savefig", "mkdir", "saveas", "Write", "tofile", "savetxt"}
    found = set()
    for path in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            # open() with another mode than reading
            modes = [each.value for each in node.args if isinstance(each, ast.Constant)]
            if name in calls or (name == "open" and any(str(mode)[:1] in "wax" for mode in modes if mode)):
                found.add(path.relative_to(PACKAGE).as_posix())
    # Figures are written into the memory; a folder for a drawing is made beside the module. A sweep puts its
    # parts into its folder one by one, the log of a search grows line by line, and completion goes into the
    # files of the user's shell.
    others = {"kernel/figure/svg.py", "app/curves.py", "cam/manufacture/write.py"}
    others |= {"studies/folder.py", "studies/search_log.py", "kernel/command/group.py"}
    assert found - others == WRITERS


def test_a_folder_that_is_new_empty_or_ours(tmp_path: Path) -> None:
    for name in ("new", "deep/er", "empty"):
        place = tmp_path / name
        if name == "empty":
            place.mkdir()
        folder = OutputFolder(place)
        folder.write({"a.txt": "1"})
        folder.write({"a.txt": "2", "b.txt": "3"})
        assert seen(place) == {"a.txt": "2", "b.txt": "3"}


def test_a_folder_of_others_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "report.html").write_text("mine")
    with pytest.raises(InputError, match=r"with other files \(report.html\).*--force"):
        OutputFolder(tmp_path).write({"report.html": "theirs"})
    assert seen(tmp_path) == {"report.html": "mine"}
    OutputFolder(tmp_path, force=True).write({"report.html": "theirs"})
    assert seen(tmp_path) == {"report.html": "theirs"}


def test_a_file_of_others_in_a_folder_of_ours(tmp_path: Path) -> None:
    folder = OutputFolder(tmp_path / "out")
    folder.write({"results.json": "1"})
    (tmp_path / "out" / "report.html").write_text("mine")
    with pytest.raises(InputError, match=r"report.html: exists and is not of an earlier run; --force"):
        folder.write({"results.json": "2", "report.html": "theirs"})
    assert seen(tmp_path / "out") == {"results.json": "1", "report.html": "mine"}


@pytest.mark.parametrize("force", [False, True])
def test_links_are_not_followed(tmp_path: Path, force: bool) -> None:
    mine = tmp_path / "mine"
    mine.write_text("mine")
    folder = OutputFolder(tmp_path / "out", force)
    folder.write({"a": "1"})
    (tmp_path / "out" / "b").symlink_to(mine)
    (tmp_path / "out" / "a").unlink()
    (tmp_path / "out" / "a").symlink_to(mine)
    for name in "ab":
        with pytest.raises(InputError, match="found a link, expected a file"):
            folder.write({name: "theirs"})
        with pytest.raises(InputError, match="found a link, expected a file"):
            write_file(tmp_path / "out" / name, "theirs")
    assert mine.read_text() == "mine"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes of Unix")
def test_what_is_no_file_is_not_replaced(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    for name, word in (("pipe", "a device"), ("folder", "a folder")):
        with pytest.raises(InputError, match=f"found {word}, expected a file"):
            write_file(tmp_path / name, "text")
    assert stat.S_ISFIFO((tmp_path / "pipe").stat().st_mode)


def test_a_file_that_exists_stays_unless_it_is_to_be_replaced(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    write_file(path, "1", replace=False)
    with pytest.raises(InputError, match="exists already; --force replaces it"):
        write_file(path, "2", replace=False)
    path.chmod(0o600)
    write_file(path, "3")
    assert path.read_text() == "3"
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


@pytest.mark.parametrize("nth", range(5))
def test_a_full_disk_leaves_all_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, nth: int) -> None:
    folder = OutputFolder(tmp_path / "out")
    old = dict.fromkeys("abc", "old")
    folder.write(old)
    sync, calls = os.fsync, iter(range(10))

    def full(file: int) -> None:
        if next(calls) == nth:
            raise OSError(errno.ENOSPC, "No space left on device")
        sync(file)

    monkeypatch.setattr(os, "fsync", full)
    if nth < 4:
        with pytest.raises(InputError, match=r"out: the disk is full; nothing was replaced"):
            folder.write(dict.fromkeys("abc", "new"))
        assert seen(tmp_path / "out") == old
    else:
        folder.write(dict.fromkeys("abc", "new"))
        assert seen(tmp_path / "out") == dict.fromkeys("abc", "new")
    assert leftovers(tmp_path / "out") == []


_KILLED = """
import os, signal, sys
from pathlib import Path
from linkwright.kernel.files.output import OutputFolder
nth, calls = int(sys.argv[2]), 0
def counted(act):
    def done(*args):
        global calls
        calls += 1
        if calls == nth:
            os.kill(os.getpid(), signal.SIGKILL)
        return act(*args)
    return done
os.fsync, Path.replace = counted(os.fsync), counted(Path.replace)
OutputFolder(Path(sys.argv[1])).write({name: "new" * 100_000 for name in "abc"})
"""


@pytest.mark.skipif(os.name == "nt", reason="needs signals of Unix")
@pytest.mark.parametrize("nth", [3, 6, 8, 9])
def test_a_killed_run_tears_no_file(tmp_path: Path, nth: int) -> None:
    folder = OutputFolder(tmp_path / "out")
    folder.write(dict.fromkeys("abc", "old"))
    done = subprocess.run([sys.executable, "-c", _KILLED, str(folder.path), str(nth)], check=False)
    assert done.returncode == (-9 if nth < 9 else 0)
    found = seen(folder.path)
    assert set(found) == set("abc")
    assert set(found.values()) <= {"old", "new" * 100_000}
    # What it left behind is no obstacle, and does not stay.
    assert bool(leftovers(folder.path)) == (nth < 9)
    folder.write(dict.fromkeys("abc", "last"))
    assert seen(folder.path) == dict.fromkeys("abc", "last")
    assert leftovers(folder.path) == []


@pytest.mark.skipif(os.name == "nt", reason="asks whether a process is alive")
def test_what_others_are_writing_is_left_alone(tmp_path: Path) -> None:
    with trial(tmp_path / "cam.dxf") as part:
        part.write_text("unfinished")
        computer, process = part.name.removeprefix(".linkwright-part-").split("-")[:2]
        assert int(process) == os.getpid()
        # Of another computer; not of ours.
        others = [f".linkwright-part-{int(computer, 16) ^ 1:08x}-1-0badcafe", ".linkwright-part-notes.txt"]
        for name in others:
            (tmp_path / name).write_text("others")
        write_file(tmp_path / "a", "new")
        assert part.read_text() == "unfinished"
    assert sorted(leftovers(tmp_path)) == sorted(others)


@pytest.mark.parametrize("nth", [1, 2, 3])
def test_an_interrupt_while_writing_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, nth: int
) -> None:
    sync, unlink, calls = os.fsync, Path.unlink, iter(range(1, 100))

    def interrupted(file: int) -> None:
        sync(file)
        if next(calls) == nth:
            raise KeyboardInterrupt

    def again(path: Path, *, missing_ok: bool = False) -> None:
        # A second one, amid the removal.
        monkeypatch.setattr(Path, "unlink", unlink)
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupted)
    monkeypatch.setattr(Path, "unlink", again)
    with pytest.raises(KeyboardInterrupt):
        OutputFolder(tmp_path).write(dict.fromkeys("abc", "new"))
    assert leftovers(tmp_path) == []


@pytest.mark.skipif(os.name == "nt", reason="needs signals of Unix")
def test_a_killed_first_run_leaves_a_folder_of_ours(tmp_path: Path) -> None:
    for nth in (1, 6):
        place = tmp_path / str(nth)
        subprocess.run([sys.executable, "-c", _KILLED, str(place), str(nth)], check=False)
        OutputFolder(place).write({"a": "last"})
        assert (place / "a").read_text() == "last"


def test_a_trial_that_fails_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "cam.dxf"
    path.write_text("old")

    def torn() -> None:
        with trial(path) as part:
            part.write_text("ne")
            raise ValueError("torn")

    with pytest.raises(ValueError, match="torn"):
        torn()
    assert seen(tmp_path) == {"cam.dxf": "old"}
    with trial(path) as part:
        assert part.suffix == ".dxf"
        part.write_text("new")
    assert seen(tmp_path) == {"cam.dxf": "new"}
    assert leftovers(tmp_path) == []


def test_what_is_no_folder(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for name in ("file", "file/below"):
        with pytest.raises(InputError, match="found a file"):
            OutputFolder(tmp_path / name).require()


NASTY = [
    "../../x",
    "/etc/passwd",
    "a\\b",
    "CON",
    "nul.txt",
    "Lpt1",
    "x" * 300,
    "Я" * 300,
    "a\nb",
    "a\x00b",
    "…",
    "",
    ".",
    "..",
    "-rf",
    "*?",
    "a:b",
    "trailing. ",
    "\u202egnp.exe",
]


@pytest.mark.parametrize("words", NASTY, ids=range(len(NASTY)))
def test_names_of_files_are_plain(tmp_path: Path, words: str) -> None:
    name = file_names({words: ".csv"})[words]
    assert len(name.encode()) < 200
    assert not set(name) & set('/\\:*?"<>|\n\0 ')
    assert name.split(".")[0].casefold() not in ("con", "nul", "lpt1")
    assert Path(name).name == name
    write_file(tmp_path / name, "here")
    assert (tmp_path / name).parent == tmp_path
    assert (tmp_path / name).read_text() == "here"
    assert file_name(file_name(words)) == file_name(words)


def test_names_that_differ_in_other_letters_alone() -> None:
    names = file_names(dict.fromkeys(["a b", "a_b", "A/b", "a_b_2", "c"], ".csv"))
    assert len({name.casefold() for name in names.values()}) == 5
    assert names["a b"] == "a_b.csv"
    assert names["c"] == "c.csv"
