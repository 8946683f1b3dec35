"""What Windows does in another way than Unix: processes, interrupts, pipes, names of files in use.

| | Unix | Windows |
| --- | --- | --- |
| is a process alive | signal 0 | its handle and exit code |
| a process that Ctrl+C does not reach | signal blocked, own session | flag of the console, own group |
| nobody reads a pipe | `EPIPE` | `EINVAL` of the C library |
| a name that a program holds open | free to be replaced | refused until it is closed |
| bytes of a file that a program claims | `lockf` | `LockFile` of the C library |

Source: Microsoft, Windows API: OpenProcess, GetExitCodeProcess, SetConsoleCtrlHandler, CreateProcess.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from errno import EACCES, EAGAIN, EINVAL
from pathlib import Path
from time import sleep
from typing import IO, Any

# Not `os.name` where it is asked: a test may say otherwise without changing the paths of Python.
WINDOWS = os.name == "nt"

# Rights, error and exit code of winnt.h, winerror.h and minwinbase.h.
_QUERY_LIMITED_INFORMATION, _INVALID_PARAMETER, _STILL_ACTIVE = 0x1000, 87, 259

# Of winbase.h; `subprocess` has it on Windows only.
_NEW_PROCESS_GROUP = 0x200

# As the option -P of Python.
_SAFE_PATH = "PYTHONSAFEPATH"

# How often and how long to wait for a scanner or an indexer that examines a new file [s].
_TRIES, _PAUSE = 20, 0.05


def is_alive(process: int) -> bool:
    """Whether a process runs on this computer, if need be one of another user."""
    if WINDOWS:
        return _has_no_exit_code(process)
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


def _has_no_exit_code(process: int) -> bool:
    """The same on Windows, where signal 0 would end the process."""
    import ctypes

    kernel = _kernel32()
    kernel.OpenProcess.restype = ctypes.c_void_p
    handle = kernel.OpenProcess(_QUERY_LIMITED_INFORMATION, False, ctypes.c_ulong(process))
    if not handle:
        # Without the right to ask, it is there all the same.
        return bool(ctypes.get_last_error() != _INVALID_PARAMETER)  # type: ignore[attr-defined]
    code = ctypes.c_ulong()
    is_known = kernel.GetExitCodeProcess(ctypes.c_void_p(handle), ctypes.byref(code))
    kernel.CloseHandle(ctypes.c_void_p(handle))
    return not is_known or code.value == _STILL_ACTIVE


def _kernel32() -> Any:
    """The library of Windows with calls for processes and the console."""
    import ctypes

    return ctypes.WinDLL("kernel32", use_last_error=True)  # type: ignore[attr-defined]


@contextmanager
def deaf() -> Iterator[None]:
    """Processes that are started within it are not told of an interrupt from the keyboard."""
    with _console_deaf() if WINDOWS else _signal_blocked():
        yield


@contextmanager
def _signal_blocked() -> Iterator[None]:
    """Block the signal, which a new process inherits; one that comes meanwhile waits."""
    import signal

    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _console_deaf() -> Iterator[None]:
    """Set the flag that leaves out Ctrl+C, which a new process inherits; one that comes meanwhile is lost."""
    kernel = _kernel32()
    kernel.SetConsoleCtrlHandler(None, True)
    try:
        yield
    finally:
        kernel.SetConsoleCtrlHandler(None, False)


@contextmanager
def safe_path() -> Iterator[None]:
    """Let Pythons that are started within it import nothing from the present folder.

    It may be that of a stranger's machine file, with a module of the name of one of the library beside it.
    """
    before = os.environ.get(_SAFE_PATH)
    os.environ[_SAFE_PATH] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[_SAFE_PATH]
        else:
            os.environ[_SAFE_PATH] = before


@contextmanager
def away_from(settings: str) -> Iterator[None]:
    """Be elsewhere if the present folder has a file with settings of a library, which is imported within."""
    here = Path.cwd() if os.path.lexists(settings) else None
    if here is not None:
        os.chdir(Path(__file__).parent)
    try:
        yield
    finally:
        if here is not None:
            os.chdir(here)


def apart() -> dict[str, Any]:
    """Arguments of `subprocess.Popen` for a program that Ctrl+C does not reach."""
    return {"creationflags": _NEW_PROCESS_GROUP} if WINDOWS else {"start_new_session": True}


def is_unread(error: OSError) -> bool:
    """Whether an error of writing says that nobody reads the pipe any more."""
    return isinstance(error, BrokenPipeError) or (
        WINDOWS and error.errno == EINVAL and error.filename is None
    )


def rename(part: Path, place: Path) -> None:
    """Give a file its name, over one that has it; on Windows again and again for a second."""
    for _ in range(_TRIES if WINDOWS else 0):
        try:
            part.replace(place)
        except PermissionError:
            sleep(_PAUSE)
        else:
            return
    part.replace(place)


def claims(file: IO[bytes], first: int, count: int, *, wait: bool = False) -> bool:
    """Claim bytes of a file, which need not be there, against other processes; False if one has them.

    The claim ends with the file or the process, however that ends. `wait` for a process that claims briefly.
    """
    try:
        if WINDOWS:
            import msvcrt

            file.seek(first)
            msvcrt.locking(  # type: ignore[attr-defined]
                file.fileno(),
                msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK,  # type: ignore[attr-defined]
                count,
            )
        else:
            os.lseek(file.fileno(), first, os.SEEK_SET)
            os.lockf(file.fileno(), os.F_LOCK if wait else os.F_TLOCK, count)
    except OSError as error:
        # Some file systems of clusters know no claims: whoever shares a folder there keeps order himself.
        return error.errno not in (EACCES, EAGAIN) and not WINDOWS
    return True


def quoted(words: Sequence[str]) -> str:
    """A command line for the shell of this system."""
    if WINDOWS:
        from subprocess import list2cmdline

        return list2cmdline(words)
    from shlex import join

    return join(words)
