"""Forced vibration of a train over its speeds: torques, stresses, amplitudes, heat; what a damper leaves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.lines import Level, Line, Panel, dashed, line_figure
from linkwright.kernel.figure.style import (
    BLUE,
    INK,
    LINES,
    MARK_LETTERS,
    ORANGE,
    RED,
    SKY,
    SOFT,
    named,
    panels,
    shortened,
    styled,
)
from linkwright.torsion.excitation.harmonics import line_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.torsion.damper.damper_design import DamperDesign
    from linkwright.torsion.limits.barred_range import BarredRange
    from linkwright.torsion.limits.overlay import Overlay
    from linkwright.torsion.response.forced import ForcedVibration
    from linkwright.torsion.response.mesh_torque import MeshTorque
    from linkwright.torsion.response.stress import ShaftStress

# Lines that can be distinguished in one panel.
_LINES_MAX = len(LINES)

_HEIGHT = 2.7


def _rpm(speeds: Floats) -> Floats:
    rpm: Floats = speeds * 30 / math.pi
    return rpm


def _over_speed(speeds: Floats, *drawn: Panel, height: float = _HEIGHT) -> Figure:
    figure = line_figure(_rpm(speeds), *drawn, height=height, over="speed of the first disc [rpm]")
    for axes in figure.axes:
        axes.set_ylim(bottom=0)
    return figure


@styled
def shaft_torques_figure(forced: ForcedVibration) -> Figure:
    """Draw the vibratory torque of the shafts over the speed. The shafts with the largest torques."""
    size = forced.shaft_torque_vibratory
    drawn = zip(_largest(size), LINES, strict=False)
    lines = [Line(size[s] / 1e3, colour, named(forced.shafts[s])) for s, colour in drawn]
    return _over_speed(forced.speeds, Panel("vibratory torque [kN m]", lines, room=None))


@styled
def stress_figure(stress: ShaftStress, barred: Sequence[BarredRange] = ()) -> Figure:
    """Draw vibratory and permitted stress over the speed; a panel for each limit, at most four."""
    groups: dict[bytes, list[int]] = {}
    for s in _largest(stress.vibratory, len(stress.shafts)):
        groups.setdefault(stress.continuous[s].tobytes(), []).append(s)
    shown = list(groups.values())[:4]
    drawn = []
    for shafts in shown:
        coloured = zip(shafts[:_LINES_MAX], LINES, strict=False)
        lines = [Line(stress.vibratory[s] / 1e6, colour, named(stress.shafts[s])) for s, colour in coloured]
        drawn.append(Panel("stress [MPa]", [*lines, *_limits(stress, shafts[0])], room=None))
    figure = _over_speed(stress.speeds, *drawn, height=0.4 + 2.3 * len(shown))
    for axes, shafts in zip(figure.axes, shown, strict=True):
        names = [stress.shafts[s] for s in shafts]
        _bar(axes, [span.barred for span in barred if span.shaft in names])
        legend_above(axes)
    return figure


def _bar(axes: Axes, ranges: Sequence[tuple[float, float]]) -> None:
    left, right = axes.get_xlim()
    for n, (low, high) in enumerate(ranges):
        ends = (max(low * 30 / math.pi, left), min(high * 30 / math.pi, right))
        axes.axvspan(*ends, color=RED, alpha=0.12, linewidth=0, label="" if n else "barred")


def _limits(stress: ShaftStress, s: int) -> Iterator[Line]:
    for limit, words, dashes in (
        (stress.continuous[s], "continuous operation", (5, 3)),
        (stress.transient[s], "transient passage", (2, 2)),
    ):
        if np.isfinite(limit).any():
            yield dashed(limit / 1e6, words, dashes, linewidth=1.2)


@styled
def orders_figure(
    forced: ForcedVibration, single: Floats, total: Floats, label: str, factor: float = 1.0
) -> Figure:
    """Draw a vibration over the speed, order by order and all together.

    The largest orders by name, the others faint. `single`: (orders, speeds) amplitude of each order; `total`:
    (speeds,) all orders in phase.
    """
    largest = _largest(single)
    faint = [
        Line(row * factor, "#c3c9d0", style={"linewidth": 0.8})
        for k, row in enumerate(single)
        if k not in largest
    ]
    named_orders = [
        Line(single[k] * factor, colour, name, style={"linewidth": 1.3})
        for k, colour in zip(largest, LINES, strict=False)
        for name in (line_name(forced.orders[k], forced.offsets[k]),)
    ]
    every = Line(total * factor, INK, "all orders", style={"linewidth": 2.0})
    panel = Panel(label, [*faint, *named_orders, every], room=None)
    figure = _over_speed(forced.speeds, panel, height=_HEIGHT + 0.2)
    figure.axes[0].legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=1.6)
    return figure


@styled
def torsion_unevenness_figure(forced: ForcedVibration, row: list[int], speed: float) -> Figure:
    """Draw the speed fluctuation along the train, and over the speed.

    Above along the train: all, as a whole, torsional; below over the speed at a few discs. `speed`: [rad/s].
    """
    figure, (along, over) = panels(2, height=5.0, shared=False)
    at = int(np.argmin(np.abs(forced.speeds - speed)))
    x = np.arange(len(forced.discs))
    parts = (
        (forced.unevenness, "in all", BLUE),
        (forced.unevenness_rigid, "rigid-body rotation", ORANGE),
        (forced.unevenness_torsional, "torsional part", SKY),
    )
    for n, (values, words, colour) in enumerate(parts):
        along.bar(x + 0.27 * (n - 1), values[row, at], width=0.25, color=colour, label=words)
    turned = 30 if len(x) > 6 or max(map(len, forced.discs)) > 9 else 0
    names = [shortened(forced.discs[d], MARK_LETTERS) for d in row]
    along.set_xticks(x, names, rotation=turned, ha="right" if turned else "center")
    along.set_ylabel(f"δ at {_rpm(forced.speeds)[at]:.0f} rpm")
    along.grid(visible=False, axis="x")
    legend_above(along)
    shown = dict.fromkeys([0, int(forced.unevenness[:, at].argmax()), int(forced.unevenness[:, at].argmin())])
    for d, colour in zip(shown, (BLUE, RED, LINES[2]), strict=False):
        over.plot(_rpm(forced.speeds), forced.unevenness[d], color=colour, label=named(forced.discs[d]))
    rigid = forced.unevenness_rigid[0]
    over.plot(_rpm(forced.speeds), rigid, color=SOFT, linestyle=(0, (5, 3)), label="rigid-body rotation")
    over.set_xlim(_rpm(forced.speeds)[0], _rpm(forced.speeds)[-1])
    over.set_ylim(bottom=0)
    over.set_ylabel("speed fluctuation δ")
    over.set_xlabel("speed of the first disc [rpm]")
    legend_above(over)
    return figure


@styled
def gear_figure(meshes: MeshTorque) -> Figure:
    """Draw the torque of the gear stages over the speed, its mean with what the vibration adds and takes."""
    known = _unequal([s for s in range(len(meshes.stages)) if np.isfinite(meshes.vibratory[s]).any()], meshes)
    known = known[:_LINES_MAX]
    figure, axes = panels(len(known), height=0.6 + 1.7 * len(known))
    for panel, s in zip(axes, known, strict=True):
        sense = -1.0 if meshes.mean[s].sum() < 0 else 1.0
        low, high = sorted(
            (sense * meshes.least[s], sense * meshes.greatest[s]), key=lambda row: float(np.nansum(row))
        )
        rpm = _rpm(meshes.speeds)
        panel.fill_between(
            rpm, low / 1e3, high / 1e3, color=SKY, alpha=0.45, linewidth=0, label="mean and vibration"
        )
        panel.plot(rpm, sense * meshes.mean[s] / 1e3, color=BLUE, label="mean")
        panel.axhline(0, color=RED, linewidth=0.9)
        panel.set_xlim(rpm[0], rpm[-1])
        panel.set_ylabel(f"{named(meshes.stages[s])}\n[kN m]")
        legend_above(panel)
    axes[-1].set_xlabel("speed of the first disc [rpm]")
    return figure


def _unequal(stages: list[int], meshes: MeshTorque) -> list[int]:
    """Stages that do not carry what one before them does, as the meshes of equal planets do."""
    curves = {s: np.concatenate([meshes.mean[s], meshes.greatest[s], meshes.least[s]]) for s in stages}
    kept: list[int] = []
    for s in stages:
        if not any(np.allclose(curves[s], curves[t], rtol=_EQUAL, equal_nan=True) for t in kept):
            kept.append(s)
    return kept


@styled
def overlay_figure(one: Overlay) -> Figure:
    """Draw a measured curve over the computed one."""
    unit, factor = _SHOWN[one.what]
    lines = [
        Line(one.run_computed * factor, BLUE, "computed"),
        Line(one.measured * factor, RED, "measured", _rpm(one.speeds), "o", {"markersize": 3.5}),
    ]
    if one.permitted is not None:
        lines.append(dashed(one.permitted * factor, "continuous operation")._replace(x=_rpm(one.speeds)))
    return _over_speed(one.run_speeds, Panel(f"{one.what} [{unit}]", lines, room=None))


# Share by which torques of stages that are one differ at most: rounding.
_EQUAL = 1e-9

# Units in which measured quantities are drawn.
_SHOWN = {"stress": ("MPa", 1e-6), "torque": ("kN m", 1e-3), "angle": ("°", 180 / math.pi)}


@styled
def heat_figure(forced: ForcedVibration, parts: list[str]) -> Figure:
    """Draw the heat of dampers and couplings over the speed."""
    heat = {name: forced.shaft_heat[forced.shafts.index(name)] for name in parts}
    lines = [Line(heat[name], colour, named(name)) for name, colour in zip(parts, LINES, strict=False)]
    return _over_speed(forced.speeds, Panel("heat [W]", lines, room=None))


def _largest(rows: Floats, count: int = _LINES_MAX) -> list[int]:
    # A row that is nowhere finite has a resonance that nothing damps: it stays.
    size = np.nan_to_num(rows, nan=0.0, posinf=np.finfo(float).max).max(axis=1)
    return sorted(np.argsort(-size, kind="stable")[:count].tolist())


# Height of the picture over the best damper's peak: the resonance without damping has no end.
_TOP = 3.0


@styled
def damper_figure(design: DamperDesign) -> Figure:
    """Draw the twist of the watched shaft over the frequency, without damper and with it."""
    lines: list[Line | Level] = [
        Line(design.response_bare, SOFT, "without damper"),
        Line(design.response_rule, RED, "mode alone"),
        Line(design.response_best, BLUE, "best"),
        Level(design.magnification, "promised"),
    ]
    panel = Panel(f"twist of {design.watched}\nover that at rest [–]", lines, room=None)
    figure = line_figure(design.frequencies, panel, height=3.2, over="frequency [Hz]")
    figure.axes[0].set_ylim(0, _TOP * max(design.magnification_best, design.magnification))
    return figure
