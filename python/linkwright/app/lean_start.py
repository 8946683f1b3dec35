"""What a process that runs one command leaves out when it starts.

It is called by the command line alone: a program that imports the package keeps its own settings.
"""

from __future__ import annotations

import dataclasses
import os
import sys
from functools import partial
from reprlib import recursive_repr
from types import ModuleType
from typing import Any


def leave_out() -> None:
    """Leave out plugins of pydantic and threads of linear algebra, before either is imported."""
    # Looking for plugins of pydantic among all installed packages costs more than reading a machine file.
    # The module that would look for them imports what reads metadata of packages, and mails.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    sys.modules.setdefault("pydantic.plugin._loader", _without_plugins())
    # Threads of linear algebra start with NumPy and wait busily. The matrices of a machine are small; what is
    # large has threads of its own in the core.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def share_methods() -> None:
    """Let dataclasses share comparison, hash and text, where each has its own compiled otherwise.

    A start makes some 120 of them, pydantic's among them; compiling their methods is a tenth of its time.
    """
    dataclasses.dataclass = _dataclass


def import_schemas() -> None:
    """Import pydantic's forms of schemas as plain dictionaries.

    They are some 100 typed dictionaries, which only type checkers read; making them takes longer than reading
    a machine file.
    """
    if "pydantic_core.core_schema" in sys.modules:
        return
    import typing

    import typing_extensions

    kept = typing.TypedDict, typing_extensions.TypedDict
    try:
        typing.TypedDict = typing_extensions.TypedDict = _Plain  # type: ignore[assignment]
        import pydantic_core.core_schema  # noqa: F401
    finally:
        typing.TypedDict, typing_extensions.TypedDict = kept


# The decorator of the library.
_DATACLASS = dataclasses.dataclass


def _dataclass(cls: type[Any] | None = None, /, **options: Any) -> Any:
    """In place of ``dataclasses.dataclass``: the same class, with methods that are written once."""
    if cls is None:
        return partial(_dataclass, **options)
    # Others than the usual ones stay as they are.
    if options.get("order") or options.get("unsafe_hash") or not options.get("eq", True):
        return _DATACLASS(cls, **options)
    own = vars(cls)
    wanted: dict[str, Any] = {"__eq__": _equal}
    if options.get("repr", True):
        wanted["__repr__"] = _text
    missing = {name: method for name, method in wanted.items() if name not in own}
    # A class with a comparison of its own has None in place of a hash, which counts as none.
    if own.get("__hash__") is None and ("__hash__" not in own or "__eq__" in own):
        missing["__hash__"] = _hash if options.get("frozen") else None
    made = _DATACLASS(cls, **{**options, "eq": False, "repr": False})
    for name, method in missing.items():
        setattr(made, name, method)
    return made


def _equal(self: Any, other: object) -> Any:
    """Whether two of one class have the same entries."""
    if other.__class__ is not self.__class__:
        return NotImplemented
    return _entries(self) == _entries(other)


def _hash(self: Any) -> int:
    return hash(_entries(self))


def _entries(value: Any) -> tuple[Any, ...]:
    """The entries that are compared."""
    return tuple(getattr(value, field.name) for field in dataclasses.fields(value) if field.compare)


@recursive_repr()
def _text(self: Any) -> str:
    """The class with its entries."""
    shown = (field.name for field in dataclasses.fields(self) if field.repr)
    return f"{self.__class__.__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in shown)})"


class _Plain(dict[str, Any]):
    """In place of a typed dictionary, whose options it takes."""

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__()


def _without_plugins() -> ModuleType:
    """In place of the module of pydantic that looks for plugins: there are none."""
    module = ModuleType("pydantic.plugin._loader")
    module.get_plugins = tuple  # type: ignore[attr-defined]
    return module
