"""The command line under attack: what every call must keep, whatever it was given.

Its exit code is 0, 1 or 2 and no exception passes; an error says something, on less than a screen, without
nan; what ``--json`` prints is one object of finite numbers.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NoReturn

import click
from broken import PromiseError, watched
from click.testing import CliRunner, Result

from linkwright.app.application import application

# What an error may take at most: more than this nobody reads.
MESSAGE_MAX = 8000

# Words that a number without a value leaves in a text.
_NO_NUMBER = re.compile(r"(?<![\w.\"'=-])-?(nan|inf)(?![\w\"'])")


@lru_cache(maxsize=1)
def _application() -> click.Group:
    return application()


def call(arguments: Sequence[str], inputs: Mapping[str, str | bytes], seconds: float = 60.0) -> int:
    """Run a command in this process and look at all that it says.

    Parameters
    ----------
    arguments : sequence of str
        The command and its options.
    inputs : mapping of str to str or bytes
        The files it reads, for the record.
    seconds : float
        Longest time.

    Returns
    -------
    int
        The exit code.

    Raises
    ------
    PromiseError
        It does not keep what it must.
    """
    record = {**inputs, "command": "linkwright " + " ".join(arguments)}
    with watched(record, seconds):
        done = CliRunner().invoke(_application(), list(arguments))
        if done.exception is not None and not isinstance(done.exception, SystemExit):
            raise done.exception
        _inspect(done, arguments, record)
    return done.exit_code


def _inspect(done: Result, arguments: Sequence[str], record: Mapping[str, str | bytes]) -> None:
    if done.exit_code not in (0, 1, 2):
        raise PromiseError(f"exit code {done.exit_code}", record)
    if done.exit_code == 2 and not done.stderr.strip():
        raise PromiseError("exit code 2 without a message", record)
    if done.exit_code and not (done.stderr + done.stdout).strip():
        raise PromiseError(f"exit code {done.exit_code} without a word", record)
    if len(done.stderr) > MESSAGE_MAX:
        raise PromiseError(f"a message of {len(done.stderr)} characters", record)
    if "Traceback" in done.stderr:
        raise PromiseError(done.stderr, record)
    _no_nan(done.stderr, record)
    if "--json" in arguments and done.exit_code == 0:
        try:
            json.loads(done.stdout, parse_constant=_no_constant)
        except ValueError as error:
            raise PromiseError(f"--json: {error}", record) from None
    elif done.exit_code != 2:
        _no_nan(done.stdout, record)


def _no_nan(text: str, record: Mapping[str, str | bytes]) -> None:
    """No number without a value in a text, unless the user wrote it."""
    found = _NO_NUMBER.search(text)
    written = " ".join(each if isinstance(each, str) else repr(each) for each in record.values())
    # What overflows when it is read is infinite, and is shown as that.
    if found and found[1] not in written and not re.search(r"e(309|400)", written):
        raise PromiseError(
            f"{found[0]!r} in a text: …{text[max(0, found.start() - 100) : found.end() + 40]}…", record
        )


def _no_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is no number of JSON")


def finite(tree: Any, record: Mapping[str, str | bytes], address: str = "") -> None:
    """No number of a result is NaN or infinite."""
    if isinstance(tree, dict):
        for key, each in tree.items():
            finite(each, record, f"{address}.{key}")
    elif isinstance(tree, list):
        for each in tree:
            finite(each, record, address)
    elif isinstance(tree, float) and not abs(tree) < float("inf"):
        raise PromiseError(f"{address} = {tree}", record)


# What can be asked of a machine file, by the tables that make the question sensible.
QUESTIONS: dict[str, tuple[tuple[str, ...], ...]] = {
    "": (("check",), ("run", "--json"), ("run",)),
    "mechanism": (
        ("motion", "--json"),
        ("motion", "--at", "30 deg"),
        ("motion", "--csv", "--steps", "24"),
        ("forces", "--json"),
        ("balance", "--json"),
    ),
    "drive": (("size",), ("size", "--json"), ("run", "--json", "--curves")),
    "mechanism.cams": (("cam", "--json"), ("cam",)),
    "train": (("torsion", "--json"), ("torsion",)),
    "topper": (("run", "--json", "--curves"),),
}


def questions(text: str) -> list[tuple[str, ...]]:
    """Commands for a machine file: the word before the file, and the options after it."""
    return [
        question
        for table, asked in QUESTIONS.items()
        if not table or re.search(rf"^\[{re.escape(table)}[\].]", text, re.MULTILINE)
        for question in asked
    ]


def asked(question: Sequence[str], path: Path) -> list[str]:
    return [question[0], str(path), *question[1:]]
