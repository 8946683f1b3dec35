"""Controls of a machine: one for every entry of its file, made from the descriptions' declared quantities.

A control knows its address, its words, what it holds and within which bounds; the page draws it. Entries that
are not given are listed with what holds without them, so that they can be added.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from linkwright.kernel.description.place import field_names, join, look
from linkwright.kernel.description.schema_walk import annotation_at, kinds_at, mark_of, model_of, words_of
from linkwright.kernel.errors import LinkwrightError, UnitError
from linkwright.kernel.files.points import lines_of
from linkwright.kernel.units.marks import Quantity, QuantityList
from linkwright.kernel.units.reading import parse
from linkwright.machine.machine import Machine
from linkwright.machine.size_limits import size_and_limits

Control = dict[str, Any]


def controls(raw: Mapping[str, Any], path: str = "") -> Control:
    """The controls of a file, sound or not, as a group. `path`: of the file, beside which catalogues are.

    ``address``, ``key``, ``about``, ``entries``, ``groups`` and ``missing``.
    """
    return _group((), "machine", "", Machine, raw, raw, path)


def _group(
    place: tuple[str, ...],
    key: str,
    about: str,
    model: type[BaseModel] | None,
    node: Any,
    raw: Any,
    path: str,
) -> Control:
    entries: list[Control] = []
    groups: list[Control] = []
    for name, value in _items(node):
        at = (*place, name)
        annotation = annotation_at(Machine, at, raw)
        field = _field(model, name)
        words = field.description or "" if field else ""
        if _is_table(value):
            groups.append(_group(at, name, words, model_of(annotation, value), value, raw, path))
            continue
        entry = _entry(at, name, words, annotation, value)
        if name == "catalogue" and (types := _types(look(node, "file"), path)):
            entry |= {"holds": "choice", "choices": types}
        entries.append(entry)
    return {
        "address": join(place) if place else "",
        "key": key,
        "about": about,
        "entries": entries,
        "groups": groups,
        "missing": list(_missing(place, model, node, raw)) if model else [],
    }


def _types(file: Any, path: str) -> list[str]:
    """Types of a catalogue beside the file; none if it cannot be read, which is a problem of its entry."""
    if not isinstance(file, str) or not path:
        return []
    try:
        lines = lines_of(Path(path).parent / file, "file")
    except LinkwrightError:
        # silent: it is a problem of the file, which stands beside its entry
        return []
    heads = [head.strip() for head in lines[0][1]] if lines else []
    return [row[heads.index("type")].strip() for _, row in lines[1:]] if "type" in heads else []


def _items(node: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(node, Mapping):
        yield from node.items()
    else:
        yield from ((str(n), value) for n, value in enumerate(node))


def _is_table(value: Any) -> bool:
    if isinstance(value, list):
        return bool(value) and all(isinstance(entry, Mapping) for entry in value)
    return isinstance(value, Mapping)


def _field(model: type[BaseModel] | None, key: str) -> FieldInfo | None:
    name = field_names(model).get(key) if model else None
    return model.model_fields[name] if model and name else None


def _entry(place: tuple[str, ...], key: str, about: str, annotation: Any, value: Any) -> Control:
    control = {"address": join(place), "key": key, "about": about, "written": value}
    return control | _holds(annotation, value)


def _holds(annotation: Any, value: Any) -> Control:
    """What an entry holds: a quantity with its unit and bounds, a choice, a switch, or a text."""
    mark = mark_of(annotation)
    if isinstance(mark, Quantity):
        return {"holds": "quantity", "unit": mark.kind.unit, "bounds": _bounds(mark)} | _number(value, mark)
    if isinstance(mark, QuantityList):
        return {"holds": "list", "unit": mark.kind.unit, "expected": words_of(annotation)}
    choices = list(_choices(annotation))
    if choices:
        return {"holds": "choice", "choices": choices}
    if isinstance(value, bool):
        return {"holds": "switch"}
    if isinstance(value, int):
        return {"holds": "count"}
    return {"holds": "text" if isinstance(value, str) else "data", "expected": words_of(annotation)}


def _number(value: Any, mark: Quantity) -> Control:
    """The SI value of what is written and the tolerance behind it; none if it is no such quantity."""
    parts = size_and_limits(value) if isinstance(value, str) else None
    size, tolerance = parts or (value, "")
    try:
        return {"si": parse(size, mark.kind)} | ({"tolerance": tolerance} if tolerance else {})
    except UnitError:
        # silent: a text that is no quantity is a problem of the file, which stands beside it
        return {"si": None}


def _bounds(mark: Quantity) -> dict[str, float]:
    return {**mark.bound.schema, "most": mark.kind.most}


def _choices(annotation: Any) -> Iterator[str]:
    for branch in (annotation, *get_args(annotation)):
        if get_origin(branch) is Literal:
            yield from (str(choice) for choice in get_args(branch) if isinstance(choice, str))


def _missing(place: tuple[str, ...], model: type[BaseModel], node: Any, raw: Any) -> Iterator[Control]:
    """Entries that could be given; a table of named parts is one that elements can be added to."""
    for key, name in field_names(model).items():
        if isinstance(node, Mapping) and key in node:
            continue
        field = model.model_fields[name]
        annotation = annotation_at(Machine, (*place, key), raw)
        mark = mark_of(annotation)
        control = {
            "address": join((*place, key)),
            "key": key,
            "about": field.description or "",
            "expected": words_of(annotation),
            "usual": _usual(field),
            "kinds": kinds_at(annotation),
        }
        if mark is not None:
            yield control | {"unit": mark.kind.unit}
        else:
            yield control | {"choices": list(_choices(annotation))}


def _usual(field: FieldInfo) -> Any:
    """Default of an entry; None without one, or if it is no single value."""
    default = field.default
    if default is PydanticUndefined or not isinstance(default, str | int | float | bool):
        return None
    return default
