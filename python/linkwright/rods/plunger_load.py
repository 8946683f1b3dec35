"""What a pump card tells: plunger stroke, fluid load, fillage; and the numbers of one card or of many."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, Generic, NamedTuple, TypeVar

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.quantities import Label
from linkwright.rods.card import SurfaceCard
from linkwright.rods.model.rod_string import RodString

# Share of the extreme velocity from which on the plunger counts as moving.
_MOVING = 0.3

# Share of the samples, the nearest to their level, whose scatter counts: beside a sudden fall of the load its
# harmonics ring.
_COUNTED = 0.9

# Fluid load of a pump card over that of a full column of fluid, beyond which it is no pump's.
_COLUMN = 1.75

# A number, or one of each of many cards.
N = TypeVar("N")


_of = partial(Label, shape="(names,)", table="diagnosis")


@dataclass(frozen=True)
class CardNumbers(Generic[N]):
    """What a measured card shows, or what each of many does."""

    period: Annotated[N, _of("period of a stroke", "T", "s")]
    stroke: Annotated[N, _of("stroke of the polished rod", "S", "m")]
    load_max: Annotated[N, _of("peak polished-rod load", "PPRL", "N", "Measured.")]
    load_min: Annotated[N, _of("minimum polished-rod load", "MPRL", "N", "Measured.")]
    plunger_stroke: Annotated[N, _of("plunger stroke", "S_p", "m", "Against the barrel.")]
    fillage: Annotated[
        N, _of("fillage", "f", "", "Share of the plunger stroke left when half the fluid load has fallen.")
    ]
    fluid_load: Annotated[N, _of("fluid load on the plunger", "F_o", "N", "By the pump card.")]
    production: Annotated[
        N, _of("production", "Q", "m³/s", "Fillage times plunger displacement.", usual="m^3/d")
    ]
    power_rod: Annotated[N, _of("power of the polished rod", "P_PR", "W")]
    power_pump: Annotated[N, _of("power of the pump", "P_p", "W", "Area of its card.")]


def card_numbers(
    string: RodString, card: SurfaceCard, period: float, pump: PlungerLoad, work: Floats
) -> dict[str, Any]:
    """Numbers of a card by its pump card; `work` (2,): of the string at polished rod and plunger [J]."""
    stroke = float(np.ptp(card.position))
    friction = 2 * string.stuffing_box * stroke
    return {
        "period": period,
        "stroke": stroke,
        "load_max": float(card.load.max()),
        "load_min": float(card.load.min()),
        "plunger_stroke": pump.stroke,
        "fillage": pump.fillage,
        "fluid_load": pump.fluid_load,
        "production": float(string.pump.area) * pump.fillage * pump.stroke / period,
        "power_rod": (float(work[0]) + friction) / period,
        "power_pump": float(work[1]) / period,
    }


class PlungerLoad(NamedTuple):
    """Plunger stroke and load of a pump card."""

    stroke: float  # [m]
    fluid_load: float  # level of the upstroke over that of the downstroke [N]
    level: float  # load while the plunger sinks through the fluid [N]
    fillage: float  # share of the stroke left when half the fluid load has fallen
    unevenness: float  # mean square of the scatter about both levels, over the square of the fluid load


def against_barrel(string: RodString, position: Floats, load: Floats) -> Floats:
    """Position of the plunger against the barrel, which moves with tubing that is not anchored."""
    return np.asarray(position - string.pump.tubing_compliance(string.length) * load)


def pump_of(string: RodString, position: Floats, load: Floats) -> PlungerLoad:
    """What a pump card tells; an error says why it is no card of the string's pump."""
    pump = plunger_load(against_barrel(string, position, load), load)
    if pump is None:
        raise no_pump_card()
    column = float(string.discharge * string.pump.area)
    if pump.fluid_load > _COLUMN * column:
        raise InputError(
            f"card: its pump card has a fluid load of {pump.fluid_load:.0f} N, a column of fluid from the "
            f"pump to the surface {column:.0f} N; compare period, units, plunger and sections, which are not "
            "those of the card"
        )
    return pump


def no_pump_card() -> FindingError:
    """The finding of a card without a pump that lifts."""
    return FindingError(
        "the pump card has no upstroke whose load is above that of the downstroke: the pump does not lift, "
        "or sections and card are of different wells"
    )


def plunger_load(position: Floats, load: Floats) -> PlungerLoad | None:
    """Of samples (n,) over a stroke; None where the load of the upstroke is not above that of the
    downstroke.
    """
    velocity = np.roll(position, -1) - np.roll(position, 1)
    up, down = velocity > _MOVING * velocity.max(), velocity < _MOVING * velocity.min()
    if not (up.any() and down.any()):
        return None
    high = float(np.median(load[up]))
    half = 0.5 * (high + float(load[down].min()))
    sinking = down & (load < half)
    if not sinking.any():
        return None
    low = float(np.median(load[sinking]))
    span = high - low
    if not span > 0:
        return None
    scatter = np.sort(np.concatenate([np.abs(load[up] - high), np.abs(load[sinking] - low)]))
    unevenness = float(np.square(scatter[: int(_COUNTED * len(scatter))]).mean()) / span**2
    fillage = _fillage(position, load, 0.5 * (high + low))
    return PlungerLoad(float(np.ptp(position)), span, low, fillage, unevenness)


def _fillage(position: Floats, load: Floats, half: float) -> float:
    """Share of the stroke that is left when the load falls through half the fluid load after the top."""
    top = int(position.argmax())
    p, f = np.roll(position, -top), np.roll(load, -top)
    bottom = int(p.argmin())
    falls = np.flatnonzero((f[:bottom] >= half) & (f[1 : bottom + 1] < half))
    if not len(falls):
        return 1.0
    i = int(falls[0])
    at = p[i] + (p[i + 1] - p[i]) * (f[i] - half) / (f[i] - f[i + 1])
    return float(np.clip((at - p.min()) / np.ptp(p), 0.0, 1.0))
