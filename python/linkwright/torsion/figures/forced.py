"""Forced vibration of a train over its speeds: torques, stresses, amplitudes, heat; what a damper leaves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.style import (
    BLUE,
    INK,
    LINES,
    MARK_LETTERS,
    ORANGE,
    RED,
    SKY,
    SOFT,
    legend_above,
    level,
    named,
    panels,
    shortened,
    styled,
)

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
    """Speeds as turns a minute."""
    rpm: Floats = speeds * 30 / math.pi
    return rpm


def _over_speed(axes: Axes, speeds: Floats, label: str) -> None:
    """Limits and words of axes over the speed."""
    rpm = _rpm(speeds)
    axes.set_xlim(rpm[0], rpm[-1])
    axes.set_ylim(bottom=0)
    axes.set_ylabel(label)


@styled
def shaft_torques_figure(forced: ForcedVibration) -> Figure:
    """Draw the vibratory torque of the shafts over the speed. The shafts with the largest torques."""
    figure, (axes,) = panels(1, height=_HEIGHT)
    size = forced.shaft_torque_vibratory
    for s, colour in zip(_largest(size), LINES, strict=False):
        axes.plot(_rpm(forced.speeds), size[s] / 1e3, color=colour, label=named(forced.shafts[s]))
    _over_speed(axes, forced.speeds, "vibratory torque [kN m]")
    axes.set_xlabel("speed of the first disc [rpm]")
    legend_above(axes)
    return figure


@styled
def stress_figure(stress: ShaftStress, barred: Sequence[BarredRange] = ()) -> Figure:
    """Draw the vibratory stress of the shafts over the speed, and what they bear.

    Shafts of one limit share a panel; at most four panels.
    """
    groups: dict[bytes, list[int]] = {}
    for s in _largest(stress.vibratory, len(stress.shafts)):
        groups.setdefault(stress.continuous[s].tobytes(), []).append(s)
    shown = list(groups.values())[:4]
    figure, axes = panels(len(shown), height=0.4 + 2.3 * len(shown))
    for panel, shafts in zip(axes, shown, strict=True):
        for s, colour in zip(shafts[:_LINES_MAX], LINES, strict=False):
            rpm = _rpm(stress.speeds)
            panel.plot(rpm, stress.vibratory[s] / 1e6, color=colour, label=named(stress.shafts[s]))
        _limits(panel, stress, shafts[0])
        _over_speed(panel, stress.speeds, "stress [MPa]")
        names = [stress.shafts[s] for s in shafts]
        _bar(panel, [span.barred for span in barred if span.shaft in names])
        legend_above(panel)
    axes[-1].set_xlabel("speed of the first disc [rpm]")
    return figure


def _bar(axes: Axes, ranges: Sequence[tuple[float, float]]) -> None:
    """Shade ranges of speed, as far as they lie in view."""
    left, right = axes.get_xlim()
    for n, (low, high) in enumerate(ranges):
        ends = (max(low * 30 / math.pi, left), min(high * 30 / math.pi, right))
        axes.axvspan(*ends, color=RED, alpha=0.12, linewidth=0, label="" if n else "barred")


def _limits(axes: Axes, stress: ShaftStress, s: int) -> None:
    """Permitted in continuous operation, and in transient passage."""
    for limit, words, dashes in (
        (stress.continuous[s], "continuous operation", (5, 3)),
        (stress.transient[s], "transient passage", (2, 2)),
    ):
        if np.isfinite(limit).any():
            rpm = _rpm(stress.speeds)
            axes.plot(rpm, limit / 1e6, color=SOFT, linewidth=1.2, linestyle=(0, dashes), label=words)


@styled
def orders_figure(
    forced: ForcedVibration, single: Floats, total: Floats, label: str, factor: float = 1.0
) -> Figure:
    """Draw a vibration over the speed, order by order and all together.

    The largest orders by name, the others faint. `single`: (orders, speeds) amplitude of each order; `total`:
    (speeds,) all orders in phase.
    """
    figure, (axes,) = panels(1, height=_HEIGHT + 0.2)
    rpm = _rpm(forced.speeds)
    largest = _largest(single)
    for k in range(len(single)):
        if k not in largest:
            axes.plot(rpm, single[k] * factor, color="#c3c9d0", linewidth=0.8)
    for k, colour in zip(largest, LINES, strict=False):
        axes.plot(rpm, single[k] * factor, color=colour, linewidth=1.3, label=f"order {forced.orders[k]:.4g}")
    axes.plot(rpm, total * factor, color=INK, linewidth=2.0, label="all orders")
    _over_speed(axes, forced.speeds, label)
    axes.set_xlabel("speed of the first disc [rpm]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=1.6)
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
    _over_speed(over, forced.speeds, "speed fluctuation δ")
    over.set_xlabel("speed of the first disc [rpm]")
    legend_above(over)
    return figure


@styled
def gear_figure(meshes: MeshTorque) -> Figure:
    """Draw the torque of the gear stages over the speed, its mean with what the vibration adds and takes."""
    known = [s for s in range(len(meshes.stages)) if np.isfinite(meshes.vibratory[s]).any()][:_LINES_MAX]
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


@styled
def overlay_figure(one: Overlay) -> Figure:
    """Draw a measured curve over the computed one."""
    figure, (axes,) = panels(1, height=_HEIGHT)
    unit, factor = _SHOWN[one.what]
    axes.plot(_rpm(one.run_speeds), one.run_computed * factor, color=BLUE, label="computed")
    axes.plot(_rpm(one.speeds), one.measured * factor, "o", color=RED, markersize=3.5, label="measured")
    if one.permitted is not None:
        rpm = _rpm(one.speeds)
        axes.plot(
            rpm, one.permitted * factor, color=SOFT, linestyle=(0, (5, 3)), label="continuous operation"
        )
    _over_speed(axes, one.run_speeds, f"{one.what} [{unit}]")
    axes.set_xlabel("speed of the first disc [rpm]")
    legend_above(axes)
    return figure


# Units in which measured quantities are drawn.
_SHOWN = {"stress": ("MPa", 1e-6), "torque": ("kN m", 1e-3), "angle": ("°", 180 / math.pi)}


@styled
def heat_figure(forced: ForcedVibration, parts: list[str]) -> Figure:
    """Draw the heat of dampers and couplings over the speed."""
    figure, (axes,) = panels(1, height=_HEIGHT)
    for name, colour in zip(parts, LINES, strict=False):
        axes.plot(
            _rpm(forced.speeds), forced.shaft_heat[forced.shafts.index(name)], color=colour, label=named(name)
        )
    _over_speed(axes, forced.speeds, "heat [W]")
    axes.set_xlabel("speed of the first disc [rpm]")
    legend_above(axes)
    return figure


def _largest(rows: Floats, count: int = _LINES_MAX) -> list[int]:
    """Rows with the largest values, in their order."""
    # A row that is nowhere finite has a resonance that nothing damps: it stays.
    size = np.nan_to_num(rows, nan=0.0, posinf=np.finfo(float).max).max(axis=1)
    return sorted(np.argsort(-size, kind="stable")[:count].tolist())


# Height of the picture over the best damper's peak: the resonance without damping has no end.
_TOP = 3.0


@styled
def damper_figure(design: DamperDesign) -> Figure:
    """Draw the twist of the watched shaft over the frequency, without damper and with it."""
    figure, (axes,) = panels(1, height=3.2)
    lines = (
        (design.response_bare, SOFT, "without damper"),
        (design.response_rule, RED, "mode alone"),
        (design.response_best, BLUE, "best"),
    )
    for response, colour, label in lines:
        axes.plot(design.frequencies, response, color=colour, label=label)
    level(axes, design.magnification, "promised")
    axes.set_ylim(0, _TOP * max(design.magnification_best, design.magnification))
    axes.set_xlim(design.frequencies[0], design.frequencies[-1])
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel(f"twist of {design.watched}\nover that at rest [–]")
    legend_above(axes)
    return figure
