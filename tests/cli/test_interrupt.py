"""An interrupt from the keyboard ends the command line with exit code 130, also while it imports."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

pytestmark = pytest.mark.skipif(os.name == "nt", reason="needs signals of Unix")

# A minute: the commands below would take longer.
PATIENCE = 60.0


def _start(*arguments: str) -> subprocess.Popen[str]:
    # Each import writes to standard error as soon as it is done.
    command = [sys.executable, "-X", "importtime", "-m", "linkwright", *arguments]
    # Who started the tests may have let them ignore interrupts.
    return subprocess.Popen(
        command,
        cwd=ROOT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )


def _wait_for(program: subprocess.Popen[str], module: str) -> None:
    assert program.stderr is not None
    for line in program.stderr:
        if line.rstrip().endswith(f" {module}"):
            return
    pytest.fail(f"{module} was never imported")


@pytest.mark.parametrize(
    "module",
    ["click.core", "linkwright.app.application", "numpy", "linkwright.machine", "linkwright.app.study"],
)
def test_while_it_imports(module: str) -> None:
    """Itself, and what a command needs."""
    program = _start("run", "machines/roller_two_carts.toml", "--json")
    _wait_for(program, module)
    program.send_signal(signal.SIGINT)
    _, told = program.communicate(timeout=PATIENCE)
    assert program.returncode == 130
    assert "Traceback" not in told


def test_while_it_computes() -> None:
    program = _start("topper", "field", "machines/topper.toml", "--over", "edge_length=0.1:0.3:50000")
    _wait_for(program, "linkwright.studies.knives")
    time.sleep(0.5)
    program.send_signal(signal.SIGINT)
    start = time.monotonic()
    _, told = program.communicate(timeout=PATIENCE)
    assert program.returncode == 130
    assert "Traceback" not in told
    # A second is promised; five leave room for a busy machine.
    assert time.monotonic() - start < 5.0


def test_little_is_imported_before_it_listens() -> None:
    """An interrupt before that ends in Python's own traceback."""
    # Without the modules of the environment itself, which may import this and that.
    ask = (
        f"import sys; sys.path.insert(0, {str(ROOT / 'python')!r}); known = set(sys.modules); "
        "import linkwright.app; print(*set(sys.modules) - known)"
    )
    told = subprocess.run([sys.executable, "-I", "-S", "-c", ask], capture_output=True, text=True, check=True)
    assert "linkwright.app" in told.stdout.split()
    large = {"collections", "dataclasses", "enum", "functools", "inspect", "re", "signal", "typing"}
    assert not large & set(told.stdout.split())


# Prints how many lines of our files run before interrupts end the program on the spot.
LINES = """
import _signal, runpy, sys
count = 0
def trace(frame, event, argument):
    global count
    if "linkwright" not in frame.f_code.co_filename:
        return trace if event == "call" else None
    if _signal.getsignal(_signal.SIGINT) is not _signal.default_int_handler:
        sys.settrace(None)
        print(count)
        sys.exit()
    count += event == "line"
    return trace
_signal.signal(_signal.SIGINT, _signal.default_int_handler)
sys.settrace(trace)
"""


@pytest.mark.parametrize(
    ("start", "name"),
    [("runpy.run_module('linkwright', alter_sys=True)", "-m"), ("import linkwright.app", "bin/linkwright")],
)
def test_no_file_of_ours_is_told_of_an_early_interrupt(start: str, name: str) -> None:
    """From the first lines of the package on, before it imports its own modules; 296 lines were too many."""
    code = f"{LINES}sys.argv, sys.orig_argv = [{name!r}], ['python', '-m', 'linkwright']\n{start}"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert int(done.stdout) < 20


@pytest.mark.parametrize("name", ["study.py", "linkwright_study.py", "-m", ""])
def test_programs_that_import_the_package_keep_their_interrupts(name: str) -> None:
    code = (
        f"import signal, sys; sys.argv, sys.orig_argv = [{name!r}], ['python', '-m', 'study']; "
        "signal.signal(signal.SIGINT, signal.default_int_handler); import linkwright; "
        "assert signal.getsignal(signal.SIGINT) is signal.default_int_handler"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)


# A grid that takes minutes.
GRID = """
machine = "roller_one_cart"
[variables.ratio]
address = "drive.gearbox.ratio"
range = [9.0, 10.0]
steps = 1000
[variables.mass]
address = "bodies.cart1.mass"
range = ["900 kg", "1100 kg"]
steps = 1000
[responses]
delta = "steady_state.unevenness"
"""


def _sweep(
    folder: Path, until: Callable[[int], bool] | None = None
) -> tuple[subprocess.Popen[str], set[int]]:
    """A sweep by two processes that has begun to write, or has come as far as is asked; and its processes."""
    (folder / "study.toml").write_text(GRID)
    command = [sys.executable, "-m", "linkwright", "sweep", "study.toml", "--out", "rows", "--workers", "2"]
    program = subprocess.Popen(
        command,
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    last = time.monotonic() + PATIENCE
    while not (list(folder.glob("rows/*.parquet")) if until is None else until(program.pid)):
        assert program.poll() is None, program.communicate()
        assert time.monotonic() < last
        time.sleep(0.01)
    workers = {pid for pid in _session(program.pid) if pid != program.pid}
    assert len(workers) >= 2
    return program, workers


def _session(leader: int) -> set[int]:
    living = set()
    for place in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, session = place.read_text().rpartition(")")[2].split()[:4]
        except OSError:
            continue
        if int(session) == leader and state != "Z":
            living.add(int(place.parent.name))
    return living


def _all_end(leader: int, seconds: float) -> bool:
    """Whether all processes of a session end in time; they are ended otherwise."""
    until = time.monotonic() + seconds
    while _session(leader) and time.monotonic() < until:
        time.sleep(0.05)
    left = _session(leader)
    for pid in left:
        os.kill(pid, signal.SIGKILL)
    return not left


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs the processes of Linux")
def test_a_sweep_by_several_processes(tmp_path: Path) -> None:
    program, _ = _sweep(tmp_path)
    # As a terminal does: to all processes of the group.
    os.killpg(program.pid, signal.SIGINT)
    start = time.monotonic()
    _, told = program.communicate(timeout=PATIENCE)
    assert program.returncode == 130
    assert told == ""
    assert time.monotonic() - start < 5.0
    assert _all_end(program.pid, 10.0)


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs the processes of Linux")
def test_processes_that_are_just_started(tmp_path: Path) -> None:
    """They are not told of it: while they import, they would end in a traceback."""
    program, _ = _sweep(tmp_path, until=lambda pid: len(_session(pid)) >= 4)
    os.killpg(program.pid, signal.SIGINT)
    _, told = program.communicate(timeout=PATIENCE)
    assert program.returncode == 130
    assert told == ""
    assert _all_end(program.pid, 10.0)


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs the processes of Linux")
def test_a_sweep_that_is_killed_leaves_no_process(tmp_path: Path) -> None:
    program, _ = _sweep(tmp_path)
    program.kill()
    program.communicate(timeout=PATIENCE)
    assert _all_end(program.pid, 10.0)
    # What is written is whole, and the same command goes on from there.
    for path in (tmp_path / "rows").glob("*.parquet"):
        assert path.read_bytes()[-4:] == b"PAR1"
