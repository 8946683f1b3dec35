r"""A driveline whose shafts twist, as a train.

Its stations stand in a row; what lies between two of them is rigid unless its stiffness is given:

| station | turns with | holds |
| --- | --- | --- |
| `motor` | the motor | rotor, half of the coupling, flywheel and brake on the motor shaft |
| `gearbox` | the motor | the other half of the coupling, the gearbox |
| `wheel` | the crankshaft | the gearbox's last wheel |
| `crank` | the crankshaft | flywheel and brake on the crankshaft, the mechanism |

`motor_shaft`, `gears` and `crankshaft` lie between them. Stations that nothing elastic parts, and that turn
alike, are one disc. The inertia of a gearbox, which catalogues give as a whole, may stand on either side of
rigid teeth, where it counts by the square of the ratio; it is put where a shaft ends. A motor of constant
speed holds its end of the train.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic_core import InitErrorDetails

from linkwright.drive.model.drive import Drive
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.kernel.description.base import fault
from linkwright.kernel.description.place import look
from linkwright.kernel.errors import MachineError, Problem
from linkwright.kernel.numerics.tangent import primal
from linkwright.torsion.model.drive_shaft import DriveShaft, LooseShaft
from linkwright.torsion.model.train import GROUND, Disc, Shaft, Train, TrainGear

MOTOR, GEARBOX, WHEEL, CRANK = "motor", "gearbox", "wheel", "crank"
MOTOR_SHAFT, GEARS, CRANKSHAFT = "motor_shaft", "gears", "crankshaft"

# Entries that make a driveline elastic, as a message names them.
STIFFNESS_KEYS = ("drive.motor_shaft.stiffness", "drive.gearbox.stiffness", "drive.crankshaft.stiffness")

# What a disc without inertia lacks.
_LACKS = {
    MOTOR: ("drive.motor.inertia", "the rotor at the end of a flexible shaft"),
    GEARBOX: ("drive.gearbox.inertia", "the gears at the end of a flexible shaft"),
    WHEEL: ("drive.gearbox.wheel_inertia", "the wheel between elastic gears and an elastic crankshaft"),
    CRANK: ("bodies", "the mechanism on the crankshaft"),
}

_REMEDY = "give it, however small, or omit the stiffness of one of the two adjacent parts"


def drive_train(drive: Drive, inertia: float) -> Train:
    """Discs, shafts and gears of a driveline. From the motor to the crank. `inertia`: [kg m²]."""
    _require_numbers(drive)
    at = _places(drive)
    discs: dict[str, float] = {}
    for station, J in station_inertias(drive, inertia).items():
        if at[station] != GROUND:
            discs[at[station]] = discs.get(at[station], 0.0) + J
    _require_inertia(discs)
    gears = {} if at[GEARBOX] in (at[WHEEL], GROUND) else {GEARS: _gears(drive, at)}
    return Train.model_construct(
        discs={name: Disc.model_construct(inertia=J) for name, J in discs.items()},
        shafts=_shafts(drive, at),
        gears=gears,
    )


def station_inertias(drive: Drive, inertia: float) -> dict[str, float]:
    """Inertias of the stations at their own speeds, together those of drive and mechanism [kg m²]."""
    share = _share_of_wheel(drive)
    J = {
        MOTOR: drive.motor.inertia if drive.motor else 0.0,
        GEARBOX: (1.0 - share) * drive.gearbox.inertia,
        WHEEL: _wheel(drive) + share * drive.gearbox.inertia * drive.gearbox.ratio**2,
        CRANK: inertia,
    }
    if drive.coupling is not None:
        J[MOTOR] += {None: 0.5, MOTOR: 1.0, GEARBOX: 0.0}[drive.coupling.beside] * drive.coupling.inertia
        J[GEARBOX] += {None: 0.5, MOTOR: 0.0, GEARBOX: 1.0}[drive.coupling.beside] * drive.coupling.inertia
    for part in (drive.flywheel, drive.brake):
        if part is not None and not (part.on == CRANK and part.beside == GEARBOX):
            J[part.beside or part.on] += part.inertia
    return J


def brake_disc(drive: Drive) -> str:
    """Disc on which the brake acts."""
    assert drive.brake is not None
    on = drive.brake.on
    return _places(drive)[
        WHEEL if on == CRANK and drive.brake.beside == GEARBOX else drive.brake.beside or on
    ]


def two_trains(machine: object) -> Iterator[InitErrorDetails]:
    """The fault of a file that describes a train beside a torsionally flexible driveline."""
    drive = look(machine, "drive")
    if look(machine, "train") is None:
        return
    for place in (("motor_shaft",), ("gearbox", "stiffness"), ("crankshaft",)):
        node = drive
        for key in place:
            node = look(node, key)
        if node is not None:
            remedy = "describe the driveline in [train], or leave [train] out"
            yield fault("drive", *place, found="one beside [train]", expected="one train", remedy=remedy)


def _wheel(drive: Drive) -> float:
    """What turns at the gearbox with the crankshaft [kg m²]."""
    parts = (drive.flywheel, drive.brake)
    beside = (part.inertia for part in parts if part and part.on == CRANK and part.beside == GEARBOX)
    return drive.gearbox.wheel_inertia + sum(beside)


def _share_of_wheel(drive: Drive) -> float:
    """Share of the gearbox's inertia that is put behind its rigid teeth, where a crankshaft ends."""
    if drive.crankshaft is None or drive.gearbox.stiffness is not None or _wheel(drive) > 0:
        return 0.0
    return 1.0 if drive.motor_shaft is None else 0.5


