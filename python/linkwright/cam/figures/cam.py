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
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.lines import Level, Line, Panel, line_figure
from linkwright.kernel.figure.style import (
    BLUE,
    GREEN,
    INK,
    LINES,
    MATH,
    RED,
    SOFT,
    log_height,
    named,
    panels,
    styled,
)
from linkwright.kernel.reader.numbers import quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.cam.dynamics.residual_vibration import ResidualSpectrum
    from linkwright.cam.laws.motion_law import MotionLaw

# A limit is drawn within so many times the largest value.
_FAR = 2.5

_REVOLUTION = np.array([0.0, 360.0])
_ANGLE = "cam angle θ from the start of the programme [°]"

# Points of a curve between two joints of its law: chords of an eighth of a degree and finer cannot be seen.
_POINTS = 721


@styled
def lift_figure(profile: CamProfile) -> Figure:
    """Draw lift, velocity, acceleration and jerk over the cam angle θ."""
    scale, unit, letter = (180 / math.pi, "°", "ψ") if profile.cam.is_oscillating else (1e3, "mm", "s")
    drawn = []
    for order, curve in enumerate((profile.lift, profile.lift_d1, profile.lift_d2, profile.lift_d3)):
        x, y = _with_gaps(profile.angle, scale * curve)
        per = ("", "/rad", "/rad²", "/rad³")[order]
        line = Line(y, (BLUE, GREEN, RED, LINES[4])[order], x=x)
        drawn.append(Panel(f"{letter}{'′' * order} [{unit}{per}]", [line]))
    figure = _over_cam(profile, *drawn, height=7.6)
    figure.align_ylabels()
    return figure


def _over_cam(profile: CamProfile, *drawn: Panel, height: float) -> Figure:
    """Panels over one revolution of the cam, with vertical lines at segment boundaries."""
    figure = line_figure(_REVOLUTION, *drawn, height=height, over=_ANGLE)
    for axes in figure.axes:
        for joint in profile.cam.programme.joints:
            at = math.degrees(joint.angle)
            axes.axvline(at, color=SOFT, linewidth=0.8, linestyle=(0, (1, 2)), zorder=0.5)
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
    limit, lines = math.degrees(profile.cam.limit), []
    for flank, colour in zip(profile.flanks, LINES, strict=False):
        x, y = _with_gaps(flank.shape.angle, np.degrees(flank.shape.rows["pressure_angle"]))
        lines.append(Line(y, colour, flank.contact.name if len(profile.flanks) > 1 else "", x))
        for extreme in (flank.pressure_angle_max, flank.pressure_angle_min):
            at, value = np.degrees([extreme.angle, extreme.value])
            lines.append(Line(np.array([value]), colour, x=np.array([at]), form="o", style={"markersize": 4}))
    limits = [Level(limit, f"limit ±{limit:.3g}°", RED), Level(-limit, "", RED)]
    panel = Panel("pressure angle γ [°]", [*lines, *limits], room=(-limit, limit))
    return _over_cam(profile, panel, height=2.9)


@styled
def curvature_figure(profile: CamProfile) -> Figure:
    """Draw the curvature of the profile with what it may be."""
    lines, parts = [], _parts(profile)
    for flank, colour in zip(parts, LINES, strict=False):
        with np.errstate(divide="ignore"):
            bend = 1e-3 / flank.curvature_radius
        # A sharp point bends without limit; what is beyond is not drawn.
        kept = np.where(np.abs(bend) < _most(profile), bend, np.nan)
        x, y = _with_gaps(flank.shape.angle, kept)
        lines.append(Line(y, colour, flank.contact.name if len(parts) > 1 else "", x))
    drawn = np.concatenate([line.y for line in lines])
    limits = _near(_curvature_limits(profile), drawn[np.isfinite(drawn)])
    room = (0.0, *(limit.height for limit in limits))
    return _over_cam(profile, Panel("curvature 1/ρ [1/mm]", [*lines, *limits], room), height=2.9)


