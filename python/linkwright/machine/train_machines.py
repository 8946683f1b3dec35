"""Machine files of the mechanisms on a train, put in the place of their names."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from linkwright.kernel.description.place import join, look
from linkwright.kernel.errors import MachineFileError, Problem, show
from linkwright.kernel.files.named_file import named_file


def with_machines_of_train(
    tables: dict[str, Any],
    folder: Path,
    tables_of_file: Callable[[Path], dict[str, Any]],
    read: Callable[[Path], Any],
    *,
    allow_outside: bool = False,
) -> None:
    """Put the machine of each file that a mechanism of a train names in its place; `tables` is changed.

    `tables_of_file`, `read`: tables of a machine file, and its machine. Raises MachineFileError: the file
    lies outside, cannot be read, describes no machine, or has a train itself.
    """
    listed = look(tables.get("train"), "mechanisms")
    for name, entry in listed.items() if isinstance(listed, dict) else ():
        file = look(entry, "machine")
        if not isinstance(file, str):
            continue
        key = join(("train", "mechanisms", name, "machine"))
        path = named_file(file, folder, key, allow_outside=allow_outside)
        if not path.is_file():
            expected = "a machine file in the folder of this one, or below it"
            raise MachineFileError([Problem(key, f"{show(file)}, no such file", expected)])
        # A train could name this file again, and so on.
        if "train" in tables_of_file(path):
            expected = "a machine file with a [mechanism], without [train]"
            remedy = "leave [train] out there, or write its discs into this train"
            raise MachineFileError([Problem(key, show(file), expected, remedy)])
        entry["machine"] = read(path)
