"""What a study asks: the analyses that give it, and one number out of each result.

A response is named by its analysis and its quantity, ``steady_state.unevenness``; where a machine has several
of a kind the name stands between, ``cam.valve.pressure_angle_max``; so does that of a result within another,
``pumping_unit.gear.work``. The names of `linkwright.sensitivity` mean the same numbers here, such as
``free_vibration.natural_frequencies.1`` and ``forced_vibration.shaft_torque_max.SHAFT``.

``motion.C.x`` is the place of a point over the crank angle, ``motion.C.y`` likewise. ``path.tool.error_rms``
is how far a point passes from the path ``tool`` of the study. ``forces.reaction_max.A`` is the largest force
of a pair, ``linkage.R.swing`` the swing of an element, ``cycle_motion.ram.place.velocity.maximum`` the
maximum velocity of a slider.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from inspect import signature
from typing import Any, NamedTuple, get_type_hints

import numpy as np

from linkwright.app.subjects import ANALYSES as SUBJECTS
from linkwright.driveline.train_chain import driveline_chain
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import FindingError, LinkwrightError, MachineError
from linkwright.kernel.quantities import Label, declared, is_array
from linkwright.kernel.result import Result, result_within
from linkwright.kernel.units.reading import is_number
from linkwright.machine.address import addresses, get, kind
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.studies.model import Response, StudyPath
from linkwright.studies.point_responses import of_motion, of_path
from linkwright.studies.study_response import (
    CYCLE,
    ENTRY,
    LINKAGE,
    MOTION,
    OF_ONE_PART,
    PARTS,
    PATH,
    NoPlaceError,
    StudyResponse,
    wrong,
)
from linkwright.torsion.model.whole_train import whole_train
from linkwright.torsion.response.stress import stressed

# Analyses with a function of their own, by name.
ANALYSES = {analysis.name: analysis for analysis in SUBJECTS if analysis.function is not None}

# Former names of analyses → today's.
_FORMERLY = {analysis.formerly: analysis.name for analysis in SUBJECTS if analysis.formerly}

# What `run` calls a result within another → the analysis, and its name there.
_WITHIN = {analysis.name: analysis.within.split(".") for analysis in SUBJECTS if analysis.within}

# The largest force of every pair, by its name.
PAIRS = "forces.reaction_max"


def analysis(name: str) -> Callable[..., Result]:
    """The function of an analysis, imported now."""
    return ANALYSES[name].analyse


def asked(machine: Machine, name: str, response: Response, paths: Mapping[str, StudyPath]) -> StudyResponse:
    """A response of a study, checked against what there is; `paths`: those of the study.

    Raises `MachineError`: no such analysis or quantity, a curve where a number belongs, or the reverse.
    """
    if response.entry is not None:
        return _of_entry(machine, name, response.entry)
    text = response.quantity or response.curve or ""
    first, *rest = text.split(".")
    first = _FORMERLY.get(first, first)
    if first in _WITHIN:
        first, *rest = *_WITHIN[first], *rest
    key = "quantity" if response.quantity is not None else "curve"
    if first == MOTION:
        return of_motion(machine, name, key, text, response)
    if first == PATH:
        return of_path(paths, name, key, text, response)
    if first not in ANALYSES or not rest:
        raise wrong(
            name, key, text, "analysis.quantity", suggestion(first, (*ANALYSES, *_WITHIN, MOTION, PATH))
        )
    if text.startswith(f"{PAIRS}."):
        return _of_pair(machine, name, key, text, response)
    if first == CYCLE:
        return _of_cycle(machine, name, key, text, response)
    if first == LINKAGE and len(rest) > 1:
        return _of_element(machine, name, key, text, response)
    owner, inner, rest = _within(get_type_hints(analysis(first))["return"], rest)
    known = {attribute: mark for attribute, (_, mark) in declared(owner).items() if isinstance(mark, Label)}
    of, quantity, extreme, index, wants_curve = _asked_for(first, owner, rest, response)
    if quantity not in known:
        of_result = ".".join(filter(None, (first, inner)))
        remedy = suggestion(quantity, known) or f"such as {of_result}.{next(iter(known))}"
        raise wrong(name, key, text, f"a quantity of {of_result}", remedy)
    axes = _axes(known[quantity])
    is_part = bool(of) and len(axes) == 1 and axes[0] in PARTS
    if is_array(owner, quantity) and not wants_curve and not is_part:
        remedy = f'{{ curve = "{text}", extreme = "max" }}'
        raise wrong(name, key, f"{text}, which is a curve", "one number", remedy)
    if wants_curve and not is_array(owner, quantity):
        raise wrong(name, key, f"{text}, which is a number", "a curve", f'write "{text}" alone')
    mark = known[quantity]
    of_part = ANALYSES[first].mark
    if of_part is not None and not inner:
        mark = of_part(machine, ".".join(of) or None, mark)
    axes = _axes(mark)
    _require_part(
        machine, first, of, axes, lambda remedy: wrong(name, key, text, "a name that there is", remedy)
    )
    if response.level is not None and "level" not in signature(analysis(first)).parameters:
        raise wrong(name, "level", f"{response.level:g}", f"nothing: {first} has no intervals")
    picked = (extreme, index)
    own = (".".join(of),) if of else ()
    if index is not None and len(axes) - len(own) > 1:
        place = next((parts for parts in axes if parts in PARTS and not of), None)
        one = f", or {first}.NAME.{quantity} with NAME of {place}" if place else ""
        raise wrong(name, "index", f"{text}, a list of curves", f"extreme{one}")
    return StudyResponse(
        *(name, first, own, quantity, mark.word, mark.unit, *picked),
        inner=inner,
        axes=axes,
        level=response.level,
        otherwise=response.otherwise,
    )


# Curves over the speeds of which `linkwright.sensitivity` names the largest number of a shaft.
_OF_SHAFTS = ("forced_vibration.shaft_torque_vibratory", "forced_vibration.shaft_torque_max")


def _axes(mark: Any) -> tuple[str, ...]:
    """What the axes of a quantity run over, by its shape."""
    shape = mark.shape if isinstance(mark, Label) else ""
    return tuple(axis.strip() for axis in shape.strip("()").split(",") if axis.strip())


class _AskedFor(NamedTuple):
    """What the name of a response refers to in a result."""

    of: list[str]  # keys of the name of a part
    quantity: str
    extreme: str | None
    place: int | None  # in a list
    is_curve: bool  # whether a number of a curve is asked for


def _asked_for(first: str, owner: type, rest: list[str], response: Response) -> _AskedFor:
    """Parse the keys of a name: the quantity is last or, as in `linkwright.sensitivity`, first."""
    head, *place = rest
    picked, is_curve = (response.extreme, response.index), response.curve is not None
    *of, quantity = rest
    marks = {name: mark for name, mark in declared(owner).items() if isinstance(mark[1], Label)}
    if not place or quantity in marks or head not in marks or not is_array(owner, head):
        return _AskedFor(of, quantity, *picked, is_curve)
    if is_curve:
        return _AskedFor(place, head, *picked, True)
    if _axes(marks[head][1]) in [(parts,) for parts in PARTS] and not place[0].isdecimal():
        return _AskedFor(place, head, *picked, is_curve)
    if f"{first}.{head}" in _OF_SHAFTS:
        return _AskedFor(place, head, "max", None, True)
    if place[0].isdecimal():
        return _AskedFor(place[1:], head, None, int(place[0]), True)
    return _AskedFor(of, quantity, *picked, False)


def _within(owner: type, rest: list[str]) -> tuple[type, str, list[str]]:
    """The result within a result that names lead to, its name there, and what is left of them."""
    for at in range(min(2, len(rest) - 1)):
        # After the name of a part, if there is one.
        kind = result_within(owner, rest[at])
        if kind is not None:
            return kind, rest[at], [*rest[:at], *rest[at + 1 :]]
    return owner, "", rest


def require_place(machine: Machine, response: StudyResponse) -> None:
    """Refuse, by a `MachineError`, an index beyond a list of the machine; without an answer its rows tell."""
    if response.index is None or response.analysis in (MOTION, PATH):
        return
    try:
        response.number(analysis(response.analysis)(machine, *response.arguments, **response.options))
    except NoPlaceError as error:
        expected = f"0 to {error.count - 1}: the list has {error.count} values"
        raise wrong(response.name, "index", str(response.index), expected) from None
    except LinkwrightError:
        # silent: a machine without an answer has no list whose length tells anything, and each row says why
        return


def _require_part(
    machine: Machine, first: str, of: list[str], axes: tuple[str, ...], wrong: Callable[[str], MachineError]
) -> None:
    """Raise what is wrong, with a remedy, if a response names no part of the machine, or should name one."""
    place = next((parts for parts in axes if parts in PARTS), None)
    if first in OF_ONE_PART:
        parts = ANALYSES[first].parts
        known = [*machine.mechanism.cams] if parts is None else [*parts(machine)]
        if not of and len(known) == 1:
            return
    elif not of:
        return
    elif first == "shaft_stress" and machine.train is not None:
        known = [*stressed(whole_train(machine.train).shafts)]
    elif first == "elastic_motion" and place is not None:
        known = [*getattr(driveline_chain(machine), place)]
    elif machine.train is not None and place is not None:
        known = [*getattr(analysis("free_vibration")(machine), place)]
    else:
        raise wrong(f"leave out {'.'.join(of)}")
    given = ".".join(of)
    if given not in known and not known:
        raise wrong(f"the machine has no {ANALYSES[first].part or 'cam'}s")
    if given not in known:
        raise wrong(suggestion(given, known) if of else f"name one of {', '.join(known)}")


def _of_entry(machine: Machine, name: str, address: str) -> StudyResponse:
    try:
        value, mark = get(machine, address), kind(machine, address)
    except MachineError as error:
        remedy = error.problems[0].remedy or suggestion(address, addresses(machine))
        raise wrong(name, "entry", address, "the address of an entry", remedy) from None
    if not is_number(value):
        found = f"{address}, which is no number" if value is not None else f"{address}, which is not given"
        raise wrong(name, "entry", found, "the address of a number")
    return StudyResponse(name, ENTRY, (address,), address, address, mark.unit if mark else "")


def entry_number(machine: Machine, address: str) -> float:
    """A number of a machine; a `FindingError` if this machine has none there."""
    value = get(machine, address)
    if not is_number(value):
        raise FindingError(f"{address} has no number in this machine")
    return float(value)


def _of_element(machine: Machine, name: str, key: str, text: str, response: Response) -> StudyResponse:
    from linkwright.linkages.cycle import ElementMotion, elements_of

    element, _, quantity = text.removeprefix(f"{LINKAGE}.").rpartition(".")
    if response.curve is not None:
        raise wrong(name, key, f"{text}, which is a number", "a curve", f'write "{text}" alone')
    marks = {
        attribute: mark for attribute, (_, mark) in declared(ElementMotion).items() if isinstance(mark, Label)
    }
    if quantity not in marks:
        raise wrong(name, key, text, "a quantity of an element", suggestion(quantity, marks))
    elements = elements_of(machine)
    if element not in elements:
        raise wrong(name, key, text, f"{LINKAGE}.ELEMENT.{quantity}", suggestion(element, elements))
    word, unit = f"{marks[quantity].word} of {element}", marks[quantity].unit
    return StudyResponse(name, LINKAGE, (element,), quantity, word, unit, otherwise=response.otherwise)


def _of_cycle(machine: Machine, name: str, key: str, text: str, response: Response) -> StudyResponse:
    curve, _, extreme = text.removeprefix(f"{CYCLE}.").rpartition(".")
    if response.curve is not None:
        raise wrong(name, key, f"{text}, which is a number", "a curve", f'write "{text}" alone')
    if extreme not in ("minimum", "maximum"):
        raise wrong(name, key, text, f"{CYCLE}.CURVE.minimum or {CYCLE}.CURVE.maximum")
    known = curves_of(machine)
    if curve not in known:
        raise wrong(name, key, text, f"{CYCLE}.CURVE.{extreme}", suggestion(curve, known))
    word, unit = known[curve]
    return StudyResponse(
        name, CYCLE, (curve,), extreme, f"{extreme} {word}", unit, otherwise=response.otherwise
    )


def curves_of(machine: Machine) -> dict[str, tuple[str, str]]:
    """Curves of the motion over the cycle that have extremes: name → word and SI unit."""
    compiled, linkage = compile_machine(machine).first(), machine.linkage
    points = linkage.moving_points()
    known: dict[str, tuple[str, str]] = {}
    for name in linkage.slides():
        if name in compiled.slides:
            known |= _rates(f"{name}.place", f"of {name}", ("position", "velocity", "acceleration"), "m")
    for name in linkage.links():
        words = ("angle", "angular velocity", "angular acceleration")
        known |= _rates(f"{name}.angle", f"of {name}", words, "rad")
    for name in points:
        for axis in "xy":
            words = (axis, f"velocity along {axis}", f"acceleration along {axis}")
            known |= _rates(f"{name}.{axis}", f"of {name}", words, "m")
        if name not in compiled.slides:
            known[f"{name}.velocity"] = (f"speed of {name}", "m/s")
            known[f"{name}.acceleration"] = (f"acceleration of {name}", "m/s²")
    return known


def _rates(curve: str, of: str, words: tuple[str, str, str], unit: str) -> dict[str, tuple[str, str]]:
    endings = (("", unit), (".velocity", f"{unit}/s"), (".acceleration", f"{unit}/s²"))
    return {
        curve + ending: (f"{word} {of}", of_rate)
        for word, (ending, of_rate) in zip(words, endings, strict=True)
    }


def _of_pair(machine: Machine, name: str, key: str, text: str, response: Response) -> StudyResponse:
    pair = text.removeprefix(f"{PAIRS}.")
    if response.curve is not None:
        raise wrong(name, key, f"{text}, which is a number", "a curve", f'write "{text}" alone')
    # Which pairs there are does not depend on the motion.
    forces: Any = analysis("forces")(machine, speed=1.0, angles=np.array([0.0, 1.0]))
    if pair not in forces.pairs:
        raise wrong(name, key, text, f"{PAIRS}.PAIR", suggestion(pair, forces.pairs))
    return StudyResponse(name, "forces", (pair,), "reaction_max", f"maximum force of {pair}", "N")
