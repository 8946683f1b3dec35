"""Packages that only some functions need: one that is missing is named with the command that installs it.

They are the extras of the package, `[project.optional-dependencies]` of its `pyproject.toml`.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from linkwright.kernel import system
from linkwright.kernel.errors import InputError


def require(module: str, extra: str, need: str) -> Any:
    """A module of an extra, as ``require("typst", "report", "a PDF needs Typst")``; else an `InputError`."""
    try:
        return import_module(module)
    except ModuleNotFoundError:
        reason = "which is not installed"
    except ImportError as error:
        reason = f"which cannot be imported ({' '.join(str(error).split())})"
    raise InputError(f"{need}, {reason}; in the clone of Linkwright: {install_command(extra)}")


def install_command(extra: str) -> str:
    """The command that installs an extra from a clone."""
    # cmd.exe of Windows takes single quotes as letters; Unix shells need quotes around brackets.
    quote = '"' if system.WINDOWS else "'"
    return f"pip install {quote}.[{extra}]{quote}"
