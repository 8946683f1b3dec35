r"""Loads and stresses of the sections of a rod string, by the modified Goodman diagram of API.

.. math::

    S_{max} \le \left(\frac{T}{4} + 0.5625\,S_{min}\right) SF

with the stress range used over that which is permissible as the loading of the section. Stresses are those of
the effective tension at the top of a section: dynamic load and weight in the fluid below.

References
----------
.. [1] API RP 11BR, Recommended Practice for Care and Handling of Sucker Rods: modified Goodman diagram.
.. [2] Lubinski, Blenkarn, Buckling of Tubing in Pumping Wells, Trans. AIME 210 (1957) 73: effective tension.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.rods.model.rod_string import GRAVITY, RodString
from linkwright.rods.scalars import goodman, peak

_of = partial(Label, shape="(sections,)")


@dataclass(frozen=True)
class RodStress(Result):
    """Loads and stresses of the sections; NaN in the limits of one without a tensile strength."""

    sections: Annotated[tuple[str, ...], About("Size or diameter of each section.")]
    length: Annotated[Floats, _of("length", "L", "m")]
    load_max: Annotated[Floats, _of("maximum load at the top", "F_max", "N")]
    load_min: Annotated[Floats, _of("minimum load at the top", "F_min", "N")]
    load_bottom_min: Annotated[
        Floats,
        _of(
            *("minimum load at the lower end", "", "N"),
            "Effective tension: below zero the rods tend to buckle.",
        ),
    ]
    stress_max: Annotated[Floats, _of("maximum stress", "S_max", "Pa")]
    stress_min: Annotated[Floats, _of("minimum stress", "S_min", "Pa")]
    stress_permissible: Annotated[
        Floats, _of("permissible maximum stress", "S_A", "Pa", "At this minimum stress.")
    ]
    loading: Annotated[Floats, _of("stress range over the permissible range", "", "", "Goodman loading.")]
    tensile: Annotated[Floats, _of("minimum tensile strength", "T", "Pa")]

    @property
    def loading_max(self) -> Annotated[float | None, Label("maximum Goodman loading", "", "")]:
        """Of all sections with a tensile strength; None without any."""
        known = self.loading[np.isfinite(self.loading)]
        return float(known.max()) if len(known) else None


def weight_below(string: RodString) -> Floats:
    """Weight of the rods in the fluid below each station [N]."""
    columns = string.columns
    hung = GRAVITY * string.buoyancy_factor * columns.length * columns.mass
    return np.asarray(np.append(np.cumsum(hung[::-1])[::-1], 0.0))


def rod_stress(string: RodString, load: Floats) -> RodStress:
    """Of dynamic loads (stations, n) at the tops of sections and at the pump [N]."""
    columns, below = string.columns, weight_below(string)
    high, low = peak(load, +1) + below, peak(load, -1) + below
    largest, smallest = high[:-1] / columns.area, low[:-1] / columns.area
    tensile = np.array([np.nan if s.strength is None else s.strength for s in string.sections])
    limit, loading = goodman(string, tensile, largest, smallest)
    return RodStress(
        sections=tuple(f"{s.rod} in" if s.rod else f"{1e3 * s.body:.4g} mm" for s in string.sections),
        length=columns.length,
        load_max=high[:-1],
        load_min=low[:-1],
        load_bottom_min=low[1:],
        stress_max=largest,
        stress_min=smallest,
        stress_permissible=limit,
        loading=loading + 0 * tensile,
        tensile=tensile,
    )
