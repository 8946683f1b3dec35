r"""A cam under the loads of its machine: what presses where, how hard the surfaces are loaded, when contact
is lost.

The normal force N comes from the equilibrium of the whole machine (`linkwright.analysis.forces`), with all
bodies, loads and guides. Where it is negative the first contact would have to pull: a second follower, a
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

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.cam.hertz import LineContact, Material, line_contact
from linkwright.analysis.cam.lift_off import speed_of_loss
from linkwright.analysis.cam.profile import CamProfile, Flank
from linkwright.analysis.forces import forces
from linkwright.analysis.kinetostatics.result import Forces
from linkwright.analysis.result import Result
from linkwright.errors import FindingError
from linkwright.machine import Machine

Floats = NDArray[np.float64]

# A force below this share of the largest is none: rounding must not decide which side carries.
_NOTHING = 1e-9

# Rounding of a force that is a difference of forces of this share.
_ROUNDING = 1e-12

# Angles a turn at which the speed of losing contact is looked for; then so many in the two intervals about
# the least, each time, until the angle is good to a millionth of a radian, and the speed, flat there, to
# rounding.
_ANGLES, _CLOSER, _ROUNDS = 720, 41, 4


@dataclass(frozen=True)
class LoadedCam(Result):
    """A cam under load over the crank angle.

    Attributes
    ----------
    crank_angle : ndarray, shape (n,)
        [rad].
    force : ndarray, shape (n,)
        Normal force; negative where the second contact, or the outer flank, carries [N].
    pressure_angle : ndarray, shape (n,)
        Of the first contact [rad].
    name : str
        The cam's.
    force_max, force_max_angle : float
        Largest in size [N], and the crank angle there [rad].
    force_min : float
        Least, with its sign [N].
    side_changes : int
        How often in these angles, gone round, the force changes from one side to the other.
    speed_lost : float
        Crank speed at which a follower closed by a spring leaves the cam [rad/s]; None if it never does, or
        if something else closes it.
    speed_lost_angle : float
        Crank angle there [rad].
    pressure_max, pressure_max_angle : float
        Largest pressure by Hertz [Pa], and the crank angle there [rad]; None without width, or for an edge.
    shear_max, shear_depth : float
        Largest shear stress below the surface [Pa], and its depth there [m].
    pressure : ndarray, shape (n,), or None
        Pressure over the crank angle [Pa].
    findings : tuple of str
        Contact that is lost, a roller that does not fit, in sentences.
    """

    crank_angle: Floats
    force: Floats
    pressure_angle: Floats
    name: str
    force_max: float
    force_max_angle: float
    force_min: float
    side_changes: int
    speed_lost: float | None
    speed_lost_angle: float | None
    pressure_max: float | None
    pressure_max_angle: float | None
    shear_max: float | None
    shear_depth: float | None
    pressure: Floats | None
    findings: tuple[str, ...] = ()


def loaded_cam(machine: Machine, profile: CamProfile, found: Forces | None = None) -> LoadedCam:
    """A cam under the loads of its machine.

    Parameters
    ----------
    machine : Machine
        The machine, with bodies and loads.
    profile : CamProfile
        One of its cams.
    found : Forces, optional
        Forces along a motion; without them, those of the steady motion or at the design speed.

    Returns
    -------
    LoadedCam
        Over the crank angles of the forces.

    Raises
    ------
    InputError
        Nothing says at which speed the machine runs.
    FindingError
        The machine has no motion.
    """
    found = forces(machine) if found is None else found
    force = found.drives[profile.name]
    angle = np.mod(found.crank_angle - profile.cam.phase, 2 * np.pi)
    rows = [flank.contact.kernel.rows(angle) for flank in profile.flanks]
    worst = int(np.nanargmax(np.abs(force)))
    lost = _speed_lost(machine, profile) if profile.cam.closure == "spring" else None
    hertz, misfit = _hertz(profile, rows, force)
    hardest = int(np.argmax(hertz.pressure)) if hertz else 0
    carrying = force[np.abs(force) > _NOTHING * abs(force[worst])]
    return LoadedCam(
        found.crank_angle,
        force,
        rows[0]["pressure_angle"],
        profile.name,
        float(abs(force[worst])),
        float(found.crank_angle[worst]),
        float(np.nanmin(force)),
        int(np.count_nonzero(np.diff(np.sign([*carrying[-1:], *carrying])))),
        lost[0] if lost else None,
        lost[1] if lost else None,
        float(hertz.pressure[hardest]) if hertz else None,
        float(found.crank_angle[hardest]) if hertz else None,
        float(hertz.shear[hardest]) if hertz else None,
        float(hertz.shear_depth[hardest]) if hertz else None,
        hertz.pressure if hertz else None,
        (*misfit, *_left(profile, found, force)),
    )


def _left(profile: CamProfile, found: Forces, force: Floats) -> tuple[str, ...]:
    """A follower that nothing keeps on its cam."""
    lacking = float(np.nanmin(force))
    if profile.cam.closure != "spring" or lacking >= -_NOTHING * float(np.nanmax(np.abs(force))):
        return ()
    at = np.degrees(found.crank_angle[int(np.nanargmin(force))])
    return (
        f"the follower leaves cam {profile.name}: at a crank angle of {at:.4g}° and "
        f"{abs(float(np.nanmax(found.speed))):.4g} rad/s it would have to be pulled with {-lacking:.4g} N; "
        "a spring that presses with so much more there, a lower speed, or a groove keeps it on the cam",
    )


def _speed_lost(machine: Machine, profile: CamProfile) -> tuple[float, float] | None:
    """Speed at which contact is lost, and the crank angle, looked at closer and closer."""
    samples = np.linspace(0, 2 * np.pi, _ANGLES)
    angles = profile.cam.phase + np.unique(np.concatenate((profile.cam.lift.breaks, samples)))
    speed, at = _least_speed(machine, profile, angles)
    if not np.isfinite(speed):
        return None
    width = float(samples[1])
    for _ in range(_ROUNDS):
        nearer = _least_speed(machine, profile, at + width * np.linspace(-1, 1, _CLOSER))
        speed, at = min((speed, at), nearer)
        width *= 4 / _CLOSER
    return speed, at


def _least_speed(machine: Machine, profile: CamProfile, angles: Floats) -> tuple[float, float]:
    """Least ω at which contact is lost, and its angle, from forces at three speeds; else infinite."""
    one, two, three = (
        forces(machine, speed=speed, angles=angles).drives[profile.name] for speed in (1.0, 2.0, 3.0)
    )
    square = 0.5 * (three - 2 * two + one)
    linear = two - one - 3 * square
    still = one - linear - square
    size = float(np.abs(three).max())
    least = max(_NOTHING * float(np.abs(square).max()), _ROUNDING * size)
    losing = (square < -least) | (linear < -_NOTHING * size)
    speeds = np.where(still > 0, speed_of_loss(still, linear, square), 0.0)
    speeds = np.where(losing, speeds, np.inf)
    at = int(np.argmin(speeds))
    return float(speeds[at]), float(angles[at])


def _hertz(
    profile: CamProfile, rows: list[dict[str, Floats]], force: Floats
) -> tuple[LineContact | None, tuple[str, ...]]:
    """Pressure at the contact that carries, and what does not fit; None without a width or for an edge."""
    cam = profile.cam
    if cam.width is None or cam.contact == "point":
        return None, ()
    material = Material(cam.elastic_modulus, cam.poisson_ratio)
    first = profile.flanks[0]
    pulled = _outer(first, rows[0]) if len(rows) == 1 else _inner(profile.flanks[1], rows[1])
    pushed = _inner(first, rows[0])
    carried = np.abs(force) if cam.closure != "spring" else np.maximum(force, 0.0)
    # A follower that only a spring closes has no other side that could carry.
    pushes = (force >= 0) | (cam.closure == "spring")
    radius, roller = (np.where(pushes, a, b) for a, b in zip(pushed, pulled, strict=True))
    try:
        return line_contact(carried, radius, roller, cam.width, material, material), ()
    except FindingError as error:
        return None, (f"cam {profile.name}: {error}",)


def _inner(flank: Flank, rows: dict[str, Floats]) -> tuple[Floats, Floats]:
    """Radii of curvature of profile and follower."""
    bend = rows["bend"]
    if not flank.contact.kernel.is_roller:
        return bend, np.full_like(bend, np.inf)
    roller = flank.contact.sizes.roller_radius
    with np.errstate(divide="ignore"):
        return 1.0 / bend - roller, np.full_like(bend, roller)


def _outer(flank: Flank, rows: dict[str, Floats]) -> tuple[Floats, Floats]:
    """The same at the outer flank of a groove, which is hollow where the pitch curve is convex."""
    roller = flank.contact.sizes.roller_radius
    with np.errstate(divide="ignore"):
        return -(1.0 / rows["bend"] + roller), np.full_like(rows["bend"], roller)