def _places(drive: Drive) -> dict[str, str]:
    held = isinstance(drive.motor, ConstantSpeedMotor)
    motor = GROUND if held else MOTOR
    gearbox = motor if drive.motor_shaft is None else GEARBOX
    if drive.motor_shaft is None and not held and _is_idle(drive):
        # Nothing in front of the gears: they only turn along.
        motor = gearbox = GEARBOX
    rigid = drive.gearbox.stiffness is None
    together = rigid and (drive.gearbox.ratio == 1.0 or gearbox == GROUND or motor == GEARBOX)
    if drive.crankshaft is None:
        return {MOTOR: motor, GEARBOX: CRANK if together else gearbox, WHEEL: CRANK, CRANK: CRANK}
    # Rigid gears behind a rigid motor shaft: the gearbox is what stands at the crankshaft.
    apart = GEARBOX if rigid and drive.motor_shaft is None else WHEEL
    return {MOTOR: motor, GEARBOX: gearbox, WHEEL: gearbox if together else apart, CRANK: CRANK}


def _is_idle(drive: Drive) -> bool:
    """Whether nothing with inertia turns with the motor, apart from a gearbox that counts at its wheel."""
    J = station_inertias(drive, 0.0)
    return drive.gearbox.stiffness is None and J[MOTOR] + J[GEARBOX] == 0


def _gears(drive: Drive, at: dict[str, str]) -> TrainGear:
    box = drive.gearbox
    return TrainGear.model_construct(
        between=(at[GEARBOX], at[WHEEL]),
        ratio=box.ratio,
        stiffness=box.stiffness,
        damping=box.damping,
        backlash=box.backlash,
    )


def _shafts(drive: Drive, at: dict[str, str]) -> dict[str, Shaft]:
    box, shafts = drive.gearbox, {}
    if drive.motor_shaft is not None:
        shafts[MOTOR_SHAFT] = _between(drive.motor_shaft, (at[MOTOR], at[GEARBOX]))
    if box.stiffness is not None and at[GEARBOX] == GROUND:
        # Teeth whose first side is held are a spring at the other.
        shafts[GEARS] = LooseShaft.model_construct(
            between=(GROUND, at[WHEEL]),
            stiffness=box.stiffness * box.ratio**2,
            damping=box.damping * box.ratio**2,
            backlash=box.backlash / box.ratio,
        )
    if drive.crankshaft is not None:
        shafts[CRANKSHAFT] = _between(drive.crankshaft, (at[WHEEL], at[CRANK]))
    return shafts


def _between(shaft: DriveShaft, ends: tuple[str, str]) -> Shaft:
    entries = {name: getattr(shaft, name) for name in DriveShaft.model_fields}
    if shaft.twist is not None:
        # What vibrates about rest twists by the slope there.
        entries["stiffness"] = shaft.rate
    return LooseShaft.model_construct(between=ends, **entries)


def _require_numbers(drive: Drive) -> None:
    entries: dict[str, Any] = {"drive.gearbox.ratio": drive.gearbox.ratio}
    if drive.gearbox.stiffness is not None:
        entries["drive.gearbox.stiffness"] = drive.gearbox.stiffness
    for key, shaft in ((MOTOR_SHAFT, drive.motor_shaft), (CRANKSHAFT, drive.crankshaft)):
        if shaft is not None and shaft.stiffness is not None:
            entries[f"drive.{key}.stiffness"] = shaft.stiffness
    wrong = [
        Problem(key, f"{value!r}", "one finite number above zero")
        for key, value in entries.items()
        if not isinstance(primal(value), int | float) or not 0 < value < float("inf")
    ]
    if wrong:
        raise MachineError(wrong)


def _require_inertia(discs: dict[str, float]) -> None:
    wrong = [
        Problem(key, f"{J:.6g} kg m²", f"an inertia above zero of {what}", _REMEDY)
        for (key, what), J in ((_LACKS[name], J) for name, J in discs.items())
        if not 0 < J < float("inf")
    ]
    if wrong:
        raise MachineError(wrong)
