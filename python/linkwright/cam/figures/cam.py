"""Figures of a cam over one revolution, its drawing with its follower, motion laws and their vibration."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from linkwright.cam.dynamics.loaded import LoadedCam
from linkwright.cam.profile.contact import CamCurve
from linkwright.cam.profile.profile import CamProfile, Flank
from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.style import (
    BLUE,
    GREEN,
    INK,
    LINES,
    MATH,
    RED,
    SOFT,
    legend_above,
    level,
    log_height,
    named,
    panels,
    roomy,
    styled,
    turn_axis,
    zero_line,
)
from linkwright.kernel.page.numbers import quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.cam.dynamics.residual_vibration import ResidualSpectrum
    from linkwright.cam.laws.motion_law import MotionLaw

# Value, words and colour of a line that is not to be passed.
Limit = tuple[float, str, str]

# A limit is drawn within so many times the largest value.
_FAR = 2.5

_ANGLE = "cam angle θ from the start of the programme [°]"

# Points of a curve between two joints of its law: chords of an eighth of a degree and finer cannot be seen.
_POINTS = 721


@styled
def lift_figure(profile: CamProfile) -> Figure:
    """Draw lift, velocity, acceleration and jerk over the cam angle θ."""
    figure, axes = panels(4, height=7.6)
    swings = profile.cam.is_oscillating
    scale, unit, letter = (180 / math.pi, "°", "ψ") if swings else (1e3, "mm", "s")
    curves = (profile.lift, profile.lift_d1, profile.lift_d2, profile.lift_d3)
    for order, (axis, curve) in enumerate(zip(axes, curves, strict=True)):
        x, y = _with_gaps(profile.angle, scale * curve)
        axis.plot(x, y, color=(BLUE, GREEN, RED, LINES[4])[order])
        per = ("", "/rad", "/rad²", "/rad³")[order]
        axis.set_ylabel(f"{letter}{'′' * order} [{unit}{per}]")
        roomy(axis, scale * curve)
        zero_line(axis)
        _joints(axis, profile)
        turn_axis(axis, label=False)
    axes[-1].set_xlabel(_ANGLE)
    figure.align_ylabels()
    return figure


@styled
def cam_figure(profile: CamProfile) -> Figure:
    """Draw the cam with its followers, as it stands where the programme begins."""
    parts = _parts(profile)
    figure, axes = panels(1, height=4.3 if len(parts) == 1 else 3.9, columns=len(parts), shared=False)
    for axis, flank in zip(axes, parts, strict=True):
        _draw_cam(axis, profile, flank)
        followers = (flank,) if profile.cam.closure == "conjugate" else profile.flanks
        for k, follower in enumerate(followers):
            _draw_follower(axis, follower, turned=follower.contact.turned if k else 0.0, first=k == 0)
        axis.set_aspect("equal", adjustable="datalim")
        axis.set_xlabel("x [mm]")
        if len(parts) > 1:
            axis.set_title(flank.contact.name, loc="left", pad=22)
    axes[0].set_ylabel("y [mm]")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=4, handlelength=1.8)
    return figure


@styled
def pressure_angle_figure(profile: CamProfile) -> Figure:
    """Draw the pressure angle of each contact with its limit."""
    figure, (axes,) = panels(1, height=2.9)
    limit, drawn = math.degrees(profile.cam.limit), []
    for k, flank in enumerate(profile.flanks):
        gamma = np.degrees(flank.shape.rows["pressure_angle"])
        x, y = _with_gaps(flank.shape.angle, gamma)
        axes.plot(x, y, color=LINES[k], label=flank.contact.name if len(profile.flanks) > 1 else None)
        for extreme in (flank.pressure_angle_max, flank.pressure_angle_min):
            axes.plot(np.degrees(extreme.angle), np.degrees(extreme.value), "o", color=LINES[k], markersize=4)
        drawn.append(gamma)
    level(axes, limit, f"limit ±{limit:.3g}°", RED)
    axes.axhline(-limit, color=RED, linewidth=1.1, linestyle=(0, (5, 3)))
    roomy(axes, *drawn, np.array([-limit, limit]))
    _joints(axes, profile)
    zero_line(axes)
    turn_axis(axes, label=False)
    axes.set_xlabel(_ANGLE)
    axes.set_ylabel("pressure angle γ [°]")
    legend_above(axes)
    return figure


@styled
def curvature_figure(profile: CamProfile) -> Figure:
    """Draw the curvature of the profile with what it may be."""
    figure, (axes,) = panels(1, height=2.9)
    drawn, parts = [], _parts(profile)
    for k, flank in enumerate(parts):
        with np.errstate(divide="ignore"):
            bend = 1e-3 / flank.curvature_radius
        # A sharp point bends without limit; what is beyond is not drawn.
        kept = np.where(np.abs(bend) < _most(profile), bend, np.nan)
        x, y = _with_gaps(flank.shape.angle, kept)
        axes.plot(x, y, color=LINES[k], label=flank.contact.name if len(parts) > 1 else None)
        drawn.append(kept[np.isfinite(kept)])
    limits = _near(_curvature_limits(profile), np.concatenate(drawn))
    for value, words, colour in limits:
        level(axes, value, words, colour)
    roomy(axes, *drawn, np.array([0.0, *(value for value, _, _ in limits)]))
    _joints(axes, profile)
    zero_line(axes)
    turn_axis(axes, label=False)
    axes.set_xlabel(_ANGLE)
    axes.set_ylabel("curvature 1/ρ [1/mm]")
    if axes.get_legend_handles_labels()[1]:
        legend_above(axes)
    return figure


@styled
def cam_force_figure(loaded: LoadedCam) -> Figure:
    """Draw the contact force, and the pressure by Hertz if there is one."""
    rows = 1 if loaded.pressure is None else 2
    figure, axes = panels(rows, height=2.7 * rows)
    angle = np.degrees(loaded.crank_angle)
    axes[0].plot(angle, loaded.force, color=BLUE)
    axes[0].set_ylabel("normal force N [N]")
    roomy(axes[0], loaded.force, np.zeros(1))
    zero_line(axes[0])
    if loaded.pressure is not None:
        axes[1].plot(angle, 1e-6 * loaded.pressure, color=RED)
        axes[1].set_ylabel("contact pressure [MPa]")
        axes[1].set_ylim(bottom=0)
    for axis in axes:
        turn_axis(axis, label=axis is axes[-1])
    return figure


# -- parts of the figures ------------------------------------------------------------------------------------


def _most(profile: CamProfile) -> float:
    """Curvature beyond which nothing is drawn [1/mm]."""
    return 100 / (1e3 * profile.base_radius)


def _curvature_limits(profile: CamProfile) -> list[Limit]:
    """Values [1/mm], words and colours of what the curvature may be."""
    cam, curvature_limits = profile.cam, []
    if cam.curvature_limit is not None:
        curvature_limits.append(
            (
                1e-3 / cam.curvature_limit,
                f"convex limit ρ = {quantity(cam.curvature_limit, 'm', usual='mm')}",
                RED,
            )
        )
    if cam.cutter_radius is not None and profile.curvature_radius_concave_min is not None:
        words = f"cutter of {quantity(cam.cutter_radius, 'm', usual='mm')} in hollow parts"
        curvature_limits.append((-1e-3 / cam.cutter_radius, words, LINES[3]))
    return curvature_limits


def _near(limits: list[Limit], drawn: Floats) -> list[Limit]:
    """Limits that do not press the curve flat; those far away are kept with ease."""
    reach = _FAR * float(np.abs(drawn).max(initial=0.0))
    return [limit for limit in limits if abs(limit[0]) <= reach]


def _with_gaps(angle: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Degrees and values, with a gap where an angle stands twice with two values."""
    same = np.diff(angle) <= 0
    size = float(np.nanmax(np.abs(values))) if len(values) else 0.0
    jumps = np.flatnonzero(same & (np.abs(np.diff(values)) > 1e-6 * size)) + 1
    return np.insert(np.degrees(angle), jumps, np.nan), np.insert(values, jumps, np.nan)


