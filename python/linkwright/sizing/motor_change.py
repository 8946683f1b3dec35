"""A machine with another motor or flywheel; inertia of a motor's rotor, given or estimated."""

from __future__ import annotations

from typing import Any

from linkwright.drive.model.catalogue import CatalogueMotor, estimated_inertia, motors
from linkwright.machine.machine import Machine


def rotor_inertia(known: CatalogueMotor) -> tuple[float, bool]:
    """Inertia of a type's rotor [kg m²], and whether it is estimated from the rated torque."""
    if known.inertia is not None:
        return known.inertia, False
    return estimated_inertia(known.torque_rated), True


def with_motor(
    machine: Machine, known: CatalogueMotor, *, inertia: float, ratio: float, note: str = ""
) -> Machine:
    """Put a motor of the catalogue into a machine.

    `inertia`: of its rotor [kg m²]; `ratio`: of the gearbox [–]; `note`: a sentence to add to the machine's
    description. Raises MachineError: the catalogue gives no characteristic for the type.
    """
    tables = _tables(machine)
    drive = tables.setdefault("drive", {})
    drive["motor"] = {**_motor_table(known, ratio, drive.get("speed")), "inertia": inertia}
    drive["gearbox"] = {**drive.get("gearbox", {}), "ratio": ratio}
    # Tolerances of the motor that it had go with it.
    for place in [place for place in machine.tolerances if place.startswith("drive.motor.")]:
        del tables["tolerances"][place]
    return _made(tables, note)


def _motor_table(known: CatalogueMotor, ratio: float, speed: float | None) -> dict[str, Any]:
    if known in motors():
        return {"kind": "induction", "catalogue": known.type}
    if known.kind == "servo":
        assert speed is not None
        rated = {"speed_rated": known.speed_rated, "torque_rated": known.torque_rated}
        return {"kind": "constant_speed", "speed": speed * ratio, **rated}
    entries = {name: getattr(known, name) for name in _ENTRIES[known.kind]}
    if known.breakdown_is_minimum:
        entries["torque_breakdown"] = known.breakdown
    if known.start_is_minimum:
        entries |= known.start
    return {"kind": known.kind} | {name: value for name, value in entries.items() if value is not None}


# Entries of a machine file that describe a motor of one's own, by its kind.
_ENTRIES = {
    "induction": ("speed_synchronous", "speed_rated", "torque_rated", "torque_breakdown", "torque_start"),
    "dc": ("speed_no_load", "speed_rated", "torque_rated", "torque_stall", "torque_max"),
}


def with_flywheel(machine: Machine, inertia: float, *, note: str = "") -> Machine:
    """Put a flywheel on the crankshaft, in place of any that the machine has.

    `inertia`: of the flywheel [kg m²]; 0 leaves it out; `note`: a sentence to add to the machine's
    description.
    """
    tables = _tables(machine)
    drive = tables.setdefault("drive", {})
    drive.pop("flywheel", None)
    if inertia > 0:
        drive["flywheel"] = {"inertia": inertia, "on": "crank"}
    return _made(tables, note)


def _tables(machine: Machine) -> dict[str, Any]:
    return machine.model_dump(by_alias=True, exclude_unset=True)


def _made(tables: dict[str, Any], note: str) -> Machine:
    if note:
        tables["description"] = " ".join(text for text in (tables.get("description"), note) if text)
    return Machine.model_validate(tables)
