"""Write a machine as a TOML file: what was given, in SI with units; it reads back as the same machine."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

from linkwright.kernel.description.place import field_names
from linkwright.kernel.description.schema_walk import annotation_at, mark_of
from linkwright.kernel.errors import InputError, UnitError, show
from linkwright.kernel.files.output import write_file
from linkwright.kernel.public import public
from linkwright.kernel.reader.out_units import OutUnits
from linkwright.kernel.units.kinds import Kind
from linkwright.kernel.units.marks import Quantity
from linkwright.kernel.units.reading import parse, parse_list, to_text
from linkwright.kernel.units.spellings import normal
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
    return _text(machine, None)


def in_own_units(machine: Machine) -> str:
    """A machine as TOML in its ``[units]`` or those of its file, else in SI; it reads back the same."""
    return _text(machine, OutUnits.of_table(machine.units))


def _spelled(value: float, kind: Kind, place: tuple[str, ...], machine: Machine, units: OutUnits) -> str:
    """A quantity in units if these have one of its kind, else as the file writes it, else in SI."""
    given, (name, factor) = _given(machine, place), units.shown(kind.unit)
    if factor == 1.0:
        return given if isinstance(given, str) and _reads(given, value, kind) else to_text(value, kind)
    # As few digits as give the value back.
    texts = (f"{value / factor:.{digits}g} {normal(name)}" for digits in (6, 12, 15, 16, 17))
    return next((text for text in texts if _reads(text, value, kind)), to_text(value, kind))


def _listed(values: tuple[Any, ...], place: tuple[str, ...], machine: Machine) -> Any:
    given, mark = _given(machine, place), mark_of(annotation_at(Machine, (*place, "0"), machine))
    return given if isinstance(mark, Quantity) and _reads(given, values, mark.kind) else list(values)


def _reads(given: object, value: float | tuple[float, ...], kind: Kind) -> bool:
    try:
        return (tuple(parse_list(given, kind)) if isinstance(value, tuple) else parse(given, kind)) == value
    except UnitError:
        # silent: a spelling that is not read as the value is not used
        return False


def _given(machine: Machine, place: tuple[str, ...]) -> object:
    """The entry of the file that a machine was read from; None if it has none there."""
    node: Any = machine.as_given
    for key in place:
        if isinstance(node, list) and key.isdecimal() and int(key) < len(node):
            node = node[int(key)]
        elif isinstance(node, dict):
            node = node.get(key)
        else:
            return None
    return node


def _text(machine: Machine, units: OutUnits | None) -> str:
    import tomlkit

    document = tomlkit.document()
    for key, value in _table(machine, (), machine, units).items():
        _add(document, key, value)
    return tomlkit.dumps(document)


def _add(document: TOMLDocument, key: str, value: Any) -> None:
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


def _table(
    node: BaseModel, place: tuple[str, ...], machine: Machine, units: OutUnits | None
) -> dict[str, Any]:
    entries = {
        key: _toml_value(getattr(node, name), (*place, key), machine, units)
        for key, name in field_names(type(node)).items()
        if name in node.model_fields_set and getattr(node, name) is not None
    }
    return dict(sorted(entries.items(), key=_rank))


def _rank(entry: tuple[str, Any]) -> int:
    return 0 if entry[0] == "kind" else 2 if isinstance(entry[1], dict) else 1


def _toml_value(value: Any, place: tuple[str, ...], machine: Machine, units: OutUnits | None) -> Any:
    if isinstance(value, BaseModel):
        return _table(value, place, machine, units)
    if isinstance(value, dict):
        return {key: _toml_value(entry, (*place, key), machine, units) for key, entry in value.items()}
    if isinstance(value, tuple):
        is_tables = any(isinstance(entry, BaseModel) for entry in value)
        if units is not None and not is_tables:
            return _listed(value, place, machine)
        return [
            _toml_value(entry, (*place, str(n)), machine, units) if is_tables else entry
            for n, entry in enumerate(value)
        ]
    if not isinstance(value, str | int | float):
        raise InputError(f"{'.'.join(place)}: {show(value)} is not one value; write one machine at a time")
    mark = mark_of(annotation_at(Machine, place, machine))
    if isinstance(value, float) and isinstance(mark, Quantity) and mark.kind.unit:
        return (
            to_text(value, mark.kind) if units is None else _spelled(value, mark.kind, place, machine, units)
        )
    return value