def _joints(axes: Axes, profile: CamProfile) -> None:
    """Vertical lines at segment boundaries."""
    for joint in profile.cam.programme.joints:
        axes.axvline(math.degrees(joint.angle), color=SOFT, linewidth=0.8, linestyle=(0, (1, 2)), zorder=0.5)


def _parts(profile: CamProfile) -> Sequence[Flank]:
    """One contact of each cam."""
    return profile.flanks if profile.cam.closure == "conjugate" else profile.flanks[:1]


def _course(curve: CamCurve) -> Floats:
    """Places along a curve, from joint to joint, (n, 2) [mm]."""
    course = []
    for low, high in zip(curve.breaks, curve.breaks[1:], strict=False):
        n = max(9, int(_POINTS * (high - low) / (2 * math.pi)))
        phi = np.linspace(low, high, n)
        course += [curve.points(phi[:-1]), curve.points(phi[-1:], "before")]
    return 1e3 * np.concatenate(course)


def _draw_cam(axes: Axes, profile: CamProfile, flank: Flank) -> None:
    """Outline, pitch curve, base circle, centre."""
    roller = flank.contact.sizes.roller_radius
    outline = _course(flank.curve())
    axes.fill(*outline.T, color=BLUE, alpha=0.1, linewidth=0)
    axes.plot(*outline.T, color=BLUE, label="profile")
    if profile.cam.closure == "groove":
        axes.plot(*_course(flank.curve(roller)).T, color=BLUE)
    if roller > 0:
        axes.plot(
            *_course(flank.curve(0.0)).T, color=GREEN, linewidth=1.1, linestyle="-.", label="pitch curve"
        )
    turn = np.linspace(0, 2 * math.pi, _POINTS)
    circle = 1e3 * flank.contact.sizes.base_radius * np.array([np.cos(turn), np.sin(turn)])
    axes.plot(*circle, color=SOFT, linewidth=1.0, linestyle=(0, (5, 3)), label="base circle")
    axes.plot(0, 0, "+", color=INK, markersize=9)


