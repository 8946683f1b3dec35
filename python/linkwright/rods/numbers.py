r"""Terms of API RP 11L beside the computed motion.

.. math::

    N_o = \frac{60\,a}{4L}\;\text{per min}, \qquad F_c = \frac{N_o'}{N_o},

with N_o′ the lowest natural frequency of the tapered string, fixed at the polished rod and free at the pump.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, cast

import numpy as np

from linkwright.kernel.numerics.implicit import solution_along
from linkwright.kernel.numerics.tangent import Tangent, primal
from linkwright.kernel.numerics.zeros import zero
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.rods.model.rod_string import RodString

_of = partial(Label, table="rod_numbers")


@dataclass(frozen=True)
class ApiNumbers(Result):
    """Dimensionless terms of a pumping installation by API RP 11L."""

    speed: Annotated[float, _of("pumping speed", "N", "Hz", "Strokes per time.", usual="1/min")]
    natural_frequency: Annotated[
        float, _of("natural frequency of a uniform string", "N_o", "Hz", "a/(4L).", usual="1/min")
    ]
    natural_frequency_tapered: Annotated[
        float, _of("natural frequency of the tapered string", "N_o′", "Hz", usual="1/min")
    ]
    frequency_factor: Annotated[float, _of("frequency factor", "F_c", "", "N_o′/N_o.")]
    spring_rate: Annotated[float, _of("spring rate of the string", "k_r", "N/m")]
    stroke_force: Annotated[
        float,
        _of("force that stretches the rods by the stroke", "S k_r", "N", "Stroke times spring rate."),
    ]
    load_ratio: Annotated[float, _of("fluid load", "F_o/Sk_r", "", "Over S k_r.")]
    speed_ratio: Annotated[float, _of("speed", "N/N_o", "")]
    speed_ratio_tapered: Annotated[float, _of("speed by the tapered string", "N/N_o′", "")]
    stroke_ratio: Annotated[float, _of("plunger stroke", "S_p/S", "")]
    peak_ratio: Annotated[float, _of("peak load", "F_1/Sk_r", "", "PPRL − W_rf over S k_r.")]
    minimum_ratio: Annotated[float, _of("minimum load", "F_2/Sk_r", "", "W_rf − MPRL over S k_r.")]
    torque_ratio: Annotated[
        float | None,
        _of(
            *("peak torque of the gearbox", "2T/S²k_r", ""),
            "With the best counterbalance; None without a pumping unit.",
        ),
    ]
    counterbalance_effect: Annotated[
        float, _of("counterbalance effect by API RP 11L", "CBE", "N", "1.06 (W_rf + F_o/2).")
    ]


def api_numbers(string: RodString, scalars: Mapping[str, Any], torque: Any) -> ApiNumbers:
    """The terms of a motion by its scalars and the peak torque of the gearbox [N m]."""
    rounded = {
        name: None if x is None else float(x) for name, x in api_terms(string, scalars, torque).items()
    }
    return ApiNumbers(**cast(Any, rounded))


def api_terms(string: RodString, scalars: Mapping[str, Any], torque: Any = None) -> dict[str, Any]:
    """The terms as numbers, or with derivatives."""
    uniform = string.sound / (4 * string.length)
    tapered = natural_frequency(string)
    stroke, period, weight = (scalars[name] for name in ("stroke", "period", "weight_fluid"))
    force = stroke * string.stiffness
    return {
        "speed": 1 / period,
        "natural_frequency": uniform,
        "natural_frequency_tapered": tapered,
        "frequency_factor": tapered / uniform,
        "spring_rate": string.stiffness,
        "stroke_force": force,
        "load_ratio": string.fluid_load / force,
        "speed_ratio": 1 / (period * uniform),
        "speed_ratio_tapered": 1 / (period * tapered),
        "stroke_ratio": scalars["plunger_stroke"] / stroke,
        "peak_ratio": (scalars["load_max"] - weight) / force,
        "minimum_ratio": (weight - scalars["load_min"]) / force,
        "torque_ratio": None if torque is None else 2 * torque / (stroke * force),
        "counterbalance_effect": 1.06 * (weight + 0.5 * string.fluid_load),
    }


def natural_frequency(string: RodString) -> Any:
    """Lowest natural frequency without damping, fixed at the top and free at the pump [Hz]."""
    sections = [(s.length, s.modulus * s.area, s.mass) for s in string.sections]
    plain = [tuple(map(primal, section)) for section in sections]

    def free_load(omega: Any, sections: Any = plain) -> Any:
        """Load at the pump for a load of one at the polished rod, which stands still."""
        position, load = 0.0, 1.0
        for length, rigidity, mass in sections:
            k = omega * np.sqrt(mass / rigidity)
            cos, sin = np.cos(k * length), np.sin(k * length)
            position, load = (
                position * cos - load * sin / (rigidity * k),
                position * rigidity * k * sin + load * cos,
            )
        return load

    # That of any taper lies between none and the second one of the uniform string.
    omega = np.linspace(1e-3, 3.0, 301) * 2 * np.pi * float(primal(string.sound / (4 * string.length)))
    first = int(np.argmax(free_load(omega) <= 0))
    found = zero(lambda at: float(free_load(at)), float(omega[first - 1]), float(omega[first]))
    slope = free_load(Tangent(found, np.ones(1))).d[0]
    return solution_along(found, free_load(found, sections), slope) / (2 * np.pi)
