"""Numbers of a rod string in motion, by formulas that take numbers, arrays of many strings, or derivatives.

A valve that opens or shuts makes a corner in the load, between two samples: the lines of both its sides meet
there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, Generic, TypeVar

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import primal
from linkwright.kernel.quantities import Label
from linkwright.rods.core import Cards
from linkwright.rods.model.rod_string import GRAVITY, RodString

# Samples of the cards beside a peak through which the lines of its sides go, beyond those between which a
# corner is rounded; by what that may seem more, where harmonics end.
_NEAR, _FAR, _RINGING = 3, 5, 1.2

# A number, or one of each of many strings.
N = TypeVar("N")


_of = partial(Label, table="rod_string")


@dataclass(frozen=True)
class StringNumbers(Generic[N]):
    """Loads, strokes, production and powers of a predicted string, or of many."""

    period: Annotated[N, _of("period of a stroke", "T", "s", over="period")]
    stroke: Annotated[N, _of("stroke of the polished rod", "S", "m")]
    plunger_stroke: Annotated[
        N,
        _of(
            *("effective plunger stroke", "S_p", "m"),
            "Against the barrel, which moves with tubing that is not anchored.",
        ),
    ]
    load_max: Annotated[N, _of("peak polished-rod load", "PPRL", "N")]
    load_min: Annotated[N, _of("minimum polished-rod load", "MPRL", "N")]
    production: Annotated[N, _of("production", "Q", "m³/s", "Liquid, at discharge pressure.", usual="m^3/d")]
    weight_air: Annotated[N, _of("weight of the rods in air", "W_r", "N")]
    weight_fluid: Annotated[N, _of("weight of the rods in the fluid", "W_rf", "N")]
    fluid_load: Annotated[N, _of("fluid load on the plunger", "F_o", "N")]
    stretch: Annotated[N, _of("stretch of the rods by the fluid load", "F_o/k_r", "m", "Static.")]
    power_rod: Annotated[N, _of("power of the polished rod", "P_PR", "W")]
    power_pump: Annotated[N, _of("power of the pump", "P_p", "W", "Area of its card.")]
    power_damping: Annotated[N, _of("power lost to damping", "P_c", "W")]
    power_hydraulic: Annotated[N, _of("hydraulic power", "P_h", "W", "Production times pressure rise.")]
    plunger_travel: Annotated[N, Label("travel of the plunger", "", "m", "Against the casing.")]


def string_scalars(
    string: RodString, stroke: Any, period: Any, cards: Cards, mean_load: Any, moved: Floats
) -> dict[str, Any]:
    """Loads, strokes, production and powers of strings by their cards.

    ``moved``: position of the polished rod at the samples of the cards, (…, n) [m].
    """
    pump, load = string.pump, cards.load
    weight, fluid_load = string.weight_fluid, string.fluid_load
    direction = np.sign(np.roll(moved, -1, axis=-1) - np.roll(moved, 1, axis=-1))
    rod = load[..., 0, :] + along_curve(string.stuffing_box) * direction
    plunger = cards.position[..., -1, :]
    barrel = along_curve(pump.tubing_compliance(string.length)) * load[..., -1, :]
    plunger_stroke = span(plunger - barrel)
    # Liquid is sold at discharge pressure, to which the plunger compresses it.
    rise = string.discharge - string.intake
    leaked = pump.leak * mean_load / fluid_load
    lifted = pump.area * pump.fillage * plunger_stroke * (1 - rise / pump.bulk_modulus) / period - leaked
    production = np.where(primal(lifted) > 0, lifted, 0.0 * lifted)
    friction = 2 * string.stuffing_box * stroke
    return {
        "period": period,
        "stroke": stroke,
        "plunger_stroke": plunger_stroke,
        "plunger_travel": span(plunger),
        "load_max": peak(rod, +1) + weight,
        "load_min": peak(rod, -1) + weight,
        "weight_air": string.weight_air,
        "weight_fluid": weight,
        "fluid_load": fluid_load,
        "stretch": fluid_load / string.stiffness,
        "production": production,
        "power_rod": (cards.work[..., 0] + friction) / period,
        "power_pump": cards.work[..., -1] / period,
        "power_damping": cards.loss.sum(-1) / period,
        "power_hydraulic": production * rise,
    }


def goodman_loadings(string: RodString, load: Any) -> dict[int, Any]:
    """Stress range over the permissible range of each section with a strength, by loads (…, stations, n)."""
    below: Any = string.weight_fluid
    found = {}
    for n, section in enumerate(string.sections):
        if section.strength is not None:
            high, low = (peak(load[..., n, :], sign) + below for sign in (+1, -1))
            found[n] = goodman(string, section.strength, high / section.area, low / section.area)[1]
        below = below - GRAVITY * string.buoyancy_factor * section.length * section.mass
    return found


def permissible(string: RodString, tensile: Any, low: Any) -> Any:
    """Permissible maximum stress beside a minimum stress [Pa]."""
    return (tensile / 4 + 0.5625 * low) * string.service_factor


def goodman(string: RodString, tensile: Any, high: Any, low: Any) -> tuple[Any, Any]:
    """Permissible maximum stress, and the loading; without bound beyond what any range permits."""
    limit = permissible(string, tensile, low)
    room = limit - low
    is_none = primal(room) <= 0
    loading = (high - low) / np.where(is_none, 1.0, room)
    return limit, np.where(is_none, np.inf, loading)


def peak(load: Any, sign: int) -> Any:
    """Maximum (+1) or minimum (−1) over the last axis of loads at twice the samples of their waves.

    A valve that opens or shuts makes a corner, which a chord between two samples of the waves cuts off. The
    lines of both its sides, of slopes a and −b, meet at most 2ab/(a + b) above the higher of these samples;
    what seems to be higher is beside a jump. Where a corner moves, loads follow its entries with a jump:
    derivatives beside it are those of its sides, and the corner has its own by both.
    """
    top = (sign * primal(load)).argmax(axis=-1)
    steps = (-_FAR, -_NEAR, 0, _NEAR, _FAR)
    left_end, left, highest, right, right_end = (_picked(load, top + step) for step in steps)
    rise, fall = ((pair[1] - pair[0]) / (_FAR - _NEAR) for pair in ((left_end, left), (right, right_end)))
    is_corner = (sign * primal(rise) > 0) & (sign * primal(fall) < 0)
    bend = np.where(is_corner, rise - fall, 1.0)
    place = (right - left - _NEAR * (rise + fall)) / bend
    height = left + rise * (place + _NEAR)
    above, most = sign * primal(height - highest), sign * primal(-rise * fall * 2 / bend)
    is_corner = is_corner & (np.abs(primal(place)) <= 2) & (above <= _RINGING * most)
    return np.where(is_corner, height, highest)


def extreme(curve: Any, sign: int) -> Any:
    """Maximum (+1) or minimum (−1) over the last axis."""
    return _picked(curve, (sign * primal(curve)).argmax(axis=-1))


def _picked(curve: Any, at: Any) -> Any:
    """The sample of each curve at a place, counted round the period."""
    at = at % curve.shape[-1]
    if curve.ndim == 1:
        return curve[int(at)]
    return np.take_along_axis(curve, at[..., None], axis=-1)[..., 0]


def span(curve: Any) -> Any:
    """Maximum less minimum over the last axis."""
    return extreme(curve, +1) - extreme(curve, -1)


def along_curve(number: Any) -> Any:
    """A number, or one of each string, beside curves (…, n)."""
    return number[..., None] if isinstance(number, np.ndarray) and number.ndim else number
