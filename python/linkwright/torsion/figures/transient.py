"""Motion of a train in time: speeds of discs, torques in shafts, amplitudes over speed and order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.style import INK, LINES, SOFT, panels, styled, zero_line

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.torsion.in_time.transient import TorsionTransient
    from linkwright.torsion.in_time.waterfall import Waterfall

_RPM = 30 / np.pi

# Columns of a picture in which a motion of more samples is drawn as the band between its extremes.
_COLUMNS = 1200

# Shafts in one picture where nothing is said.
_SHAFTS = 4

# Decades of the amplitude that a waterfall shows; below it is paper.
_DECADES = 3.0


@styled
def transient_figure(
    motion: TorsionTransient,
    *,
    shafts: Sequence[str] = (),
    discs: Sequence[str] = (),
    marks: Sequence[tuple[float, str]] = (),
) -> Figure:
    """Draw the speeds of discs and the torques in shafts over time.

    `shafts`: by default those that swing most; `discs`: by default the first and the last; `marks`: times [s]
    with words, such as those of events.
    """
    shown = [motion.shafts.index(name) for name in shafts] or _loaded(motion)
    turning = [motion.discs.index(name) for name in discs] or [0, len(motion.discs) - 1]
    figure, axes = panels(1 + len(shown), height=1.9 + 1.35 * len(shown))
    for disc, colour in zip(dict.fromkeys(turning), LINES, strict=False):
        _curve(axes[0], motion.time, _RPM * motion.speed[disc], colour, motion.discs[disc])
    axes[0].set_ylabel("speed [rpm]")
    for panel, shaft, colour in zip(axes[1:], shown, (*LINES, INK), strict=False):
        _shaft(panel, motion, shaft, colour)
    for time, word in marks:
        for panel in axes:
            panel.axvline(time, color=INK, linewidth=0.9, linestyle=":")
        axes[0].annotate(
            word,
            (time, 1),
            xycoords=("data", "axes fraction"),
            xytext=(3, -9),
            textcoords="offset points",
            fontsize=8,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
        )
    legend_above(axes[0])
    axes[-1].set_xlim(float(motion.time[0]), float(motion.time[-1]))
    axes[-1].set_xlabel("time t [s]")
    return figure


@styled
def waterfall_figure(waterfall: Waterfall, *, quantity: str = "amplitude") -> Figure:
    """Draw amplitudes over order and speed, or over time where the speed comes and goes."""
    from matplotlib.colors import LogNorm

    figure, (axes,) = panels(1, height=4.4)
    rising = bool((np.diff(waterfall.speed) > 0).all())
    falling = bool((np.diff(waterfall.speed) < 0).all())
    up = _RPM * waterfall.speed if rising or falling else waterfall.time
    largest = float(waterfall.amplitudes.max()) or 1.0
    shade = axes.pcolormesh(
        waterfall.orders,
        up,
        np.clip(waterfall.amplitudes, largest * 10**-_DECADES, None),
        norm=LogNorm(largest * 10**-_DECADES, largest),
        cmap="magma_r",
        shading="nearest",
        rasterized=True,
    )
    # Powers of ten as numbers: a PDF shows the marks of mathematics as they are written.
    figure.colorbar(shade, ax=axes, label=quantity, pad=0.02, format=lambda value, _: f"{value:g}")
    step = float(waterfall.orders[0])
    axes.set_xlim(0.5 * step, float(waterfall.orders[-1]) + 0.5 * step)
    axes.set_ylim(float(up.min()), float(up.max()))
    axes.set_xlabel("order ν [–]")
    axes.set_ylabel("speed [rpm]" if rising or falling else "time t [s]")
    axes.grid(False)
    return figure


def _loaded(motion: TorsionTransient) -> list[int]:
    swing = motion.torque_max - motion.torque_min
    return sorted(np.argsort(-swing, kind="stable")[:_SHAFTS].tolist())


def _curve(axes: Axes, time: Floats, values: Floats, colour: str, label: str | None = None) -> None:
    """A line; of more samples than the picture has columns, the band between minimum and largest of each."""
    fold = len(time) // _COLUMNS
    if fold < 4:
        axes.plot(time, values, color=colour, label=label, linewidth=1.1)
        return
    n = len(time) // fold
    parts = values[: n * fold].reshape(n, fold)
    at = time[: n * fold].reshape(n, fold).mean(axis=1)
    axes.fill_between(at, parts.min(axis=1), parts.max(axis=1), color=colour, label=label, linewidth=0.6)


def _shaft(axes: Axes, motion: TorsionTransient, shaft: int, colour: str) -> None:
    _curve(axes, motion.time, 1e-3 * motion.torque[shaft], colour)
    for time, value in (
        (motion.torque_max_time[shaft], motion.torque_max[shaft]),
        (motion.torque_min_time[shaft], motion.torque_min[shaft]),
    ):
        axes.plot([time], [1e-3 * value], "o", color=INK, markersize=3.5)
    axes.set_ylabel(f"{motion.shafts[shaft]}\n[kN m]")
    axes.annotate(
        f"{1e-3 * motion.torque_min[shaft]:.4g} … {1e-3 * motion.torque_max[shaft]:.4g} kN m".replace(
            "-", "−"
        ),
        (1, 1),
        xycoords="axes fraction",
        xytext=(0, 2),
        textcoords="offset points",
        ha="right",
        fontsize=8,
        color=SOFT,
    )
    zero_line(axes)