@styled
def cam_force_figure(loaded: LoadedCam) -> Figure:
    """Draw the contact force, and the pressure by Hertz if there is one."""
    drawn = [Panel("normal force N [N]", [Line(loaded.force, BLUE)], room=(0.0,))]
    if loaded.pressure is not None:
        drawn.append(Panel("contact pressure [MPa]", [Line(1e-6 * loaded.pressure, RED)], room=None))
    figure = line_figure(np.degrees(loaded.crank_angle), *drawn, height=2.7 * len(drawn))
    for axes in figure.axes[1:]:
        axes.set_ylim(bottom=0)
    return figure


# -- parts of the figures ------------------------------------------------------------------------------------


def _most(profile: CamProfile) -> float:
    """Curvature beyond which nothing is drawn [1/mm]."""
    return 100 / (1e3 * profile.base_radius)


def _curvature_limits(profile: CamProfile) -> list[Level]:
    """What the curvature may be [1/mm]."""
    cam, limits = profile.cam, []
    if cam.curvature_limit is not None:
        words = f"convex limit ρ = {quantity(cam.curvature_limit, 'm', usual='mm')}"
        limits.append(Level(1e-3 / cam.curvature_limit, words, RED))
    if cam.cutter_radius is not None and profile.curvature_radius_concave_min is not None:
        words = f"cutter of {quantity(cam.cutter_radius, 'm', usual='mm')} in hollow parts"
        limits.append(Level(-1e-3 / cam.cutter_radius, words, LINES[3]))
    return limits


def _near(limits: list[Level], drawn: Floats) -> list[Level]:
    """Limits that do not flatten the curve; those far away are easily kept."""
    reach = _FAR * float(np.abs(drawn).max(initial=0.0))
    return [limit for limit in limits if abs(limit.height) <= reach]


def _with_gaps(angle: Floats, values: Floats) -> tuple[Floats, Floats]:
    same = np.diff(angle) <= 0
    size = float(np.nanmax(np.abs(values))) if len(values) else 0.0
    jumps = np.flatnonzero(same & (np.abs(np.diff(values)) > 1e-6 * size)) + 1
    return np.insert(np.degrees(angle), jumps, np.nan), np.insert(values, jumps, np.nan)


def _parts(profile: CamProfile) -> Sequence[Flank]:
    return profile.flanks if profile.cam.closure == "conjugate" else profile.flanks[:1]


def _course(curve: CamCurve) -> Floats:
    course = []
    for low, high in zip(curve.breaks, curve.breaks[1:], strict=False):
        n = max(9, int(_POINTS * (high - low) / (2 * math.pi)))
        phi = np.linspace(low, high, n)
        course += [curve.points(phi[:-1]), curve.points(phi[-1:], "before")]
    return 1e3 * np.concatenate(course)


def _draw_cam(axes: Axes, profile: CamProfile, flank: Flank) -> None:
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
    drawn = []
    for order, label in enumerate(_LABELS):
        lines = []
        for n, (name, law) in enumerate(laws.items()):
            x, y = _law_course(law, order)
            dash = _DASHES[n // len(LINES) % len(_DASHES)]
            lines.append(Line(y, LINES[n % len(LINES)], "" if order else name, x, dash))
        drawn.append(Panel(label, lines))
    # Beyond the ends, so that jumps are seen there.
    ends = np.array([-0.05, 1.05])
    return line_figure(ends, *drawn, height=8.2, over="share z of the section [–]")


def _law_course(law: MotionLaw, order: int) -> tuple[Floats, Floats]:
    """A derivative piece by piece, with the values on both sides of each break; rest at the outer ends."""
    derivative = law.derivative(order)
    u = np.linspace(0.0, 1.0, _LAW_POINTS)
    x, y = [law.start], [float(law.at(law.start)) if order == 0 else 0.0]
    for low, high, piece in zip(law.breaks, law.breaks[1:], derivative.pieces, strict=False):
        x += (low + (high - low) * u).tolist()
        y += piece.at(u).tolist()
    return np.array([*x, law.end]), np.array([*y, y[-1] if order == 0 else 0.0])


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
