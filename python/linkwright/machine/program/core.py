"""The compiled core, of which a program is made; one that was built from other sources is refused."""

from __future__ import annotations

from operator import attrgetter

from linkwright import _core
from linkwright.kernel.errors import CoreError

# As `FORMAT` in `crates/linkwright-core/src/plan/mod.rs`: the two change together.
FORMAT = 30


def check_format(core: object) -> None:
    """Refuse a core that was built from other sources: a `CoreError` if its number differs or is missing."""
    number = getattr(core, "FORMAT", None)
    if number != FORMAT:
        raise CoreError(number, FORMAT, str(getattr(core, "__file__", "linkwright._core")))


check_format(_core)


def require(name: str) -> None:
    """Refuse a core without what came later than others of its format, by a `CoreError`."""
    try:
        attrgetter(name)(_core)
    except AttributeError:
        raise CoreError(FORMAT, FORMAT, f"{_core.__file__}: {name} is missing") from None


# What a program consists of, for those who read it.
Element = _core.Element
Line = _core.Line

# Outcomes of machines, and what each number means.
Status = _core.Status
SENTENCES: dict[int, str] = dict(_core.Status.sentences())

# Most revolutions and steps of a search for periodic motions, and most steps of the mesh of one.
SEARCH_TURNS_MAX = _core.SEARCH_TURNS_MAX
SEARCH_STEPS_MAX = _core.SEARCH_STEPS_MAX
MESH_STEPS_MAX = _core.MESH_STEPS_MAX

# What of a machine is asked for, and what the core answers.
Channel = _core.Channel
SteadyMotion = _core.SteadyMotion
SteadySolution = _core.SteadySolution
SteadyCurves = _core.SteadyCurves
SteadyGradient = _core.SteadyGradient
NoSteadyMotion = _core.NoSteadyMotion
DrivelineGradient = _core.DrivelineGradient
DrivelineMotion = _core.DrivelineMotion
DrivelineInTime = _core.DrivelineInTime
DrivelineRows = _core.DrivelineRows
NoDrivelineMotion = _core.NoDrivelineMotion
DrivelineTorque = _core.DrivelineTorque
DrivelineStation = _core.DrivelineStation
motion_at = _core.motion_at

# Systems of equations of one shape.
solve_systems = _core.solve_systems
