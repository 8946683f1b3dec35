"""The analyses of a train: all of its torsional vibration, and the parts that studies ask for."""

from __future__ import annotations

from operator import attrgetter

from linkwright.machine.analysis import Analysis, of
from linkwright.machine.machine import Machine


def _is_rotating(machine: Machine) -> bool:
    return machine.has_crank or machine.train is not None


TORSION = Analysis(
    name="torsion",
    words="Torsional vibration",
    lane="torsion",
    applies=_is_rotating,
    obstacle=of("drive.obstacles:no_shaft"),
    is_of_study=False,
    summary=of("torsion.modes.check:train_summary"),
)

FREE = Analysis(
    name="free_vibration",
    function=of("torsion.modes.free:free_vibration"),
    applies=attrgetter("twists"),
    is_of_study=False,
    check=of("torsion.modes.check:check_train"),
    tangents=of("torsion.gradient.modes:mode_derivatives"),
    many=of("torsion.response.many_trains:free_vibrations"),
)

DAMPED = Analysis(
    name="damped_vibration",
    function=of("torsion.modes.damped:damped_vibration"),
    applies=attrgetter("twists"),
    is_of_study=False,
    many=of("torsion.response.many_trains:damped_vibrations"),
)

FORCED = Analysis(
    name="forced_vibration",
    function=of("torsion.response.forced:forced_vibration"),
    applies=attrgetter("twists"),
    is_of_study=False,
    tangents=of("torsion.gradient.forced:forced_tangents"),
    many=of("torsion.response.many_trains:forced_vibrations"),
)

STRESS = Analysis(
    name="shaft_stress",
    function=of("torsion.response.stress:shaft_stress"),
    applies=attrgetter("twists"),
    is_of_study=False,
)
