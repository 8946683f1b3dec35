"""What a study asks: the analyses that give it, and one number out of each result.

A response is named by its analysis and its quantity, ``steady_state.unevenness``; where a machine has several
of a kind the name stands between, ``cam.valve.pressure_angle_max``. ``motion.C.x`` is the place of a point
over the crank angle, ``motion.C.y`` likewise. ``forces.reaction_max.A`` is the largest force of a pair.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from inspect import signature
from typing import Any, get_type_hints

import numpy as np
from numpy.typing import NDArray

from linkwright.drive.batch import SteadyStates
from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import FindingError, MachineError, Problem, show
from linkwright.kernel.quantities import Label, declared, is_array
from linkwright.kernel.result import Result
from linkwright.kernel.units import is_number
from linkwright.machine.address import addresses, get, kind
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.studies.model import Response

# Analysis → the function that makes it of a machine, and a name where there are several.
ANALYSES = {
    "reduction": "drive.reduction:reduction",
    "constant_energy": "drive.evenness:constant_energy",
    "steady_state": "drive.steady_state:steady_state",
    "run_up": "drive.run_up:run_up",
    "run_down": "drive.run_up:run_down",
    "linkage": "linkages.cycle:linkage",
    "forces": "kinetostatics.forces:forces",
    "cam": "cam.profile.profile:cam_profile",
    "cam_check": "cam.profile.check:cam_check",
    "cam_force": "cam.dynamics.loaded:cam_force",
    "pumping_unit": "pumping.unit:pumping_unit",
    "rotator": "pumping.rod_rotator:rod_rotator",
    "rod_rotator": "pumping.rod_rotator:rod_rotator",
    "turning_moment": "turning.diagram:turning_moment",
    "topper": "topping.topper:topper",
    "topper_field": "topping.field:topper_field",
    "free_vibration": "torsion.modes.free:free_vibration",
    "forced_vibration": "torsion.response.forced:forced_vibration",
}

# The analysis of points alone, which needs no drive; and what is no analysis, but stands in the machine.
MOTION, ENTRY = "motion", "entry"

# Analyses of one part of the machine, by its name.
OF_ONE_CAM = ("cam", "cam_check", "cam_force")

# Parts of a train that a list of curves has a row for.
_PARTS = ("discs", "shafts")

# The largest force of every pair, by its name.
PAIRS = "forces.reaction_max"

# What the core gives of the steady motion of many machines.
_OF_BATCH = frozenset(declared(SteadyStates))

# Crank angles per revolution at which a motion is sampled for its extremes: an extreme between them is missed
# by at most (half a step)²/2 of the second derivative, 4e-5 of a harmonic motion's amplitude.
SAMPLES = 360


@dataclass(frozen=True)
class StudyResponse:
    """One response of a study."""

    name: str  # its name in the study
    analysis: str  # analysis that it comes from
    # Name of the cam, the point, the pair, or the part of a train, where there are several; the
    # address of an entry.
    of: tuple[str, ...]
    quantity: str  # attribute of the result; of a point `"x"` or `"y"`
    # What it is called, SI unit.
    word: str
    unit: str
    extreme: str | None = None  # what is taken of a curve
    index: int | None = None  # place in a list
    at: float | None = None  # crank angle at which a motion is taken [rad]
    axes: tuple[str, ...] = ()  # of a list of curves: `("shafts", "speeds")`
    level: float | None = None  # confidence level of an interval; without it, that of the analysis
    otherwise: float | None = None  # what stands for a number that the machine does not have

    @property
    def arguments(self) -> tuple[str, ...]:
        """What the analysis takes besides the machine."""
        return self.of if self.analysis in OF_ONE_CAM else ()

    @property
    def options(self) -> dict[str, float]:
        """What the analysis takes besides, by name."""
        return {} if self.level is None else {"level": self.level}

    @property
    def key(self) -> tuple[str, tuple[str, ...], float | None]:
        """Analysis, name and level: what is computed once for all responses that share it."""
        return self.analysis, self.arguments, self.level

    @property
    def is_batch(self) -> bool:
        """Whether the core computes it for many machines at once."""
        is_scalar = self.extreme is None and self.index is None and self.otherwise is None
        return self.analysis in (MOTION, ENTRY) or (
            self.analysis == "steady_state" and is_scalar and self.quantity in _OF_BATCH
        )

    def number(self, result: Any) -> float:
        """The number that is asked for, out of a result; a `FindingError` if the machine has none."""
        value = getattr(result, self.quantity)
        if isinstance(value, Mapping):
            value = value.get(*self.of)
        if value is not None and (self.extreme is not None or self.index is not None):
            value = self._picked(result, np.asarray(value))
        if value is None or not math.isfinite(float(value)):
            if self.otherwise is not None:
                return self.otherwise
            raise FindingError(f"{self.word} has no value for this machine")
        return float(value)

    def _picked(self, result: Any, values: NDArray[Any]) -> Any:
        """One number of a curve, or of all curves of a list; of complex amplitudes their absolute values."""
        values = np.abs(values) if np.iscomplexobj(values) else values.astype(float)
        if self.of and not self.arguments:
            axis = next(axis for axis, parts in enumerate(self.axes) if parts in _PARTS)
            values = np.take(values, getattr(result, self.axes[axis]).index(self.of[0]), axis=axis)
        if self.extreme is not None:
            return taken(values.ravel(), self.extreme)
        assert self.index is not None
        if self.index >= len(values):
            raise FindingError(
                f"{self.analysis}.{self.quantity} has {len(values)} values, none of number {self.index}"
            )
        return values[self.index]


def taken(curve: Floats, extreme: str) -> Any:
    """One number of each curve, over its last axis."""
    match extreme:
        case "max":
            return curve.max(axis=-1)
        case "min":
            return curve.min(axis=-1)
        case "range":
            return np.ptp(curve, axis=-1)
        case "mean":
            return curve.mean(axis=-1)
    return np.sqrt((curve**2).mean(axis=-1))


def analysis(name: str) -> Callable[..., Result]:
    """The function of an analysis, imported now."""
    module, _, function = ANALYSES[name].partition(":")
    analyse: Callable[..., Result] = getattr(import_module(f"linkwright.{module}"), function)
    return analyse


def asked(machine: Machine, name: str, response: Response) -> StudyResponse:
    """A response of a study, checked against what there is.

    Raises `MachineError`: no such analysis or quantity, a curve where a number belongs, or the reverse.
    """
    if response.entry is not None:
        return _of_entry(machine, name, response.entry)
    text = response.quantity or response.curve or ""
    first, *rest = text.split(".")
    key = "quantity" if response.quantity is not None else "curve"
    if first == MOTION:
        return _of_motion(machine, name, key, text, response)
    if first not in ANALYSES or not rest:
        raise _wrong(name, key, text, "analysis.quantity", suggestion(first, (*ANALYSES, MOTION)))
    if text.startswith(f"{PAIRS}."):
        return _of_pair(machine, name, key, text, response)
    owner = get_type_hints(analysis(first))["return"]
    known = {attribute: mark for attribute, (_, mark) in declared(owner).items() if isinstance(mark, Label)}
    *of, quantity = rest
    if quantity not in known:
        raise _wrong(name, key, text, f"a quantity of {first}", suggestion(quantity, known))
    wants_curve = response.curve is not None
    if is_array(owner, quantity) and not wants_curve:
        remedy = f'{{ curve = "{text}", extreme = "max" }}'
        raise _wrong(name, key, f"{text}, which is a curve", "one number", remedy)
    if wants_curve and not is_array(owner, quantity):
        raise _wrong(name, key, f"{text}, which is a number", "a curve", f'write "{text}" alone')
    mark = known[quantity]
    axes = tuple(axis.strip() for axis in mark.shape.strip("()").split(",") if axis.strip())
    _require_part(
        machine, first, of, axes, lambda remedy: _wrong(name, key, text, "a name that there is", remedy)
    )
    if response.level is not None and "level" not in signature(analysis(first)).parameters:
        raise _wrong(name, "level", f"{response.level:g}", f"nothing: {first} has no intervals")
    picked = (response.extreme, response.index)
    own = (".".join(of),) if of else ()
    if response.index is not None and len(axes) - len(own) > 1:
        place = next((parts for parts in axes if parts in _PARTS and not of), None)
        one = f", or {first}.NAME.{quantity} with NAME of {place}" if place else ""
        raise _wrong(name, "index", f"{text}, a list of curves", f"extreme{one}")
    return StudyResponse(
        *(name, first, own, quantity, mark.word, mark.unit, *picked),
        axes=axes,
        level=response.level,
        otherwise=response.otherwise,
    )


def _require_part(
    machine: Machine, first: str, of: list[str], axes: tuple[str, ...], wrong: Callable[[str], MachineError]
) -> None:
    """Raise what is wrong, with a remedy, if a response names no part of the machine, or should name one."""
    place = next((parts for parts in axes if parts in _PARTS), None)
    if first in OF_ONE_CAM:
        known = [*machine.mechanism.cams]
        if not of and len(known) == 1:
            return
    elif not of:
        return
    elif machine.train is not None and place is not None:
        known = [*getattr(analysis("free_vibration")(machine), place)]
    else:
        raise wrong(f"leave out {'.'.join(of)}")
    given = ".".join(of)
    if given not in known:
        raise wrong(suggestion(given, known) if of else f"name one of {', '.join(known) or 'no cams'}")


def _of_entry(machine: Machine, name: str, address: str) -> StudyResponse:
    """A number of the machine, given or of a catalogue."""
    try:
        value, mark = get(machine, address), kind(machine, address)
    except MachineError as error:
        remedy = error.problems[0].remedy or suggestion(address, addresses(machine))
        raise _wrong(name, "entry", address, "the address of an entry", remedy) from None
    if not is_number(value):
        found = f"{address}, which is no number" if value is not None else f"{address}, which is not given"
        raise _wrong(name, "entry", found, "the address of a number")
    return StudyResponse(name, ENTRY, (address,), address, address, mark.unit if mark else "")


def entry_number(machine: Machine, address: str) -> float:
    """A number of a machine; a `FindingError` if this machine has none there."""
    value = get(machine, address)
    if not is_number(value):
        raise FindingError(f"{address} has no number in this machine")
    return float(value)


def _of_motion(machine: Machine, name: str, key: str, text: str, response: Response) -> StudyResponse:
    """A coordinate of a point."""
    point, _, coordinate = text.removeprefix(MOTION).removeprefix(".").rpartition(".")
    points = compile_machine(machine).points
    if coordinate not in ("x", "y") or point not in points:
        raise _wrong(name, key, text, "motion.POINT.x or motion.POINT.y", suggestion(point, points))
    if response.curve is None:
        remedy = f'{{ curve = "{text}", extreme = "max" }} or {{ curve = "{text}", at = "30 deg" }}'
        raise _wrong(name, key, f"{text}, which is a curve", "one number", remedy)
    if response.index is not None:
        raise _wrong(name, "index", str(response.index), "extreme or at, of a motion")
    for key in ("level", "otherwise"):
        if getattr(response, key) is not None:
            raise _wrong(name, key, f"{getattr(response, key):g}", "nothing beside a motion")
    word = f"{coordinate} of {point}"
    return StudyResponse(name, MOTION, (point,), coordinate, word, "m", response.extreme, at=response.at)


def _of_pair(machine: Machine, name: str, key: str, text: str, response: Response) -> StudyResponse:
    """The largest force of a pair."""
    pair = text.removeprefix(f"{PAIRS}.")
    if response.curve is not None:
        raise _wrong(name, key, f"{text}, which is a number", "a curve", f'write "{text}" alone')
    # Which pairs there are does not depend on the motion.
    forces: Any = analysis("forces")(machine, speed=1.0, angles=np.array([0.0, 1.0]))
    if pair not in forces.pairs:
        raise _wrong(name, key, text, f"{PAIRS}.PAIR", suggestion(pair, forces.pairs))
    return StudyResponse(name, "forces", (pair,), "reaction_max", f"maximum force of {pair}", "N")


def _wrong(name: str, key: str, found: str, expected: str, remedy: str = "") -> MachineError:
    return MachineError([Problem(f"responses.{name}.{key}", show(found), expected, remedy)])
