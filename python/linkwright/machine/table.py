"""The entries of a machine as rows of words, each number with its unit."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, get_args, get_origin

from pydantic import BaseModel

from linkwright.kernel.description.base import Description
from linkwright.kernel.description.place import field_names, join, keys, look
from linkwright.kernel.description.schema_walk import annotation_at
from linkwright.kernel.reader.numbers import measured, number, pretty_unit
from linkwright.kernel.reader.out_units import reader
from linkwright.linkages.model.topology import TABLES
from linkwright.machine.address import kind

if TYPE_CHECKING:
    from linkwright.machine.machine import Machine

Place = tuple[str, ...]

# Headings of tables of elements that are not the table's own name.
_GROUPS = {"points": "Fixed points", "rigid_points": "Points on links"}

# Tables of a train, in the order of the report.
_TRAIN = (
    *("engines", "discs", "shafts", "gears", "planetaries", "couplings", "dampers", "pendulums"),
    *("clutches", "brakes", "freewheels"),
    *("motors", "mechanisms", "drivers", "loads", "excitations"),
)

# Significant digits of what a file gives: no fewer than it has, as a rule.
_GIVEN = 6

# Longer lists are cut; the machine file holds them all.
_LONGEST_LIST = 12


class Entry(NamedTuple):
    """An entry: its word, its value with the unit, and whether it was given or follows from others."""

    word: str
    value: str
    given: bool = True


class Part(NamedTuple):
    """A part of a machine: its group, its name, its entries, and whether the file gives it that name."""

    group: str
    name: str
    entries: list[Entry]
    is_named: bool = False


def machine_parts(machine: Machine) -> list[Part]:
    """All parts of a machine, from turning moments and topper to bodies, loads and run-up."""
    parts = (_diagram, _topper, _drive, _train, _unit, _mechanism, _axes, _tables, _run_up)
    return [part for one in parts for part in one(machine)]


def part_names(machine: Machine) -> set[str]:
    """Names that the file gives to parts of the machine."""
    return {part.name for part in machine_parts(machine) if part.is_named}


def _diagram(machine: Machine) -> Iterator[Part]:
    if machine.turning_moment is not None:
        yield from _nested("Turning moment", machine, ("turning_moment",))


def _topper(machine: Machine) -> Iterator[Part]:
    cut = machine.topper
    if cut is None:
        return
    yield _part("Topper", machine, ("topper",))
    yield _part("Topper", machine, ("topper", "motion"))
    if cut.field is not None:
        for part in _nested("Topper", machine, ("topper", "field")):
            is_whole = part.name == "field"
            yield part if is_whole else part._replace(name=f"field: {part.name.replace('_', ' ')}")
    if "limits" in cut.model_fields_set:
        yield _part("Topper", machine, ("topper", "limits"))


def _drive(machine: Machine) -> Iterator[Part]:
    if machine.drive is None:
        return
    if machine.drive.speed is not None:
        yield Part(
            "Drive", "design", [Entry("speed", _value(machine, ("drive", "speed"), machine.drive.speed))]
        )
    for name in ("motor", "motor_shaft", "gearbox", "coupling", "flywheel", "brake", "crankshaft"):
        if getattr(machine.drive, name) is not None:
            yield _part("Drive", machine, ("drive", name))


def _train(machine: Machine) -> Iterator[Part]:
    train = machine.train
    if train is None:
        return
    if train.engine is not None:
        word = "Engine" if train.engine.machine == "engine" else "Compressor"
        yield from _nested(word, machine, ("train", "engine"))
    for table in _TRAIN:
        for name in getattr(train, table):
            yield _part(table.capitalize(), machine, ("train", table, name))
    for name in ("modal_damping", "run", "transient"):
        if getattr(train, name) is not None:
            yield _part("Train", machine, ("train", name))


def _nested(group: str, machine: Machine, place: Place) -> Iterator[Part]:
    part = _part(group, machine, place)
    if part.entries:
        yield part
    node: Any = machine
    for key in place:
        node = look(node, key)
    for key in keys(node):
        if isinstance(look(node, key), BaseModel):
            yield from _nested(group, machine, (*place, key))


def _unit(machine: Machine) -> Iterator[Part]:
    for name in ("pumping_unit", "rod_rotator"):
        if getattr(machine, name) is not None:
            yield _part("Pumping unit", machine, (name,))
    if machine.pumping_unit is not None and machine.pumping_unit.load is not None:
        yield _part("Pumping unit", machine, ("pumping_unit", "load"))
    if machine.rod_string is not None:
        part = _part("Rod string", machine, ("rod_string",))
        yield part._replace(entries=[each for each in part.entries if not each.word.startswith("section ")])
        yield _part("Rod string", machine, ("rod_string", "pump"))
        for n in range(len(machine.rod_string.sections)):
            part = _part("Rod string", machine, ("rod_string", "sections", str(n)))
            # A rod of a linkage is a connecting rod, in other languages another word.
            words = [
                each._replace(word="nominal size") if each.word == "rod" else each for each in part.entries
            ]
            yield part._replace(name="section", entries=words)


def _mechanism(machine: Machine) -> Iterator[Part]:
    for table in TABLES:
        group = _GROUPS.get(table) or table.replace("_", " ").capitalize()
        for name in getattr(machine.mechanism, table):
            yield _part(group, machine, ("mechanism", table, name))


def _axes(machine: Machine) -> Iterator[Part]:
    if machine.master is not None:
        yield _part("Servo axes", machine, ("master",))
    for name in machine.axes:
        for part in _nested("Servo axes", machine, ("axes", name)):
            if part.is_named:
                yield part
            elif any(entry.given for entry in part.entries):
                yield part._replace(name=f"{name}: {part.name}")


def _tables(machine: Machine) -> Iterator[Part]:
    for table in ("bodies", "loads"):
        for name in getattr(machine, table):
            yield _part(table.capitalize(), machine, (table, name))


def _run_up(machine: Machine) -> Iterator[Part]:
    if machine.run_up.model_fields_set:
        yield _part("Run-up", machine, ("run_up",))


def _part(group: str, machine: Machine, place: Place) -> Part:
    node: Any = machine
    around: Any = None
    for key in place:
        node, around = look(node, key), node
    entries = list(_entries(machine, place, node))
    name = place[-1].replace("_", " ") if len(place) < 3 else place[-1]
    return Part(group, name, entries, isinstance(around, dict))


def _entries(machine: Machine, place: Place, node: object, before: str = "") -> Iterator[Entry]:
    assumed = _not_given(node)
    for key in keys(node):
        value, word = look(node, key), f"{before}{key}".replace("_", " ")
        if isinstance(value, tuple) and value and isinstance(value[0], BaseModel):
            for n, entry in enumerate(value):
                yield Entry(
                    f"{word.removesuffix('s')} {n + 1}", _words(machine, (*place, key, str(n)), entry)
                )
        elif isinstance(value, dict) and any(isinstance(entry, BaseModel) for entry in value.values()):
            for name, entry in value.items():
                yield Entry(f"{word.removesuffix('s')} {name}", _words(machine, (*place, key, name), entry))
        elif isinstance(value, Description) and value.shown_with_part:
            yield from _entries(machine, (*place, key), value, f"{word} ")
        # A zero that nobody wrote says nothing.
        elif (
            value not in (None, {}, ())
            and not isinstance(value, BaseModel)
            and not (key in assumed and value == 0)
        ):
            yield Entry(word, _value(machine, (*place, key), value), key not in assumed)


def _words(machine: Machine, place: Place, node: BaseModel) -> str:
    parts = []
    for key in keys(node):
        value = look(node, key)
        if key not in _not_given(node) and value is not None:
            nested = isinstance(value, BaseModel)
            text = _words(machine, (*place, key), value) if nested else _value(machine, (*place, key), value)
            parts.append(text if key == "kind" else f"{key.replace('_', ' ')} {text}")
    return ", ".join(parts) or "–"


def _not_given(node: object) -> set[str]:
    if not isinstance(node, BaseModel):
        return set()
    names = field_names(type(node))
    return {key for key, name in names.items() if name not in node.model_fields_set}


def _value(machine: Machine, place: Place, value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(
            f"{name} = {_value(machine, (*place, name), entry)}" for name, entry in value.items()
        )
    if isinstance(value, tuple):
        if value and isinstance(value[0], str):
            return ", ".join(value)
        return _list(machine, place, value)
    if isinstance(value, bool | str):
        # A choice is a word; a name or a formula stands as the file has it.
        branches = get_args(annotation := annotation_at(type(machine), place, machine))
        is_choice = any(get_origin(branch) is Literal for branch in (annotation, *branches))
        return str(value).replace("_", " ") if is_choice else str(value)
    quantity = kind(machine, join(place))
    unit = quantity.unit if quantity else ""
    is_pumped = machine.pumping_unit is not None or machine.rod_string is not None
    # Pumping speeds are counted in strokes, and revolutions of the crank, per minute.
    usual = "rpm" if unit == "rad/s" and is_pumped else ""
    return measured(value, pretty_unit(unit), digits=_GIVEN, usual=usual)


def _list(machine: Machine, place: Place, values: tuple[float, ...]) -> str:
    quantity = kind(machine, join((*place, "0")))
    unit = quantity.unit if quantity else ""
    shown = values[:_LONGEST_LIST]
    usual = "deg" if unit == "rad" else ""
    name, factor = reader().shown(pretty_unit(unit), usual)
    texts = [number(entry / factor, _GIVEN) for entry in shown]
    more = ["…"] if len(values) > len(shown) else []
    return f"{', '.join(texts + more)} {name}".rstrip()


def grouped(parts: list[Part]) -> list[tuple[str, list[Part]]]:
    """Parts of a machine with the heading of each group."""
    return [(group, list(members)) for group, members in groupby(parts, key=lambda part: part.group)]
