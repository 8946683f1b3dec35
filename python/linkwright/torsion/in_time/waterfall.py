r"""Amplitudes over speed and order: the short-time Fourier transform of a motion over the angle of one of
its discs.

A motion that speeds up is no periodic one, but over a few revolutions it nearly is. A window of N revolutions
slides over it, and in each the signal x is taken over the angle φ of the disc, not over time, so that orders
stay where they are while the speed changes,

.. math:: A_\nu = \frac{2}{\int w\,d\varphi} \left|\int w(\varphi)\,\bigl(x - \bar x\bigr)\,
    e^{-i\nu\varphi}\,d\varphi\right|

with Hann's window w. It tells apart orders that differ by 2/N; a line between two orders is not an amplitude.

References
----------
.. [1] Harris, On the use of windows for harmonic analysis, Proc. IEEE 66 (1978) 51-83: Hann's window.
.. [2] Fyfe and Munck, Analysis of computed order tracking, Mech. Syst. Signal Process. 11 (1997) 187-205:
resampling over the angle.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import number
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import COUNT
from linkwright.kernel.units.marks import positive

# Samples of the angle in a wave of the highest order: cubics between them err by a thousandth.
_A_WAVE = 16

# A window starts a quarter of its length after the one before.
_HOPS = 4


@dataclass(frozen=True)
class Waterfall(Result):
    """Amplitudes over speed and order."""

    time: Annotated[Floats, Label("time", "t", "s", "In the middle of each window.", shape="(windows,)")]
    speed: Annotated[Floats, Label("mean speed of the disc", "ω", "rad/s", "In each window.")]
    orders: Annotated[
        Floats, Label("excitation order of the disc", "ν", "", shape="(orders,)", over="orders")
    ]
    amplitudes: Annotated[
        Floats,
        Label("amplitude of each order", "", "", "In the unit of the signal.", shape="(windows, orders)"),
    ]
    turns: Annotated[int, Label("revolutions of a window", "", "")]

    def order(self, wanted: float) -> Floats:
        """Amplitudes of the order nearest to the wanted one, (windows,), in the unit of the signal."""
        amplitudes: Floats = self.amplitudes[:, int(np.abs(self.orders - number("order", wanted)).argmin())]
        return amplitudes


@public
def waterfall(
    time: ArrayLike,
    angle: ArrayLike,
    signal: ArrayLike,
    *,
    highest: float = 12.0,
    step: float = 0.5,
    turns: int = 8,
) -> Waterfall:
    """Amplitudes of a motion over speed and order.

    Parameters
    ----------
    time : array_like, shape (n,)
        Increasing [s].
    angle : array_like, shape (n,)
        Of the disc whose turns count, increasing [rad].
    signal : array_like, shape (n,)
        Speed of a disc, torque of a shaft, or anything else.
    highest, step : float
        Last order, and from one to the next.
    turns : int
        Of a window, at least two over the step.

    Returns
    -------
    Waterfall
        Windows follow each other by a quarter of their length.

    Raises
    ------
    InputError
        The disc does not turn forward all the time or not far enough, or samples are too few for the highest
        order.
    """
    t, phi, x = (np.asarray(values, dtype=float) for values in (time, angle, signal))
    _require(t, phi, x, highest, step, turns)
    window = 2 * np.pi * turns
    n = int(np.ceil(_A_WAVE * max(highest, 1.0) * turns))
    hop = window / _HOPS
    starts = phi[0] + hop * np.arange(int((phi[-1] - phi[0] - window) / hop + 1e-9) + 1)
    share = (np.arange(n) + 0.5) / n
    orders: Floats = step * np.arange(1.0, round(highest / step) + 1)
    weight = 1 - np.cos(2 * np.pi * share)
    waves = np.exp(-1j * window * np.outer(share, orders)) * weight[:, None] * (2 / weight.sum())
    places = starts[:, None] + window * share
    over_angle = _cubic(phi, x, places)
    mean = (over_angle * weight).sum(axis=1, keepdims=True) / weight.sum()
    begin, end = (np.interp(starts + shift, phi, t) for shift in (0.0, window))
    return Waterfall(
        time=0.5 * (begin + end),
        speed=window / (end - begin),
        orders=orders,
        amplitudes=np.abs((over_angle - mean) @ waves),
        turns=turns,
    )


def _require(t: Floats, phi: Floats, x: Floats, highest: float, step: float, turns: int) -> None:
    if not (t.ndim == 1 and t.shape == phi.shape == x.shape and len(t) > 3):
        raise InputError(
            f"time, angle and signal have shapes {t.shape}, {phi.shape}, {x.shape}: expected lists of one "
            "length"
        )
    in_range(highest=(highest, positive(COUNT)), step=(step, positive(COUNT)))
    if step > highest:
        raise InputError(f"orders up to {highest:g} in steps of {step:g}: expected 0 < step ≤ highest")
    if turns < 2 / step - 1e-9:
        raise InputError(
            f"turns: found {turns}, expected at least {2 / step:g}, to tell apart steps of {step:g}"
        )
    advance = np.diff(phi)
    if not (np.diff(t) > 0).all() or not (advance > 0).all():
        raise InputError(
            "a waterfall needs a disc that always rotates forward; select such a part of the motion"
        )
    if phi[-1] - phi[0] < 2 * np.pi * turns:
        done = (phi[-1] - phi[0]) / (2 * np.pi)
        raise InputError(
            f"turns: found a motion of {done:.4g} revolutions, expected {turns} or more for a window"
        )
    # Four samples a wave are the minimum from which a cubic finds its amplitude to a few per cent.
    if advance.max() * highest > 0.5 * np.pi:
        most = 0.5 * np.pi / advance.max()
        raise InputError(
            f"highest: found order {highest:g}, expected {most:.3g} at most with these samples; sample the "
            "motion more finely: sample_time"
        )


def _cubic(x: Floats, y: Floats, places: Floats) -> Floats:
    k = np.clip(np.searchsorted(x, places) - 2, 0, len(x) - 4)
    near = [x[k + n] for n in range(4)]
    values = np.zeros_like(places)
    for n in range(4):
        weight = np.ones_like(places)
        for m in range(4):
            if m != n:
                weight *= (places - near[m]) / (near[n] - near[m])
        values += weight * y[k + n]
    return values
