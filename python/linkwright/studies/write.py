"""Write a study as a file: it names its machine file, or stands beside one that is written with it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from linkwright.kernel.errors import InputError
from linkwright.kernel.files.output import require_place, write_file
from linkwright.kernel.units.kinds import ANGLE, LENGTH, Kind
from linkwright.kernel.units.reading import is_number, to_text
from linkwright.machine.address import kind
from linkwright.machine.machine import Machine
from linkwright.machine.write import dumps
from linkwright.studies.plan import StudyPlan, kind_of

# Behind the name of a study, the machine that is written beside it.
_BESIDE = "_machine.toml"


def study_text(plan: StudyPlan, machine: str) -> str:
    """The study file of a plan as TOML, quantities with units; `machine`: the machine file that it names."""
    import tomlkit

    given = plan.study.model_dump(exclude_unset=True, exclude_none=True)
    document = tomlkit.document()
    document.add("machine", tomlkit.item(machine))
    for key, entry in given.items():
        if not isinstance(entry, Mapping):
            document.add(key, tomlkit.item(entry))
    tables = {
        "variables": {name: _variable(plan, name, entry) for name, entry in given["variables"].items()},
        "derived": {name: _derived(entry) for name, entry in given.get("derived", {}).items()},
        "paths": {name: _path(entry) for name, entry in given.get("paths", {}).items()},
        "responses": {name: _response(entry) for name, entry in given["responses"].items()},
        "constraints": {
            name: {key: _worded(limit, kind_of(plan.units[name])) for key, limit in limits.items()}
            for name, limits in given.get("constraints", {}).items()
        },
    }
    for key, entry in given.items():
        if isinstance(entry, Mapping) and entry:
            document.add(key, _table(tables.get(key, entry), is_deep=key in ("variables", "paths")))
    return tomlkit.dumps(document)


def write_study(
    plan: StudyPlan, place: Path, source: Path, described: Machine | None, *, force: bool
) -> list[Path]:
    """Write the study file of a plan, and its machine beside it if its source describes another one.

    `source`: the file or the name in the library that the machine is from; `described`: the machine as that
    file describes it, None if it was read with other entries. Returns what was written. Raises `InputError`
    where a file exists and is not to be replaced, or cannot be written.
    """
    require_place(place, replace=force)
    named = _source(place, source) if described is not None and _alike(described, plan.machine) else ""
    contents = {} if named else {beside(place): dumps(plan.machine)}
    contents[place] = study_text(plan, named or beside(place).name)
    # Neither is written unless both can be; the study comes last, since it names the other.
    for path in contents:
        if path.resolve() == source.resolve():
            raise InputError(f"{path}: found the machine file of the study itself; name another file")
        require_place(path, replace=force)
    for path, text in contents.items():
        write_file(path, text, replace=force)
    return list(reversed(contents))


def beside(place: Path) -> Path:
    """The machine file that is written beside a study."""
    return place.with_name(place.stem + _BESIDE)


def _alike(described: Machine, machine: Machine) -> bool:
    """Whether two machines are the same, but for a study."""
    without_study = described if described.study is None else described.with_entries({"study": None})
    return dumps(without_study) == dumps(machine)


def _source(place: Path, source: Path) -> str:
    """How a study at a place names the file of its machine; empty if it may not: only what lies below it."""
    if not source.exists():  # a name of the library
        return str(source)
    path, folder = source.resolve(), place.parent.resolve()
    return path.relative_to(folder).as_posix() if path.is_relative_to(folder) else ""


def _variable(plan: StudyPlan, name: str, given: Mapping[str, Any]) -> dict[str, Any]:
    addresses = given["address"]
    entries = {**given, "address": _addresses(addresses)}
    mark = kind(plan.machine, addresses[0])
    for key in ("range", "values"):
        if key in given:
            entries[key] = [_worded(value, mark) for value in given[key]]
    return entries


def _derived(given: Mapping[str, Any]) -> Any:
    addresses = given.get("address", ())
    return {**given, "address": _addresses(addresses)} if addresses else given["formula"]


def _addresses(addresses: Sequence[str]) -> str | list[str]:
    return addresses[0] if len(addresses) == 1 else list(addresses)


def _path(given: Mapping[str, Any]) -> dict[str, Any]:
    kinds = {"x": LENGTH, "y": LENGTH, "crank_angle": ANGLE}
    return {
        key: [to_text(value, kinds[key]) for value in entry] if key in kinds else entry
        for key, entry in given.items()
    }


def _response(given: Mapping[str, Any]) -> Any:
    return given["quantity"] if given.keys() == {"quantity"} else given


def _worded(value: Any, mark: Kind | None) -> Any:
    return to_text(value, mark) if mark is not None and mark.unit and is_number(value) else value


def _table(entries: Mapping[str, Any], *, is_deep: bool) -> Any:
    """A table, in which other tables have lines of their own if it is deep, or stand on one line each."""
    import tomlkit

    table = tomlkit.table(is_super_table=is_deep)
    for name, entry in entries.items():
        if not isinstance(entry, Mapping):
            table.add(name, tomlkit.item(entry))
        elif is_deep:
            table.add(name, _table(entry, is_deep=False))
        else:
            inline = tomlkit.inline_table()
            inline.update({key: value for key, value in entry.items() if value is not None})
            table.add(name, inline)
    return table
