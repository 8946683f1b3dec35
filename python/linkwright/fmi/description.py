"""`modelDescription.xml` of FMI 2.0 and 3.0.

Functional Mock-up Interface for Model Exchange and Co-Simulation, 2.0.4, sections 2.2, 3.3 and 4.3;
Functional Mock-up Interface Specification, 3.0.1, section 2.4.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple
from xml.etree import ElementTree

from linkwright.fmi.units import UnitDefinition, unit_name
from linkwright.fmi.variables import TIME, Variable, indicators, is_structured

_TRUE = "true"

# Descriptions are in English, whatever the language of reports: tools show them as they are.
_ABOUT = "Drive with its mechanism; the crank angle is the generalised coordinate."

# What the library can do.
_MODEL_EXCHANGE_2 = ("canGetAndSetFMUstate", "canSerializeFMUstate", "providesDirectionalDerivative")
_CO_SIMULATION_2 = ("canHandleVariableCommunicationStepSize", *_MODEL_EXCHANGE_2)
_MODEL_EXCHANGE_3 = ("canGetAndSetFMUState", "canSerializeFMUState", "providesDirectionalDerivatives")
_CO_SIMULATION_3 = ("canHandleVariableCommunicationStepSize", *_MODEL_EXCHANGE_3)


class Experiment(NamedTuple):
    """What a tool proposes for a simulation."""

    stop: float  # [s]
    step: float  # [s]
    tolerance: float


class Description(NamedTuple):
    """What a description says, whichever version it is of."""

    name: str  # of the machine
    identifier: str  # name of the library in the FMU
    tool: str
    token: str
    variables: Sequence[Variable]
    indicators: int
    units: Sequence[UnitDefinition]
    experiment: Experiment

    @property
    def convention(self) -> str:
        """Naming convention of the variables."""
        names = (variable.name for variable in self.variables)
        return "structured" if all(map(is_structured, names)) else "flat"

    def displayed(self, unit: str) -> dict[str, str]:
        """The attribute that names the unit for display, where it has one of its own."""
        shown = next((each.shown for each in self.units if each.name == unit), None)
        return {"displayUnit": shown[0]} if shown else {}

    @property
    def outputs(self) -> list[Variable]:
        """What is read at every communication point."""
        return [variable for variable in self.variables if variable.causality == "output"]

    @property
    def derivatives(self) -> list[Variable]:
        """Derivatives of the states, in the order of the states."""
        return [variable for variable in self.variables if variable.derivative_of]

    @property
    def initial_unknowns(self) -> list[Variable]:
        """What is computed at the start, each once."""
        return [
            variable
            for variable in self.variables
            if variable.start is None and (variable.causality == "output" or variable.derivative_of)
        ]


def model_description(of: Description, version: str) -> bytes:
    """The description of FMI ``"2.0"`` or ``"3.0"`` as XML."""
    root = (_fmi2 if version == "2.0" else _fmi3)(of)
    ElementTree.indent(root)
    text: bytes = ElementTree.tostring(root, "utf-8")
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + text + b"\n"


def _fmi2(of: Description) -> ElementTree.Element:
    root = ElementTree.Element("fmiModelDescription", _head(of, "2.0", "guid"))
    root.set("numberOfEventIndicators", str(of.indicators))
    exchange = dict.fromkeys(_MODEL_EXCHANGE_2, _TRUE) | {"completedIntegratorStepNotNeeded": _TRUE}
    _add(root, "ModelExchange", {"modelIdentifier": of.identifier} | exchange)
    _add(root, "CoSimulation", {"modelIdentifier": of.identifier} | dict.fromkeys(_CO_SIMULATION_2, _TRUE))
    _units(root, of.units)
    _experiment(root, of.experiment)
    # Derivatives and dependencies name a variable by its number from 1.
    place = {variable.name: str(nth) for nth, variable in enumerate(of.variables, 1)}
    listed = _add(root, "ModelVariables")
    for variable in of.variables:
        scalar = _add(listed, "ScalarVariable", _common(variable))
        _add(scalar, "Boolean" if variable.is_bool else "Real", _typed(of, variable, place.__getitem__))
    structure = _add(root, "ModelStructure")
    parts = {
        "Outputs": of.outputs,
        "Derivatives": of.derivatives,
        "InitialUnknowns": of.initial_unknowns,
    }
    for name, unknowns in parts.items():
        part = _add(structure, name)
        for unknown in unknowns:
            depends = {} if name == "InitialUnknowns" else _dependencies(unknown, place.__getitem__)
            _add(part, "Unknown", {"index": place[unknown.name]} | depends)
    return root


def _fmi3(of: Description) -> ElementTree.Element:
    root = ElementTree.Element("fmiModelDescription", _head(of, "3.0", "instantiationToken"))
    _add(root, "ModelExchange", {"modelIdentifier": of.identifier} | dict.fromkeys(_MODEL_EXCHANGE_3, _TRUE))
    _add(root, "CoSimulation", {"modelIdentifier": of.identifier} | dict.fromkeys(_CO_SIMULATION_3, _TRUE))
    _units(root, of.units)
    _experiment(root, of.experiment)
    all_variables = [TIME, *of.variables, *indicators(of.indicators)]
    reference = {variable.name: str(variable.reference) for variable in all_variables}
    listed = _add(root, "ModelVariables")
    for variable in all_variables:
        typed = _typed(of, variable, reference.__getitem__)
        _add(listed, "Boolean" if variable.is_bool else "Float64", _common(variable) | typed)
    structure = _add(root, "ModelStructure")
    parts = {
        "Output": of.outputs,
        "ContinuousStateDerivative": of.derivatives,
        "InitialUnknown": of.initial_unknowns,
        "EventIndicator": indicators(of.indicators),
    }
    for name, unknowns in parts.items():
        for unknown in unknowns:
            depends = {} if name == "InitialUnknown" else _dependencies(unknown, reference.__getitem__)
            _add(structure, name, {"valueReference": reference[unknown.name]} | depends)
    return root


def _head(of: Description, version: str, token: str) -> dict[str, str]:
    """Attributes of the root."""
    return {
        "fmiVersion": version,
        "modelName": of.name,
        token: of.token,
        "description": _ABOUT,
        "generationTool": of.tool,
        "variableNamingConvention": of.convention,
    }


def _add(above: ElementTree.Element, name: str, attributes: Mapping[str, str] = {}) -> ElementTree.Element:
    """An element below another one."""
    return ElementTree.SubElement(above, name, dict(attributes))


def _units(root: ElementTree.Element, units: Sequence[UnitDefinition]) -> None:
    """Units with exponents and units for display."""
    listed = _add(root, "UnitDefinitions")
    for unit in units:
        element = _add(listed, "Unit", {"name": unit.name})
        _add(element, "BaseUnit", {name: str(power) for name, power in unit.exponents.items()})
        if unit.shown is not None:
            name, factor = unit.shown
            _add(element, "DisplayUnit", {"name": name, "factor": repr(factor)})


def _experiment(root: ElementTree.Element, experiment: Experiment) -> None:
    """What a tool proposes for a simulation."""
    numbers = {"stopTime": experiment.stop, "tolerance": experiment.tolerance, "stepSize": experiment.step}
    _add(root, "DefaultExperiment", {"startTime": "0.0"} | {name: repr(x) for name, x in numbers.items()})


def _common(variable: Variable) -> dict[str, str]:
    """Attributes that every variable has, in both versions."""
    attributes = {"name": variable.name, "valueReference": str(variable.reference)}
    if variable.about:
        attributes["description"] = variable.about
    attributes["causality"] = variable.causality
    attributes["variability"] = _variability(variable)
    if variable.causality in ("output", "local"):
        attributes["initial"] = "calculated" if variable.start is None else "exact"
    return attributes


def _variability(variable: Variable) -> str:
    """When the value changes."""
    if variable.causality == "parameter":
        return "tunable"
    return "discrete" if variable.is_bool else "continuous"


def _typed(of: Description, variable: Variable, place: Callable[[str], str]) -> dict[str, str]:
    """Attributes of a number or a truth value."""
    attributes: dict[str, Any] = {}
    if variable.unit:
        attributes["unit"] = unit_name(variable.unit)
        attributes |= of.displayed(attributes["unit"])
    attributes |= {
        name: repr(float(bound)) for name, bound in zip(("min", "max"), variable.bounds or (), strict=False)
    }
    if variable.start is not None:
        attributes["start"] = str(variable.start).lower() if variable.is_bool else repr(float(variable.start))
    if variable.derivative_of:
        attributes["derivative"] = place(variable.derivative_of)
    if variable.is_state:
        # Where the machine comes to rest, its speed becomes zero.
        attributes["reinit"] = _TRUE
    return attributes


def _dependencies(variable: Variable, place: Callable[[str], str]) -> dict[str, str]:
    """Inputs and states that an unknown depends on; without, on all."""
    return (
        {}
        if variable.depends is None
        else {"dependencies": " ".join(sorted(map(place, variable.depends), key=int))}
    )
