"""Machines that users and campaigns found, as files; each says which test it is of."""

from pathlib import Path

import linkwright as lw

FOUND = Path(__file__).parents[1] / "found"


def found_machine(name: str) -> lw.Machine:
    """A machine of `tests/found`."""
    return lw.read(FOUND / f"{name}.toml")
