"""Linkwright: how machines move, from the motor through gearbox and shaft to the mechanism and its work.

>>> import linkwright as lw
>>> machine = lw.read("roller_two_carts")
>>> motion = lw.steady_state(machine)
>>> round(motion.unevenness, 4)
0.085

Public names are loaded when they are first used, so that importing the package costs little.
"""

from __future__ import annotations

# What `signal` is made of, in the interpreter itself; `signal` imports enumerations and collections first.
import _signal  # type: ignore[import-not-found]
import os
import sys
from importlib import import_module

# As in `typing`, whose import takes longer than all else here.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from types import FrameType
    from typing import Any, NoReturn


def end_on_the_spot(number: int, frame: FrameType | None) -> NoReturn:
    """End the command line with what a shell reports for a program that was interrupted."""
    os._exit(130)


# An interrupt while the command line starts would end in a traceback through our files. A program that
# imports the package keeps its own ways.
_program = sys.argv[0].replace("\\", "/").split("/")[-1] if sys.argv else ""
_is_ours = _program in {"linkwright", "linkwright.exe"} or (
    _program == "-m" and "linkwright" in sys.orig_argv
)
if _is_ours and _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
    _signal.signal(_signal.SIGINT, end_on_the_spot)

__version__ = "0.1.0"

# Public name → module that holds it, as the stub beside this file lists them; `pathlib` takes long to import.
with open(f"{__file__}i", encoding="utf-8") as _stub:  # noqa: PTH123
    _HOME = {words[3]: words[1] for words in map(str.split, _stub) if words[:1] == ["from"]}

__all__ = ["__version__", *_HOME]


def __getattr__(name: str) -> Any:
    """Load a public name on first use."""
    if name not in _HOME:
        raise AttributeError(f"module 'linkwright' has no attribute {name!r}")
    value = getattr(import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Public names, loaded or not."""
    return sorted(__all__)
