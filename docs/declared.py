"""For the API page: docstrings of results tell what their attributes declare.

Griffe reads the sources without running them; a class of results (`linkwright.kernel.result`) adds the
section on its attributes when it is asked for its docstring.
"""

from __future__ import annotations

import inspect
from importlib import import_module
from typing import Any

import griffe

from linkwright.kernel.result import Record


class Declared(griffe.Extension):
    """Takes the docstrings of results from the classes themselves."""

    def on_class_instance(self, *, cls: griffe.Class, **_: Any) -> None:
        """Replace the text of the source by that of the class."""
        if cls.docstring is None or not cls.module.path.startswith("linkwright"):
            return
        found = getattr(import_module(cls.module.path), cls.name, None)
        if isinstance(found, type) and issubclass(found, Record):
            cls.docstring.value = inspect.cleandoc(found.__doc__ or "")
