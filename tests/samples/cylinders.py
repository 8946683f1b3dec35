"""Cylinders and gas of the tests of gas torque."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter, ValidationError

from linkwright.kernel.errors import Problem
from linkwright.torsion import AnyGas, Combustion, Cylinder, Indicator

Array = NDArray[np.float64]

BORE, CRANK, ROD = 0.15, 0.09, 0.32


def crank_position(phi: Array, rod: float = ROD) -> Array:
    """Piston of a plain crank; an infinite rod is a harmonic motion."""
    if np.isinf(rod):
        return CRANK * np.cos(phi)
    return CRANK * np.cos(phi) + np.sqrt(rod**2 - (CRANK * np.sin(phi)) ** 2)


def cylinder(strokes: int = 4, rod: float = ROD, shift: float = 0.0, n: int = 72) -> Cylinder:
    phi = 2 * np.pi * np.arange(n) / n
    return Cylinder(BORE, strokes, crank_position(phi - shift, rod))


def diesel(**entries: Any) -> Combustion:
    given: dict[str, Any] = {"compression_ratio": 15.0, "charge_pressure": 2.2e5}
    if not {"heat", "mean_effective_pressure", "peak_pressure", "load"} & set(entries):
        given["mean_effective_pressure"] = 16e5
    return Combustion(kind="wiebe", **(given | entries))


def measured(gas: Combustion, step: float, start: float = -360.0, **entries: Any) -> Indicator:
    """The diagram that a perfect transducer would take of a cycle, its points some degrees apart."""
    place = cylinder()
    angle = np.radians(np.arange(start, start + 720.0, step))
    pressure, _ = gas.cycle_pressure(place, np.array([150.0])).at(angle)
    given: dict[str, Any] = {"angle": angle.tolist(), "pressure": pressure[0].tolist()}
    return Indicator(**({"kind": "table", "compression_ratio": 15.0} | given | entries))


def told(entries: dict[str, Any], strokes: int = 4) -> list[Problem]:
    try:
        gas: Indicator | Combustion = TypeAdapter(AnyGas).validate_python(entries)
    except ValidationError as error:
        return [_problem(each["loc"], each.get("ctx", {}), each["msg"]) for each in error.errors()]
    return [
        _problem(each.get("loc", ()), each["type"].context or {}, "") for each in gas.cycle_faults(strokes)
    ]


def _problem(place: Any, context: dict[str, Any], message: str) -> Problem:
    found, expected = context.get("found", ""), context.get("expected", message)
    return Problem(".".join(map(str, place)), found, expected, context.get("remedy", ""))
