"""How long does a user wait for the package to load, and for one command to answer?"""

from __future__ import annotations

import subprocess
import sys

import machines
from common import ROOT, Row, seconds


def rows(quick: bool) -> list[Row]:
    """The import alone, the import with what a first analysis loads, and a whole process."""
    repeats = 5 if quick else 15
    return [*imports(repeats), command(repeats)]


def imports(repeats: int) -> list[Row]:
    """Time of the import above that of a Python that does nothing."""
    read = f"import linkwright as lw; lw.steady_state(lw.read({str(machines.TWO_CARTS)!r}))"
    acts = [lambda code=code: python("-c", code) for code in ("pass", "import linkwright", read)]
    nothing, package, answer = (1e3 * time for time in seconds(acts, repeats=repeats))
    above = "above a Python that does nothing"
    return [
        Row("import linkwright", "ms", package - nothing, target=100, aim="at most", note=above),
        Row("import, read, steady state", "ms", answer - nothing, note=above),
    ]


def command(repeats: int) -> Row:
    """`linkwright run FILE --json`, the whole process."""
    case = "linkwright run FILE --json"
    words = ("-m", "linkwright", "run", str(machines.TWO_CARTS), "--json")
    try:
        python(*words)
    except subprocess.CalledProcessError:
        return Row(case, "s", None, note="the command does not run here", target=0.5, aim="at most")
    time = seconds([lambda: python(*words)], repeats=repeats)[0]
    return Row(case, "s", time, target=0.5, aim="at most", note="whole process")


def python(*words: str) -> None:
    """Run this Python."""
    subprocess.run([sys.executable, *words], check=True, capture_output=True, cwd=ROOT)
