"""Output that nobody reads any more is no finding and no error: the program ends as others do."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest


@pytest.mark.parametrize("words", [("run", "two_carts_evenness"), ("motors",)])
def test_ends_without_a_word(words: tuple[str, ...]) -> None:
    """128 + SIGPIPE, what a shell reports for programs that the signal ends."""
    program = subprocess.Popen(
        [sys.executable, "-m", "linkwright", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert program.stdout is not None
    assert program.stderr is not None
    # Nothing is read at all, so that the first line that is written finds the pipe closed.
    program.stdout.close()
    told = program.stderr.read()
    program.stderr.close()
    assert program.wait() == 141
    assert told == b""


@pytest.mark.skipif(os.name == "nt", reason="needs a shell of Unix")
@pytest.mark.parametrize(("words", "code"), [("run roller_one_cart >&-", 0), ("run no_such_file 2>&-", 2)])
def test_a_stream_that_was_closed_before_is_no_error(words: str, code: int) -> None:
    """The exit code tells what nobody hears."""
    done = subprocess.run(
        ["sh", "-c", f"{sys.executable} -m linkwright {words}"], capture_output=True, check=False
    )
    assert done.returncode == code
    assert b"Traceback" not in done.stdout + done.stderr
