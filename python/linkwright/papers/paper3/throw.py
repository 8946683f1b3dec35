"""Formulas (16) and (17) of paper 3: inertia and compliance of a throw from its geometry."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from linkwright.papers.paper3.engine import Shift, TrialEngine
from linkwright.torsion.model.engine.throw import CrankThrow
from linkwright.torsion.model.engine.throw_compliance import compliances, restraint_length
from linkwright.torsion.model.engine.throw_inertia import published_inertia

_NAMES = {
    "constrained": "(17), k by Castigliano",
    "free": "(17), k → ∞",
    "carter": "Carter",
    "ker_wilson": "Ker Wilson",
    "zimanenko": "Zimanenko",
}


def throw_checks(trial: TrialEngine) -> dict[str, Any]:
    """(16), rebuilt, over the exact inertia, less one [–]; k of (17) [m]; stiffness by formula [N m/rad]."""
    throw = trial.engine.throw
    assert throw is not None
    stiffness = {_NAMES[name]: 1 / each for name, each in compliances(throw).items()}
    return {
        "inertia": published_inertia(throw) / trial.own - 1,
        "restraint": throw.restraint_length or restraint_length(throw),
        "stiffness": stiffness,
        "shifts": tuple(_shifts(trial, throw, stiffness)),
    }


def _shifts(trial: TrialEngine, throw: CrankThrow, stiffness: dict[str, float]) -> Iterator[Shift]:
    """The train with (16), and with each stiffness but that of the machine file."""
    disc = trial.inertia + published_inertia(throw) - trial.own
    yield trial.with_inertia("(16), drillings taken as parallel to the shaft", disc)
    for name, value in stiffness.items():
        if name != _NAMES[trial.engine.stiffness_formula]:
            yield trial.with_stiffness(name, value)
