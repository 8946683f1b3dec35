"""What is wrong between a rod string and the machine that moves it."""

from __future__ import annotations

from collections.abc import Iterator

from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault
from linkwright.kernel.description.place import look


def string_faults(machine: object) -> Iterator[InitErrorDetails]:
    """A load of the polished rod that nothing gives or that two give; two motions of the polished rod."""
    string, unit = look(machine, "rod_string"), look(machine, "pumping_unit")
    load = look(unit, "load")
    tables = [key for key in ("angle", "force", "position", "up", "down") if look(load, key) is not None]
    if string is None:
        if load is not None and not tables:
            yield fault(
                "pumping_unit",
                "load",
                expected="either angle and force, or position, up and down, or a [rod_string]",
            )
        return
    if tables:
        remedy = "the [rod_string] gives the load: remove the table, or the string"
        yield fault("pumping_unit", "load", tables[0], found="a table", expected="nothing", remedy=remedy)
    for key, part, word in (("stroke", unit, "pumping_unit"), ("speed", look(machine, "drive"), "drive")):
        value = look(string, key)
        if value is not None and part is not None:
            expected = f"nothing beside [{word}], which moves the polished rod"
            yield fault("rod_string", key, found=value, expected=expected)
