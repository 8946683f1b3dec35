"""Dynamics of cams: contact force by flanks, pressure by Hertz, vibration and what a rise leaves of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.style import (
    BLUE,
    DRIVE,
    GREEN,
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

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.cam.dynamics.contact_force import ContactForce
    from linkwright.cam.dynamics.follower_vibration import FollowerVibration
    from linkwright.cam.dynamics.hertz import LineContact
    from linkwright.cam.dynamics.residual_vibration import ResidualSpectrum


@styled
def contact_force_figure(contact: ContactForce) -> Figure:
    """Draw the normal force, by the flank that carries, and the torque of the cam shaft."""
    figure, (force, torque) = panels(2, height=4.2)
    degrees = np.degrees(contact.cam_angle)
    flanks = ((contact.side > 0, BLUE, "flank that lifts"), (contact.side < 0, RED, "other flank"))
    for carries, colour, label in flanks:
        if carries.any():
            force.plot(degrees, np.where(carries, contact.normal, np.nan), color=colour, label=label)
    if contact.lost.any():
        force.plot(degrees[contact.lost], contact.normal[contact.lost], ".", color=SOFT, label="contact lost")
    force.set_ylabel("normal force N\n[N]")
    legend_above(force)
    torque.plot(degrees, contact.torque, color=DRIVE)
    torque.set_ylabel("torque of the\ncam shaft [N m]")
    for axes, values in ((force, contact.normal), (torque, contact.torque)):
        there = values[np.isfinite(values)]
        if len(there):
            roomy(axes, there)
        zero_line(axes)
    turn_axis(torque)
    torque.set_xlabel("cam angle φ [°]")
    return figure


@styled
def pressure_figure(cam_angle: Floats, contact: LineContact, limit: float | None = None) -> Figure:
    """Draw the pressure by Hertz and the half width of the contact over the cam angle.

    ``cam_angle`` (n,): φ [rad]; ``limit``: pressure allowed [Pa].
    """
    figure, (pressure, width) = panels(2, height=4.2)
    degrees = np.degrees(cam_angle)
    pressure.plot(degrees, 1e-6 * contact.pressure, color=RED, label="largest pressure p₀")
    pressure.plot(degrees, 1e-6 * contact.shear, color=GREEN, label="largest shear, below the surface")
    if limit is not None:
        level(pressure, 1e-6 * limit, "allowed")
    pressure.set_ylabel("stress\n[MPa]")
    pressure.set_ylim(bottom=0)
    legend_above(pressure)
    width.plot(degrees, 1e3 * contact.half_width, color=BLUE, label="half width b")
    width.plot(degrees, 1e3 * contact.shear_depth, color=GREEN, label="depth of the largest shear")
    width.set_ylabel("length\n[mm]")
    width.set_ylim(bottom=0)
    legend_above(width)
    turn_axis(width)
    width.set_xlabel("cam angle φ [°]")
    return figure


@styled
def vibration_figure(vibration: FollowerVibration) -> Figure:
    """Draw how far the follower's mass is from the lift, and the force of its train on the cam."""
    figure, (place, force) = panels(2, height=4.2)
    degrees = np.degrees(vibration.cam_angle)
    place.plot(degrees, 1e3 * (vibration.position - vibration.lift), color=BLUE)
    place.set_ylabel("mass less lift x − s\n[mm]")
    zero_line(place)
    force.plot(degrees, vibration.force, color=RED)
    force.set_ylabel("force on the cam\n[N]")
    roomy(force, vibration.force)
    zero_line(force)
    for impulse in vibration.impulses:
        force.axvline(np.degrees(impulse.cam_angle), color=SOFT, linewidth=0.8, linestyle=":")
    turn_axis(force)
    force.set_xlabel("cam angle φ [°]")
    return figure


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
