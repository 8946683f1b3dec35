"""Machine files of the mechanisms on a train, put in the place of their names, and overrides in them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from linkwright.kernel.description.place import join, keys, look
from linkwright.kernel.errors import InputError, MachineFileError, Problem, show
from linkwright.kernel.files.named_file import named_file
from linkwright.machine.address import resolve
from linkwright.machine.overrides import Override


def of_mounted_file(tables: dict[str, Any], change: Override) -> tuple[str, Override] | None:
    """A mechanism of a train and an override of the file that it names; None for other overrides.

    ``train.mechanisms.press.machine.bodies.ram.mass`` leads to ``bodies.ram.mass`` in the file of the press.
    Raises InputError: the train has no such mechanism.
    """
    place = resolve(tables, change.address)
    if len(place) < 5 or (*place[:2], place[3]) != ("train", "mechanisms", "machine"):
        return None
    listed = look(tables.get("train"), "mechanisms")
    if place[2] not in keys(listed):
        names = ", ".join(map(show, keys(listed)))
        expected = f"a mechanism of the train: {names}" if names else "a train with [train.mechanisms]"
        raise InputError(
            f"{change}: {join(place[:3])}\n  found:    no such mechanism\n  expected: {expected}"
        )
    if not isinstance(look(look(listed, place[2]), "machine"), str):
        return None
    return place[2], replace(change, address=join(place[4:]))


def with_machines_of_train(
    tables: dict[str, Any],
    folder: Path,
    tables_of_file: Callable[[Path], dict[str, Any]],
    read: Callable[[Path, Sequence[Override]], Any],
    changes: Mapping[str, Sequence[Override]],
    *,
    allow_outside: bool = False,
) -> None:
    """Put the machine of each file that a mechanism of a train names in its place; `tables` is changed.

    `tables_of_file`, `read`: tables of a machine file, and its machine with overrides; `changes`: those of
    each mechanism. Raises MachineFileError: the file
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
        entry["machine"] = read(path, changes.get(name, ()))
