"""What a pump card tells: plunger stroke, fluid load, fillage."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats

# Share of the extreme velocity from which on the plunger counts as moving.
_MOVING = 0.3

# Share of the samples, the nearest to their level, whose scatter counts: beside a sudden fall of the load its
# harmonics ring.
_COUNTED = 0.9


class PlungerLoad(NamedTuple):
    """Plunger stroke and load of a pump card."""

    stroke: float  # [m]
    fluid_load: float  # level of the upstroke over that of the downstroke [N]
    level: float  # load while the plunger sinks through the fluid [N]
    fillage: float  # share of the stroke left when half the fluid load has fallen
    unevenness: float  # mean square of the scatter about both levels, over the square of the fluid load


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
