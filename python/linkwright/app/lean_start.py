"""What a process that runs one command leaves out when it starts.

It is called by the command line alone: a program that imports the package keeps its own settings.
"""

from __future__ import annotations

import os
import sys
from types import ModuleType


def leave_out() -> None:
    """Leave out plugins of pydantic and threads of linear algebra, before either is imported."""
    # Looking for plugins of pydantic among all installed packages costs more than reading a machine file.
    # The module that would look for them imports what reads metadata of packages, and mails.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    sys.modules.setdefault("pydantic.plugin._loader", _without_plugins())
    # Threads of linear algebra start with NumPy and wait busily. The matrices of a machine are small; what is
    # large has threads of its own in the core.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def _without_plugins() -> ModuleType:
    """In place of the module of pydantic that looks for plugins: there are none."""
    module = ModuleType("pydantic.plugin._loader")
    module.get_plugins = tuple  # type: ignore[attr-defined]
    return module
