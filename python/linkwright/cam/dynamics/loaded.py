r"""A cam under the loads of its machine: what presses where, how hard the surfaces are loaded, when contact
is lost.

The normal force N comes from the equilibrium of the whole machine (`linkwright.kinetostatics.forces`), with
all bodies, loads and guides. Where it is negative the first contact would have to pull: a second follower, a
second cam or the outer flank of a groove takes over; a follower that only a spring closes leaves the cam.

With dampers that resist in proportion to the speed, and inertia that goes with its square, the follower
leaves the cam at

.. math:: \omega_\mathrm{off} = \min_\varphi\{\omega > 0 : N_0 + N_1\omega + N_2\omega^2 = 0\}, \qquad
    N_1 = 0: \ \omega_\mathrm{off} = \min_{N_2 < 0}\sqrt{N_0/(-N_2)}

Loads that depend on the speed in another way count as this parabola through their values at 1, 2 and 3 rad/s.

References
----------
.. [1] Norton, Cam Design and Manufacturing Handbook, 2nd ed., chapters 8 and 12.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

import numpy as np

from linkwright.cam.core import Extreme
from linkwright.cam.dynamics.hertz import LineContact, Material, line_contact
from linkwright.cam.dynamics.lift_off import speed_of_loss
from linkwright.cam.profile.contact import Contact
from linkwright.cam.profile.profile import CamProfile, cam_profile
from linkwright.drive.steady_state import steady_state
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import SPEED
from linkwright.kernel.units.marks import positive
from linkwright.kinetostatics.collect import LEAVES
from linkwright.kinetostatics.forces import forces
from linkwright.kinetostatics.result import Forces
from linkwright.machine.machine import Machine

# A force below this share of the largest is none: rounding must not decide which side carries.
_NOTHING = 1e-9

# Rounding of a force that is a difference of forces of this share.
_ROUNDING = 1e-12

# Distance from a joint at which its two sides are examined [rad].
_BESIDE = 1e-9

# Relative accuracy of the steady speed.
_ACCURACY = 1e-10

# Looks at the neighbourhood of an extreme, and places each time: between the last ones, a millionth of
# a radian apart, a parabola gives the angle to 1e-8 rad; the value, flat there, is good to rounding.
_LOOKS, _CLOSER = 3, 41

# Share of its height by which a curve may miss its parabola in the last look: at a corner it does by a tenth.
_SMOOTH = 0.02


_FINDINGS = (
    "Contact that is lost, a roller that does not fit, angles at which there are no forces, in sentences."
)


@dataclass(frozen=True)
class LoadedCam(Result):
    """A cam under load over the crank angle."""

    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad")]
    force: Annotated[
        Floats,
        Label("normal force", "N", "N", "Negative where the second contact, or the outer flank, carries."),
    ]
    pressure_angle: Annotated[Floats, Label("pressure angle", "γ", "rad", "Of the first contact.")]
    name: Annotated[str, About("The cam's.")]
    force_max: Annotated[float, Label("maximum normal force", "N_max", "N", "With its sign.")]
    force_max_angle: Annotated[float, Label("crank angle of the maximum normal force", "φ(N_max)", "rad")]
    force_min: Annotated[float, Label("minimum normal force", "N_min", "N", "With its sign.")]
    force_min_angle: Annotated[float, Label("crank angle of the minimum normal force", "φ(N_min)", "rad")]
    speed: Annotated[float, Label("mean speed of the motion", "ω_m", "rad/s")]
    side_changes: Annotated[int, Label("contact-side reversals", "", "", "In these angles, gone round.")]
    speed_lost: Annotated[
        float | None,
        Label(
            "crank speed at which the follower leaves the cam",
            "",
            "rad/s",
            "One closed by a spring; None if it never does, or if something else closes it.",
        ),
    ]
    speed_lost_angle: Annotated[
        float | None, Label("crank angle where the follower leaves the cam", "", "rad")
    ]
    pressure_max: Annotated[
        float | None,
        Label("maximum contact pressure", "p₀", "Pa", "By Hertz; None without width, or for an edge."),
    ]
    pressure_max_angle: Annotated[
        float | None, Label("crank angle of the maximum contact pressure", "φ(p₀)", "rad")
    ]
    shear_max: Annotated[float | None, Label("maximum shear stress below the surface", "", "Pa")]
    shear_depth: Annotated[float | None, Label("depth of the maximum shear stress", "", "m")]
    pressure: Annotated[Floats | None, Label("contact pressure", "p", "Pa")]
    findings: Annotated[tuple[str, ...], About(_FINDINGS)] = ()

    @property
    def force_size(self) -> Annotated[float, Label("peak absolute normal force", "", "N")]:
        """Largest normal force in magnitude."""
        return max(abs(self.force_max), abs(self.force_min))


def cam_force(machine: Machine, name: str | None = None) -> LoadedCam:
    """`loaded_cam` by the name of the cam, which may be left out if there is one; errors as there."""
    return loaded_cam(machine, cam_profile(machine, name))


@public
def loaded_cam(machine: Machine, profile: CamProfile, speed: float | None = None) -> LoadedCam:
    """A cam under the loads of its machine.

    Parameters
    ----------
    machine : Machine
        The machine, with bodies and loads.
    profile : CamProfile
        One of its cams.
    speed : float, optional
        Of the crankshaft, the same at all angles [rad/s]; without it, the steady motion of the motor, or the
        design speed where there is none.

    Returns
    -------
    LoadedCam
        Over one revolution, at the angles of the profile: each joint of the law from before and from after.

    Raises
    ------
    InputError
        Nothing says at which speed the machine runs, the speed is none, or the profile is of another machine.
    FindingError
        The machine has no motion.
    """
    in_range(speed=(speed, positive(SPEED)))
    if profile.name not in machine.mechanism.cams:
        known = ", ".join(machine.mechanism.cams) or "none"
        raise InputError(f'profile: found that of cam "{profile.name}", expected one of the machine: {known}')
    cam = profile.cam
    pressed = partial(_pressed, machine, speed)
    angles = _angles(profile)
    contact = pressed(angles)
    force = contact.drives[profile.name]
    rows = _rows(profile, angles)
    greatest = _largest(lambda phi: pressed(phi).drives[profile.name], angles, force)
    least = _largest(lambda phi: -pressed(phi).drives[profile.name], angles, -force)
    lost = _speed_lost(machine, profile, angles) if cam.closure == "spring" else None
    hertz, misfit = _hertz(profile, rows, force)
    hardest = _hardest(profile, pressed, angles, hertz) if hertz else None
    size = float(np.nanmax(np.abs(force)))
    carrying = force[np.abs(force) > _NOTHING * size]
    return LoadedCam(
        angles,
        force,
        rows[0]["pressure_angle"],
        profile.name,
        greatest.value,
        greatest.angle,
        -least.value,
        least.angle,
        contact.motion.mean(contact.speed),
        int(np.count_nonzero(np.diff(np.sign([*carrying[-1:], *carrying])))),
        lost[0] if lost else None,
        lost[1] if lost else None,
        float(hardest[1].pressure[0]) if hardest else None,
        hardest[0] if hardest else None,
        float(hardest[1].shear[0]) if hardest else None,
        float(hardest[1].shear_depth[0]) if hardest else None,
        hertz.pressure if hertz else None,
        (*misfit, *_left(profile, -least.value, least.angle, size, contact), *_others(contact)),
    )


def _angles(profile: CamProfile) -> Floats:
    """Increasing crank angles of the profile within a revolution; joints from both sides."""
    cam_angles = profile.angle.copy()
    twice = np.flatnonzero(np.diff(cam_angles) == 0)
    cam_angles[twice] -= _BESIDE
    cam_angles[twice + 1] += _BESIDE
    cam_angles[0] += _BESIDE
    cam_angles[-1] -= _BESIDE
    angles: Floats = np.sort(np.mod(cam_angles + profile.cam.phase, 2 * np.pi))
    return angles


def _pressed(machine: Machine, speed: float | None, angles: Floats) -> Forces:
    drive = machine.drive
    if speed is None and drive is not None and drive.motor is not None:
        return forces(machine, steady_state(machine, accuracy=_ACCURACY, angles=angles))
    return forces(machine, speed=speed, angles=angles)


def _largest(function: Callable[[Floats], Floats], angles: Floats, values: Floats) -> Extreme:
    """The largest value of a function sampled at angles, examined ever more closely about its place."""
    i = int(np.nanargmax(values))
    best = Extreme(float(angles[i]), float(values[i]))
    low, high = (float(angles[min(max(k, 0), len(angles) - 1)]) for k in (i - 1, i + 1))
    for _ in range(_LOOKS):
        places = np.linspace(low, high, _CLOSER)
        here = function(places)
        k = int(np.nanargmax(here))
        if here[k] > best.value:
            best = Extreme(float(places[k]), float(here[k]))
        low, high = (float(places[min(max(m, 0), len(places) - 1)]) for m in (k - 1, k + 1))
    return _vertex(places, here, best)


def _vertex(places: Floats, values: Floats, best: Extreme) -> Extreme:
    """Vertex of the parabola through the last samples; at a corner the best sample."""
    middle, half = 0.5 * (places[0] + places[-1]), 0.5 * (places[-1] - places[0])
    if not (half > 0 and np.isfinite(values).all()):
        return best
    share = (places - middle) / half
    powers = np.stack([share**2, share, np.ones_like(share)], axis=-1)
    # About their largest: what is fitted are small differences.
    (square, linear, level), *_ = np.linalg.lstsq(powers, values - best.value, rcond=None)
    off = np.abs(powers @ [square, linear, level] - (values - best.value)).max()
    if not (square < 0 and off < _SMOOTH * -square and abs(linear) < -2 * square):
        return best
    top = -0.5 * linear / square
    return Extreme(float(middle + half * top), best.value + max(float(level + 0.5 * linear * top), 0.0))


def _left(profile: CamProfile, least: float, at: float, size: float, acting: Forces) -> tuple[str, ...]:
    if profile.cam.closure != "spring" or least >= -_NOTHING * size:
        return ()
    return (
        f"the follower leaves cam {profile.name}: at a crank angle of {np.degrees(at):.4g}° and "
        f"{abs(float(np.nanmax(acting.speed))):.4g} rad/s it would have to be pulled with {-least:.4g} N; "
        f"increase the spring force there by {-least:.4g} N, reduce the speed, or use a groove",
    )


def _others(acting: Forces) -> tuple[str, ...]:
    return tuple(text for text in acting.findings if not text.startswith(LEAVES))


def _speed_lost(machine: Machine, profile: CamProfile, angles: Floats) -> tuple[float, float] | None:
    """Speed at which contact is lost, and the crank angle; None if it never is."""
    speeds = partial(_speeds_lost, machine, profile.name)
    sampled = speeds(angles)
    if not np.isfinite(sampled).any():
        return None
    least = _largest(lambda phi: -speeds(phi), angles, -sampled)
    return -least.value, least.angle


def _speeds_lost(machine: Machine, name: str, angles: Floats) -> Floats:
    """ω at which contact is lost at each angle, from forces at three speeds; else infinite."""
    one, two, three = (forces(machine, speed=speed, angles=angles).drives[name] for speed in (1.0, 2.0, 3.0))
    square = 0.5 * (three - 2 * two + one)
    linear = two - one - 3 * square
    still = one - linear - square
    size = float(np.abs(three).max())
    least = max(_NOTHING * float(np.abs(square).max()), _ROUNDING * size)
    losing = (square < -least) | (linear < -_NOTHING * size)
    speeds = np.where(still > 0, speed_of_loss(still, linear, square), 0.0)
    return np.where(losing, speeds, np.inf)


def _rows(profile: CamProfile, angles: Floats) -> list[dict[str, Floats]]:
    cam_angles = np.mod(angles - profile.cam.phase, 2 * np.pi)
    return [flank.contact.kernel.rows(cam_angles) for flank in profile.flanks]


def _hardest(
    profile: CamProfile, pressed: Callable[[Floats], Forces], angles: Floats, hertz: LineContact
) -> tuple[float, LineContact] | None:
    """Largest contact pressure and its place; None where the contact at a neighbouring angle does not fit."""

    def at(phi: Floats) -> LineContact | None:
        return _hertz(profile, _rows(profile, phi), pressed(phi).drives[profile.name])[0]

    def pressure(phi: Floats) -> Floats:
        contact = at(phi)
        return np.full(len(phi), -np.inf) if contact is None else contact.pressure

    best = _largest(pressure, angles, hertz.pressure)
    contact = at(np.array([best.angle]))
    return None if contact is None else (best.angle, contact)


def _hertz(
    profile: CamProfile, rows: list[dict[str, Floats]], force: Floats
) -> tuple[LineContact | None, tuple[str, ...]]:
    """Pressure of the carrying contact, and what does not fit; None without a width or for an edge."""
    cam = profile.cam
    if cam.width is None or cam.contact == "point":
        return None, ()
    material = Material(cam.elastic_modulus, cam.poisson_ratio)
    first = profile.flanks[0].contact
    pulled = outer_radii(first, rows[0]) if len(rows) == 1 else radii(profile.flanks[1].contact, rows[1])
    pushed = radii(first, rows[0])
    carried = np.abs(force) if cam.closure != "spring" else np.maximum(force, 0.0)
    # A follower that only a spring closes has no other side that could carry.
    pushes = (force >= 0) | (cam.closure == "spring")
    radius, roller = (np.where(pushes, a, b) for a, b in zip(pushed, pulled, strict=True))
    try:
        return line_contact(carried, radius, roller, cam.width, material, material), ()
    except FindingError as error:
        return None, (f"cam {profile.name}: {error}",)


def radii(contact: Contact, rows: dict[str, Any]) -> tuple[Any, Any]:
    """Radii of curvature of profile and follower."""
    bend, roller = rows["bend"], contact.sizes.roller_radius
    if not contact.kernel.is_roller:
        return bend, np.inf
    with np.errstate(divide="ignore"):
        return 1.0 / bend - roller, roller


def outer_radii(contact: Contact, rows: dict[str, Any]) -> tuple[Any, Any]:
    """The same at the outer flank of a groove, which is concave where the pitch curve is convex."""
    roller = contact.sizes.roller_radius
    with np.errstate(divide="ignore"):
        return -(1.0 / rows["bend"] + roller), roller
