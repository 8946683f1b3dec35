"""Every number of a shipped machine, set to what no machine has: refused by name, or answered with numbers.

Nothing in between: no traceback, no warning (they are errors here), no NaN or infinity in JSON or messages.
The cases are a sample, the same at each run; the whole is some 13 000 files.
"""

from __future__ import annotations

import json
import math
import random
import re
from functools import cache
from pathlib import Path

import pytest
from command_line import invoke

import linkwright as lw
from linkwright import InputError, addresses
from linkwright.machine import kind

ROOT = Path(__file__).parents[2]
MACHINES = sorted(
    [*(ROOT / "machines").glob("*.toml"), *ROOT.glob("python/linkwright/kernel/files/templates/*.toml")]
)
# No quantity is that large, or a number at all.
NEVER = (math.nan, math.inf, -math.inf, 1e30, 1e300, -1e308)
_NO_NUMBER = re.compile(r"(?<!\w)[-+]?(nan|inf)(?!\w)")

# Entries at which an answer takes long, since the machine runs up for hours or is nearly at rest.
_SLOW = ("gearbox.ratio", "motor.inertia", "drive.speed", "breakdown")


@cache
def numbers(path: Path) -> tuple[str, ...]:
    return tuple(each for each in addresses(lw.read(path)) if each != "format")


def sample(n: int, seed: int) -> list[tuple[Path, str]]:
    draw = random.Random(seed)
    every = [(path, address) for path in MACHINES for address in numbers(path)]
    return draw.sample(every, n)


@pytest.mark.parametrize("value", NEVER)
def test_no_machine_has_such_a_number(value: float) -> None:
    for path, address in sample(60, seed=1):
        with pytest.raises(InputError) as caught:
            lw.read(path, [f"{address}={value!r}"])
        said = str(caught.value).replace(repr(value), "")
        assert address.rsplit(".", 1)[-1] in said
        assert not _NO_NUMBER.search(said)


def extremes(path: Path, address: str) -> list[float]:
    found = kind(lw.read(path), address)
    return [0, -0.0, -1, 1e-320, *((found.least, found.most) if found else ())]


@pytest.mark.parametrize(
    ("path", "address"), sample(28, seed=2), ids=lambda each: getattr(each, "stem", each)
)
def test_at_the_ends_of_its_range_there_is_an_answer_or_a_sentence(path: Path, address: str) -> None:
    if any(word in address for word in _SLOW):
        return
    command = "torsion" if lw.read(path).is_train_alone else "run"
    for value in random.Random(address).sample(extremes(path, address), 2):
        done = invoke(command, path, "--json", "--set", f"{address}={value!r}")
        assert done.exception is None or isinstance(done.exception, SystemExit), (value, done.exception)
        assert done.exit_code in (0, 1, 2)
        assert not _NO_NUMBER.search(done.stderr), done.stderr
        if done.exit_code < 2 and done.stdout:
            found = json.loads(done.stdout, parse_constant=pytest.fail)
            assert not _NO_NUMBER.search(" ".join(map(str, [found.get("findings"), found.get("warnings")])))
