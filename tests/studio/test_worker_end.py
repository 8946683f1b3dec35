"""The process beside a session ends without a word when the server is gone, or a terminal interrupts both."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(os.name == "nt", reason="needs signals of Unix")

MACHINE = (Path(__file__).parents[2] / "machines" / "roller_one_cart.toml").read_text(encoding="utf-8")
JOB = {"number": 1, "lane": "report", "language": "en", "text": MACHINE, "path": "", "units": {}}


def _worker() -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-m", "linkwright.studio.worker"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )


def test_nobody_reads_the_answer() -> None:
    worker = _worker()
    assert worker.stdin is not None
    assert worker.stdout is not None
    assert worker.stderr is not None
    worker.stdout.close()
    job = {**JOB, "lane": "search", "search": {}, "text": "format = 2"}
    # It is still asked: what ends it is the answer that nobody takes.
    with worker.stdin as asked, worker.stderr as told:
        asked.write(json.dumps(job).encode() + b"\n")
        asked.flush()
        assert told.read() == b""
        assert worker.wait(60) == 0


def test_an_interrupt() -> None:
    worker = _worker()
    assert worker.stdin is not None
    assert worker.stdout is not None
    worker.stdin.write(json.dumps({**JOB, "lane": "search", "search": {}, "text": ""}).encode() + b"\n")
    worker.stdin.flush()
    # It has begun to listen once it answers.
    assert worker.stdout.read(1)
    worker.send_signal(signal.SIGINT)
    _, told = worker.communicate(timeout=60)
    assert told == b""
    assert worker.returncode == -signal.SIGINT
