"""What is no plain file, and files that are damaged, end in a sentence: nothing waits, nothing escapes."""

from __future__ import annotations

import os
import shutil
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from command_line import invoke

import linkwright as lw
from linkwright import InputError, LinkwrightError, MachineFileError

ROOT = Path(__file__).parents[2]
PRESS = ROOT / "examples" / "knuckle_press_drawing"

# A reader that opens such a pipe waits for a writer who never comes.
pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes of Unix")

READERS: dict[str, Callable[[Path], object]] = {
    "machine": lw.read,
    "study": lw.read_study,
    "company": lw.read_heading,
    "record": lw.read_record,
}


def ends(call: Callable[[], object]) -> LinkwrightError:
    """The error that a call ends in; it fails if the call still waits."""
    errors: list[LinkwrightError] = []

    def run() -> None:
        try:
            call()
        except LinkwrightError as error:
            errors.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join(20.0)
    assert not thread.is_alive(), "it waits for a writer"
    return errors[0]


@pytest.mark.parametrize("reader", READERS)
def test_a_named_pipe_is_refused(reader: str, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    (tmp_path / "link.toml").symlink_to(pipe)
    for path in (pipe, tmp_path / "link.toml"):
        error = ends(lambda path=path: READERS[reader](path))
        assert "a named pipe" in str(error)


def test_a_pipe_of_the_shell_is_read(tmp_path: Path) -> None:
    text = (ROOT / "machines" / "roller_two_carts.toml").read_bytes()
    out, into = os.pipe()
    threading.Thread(target=lambda: (os.write(into, text), os.close(into))).start()
    assert lw.read(f"/dev/fd/{out}").name == lw.read(ROOT / "machines" / "roller_two_carts.toml").name
    os.close(out)


def test_files_beside_a_machine_may_be_pipes_no_more_than_itself(tmp_path: Path) -> None:
    shutil.copy(PRESS / "machine.toml", tmp_path)
    os.mkfifo(tmp_path / "press.dxf")
    assert "a named pipe" in str(ends(lambda: lw.read(tmp_path / "machine.toml")))


def test_a_damaged_drawing_is_no_drawing(tmp_path: Path) -> None:
    """Of a file cut off anywhere the parser of DXF raises this and that."""
    shutil.copy(PRESS / "machine.toml", tmp_path)
    whole = (PRESS / "press.dxf").read_bytes()
    lines = whole.splitlines(keepends=True)
    cut = [b"".join(lines[:n]) for n in (0, 1, 2, 3, 7, 20, len(lines) // 2)]
    swapped = [whole.replace(b"CIRCLE", b"\0\xff"), whole.replace(b"$INSUNITS", b"$INSUNIT", 1)]
    for data in [*cut, whole[:3000], *swapped, b"\n" * 1000, b"  0\nSECTION\n" * 50]:
        (tmp_path / "press.dxf").write_bytes(data)
        with pytest.raises(MachineFileError) as error:
            lw.read(tmp_path / "machine.toml")
        assert "drawing" in str(error.value)


@pytest.mark.parametrize("data", [b"", b"<svg", b"no picture", b"\x89PNG\r\n\x1a\n"])
def test_a_logo_that_is_no_picture(data: bytes, tmp_path: Path) -> None:
    (tmp_path / "logo.svg").write_bytes(data)
    (tmp_path / "company.toml").write_text('logo = "logo.svg"', encoding="utf-8")
    page, sheet = tmp_path / "page.html", tmp_path / "page.pdf"
    words = ["report", "--to", page, "--to", sheet, "--company", tmp_path / "company.toml"]
    done = invoke(*words, "check", "press_motion")
    assert done.exit_code == 2
    assert "logo" in done.stderr
    # Both or none.
    assert not page.exists()
    assert not sheet.exists()


def test_files_of_a_study_lie_in_its_folder(tmp_path: Path) -> None:
    folder = tmp_path / "study"
    shutil.copytree(ROOT / "examples" / "fit_from_run_down", folder)
    (folder / "run_down.csv").rename(tmp_path / "run_down.csv")
    text = (folder / "study.toml").read_text(encoding="utf-8")
    (folder / "study.toml").write_text(text.replace("run_down.csv", "../run_down.csv"), encoding="utf-8")
    done = invoke("fit", folder / "study.toml")
    assert done.exit_code == 2
    assert "--allow-outside" in done.stderr
    listed = text.split("[fit]")[0].replace('range = ["20 kg m^2", "500 kg m^2"]', "values = [1, 2]")
    listed += '[responses]\nt = "run_up.time"\n[sweep]\nmethod = "list"\nfile = "../run_down.csv"\n'
    (folder / "study.toml").write_text(listed, encoding="utf-8")
    with pytest.raises(InputError, match="allow"):
        lw.read_study(folder / "study.toml")
