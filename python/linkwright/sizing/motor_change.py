"""A machine with another motor or flywheel; inertia of a motor's rotor.

Similar machines at equal shear stress in the air gap have torque as the cube of their size and inertia as its
fifth power, so

.. math:: J = J_1 (M_n/M_{n1})^{5/3}

It is an estimate: types of one frame share their diameter and differ in length, for which J grows as M only.
"""

from __future__ import annotations

from typing import Any

from linkwright.drive.model.catalogue import CatalogueMotor, motor
from linkwright.machine.machine import Machine

# The only type of the catalogue whose inertia is printed: 0.138 kg m² at 107.7 N m (paper 1, worked case).
KNOWN = "4A160S6U3 (method 1)"

_EXPONENT = 5 / 3


def rotor_inertia(known: CatalogueMotor) -> tuple[float, bool]:
    """Inertia of a type's rotor, and whether it is an estimate.

    Parameters
    ----------
    known : CatalogueMotor
        A type of the catalogue.

    Returns
    -------
    tuple of (float, bool)
        J [kg m²]; False if the catalogue gives it, True if it is estimated from the rated torque.
    """
    if known.inertia is not None:
        return known.inertia, False
    return estimated_inertia(known.torque_rated), True


def estimated_inertia(torque_rated: float) -> float:
    """Estimate the inertia of a rotor from the rated torque of its motor.

    `torque_rated`: M_n [N m]. Returns: J [kg m²], by similarity with `KNOWN`.

    >>> round(estimated_inertia(107.7), 3)
    0.138
    """
    like = motor(KNOWN)
    assert like.inertia is not None
    return float(like.inertia * (torque_rated / like.torque_rated) ** _EXPONENT)


def with_motor(
    machine: Machine, known: CatalogueMotor, *, inertia: float, ratio: float, note: str = ""
) -> Machine:
    """Put a motor of the catalogue into a machine.

    `inertia`: of its rotor [kg m²]; `ratio`: of the gearbox [–]; `note`: a sentence to add to the machine's
    description. Raises MachineError: the catalogue gives no characteristic for the type.
    """
    tables = _tables(machine)
    drive = tables.setdefault("drive", {})
    drive["motor"] = {"kind": "induction", "catalogue": known.type, "inertia": inertia}
    drive["gearbox"] = {**drive.get("gearbox", {}), "ratio": ratio}
    return _made(tables, note)


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
    """The machine as the tables of a file."""
    return machine.model_dump(by_alias=True, exclude_unset=True)


def _made(tables: dict[str, Any], note: str) -> Machine:
    if note:
        tables["description"] = " ".join(text for text in (tables.get("description"), note) if text)
    return Machine.model_validate(tables)
