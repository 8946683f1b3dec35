"""``linkwright motors``: the motors of the catalogue."""

from __future__ import annotations

from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Json, option_value
from linkwright.kernel.command.parameter import Option

if TYPE_CHECKING:
    from linkwright.drive.model.catalogue import CatalogueMotor
    from linkwright.kernel.page.table import Row, Table

Poles = Annotated[
    int | None, Option("--poles", metavar="N", help="This number of poles alone.", show_default=False)
]
PowerMin = Annotated[
    str, Option("--power-min", metavar="POWER", help='Rated power at least, such as "5.5 kW".')
]
Series = Annotated[str, Option("--series", metavar="NAME", help="This series alone.", show_default=False)]


def motors(poles: Poles = None, power_min: PowerMin = "0 W", series: Series = "", json: Json = False) -> None:
    """List the motors of the catalogue.

    An inertia with ~ is estimated by similarity, since its source prints none; a dash is a number that
    the source does not give. A machine file takes one by drive.motor.catalogue.
    """
    found = _chosen(poles, power_min, series)
    hand_over(
        Answer(
            machine=None,
            results=lambda curves: {"motors": [_entries(each) for each in found]},
            tables=partial(_tables, found),
        ),
        json=json,
    )


def _chosen(poles: int | None, power_min: str, series: str) -> list[CatalogueMotor]:
    """The motors that are asked for, by power."""
    from linkwright.drive.model.catalogue import motors
    from linkwright.kernel.description.base import suggestion
    from linkwright.kernel.errors import InputError
    from linkwright.kernel.units import POWER

    power, known = option_value("--power-min", power_min, POWER), motors()
    names = list(dict.fromkeys(each.series for each in known))
    if series and series not in names:
        raise InputError(f'--series: there is no series "{series}": {suggestion(series, names)}')
    numbers = sorted({each.poles for each in known})
    if poles is not None and poles not in numbers:
        listed = ", ".join(map(str, numbers))
        raise InputError(f"--poles: found {poles}, the catalogue has motors with {listed} poles")
    found = [
        each
        for each in known
        if each.power_rated >= power and poles in (None, each.poles) and series in ("", each.series)
    ]
    if not found:
        raise InputError(f"no motor of the catalogue has {power:.6g} W or more and is as asked for")
    return sorted(found, key=lambda each: (each.poles, each.power_rated))


def _entries(motor: CatalogueMotor) -> dict[str, Any]:
    """All that is known of a motor, in SI, and its inertia if the source gives none."""
    from linkwright.sizing.inertia import rotor_inertia

    inertia, estimated = rotor_inertia(motor)
    return {**asdict(motor), "inertia": inertia, "inertia_is_estimated": estimated}


def _tables(found: list[CatalogueMotor]) -> list[Table]:
    from linkwright.kernel.page.table import Table

    heads = ("type", "", "poles", "power", "speed", "torque", "breakdown", "start", "inertia", "series")
    return [Table("motors", "Motors of the catalogue", heads, [_row(each) for each in found])]


def _row(motor: CatalogueMotor) -> Row:
    """A motor in the units of catalogues: kW, rpm, torques over the rated one."""
    from linkwright.kernel.page.numbers import number
    from linkwright.kernel.page.table import with_unit

    entries = _entries(motor)
    mark = "~" if entries["inertia_is_estimated"] else ""
    over = (
        "–" if torque is None else f"{number(torque / motor.torque_rated, 3)} ×"
        for torque in (motor.torque_breakdown, motor.torque_start)
    )
    return (
        motor.type,
        "",
        str(motor.poles),
        f"{number(motor.power_rated / 1000, 3)} kW",
        f"{number(motor.speed_rated * 9.549296585513721, 4)} rpm",
        with_unit(motor.torque_rated, "N m"),
        *over,
        f"{mark}{number(entries['inertia'], 3)} kg m²",
        motor.series,
    )
