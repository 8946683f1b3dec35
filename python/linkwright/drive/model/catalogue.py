"""Catalogue of motors: facts as published, read from `motors.json` and given in SI.

The file keeps the figures and the units of its sources: ratios to the rated torque, speeds in rpm. The rated
torque is the printed one, or rated power over rated speed where none is printed.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, fields
from functools import cache
from typing import Any

from linkwright.kernel.description.base import suggestion, wrong
from linkwright.kernel.errors import MachineError, Problem, show

_RPM = 2 * math.pi / 60

# The only type of the catalogue whose inertia is printed: 0.138 kg m² at 107.7 N m (paper 1, worked case).
KNOWN = "4A160S6U3 (method 1)"

_EXPONENT = 5 / 3

# Torque over rated torque that every induction motor bears for 15 s without stalling: IEC 60034-1, 9.4.1.
OVERLOAD = 1.6

# Rated power up to [kW] → minimum torques at standstill and at pull-up, over the rated torque, of motors with
# four poles above 4 kW: IEC 60034-12, table of design N, which motors of standard series have.
_DESIGN_N = {6.3: (1.6, 1.1), 10: (1.6, 1.1), 16: (1.5, 1.1), 25: (1.4, 1.0), 40: (1.3, 1.0), 63: (1.2, 0.9)}
_DESIGN_N_ABOVE = 4.0

# Share of the synchronous speed at which the torque dips between standstill and breakdown: the saddle of the
# seventh harmonic of the field, which runs at a seventh of its speed (Fischer, Elektrische Maschinen,
# asynchronous torques of harmonics).
_SADDLE = 1 / 7

# Entries that a minimum by design N stands for, and that a file may give in its place.
START = ("torque_start", "torque_pull_up", "speed_pull_up")


@dataclass(frozen=True, slots=True)
class CatalogueMotor:
    """One type of motor; entries that the source does not give are None.

    Attributes
    ----------
    type, series, frame : str
        Name of the type; series; size of the frame.
    poles : int
        Number of poles.
    speed_synchronous, speed_rated, speed_breakdown : float
        Speeds of the shaft [rad/s].
    power_rated : float
        Rated power [W].
    torque_rated, torque_breakdown, torque_start : float
        Torques [N·m].
    inertia : float
        Moment of inertia of the rotor [kg·m²].
    efficiency : float
        At the rated point [–].
    mass : float
        Of the whole motor [kg].
    current_rated : float
        Rated current [A].
    kind : str
        ``"induction"``, ``"dc"``, or ``"servo"``: one that a controller keeps at its speed.
    speed_no_load, torque_stall : float
        Of a DC motor: speed of zero torque [rad/s], torque at standstill [N m].
    torque_max, speed_max : float
        That the motor may give or reach for a short time [N m, rad/s].
    """

    type: str
    series: str
    poles: int
    speed_synchronous: float | None
    power_rated: float
    speed_rated: float
    torque_rated: float
    frame: str | None = None
    speed_breakdown: float | None = None
    torque_breakdown: float | None = None
    torque_start: float | None = None
    inertia: float | None = None
    efficiency: float | None = None
    mass: float | None = None
    current_rated: float | None = None
    kind: str = "induction"
    speed_no_load: float | None = None
    torque_stall: float | None = None
    torque_max: float | None = None
    speed_max: float | None = None

    @property
    def breakdown(self) -> float | None:
        """Breakdown torque [N m]: as the source gives it, or `OVERLOAD`; None for kinds that have none."""
        if self.breakdown_is_minimum:
            return OVERLOAD * self.torque_rated
        return self.torque_breakdown

    @property
    def breakdown_is_minimum(self) -> bool:
        """Whether the source gives no breakdown torque, so that the minimum of standards counts."""
        return self.torque_breakdown is None and self.kind == "induction"

    @property
    def start_is_minimum(self) -> bool:
        """Whether the source gives no starting torque, so that the minimum of standards counts."""
        return self.torque_start is None and self._design_n is not None

    @property
    def start(self) -> dict[str, float]:
        """Torque at standstill and pull-up point where the minimum counts; empty if no source has them."""
        if self.torque_start is not None:
            return {"torque_start": self.torque_start}
        if self._design_n is None or self.speed_synchronous is None:
            return {}
        values = [share * self.torque_rated for share in self._design_n]
        return dict(zip(START, (*values, _SADDLE * self.speed_synchronous), strict=True))

    @property
    def _design_n(self) -> tuple[float, float] | None:
        power = self.power_rated / 1e3
        if self.kind != "induction" or self.poles != 4 or power <= _DESIGN_N_ABOVE:
            return None
        return next((torques for most, torques in _DESIGN_N.items() if power <= most), None)


def motors() -> tuple[CatalogueMotor, ...]:
    """All types of the catalogue, in its order.

    Returns
    -------
    tuple of CatalogueMotor
        In SI.
    """
    return tuple(_by_type().values())


def motor(type: str) -> CatalogueMotor:
    """One type of the catalogue.

    Parameters
    ----------
    type : str
        Its name, such as ``"4A160S6U3"``.

    Returns
    -------
    CatalogueMotor
        In SI.

    Raises
    ------
    MachineError
        There is no such type; the remedy names close ones.

    Examples
    --------
    >>> round(motor("4A160S6U3").torque_rated, 1)
    107.7
    """
    known = _by_type().get(type)
    if known is None:
        expected, remedy = "a type of the catalogue of motors", _like(type)
        raise MachineError([Problem(found=show(type), expected=expected, remedy=remedy)])
    return known


def _like(type: str) -> str:
    """Types that a name may stand for: of the number of poles that it gives, if it gives one."""
    known = _by_type()
    named = re.search(r"(\d+)[- ]?pole|^4A\d+[A-Z]+(\d+)", type)
    if named is None:
        return suggestion(type, known)
    poles = int(named[1] or named[2])
    alike = [name for name, one in known.items() if one.poles == poles]
    if not alike:
        numbers = ", ".join(str(n) for n in sorted({one.poles for one in known.values()}))
        return f"the catalogue has motors with {numbers} poles"
    power = re.search(r"(\d+(?:[.,]\d+)?) ?kW", type)
    wanted = float(power[1].replace(",", ".")) * 1e3 if power else None
    if wanted is not None and not any(known[name].power_rated == wanted for name in alike):
        near = sorted(alike, key=lambda name: (abs(known[name].power_rated - wanted), name))[:3]
        return "near are " + ", ".join(f'"{name}"' for name in near)
    same = [name for name in alike if wanted is None or known[name].power_rated == wanted]
    return suggestion(type, same) or "there is " + ", ".join(f'"{name}"' for name in same[:12])


def estimated_inertia(torque_rated: float) -> float:
    """Estimate the inertia of a rotor from the rated torque of its motor.

    J = J₁ (M_n/M_n₁)^(5/3): similar machines at equal shear stress in the air gap have torque as the cube of
    their size and inertia as its fifth power. It is an estimate: types of one frame share their diameter and
    differ in length, for which J grows as M only.

    `torque_rated`: M_n [N m]. Returns: J [kg m²], by similarity with `KNOWN`.

    >>> round(estimated_inertia(107.7), 3)
    0.138
    """
    like = motor(KNOWN)
    assert like.inertia is not None
    return float(like.inertia * (torque_rated / like.torque_rated) ** _EXPONENT)


def checked_name(type: str) -> str:
    """The name of a type, or the fault if there is no such type."""
    try:
        return motor(type).type
    except MachineError as error:
        problem = error.problems[0]
        raise wrong(problem.found, problem.expected, problem.remedy) from None


def entries(type: str) -> dict[str, Any]:
    """What the catalogue gives for the entries of a motor in a machine file. Returns: entry → value in SI.
    The rated torque is left out where it is only power over speed; a breakdown torque that the source does
    not give is the minimum of IEC 60034-1, a starting torque that of IEC 60034-12 for design N,
    the inertia of a rotor by similarity.
    """
    known = _given(_row(type))
    names = (
        "speed_synchronous",
        "power_rated",
        "speed_rated",
        "torque_rated",
        "speed_breakdown",
        "torque_breakdown",
        "torque_start",
        "inertia",
    )
    values = {name: known[name] for name in names if name in known}
    if motor(type).breakdown is not None:
        values["torque_breakdown"] = motor(type).breakdown
    values.setdefault("inertia", estimated_inertia(motor(type).torque_rated))
    return values | motor(type).start


@cache
def _rows() -> dict[str, dict[str, Any]]:
    import json
    import pkgutil

    data = pkgutil.get_data("linkwright.drive.model", "motors.json")
    assert data is not None, "motors.json is part of the package"
    return {row["type"]: row for row in json.loads(data)["motors"]}


def _row(type: str) -> dict[str, Any]:
    return _rows()[motor(type).type]


@cache
def _by_type() -> dict[str, CatalogueMotor]:
    return {type: _motor(row) for type, row in _rows().items()}


def _motor(row: dict[str, Any]) -> CatalogueMotor:
    known = _given(row)
    known.setdefault("torque_rated", known.get("power_rated", 0.0) / known["speed_rated"])
    known.setdefault("power_rated", known["torque_rated"] * known["speed_rated"])
    return CatalogueMotor(
        **{field.name: known[field.name] for field in fields(CatalogueMotor) if field.name in known}
    )


# Unit at the end of a key of the file → factor to SI. A ratio is one to the rated torque.
_FACTORS = {
    "_rpm": _RPM,
    "_rad_s": 1.0,
    "_kw": 1e3,
    "_nm": 1.0,
    "_kg_m2": 1.0,
    "_kg": 1.0,
    "_percent": 1e-2,
    "_a": 1.0,
}


def _given(row: dict[str, Any]) -> dict[str, Any]:
    """The entries of a row in SI, under the names of `CatalogueMotor`."""
    known: dict[str, Any] = {}
    for key, value in row.items():
        suffix = next((factor for factor in _FACTORS if key.endswith(factor)), None)
        if suffix is not None:
            known[key.removesuffix(suffix)] = value * _FACTORS[suffix]
        elif not key.endswith("_ratio"):
            known[key] = value
    torque = known.get("torque_rated") or known["power_rated"] / known["speed_rated"]
    ratios = {key.removesuffix("_ratio"): value for key, value in row.items() if key.endswith("_ratio")}
    return known | {name: value * torque for name, value in ratios.items()}