def _draw_follower(axes: Axes, flank: Flank, *, turned: float, first: bool) -> None:
    """Roller, edge or face at the start of the programme, in the frame of the cam's first contact."""
    rows = {name: float(values[0]) for name, values in flank.shape.rows.items()}
    cos, sin = math.cos(turned), math.sin(turned)
    turn = np.array([[cos, -sin], [sin, cos]])
    place = 1e3 * turn @ np.array([rows["pitch_x"], rows["pitch_y"]])
    label = "follower" if first else None
    if not flank.contact.kernel.is_roller:
        along = turn @ np.array([-rows["normal_y"], rows["normal_x"]])
        half = 1e3 * 0.6 * flank.contact.sizes.base_radius
        ends = np.array([place - half * along, place + half * along])
        axes.plot(*ends.T, color=RED, linewidth=2.4, label=label)
    elif flank.contact.sizes.roller_radius > 0:
        angle = np.linspace(0, 2 * math.pi, 181)
        radius = 1e3 * flank.contact.sizes.roller_radius
        axes.plot(
            place[0] + radius * np.cos(angle), place[1] + radius * np.sin(angle), color=RED, label=label
        )
        axes.plot(*place, ".", color=RED, markersize=4)
    else:
        axes.plot(*place, "o", color=RED, markersize=5, label=label)


# Where the colours begin again, the lines look different.
_DASHES = ("-", "--", "-.", ":")

# Points a piece of a law; a piece has few waves.
_LAW_POINTS = 120

_LABELS = ("lift f [–]", "velocity f′ [–]", "acceleration f″ [–]", "jerk f‴ [–]")


@styled
def motion_laws_figure(laws: Mapping[str, MotionLaw]) -> Figure:
    """Draw laws and their first three derivatives over their length."""
    figure, axes = panels(4, height=8.2)
    for n, (name, law) in enumerate(laws.items()):
        colour, dash = LINES[n % len(LINES)], _DASHES[n // len(LINES) % len(_DASHES)]
        for order, axis in enumerate(axes):
            x, y = _law_course(law, order)
            axis.plot(x, y, dash, color=colour, label=name)
    for axis, label in zip(axes, _LABELS, strict=True):
        axis.set_ylabel(label)
        zero_line(axis)
    axes[-1].set_xlabel("share z of the section [–]")
    # More names than fit into one line take a second.
    legend_above(axes[0])
    return figure


def _law_course(law: MotionLaw, order: int) -> tuple[list[float], list[float]]:
    """A derivative piece by piece, with the values on both sides of each break; rest at the outer ends."""
    derivative = law.derivative(order)
    u = np.linspace(0.0, 1.0, _LAW_POINTS)
    x, y = [law.start], [float(law.at(law.start)) if order == 0 else 0.0]
    for low, high, piece in zip(law.breaks, law.breaks[1:], derivative.pieces, strict=False):
        x += (low + (high - low) * u).tolist()
        y += piece.at(u).tolist()
    return [*x, law.end], [*y, y[-1] if order == 0 else 0.0]


@styled
def residual_figure(spectra: Mapping[str, ResidualSpectrum]) -> Figure:
    """Draw the vibration that rises leave behind, over the ratio of rise time and natural period."""
    figure, (left, during) = panels(2, height=4.6)
    for (name, spectrum), colour in zip(spectra.items(), LINES * len(spectra), strict=False):
        order = np.argsort(spectrum.ratio)
        left.plot(spectrum.ratio[order], spectrum.residual[order], color=colour, label=named(name))
        during.plot(spectrum.ratio[order], spectrum.primary_acceleration[order], color=colour)
    log_height(left)
    left.set_ylabel("amplitude left\nover the lift [–]")
    # What lies below a millionth of the lift is no motion that anybody measures.
    left.set_ylim(bottom=max(left.get_ylim()[0], 1e-6))
    legend_above(left)
    during.set_ylabel("largest acceleration\nin the rise $a\\,T^2/h$ [–]", **MATH)
    during.set_xlabel("rise time over natural period τ [–]")
    return figure
