"""Write a machine as a TOML file: what was given, in SI with units; it reads back as the same machine."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

from linkwright.kernel.description.place import field_names
from linkwright.kernel.description.schema_walk import annotation_at, mark_of
from linkwright.kernel.errors import InputError
from linkwright.kernel.files.output import write_file
from linkwright.kernel.public import public
from linkwright.kernel.units import Quantity, show, to_text
from linkwright.machine.machine import Machine

if TYPE_CHECKING:
    from tomlkit import TOMLDocument

# Tables of one short entry each stand on one line, as people write them.
_INLINE = ("bodies", "loads")


@public
def write(machine: Machine, path: str | os.PathLike[str]) -> None:
    """Write a machine to a file.

    Parameters
    ----------
    machine : Machine
    path : path
        The file; replaced if it exists.

    Raises
    ------
    InputError
        The file cannot be written, or the machine stands for many machines.
    """
    write_file(path, dumps(machine))


@public
def dumps(machine: Machine) -> str:
    """Write a machine as a TOML text.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    str
        Entries that were given; what follows from others or has its usual value is left out.

    Raises
    ------
    InputError
        An entry is an array over many machines.
    """
    import tomlkit

    document = tomlkit.document()
    for key, value in _table(machine, (), machine).items():
        _add(document, key, value)
    return tomlkit.dumps(document)


def _add(document: TOMLDocument, key: str, value: Any) -> None:
    """Put one top entry into the document."""
    import tomlkit

    if key not in _INLINE:
        document.add(key, tomlkit.item(value))
        return
    table = tomlkit.table()
    for name, entries in value.items():
        inline = tomlkit.inline_table()
        inline.update(entries)
        table.add(name, inline)
    document.add(key, table)


def _table(node: BaseModel, place: tuple[str, ...], machine: Machine) -> dict[str, Any]:
    """The given entries of a description, plain entries before tables."""
    entries = {
        key: _toml_value(getattr(node, name), (*place, key), machine)
        for key, name in field_names(type(node)).items()
        if name in node.model_fields_set and getattr(node, name) is not None
    }
    return dict(sorted(entries.items(), key=_rank))


def _rank(entry: tuple[str, Any]) -> int:
    """Order of the entries of a table: its kind, plain entries, tables."""
    return 0 if entry[0] == "kind" else 2 if isinstance(entry[1], dict) else 1


def _toml_value(value: Any, place: tuple[str, ...], machine: Machine) -> Any:
    """A value as TOML can hold it."""
    if isinstance(value, BaseModel):
        return _table(value, place, machine)
    if isinstance(value, dict):
        return {key: _toml_value(entry, (*place, key), machine) for key, entry in value.items()}
    if isinstance(value, tuple):
        is_tables = any(isinstance(entry, BaseModel) for entry in value)
        return [
            _toml_value(entry, (*place, str(n)), machine) if is_tables else entry
            for n, entry in enumerate(value)
        ]
    if not isinstance(value, str | int | float):
        raise InputError(f"{'.'.join(place)}: {show(value)} is not one value; write one machine at a time")
    mark = mark_of(annotation_at(Machine, place, machine))
    if isinstance(value, float) and isinstance(mark, Quantity) and mark.kind.unit:
        return to_text(value, mark.kind)
    return value
