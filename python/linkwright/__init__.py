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
    from collections.abc import Callable
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


def _homes(init: str) -> dict[str, str]:
    """Exported name → module that holds it, as the stub beside an ``__init__.py`` lists them."""
    # `pathlib` takes long to import.
    with open(f"{init}i", encoding="utf-8") as stub:  # noqa: PTH123
        return {words[3]: words[1] for words in map(str.split, stub) if words[:1] == ["from"]}


def exports(package: dict[str, Any], homes: dict[str, str] | None = None) -> Callable[[str], Any]:
    """``__getattr__`` of this package or of a room, of which these are the globals: names on first use."""

    def load(name: str) -> Any:
        nonlocal homes
        homes = homes or _homes(package["__file__"])
        if name not in homes:
            raise AttributeError(f"module {package['__name__']!r} has no attribute {name!r}")
        package[name] = getattr(import_module(homes[name]), name)
        return package[name]

    return load


_public = _homes(__file__)

__all__ = ["__version__", *_public]

__getattr__ = exports(globals(), _public)


def __dir__() -> list[str]:
    """Public names, loaded or not."""
    return sorted(__all__)
