r"""Studies that size a part for the minimum cost: drive, cam, damper. Each is a study like any other.

| study | variables | kept within limits | minimum |
| --- | --- | --- | --- |
| `drive_study` | motor, gear ratio, flywheel | speed fluctuation, run-up, heating, overload | cost |
| `cam_study` | base circle, roller | pressure angle, contact pressure | prime circle |
| `damper_study` | ring, damping | stress or torque of a shaft over all speeds | ring |

A flywheel counts as a disc of radius r, :math:`m = 2J/r^2`.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from linkwright.drive.model.catalogue import CatalogueMotor, motors
from linkwright.kernel.errors import InputError
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units.kinds import ANGLE, LENGTH, PRESSURE, RATIO, TIME, TORQUE
from linkwright.kernel.units.marks import positive
from linkwright.machine.address import replace
from linkwright.machine.machine import Machine
from linkwright.sizing.flywheel import choose_flywheel
from linkwright.sizing.motor_change import rotor_inertia
from linkwright.sizing.power import required_power
from linkwright.studies.plan import StudyPlan
from linkwright.studies.read import new_study
from linkwright.torsion.model.train import Shaft
from linkwright.torsion.model.whole_train import RodShaft, whole_train
from linkwright.torsion.response.stress import stressed

# Motors of the catalogue that are considered, from the smallest with sufficient power on.
_MOTORS = 6

# Range of the ratio about rated over design speed, and of the flywheel about that of the present motor.
_RATIOS, _FLYWHEELS = (0.85, 1.15), (0.01, 4.0)

# Share of the breakdown torque that a motor may give in steady motion: 10 % less voltage leaves 81 % of it.
_OVERLOAD = 0.8

# Assumed prices: of a kilowatt of motor, of a kilogram of flywheel; and the radius of its disc [m].
_PER_KILOWATT, _PER_KILOGRAM, _RADIUS = 150.0, 1.5, 0.6

# How much larger than they are sizes of a cam and of a damper may become.
_LARGER = 5.0

# What a drive is judged by, beside its cost.
_OF_DRIVE: dict[str, Any] = {
    "delta": "steady_state.unevenness",
    "speed": "steady_state.speed_mean_time",
    "rms": "steady_state.torque_motor_rms",
    "peak": "steady_state.torque_motor_max",
    "power": {"entry": "drive.motor.power_rated"},
    "rated": {"entry": "drive.motor.torque_rated"},
    "breakdown": {"entry": "drive.motor.torque_breakdown"},
    "load": {"formula": "rms/rated"},
    "overload": {"formula": "peak/breakdown"},
}


def drive_study(
    machine: Machine,
    *,
    unevenness: float = 0.05,
    run_up_time: float | None = None,
    per_kilowatt: float = _PER_KILOWATT,
    per_kilogram: float = _PER_KILOGRAM,
    flywheel_radius: float = _RADIUS,
) -> StudyPlan:
    """A study of motor, gear ratio and flywheel for the minimum cost, for `optimise`.

    Permitted are `unevenness` δ [–] and the time of the run-up [s]; a motor is priced by its rated power, a
    flywheel by its mass as a disc of `flywheel_radius` [m]. Raises `InputError` without a design speed or a
    motor, or if no motor of the catalogue has the power.
    """
    prices = {
        "per_kilowatt": (per_kilowatt, positive(RATIO)),
        "per_kilogram": (per_kilogram, positive(RATIO)),
        "flywheel_radius": (flywheel_radius, positive(LENGTH)),
    }
    in_range(unevenness=(unevenness, positive(RATIO)), run_up_time=(run_up_time, positive(TIME)), **prices)
    need = required_power(machine)
    listed = _motors(machine, need.power)
    ratios = [motor.speed_rated / need.speed for motor in listed]
    inertia = choose_flywheel(machine, unevenness).inertia or 1.0
    fitted = replace(machine, {"drive.flywheel": {"inertia": inertia, "on": "crank"}})
    types = [
        {"kind": "induction", "catalogue": motor.type, "inertia": rotor_inertia(motor)[0]} for motor in listed
    ]
    fitted = replace(fitted, {"drive.motor": types[0]})
    limits: dict[str, Any] = {
        "delta": {"max": unevenness},
        "speed": {"min": 0.98 * need.speed},
        "load": {"max": 1.0},
        "overload": {"max": _OVERLOAD},
    }
    cost = f"{per_kilowatt!r}*power/1000 + {per_kilogram!r}*2*flywheel/{flywheel_radius!r}^2"
    responses: dict[str, Any] = {**_OF_DRIVE, "cost": {"formula": cost}}
    if run_up_time is not None:
        responses["start"], limits["start"] = "run_up.time", {"max": run_up_time}
    variables = {
        "motor": {"address": "drive.motor", "values": types},
        "ratio": {
            "address": "drive.gearbox.ratio",
            "range": [_RATIOS[0] * min(ratios), _RATIOS[1] * max(ratios)],
        },
        "flywheel": {
            "address": "drive.flywheel.inertia",
            "range": [share * inertia for share in _FLYWHEELS],
        },
    }
    return new_study(fitted, _tables(variables, responses, limits, "cost"))


def cam_study(
    machine: Machine,
    name: str | None = None,
    *,
    pressure_angle: float,
    contact_stress: float | None = None,
) -> StudyPlan:
    """A study of the smallest cam within its limits, for `optimise`; goal is the radius of its prime circle.

    Permitted are a pressure angle [rad] and a contact pressure [Pa], for which the roller varies too.
    Raises `InputError` where there is no such cam, base circle, or width and speed for a contact pressure.
    """
    in_range(
        pressure_angle=(pressure_angle, positive(ANGLE)), contact_stress=(contact_stress, positive(PRESSURE))
    )
    name = _one(name, machine.mechanism.cams, "cam")
    cam, address = machine.mechanism.cams[name], f"mechanism.cams.{name}"
    if cam.base_radius is None:
        raise InputError(f"{address}: found no base_radius, expected one: it is what becomes small")
    drive = machine.drive
    if contact_stress is not None and cam.width is None:
        raise InputError(f"{address}: found no width, expected one: contact pressure is that of a breadth")
    if contact_stress is not None and (drive is None or (drive.motor is None and drive.speed is None)):
        raise InputError(
            "drive.speed: found none, and no drive.motor, expected one of them: contact pressure is that of "
            "the forces at a speed; give it in the machine file"
        )
    variables = {"base": _about(f"{address}.base_radius", float(cam.base_radius))}
    # Without loads the pressure angle alone counts, which follows the prime circle whatever the roller is.
    with_roller = bool(contact_stress is not None and cam.is_roller and cam.roller_radius)
    if with_roller:
        variables["roller"] = _about(f"{address}.roller_radius", float(cam.roller_radius or 0.0))
    responses: dict[str, Any] = {
        "size": {"formula": "base + roller" if with_roller else "base"},
        "pressure_angle": f"cam.{name}.pressure_angle_max",
    }
    limits: dict[str, Any] = {"pressure_angle": {"max": pressure_angle}}
    if contact_stress is not None:
        responses["contact_stress"] = f"cam_force.{name}.pressure_max"
        limits["contact_stress"] = {"max": contact_stress}
    return new_study(machine, _tables(variables, responses, limits, "size"))


def damper_study(
    machine: Machine,
    name: str | None = None,
    *,
    shaft: str,
    stress: float | None = None,
    torque: float | None = None,
) -> StudyPlan:
    """A study of the smallest ring of a damper that keeps a shaft within its limit, for `optimise`.

    Permitted is a vibratory shear stress [Pa], of a shaft with a section, or a torque [N m]. Raises
    `InputError` where there is no such damper or shaft, or neither limit or both are given.
    """
    in_range(stress=(stress, positive(PRESSURE)), torque=(torque, positive(TORQUE)))
    train = machine.train
    name = _one(name, train.dampers if train else {}, "damper")
    assert train is not None
    shafts = whole_train(train).shafts
    shaft = _one(shaft, shafts, "shaft")
    if (stress is None) == (torque is None):
        raise InputError("stress, torque: found both or neither, expected one of them")
    damper, address = train.dampers[name], f"train.dampers.{name}"
    variables = {"ring": _about(f"{address}.ring_inertia", damper.ring_inertia)}
    for entry in ("damping", "stiffness"):
        if value := getattr(damper, entry):
            variables[entry] = _about(f"{address}.{entry}", value)
    responses: dict[str, Any] = {"size": {"formula": "ring"}}
    if stress is not None:
        known = stressed(shafts)
        if shaft not in known:
            words = (
                f'shaft: found "{shaft}", of which no section is known, expected one of {", ".join(known)}'
            )
            raise InputError(f"{words}; or limit its torque")
        responses |= _stress(shafts, shaft)
    else:
        responses["vibratory"] = f"forced_vibration.shaft_torque_vibratory.{shaft}"
    kept = {"stress": {"max": stress}} if stress is not None else {"vibratory": {"max": torque}}
    return new_study(machine, _tables(variables, responses, kept, "size"))


def _stress(shafts: dict[str, Shaft], name: str) -> dict[str, Any]:
    """Responses for the vibratory stress of a shaft: by its torque, whose derivatives are exact."""
    if isinstance(shafts[name], RodShaft):
        # Its weakest piece is not the same at all speeds.
        return {"stress": {"curve": f"shaft_stress.{name}.vibratory", "extreme": "max"}}
    section, limit = stressed(shafts)[name]
    factor = limit.concentration / section.section_modulus
    return {
        "vibratory": f"forced_vibration.shaft_torque_vibratory.{name}",
        "stress": {"formula": f"vibratory*{float(factor)!r}"},
    }


def _motors(machine: Machine, power: float) -> list[CatalogueMotor]:
    """The smallest motors of the catalogue with sufficient power, and of those poles that suit the ratio."""
    drive = machine.drive
    assert drive is not None
    assert drive.speed is not None
    suited = [motor for motor in motors() if motor.power_rated >= power]
    if not suited:
        raise InputError(f"{machine.name}: no motor of the catalogue has {power / 1e3:.4g} kW")
    wanted = drive.speed * drive.gearbox.ratio
    poles = min(suited, key=lambda motor: abs(motor.speed_rated - wanted)).poles
    # A motor whose data are worked out by several methods is one of a power.
    powers: dict[str, CatalogueMotor] = {}
    for motor in sorted(suited, key=lambda motor: -motor.power_rated):
        if motor.poles == poles:
            powers.setdefault(f"{motor.power_rated:.2g}", motor)
    return sorted(powers.values(), key=lambda motor: motor.power_rated)[:_MOTORS]


def _one(name: str | None, known: Collection[str], what: str) -> str:
    if name is None and len(known) == 1:
        return next(iter(known))
    if name is None or name not in known:
        if not known:
            raise InputError(f"the machine has no {what} to size")
        found = f'"{name}"' if name else "no name"
        raise InputError(f"{what}: found {found}, expected one of {', '.join(known)}")
    return name


def _about(address: str, value: float) -> dict[str, Any]:
    return {"address": address, "range": [value / _LARGER, value * _LARGER], "scale": "log"}


def _tables(
    variables: dict[str, Any], responses: dict[str, Any], limits: dict[str, Any], goal: str
) -> dict[str, Any]:
    return {
        "variables": variables,
        "responses": responses,
        "constraints": limits,
        "goals": {goal: "minimise"},
    }
