r"""What is known of a cam: lift, pressure angle and curvature over one revolution, and their extremes.

The pressure angle γ is that between the force on the follower, along the normal of the contact, and the way
that the follower moves; positive to the left. The radius of curvature ρ of the profile is positive where the
cam is convex; of a roller's pitch curve it is larger by the roller's radius.

The extremes are zeros of exact derivatives, not values at samples, and count both sides of each joint.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.cam.core import Extreme, Shape
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.model.cam import Cam
from linkwright.cam.model.motion_section import MotionSection
from linkwright.cam.profile.contact import CamCurve, Contact, Opposite, contacts, opposite
from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.numerics.tangent import plain, primal
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine

# Angles per revolution at which a cam is examined; between them extremes are found exactly.
ANGLES = 720


@dataclass(frozen=True)
class Flank:
    """One contact over one revolution.

    Attributes
    ----------
    contact : Contact
        The follower and its cam.
    shape : Shape
        What the core knows of it.
    pressure_angle_max, pressure_angle_min : Extreme
        Maximum and minimum pressure angle, with sign [rad].
    convex, concave : Extreme or None
        Minimum radius of curvature of the convex and of the concave parts of the profile, both positive [m];
        the first is negative where it is undercut. None if there is no such part.
    """

    contact: Contact
    shape: Shape
    pressure_angle_max: Extreme
    pressure_angle_min: Extreme
    convex: Extreme | None
    concave: Extreme | None

    @property
    def steepest(self) -> Extreme:
        """The pressure angle that is largest in magnitude."""
        both = (self.pressure_angle_max, self.pressure_angle_min)
        return max(both, key=lambda extreme: abs(extreme.value))

    @property
    def curvature_radius(self) -> Floats:
        """Radius of curvature of the profile at the angles of the shape [m]; infinite at inflections."""
        bend = self.shape.rows["bend"]
        if not self.contact.kernel.is_roller:
            return bend
        with np.errstate(divide="ignore"):
            radius: Floats = 1.0 / bend - self.contact.sizes.roller_radius
        return radius

    @property
    def profile(self) -> Floats:
        """The profile at the angles of the shape, in the contact's frame, (n, 2) [m]."""
        rows, roller = self.shape.rows, self.contact.sizes.roller_radius
        x, y = (rows[f"pitch_{axis}"] - roller * rows[f"normal_{axis}"] for axis in "xy")
        return np.column_stack((x, y))

    def curve(self, away: float | None = None) -> CamCurve:
        """A curve beside the pitch curve, by its distance outwards; without it, the profile."""
        return CamCurve(self.contact, -self.contact.sizes.roller_radius if away is None else away)


# Names of the lift and its derivatives, by the cam angle and over time.
_DERIVATIVES = (("lift", ""), ("lift_d1", "velocity"), ("lift_d2", "acceleration"), ("lift_d3", "jerk"))

# A derivative at rest is zero to this share of its peak: sums of pieces leave some units in the last place.
_ROUNDING = 1e-13

# Attributes of a profile that are no results to be written out.
_PARTS = ("cam", "flanks", "opposite")


@dataclass(frozen=True)
class CamProfile(Result):
    """A cam and its followers over one revolution."""

    angle: Annotated[
        Floats,
        Label(
            "cam angle",
            "θ",
            "rad",
            "From the start of the programme, increasing; joints of the law stand twice.",
        ),
    ]
    lift: Annotated[Floats, Label("lift from the base circle", "s", "m or rad")]
    lift_d1: Annotated[Floats, Label("first derivative of the lift by the cam angle", "s′", "m/rad or –")]
    lift_d2: Annotated[
        Floats, Label("second derivative of the lift by the cam angle", "s″", "m/rad² or 1/rad")
    ]
    lift_d3: Annotated[
        Floats, Label("third derivative of the lift by the cam angle", "s‴", "m/rad³ or 1/rad²")
    ]
    pressure_angle: Annotated[Floats, Label("pressure angle", "γ", "rad", "Of the first contact.")]
    curvature_radius: Annotated[
        Floats, Label("radius of curvature of the profile", "ρ", "m", "Of the first contact.")
    ]
    name: Annotated[str, About("The cam's.")]
    stroke: Annotated[float, Label("maximum lift", "h", "m or rad")]
    velocity_max: Annotated[
        float | None,
        Label(
            "maximum velocity of the follower",
            "",
            "m/s or rad/s",
            "Peak absolute value at the design speed; None without one.",
        ),
    ]
    acceleration_max: Annotated[
        float | None,
        Label(
            "maximum acceleration of the follower",
            "",
            "m/s² or rad/s²",
            "Peak absolute value at the design speed; None without one.",
        ),
    ]
    jerk_max: Annotated[
        float | None,
        Label(
            "maximum jerk of the follower",
            "",
            "m/s³ or rad/s³",
            "Peak absolute value at the design speed; None without one.",
        ),
    ]
    speed_constant: Annotated[
        float | None,
        Label(
            "maximum velocity that is kept over a section",
            "",
            "m/s or rad/s",
            "None without such a section or speed.",
        ),
    ]
    base_radius: Annotated[float, Label("base radius", "r₀", "m", "Of the first cam.")]
    prime_radius: Annotated[float, Label("prime radius", "", "m", "Of the first cam.")]
    pressure_angle_max: Annotated[
        float, Label("maximum pressure angle", "γ_max", "rad", "Peak absolute value over all contacts.")
    ]
    pressure_angle_max_angle: Annotated[
        float, Label("cam angle of the maximum pressure angle", "θ(γ_max)", "rad")
    ]
    curvature_radius_min: Annotated[
        float | None,
        Label(
            "minimum radius of curvature",
            "ρ_min",
            "m",
            "Minimum magnitude, convex or concave; negative where undercut.",
        ),
    ]
    curvature_radius_min_angle: Annotated[
        float | None, Label("cam angle of the minimum radius of curvature", "θ(ρ_min)", "rad")
    ]
    curvature_radius_convex_min: Annotated[
        float | None,
        Label("minimum convex radius of curvature", "", "m", "None where there is no such part."),
    ]
    curvature_radius_concave_min: Annotated[
        float | None,
        Label("minimum concave radius of curvature", "", "m", "None where there is no such part."),
    ]
    diameter_min: Annotated[
        float | None,
        Label(
            "minimum diameter",
            "d_min",
            "m",
            "For two followers on opposite sides of one cam; None for other closures.",
            table="cam",
        ),
    ]
    diameter_max: Annotated[
        float | None,
        Label(
            "maximum diameter",
            "d_max",
            "m",
            "For two followers on opposite sides of one cam; None for other closures.",
            table="cam",
        ),
    ]
    face_min: Annotated[
        float | None,
        Label(
            "minimum position of the contact on a flat face",
            "",
            "m",
            "To the left of its stem or along the arm; None for rollers.",
            table="cam",
        ),
    ]
    face_max: Annotated[
        float | None,
        Label(
            "maximum position of the contact on a flat face",
            "",
            "m",
            "To the left of its stem or along the arm; None for rollers.",
            table="cam",
        ),
    ]
    speed: Annotated[float | None, Label("design speed of the cam", "ω", "rad/s")]
    cam: Annotated[Cam, About("The description.")]
    flanks: Annotated[tuple[Flank, ...], About("The contacts.")]
    opposite: Annotated[Opposite | None, About("Whether two followers touch one cam at every angle.")]

    @property
    def joints(self) -> tuple[dict[str, Any], ...]:
        """Segment boundaries: cam angle [rad], highest continuous derivative, jumps of the derivatives."""
        joints = self.cam.motion.joints
        return tuple({"angle": j.angle, "order": j.order, "jumps": list(j.jumps)} for j in joints)

    @property
    def sections(self) -> tuple[dict[str, Any], ...]:
        """Sections: ``start``, ``end`` [rad], ``law``; extremes of the lift and its derivatives by the cam
        angle, ``lift_min``, ``lift_d1_max``, … [m or rad over rad], and their angles, ``lift_min_angle``, …
        [rad]; extremes over time at the design speed, ``velocity_min``, ``acceleration_max``, ``jerk_max``.

        Values at an end are those within the section.
        """
        described = zip(self.cam.motion.stretches, self.cam.sections, strict=True)
        return tuple(self._section(law, section) for law, section in described)

    def _section(self, law: MotionLaw, section: MotionSection) -> dict[str, Any]:
        entries: dict[str, Any] = {"start": law.start, "end": law.end, "law": section.law_name}
        for order, (by_angle, over_time) in enumerate(_DERIVATIVES):
            least, most = law.extremes(order)
            rounding = _ROUNDING * max(abs(least.value), abs(most.value))
            for end, extreme in (("min", least), ("max", most)):
                value = 0.0 if abs(extreme.value) <= rounding else extreme.value
                entries |= {f"{by_angle}_{end}": value, f"{by_angle}_{end}_angle": extreme.at}
                if over_time:
                    entries[f"{over_time}_{end}"] = in_time(value, order, self.speed)
        return entries

    @public
    def unit_of(self, name: str) -> str:
        """SI unit of an attribute: a lift has metres, that of an oscillating follower radians."""
        return unit_in(super().unit_of(name), self.cam)

    def _entries(self) -> dict[str, Any]:
        """What is written out: numbers and curves, not the parts that they are from."""
        return {key: value for key, value in super()._entries().items() if key not in _PARTS}


def unit_in(units: str, cam: Cam) -> str:
    """The unit of a cam's quantity out of two, "m or rad": that of a line or that of an angle."""
    both = units.split(" or ")
    return both[-1 if cam.is_oscillating else 0].replace("–", "")


def the_cam(machine: Machine, name: str | None = None) -> tuple[str, Cam]:
    """A cam by name, optional if there is one, with its name; `InputError` if none fits, or several."""
    cams = machine.mechanism.cams
    if not cams:
        raise InputError("the machine has no cam: give it one as [mechanism.cams.NAME]")
    if name is None and len(cams) > 1:
        raise InputError(f"the machine has several cams: name one of {', '.join(cams)}")
    chosen = next(iter(cams)) if name is None else name
    if chosen not in cams:
        raise InputError(f"{show(chosen)}: the machine has no such cam; {suggestion(chosen, cams)}")
    return chosen, cams[chosen]


@public
def cam_profile(machine: Machine, name: str | None = None, *, n: int = ANGLES) -> CamProfile:
    """Profile of a cam over one revolution.

    Parameters
    ----------
    machine : Machine
    name : str, optional
        The cam's name; may be left out if there is one.
    n : int
        Cam angles per revolution, at least 16; extremes do not depend on it.

    Returns
    -------
    CamProfile
        Curves and extremes. Whether the cam can be made is asked by `cam_faults`.

    Raises
    ------
    InputError
        No such cam, or too few angles.
    AssemblyError
        A second follower leaves no room for its cam.
    """
    if not 16 <= n <= 1_000_000:
        raise InputError(f"n = {n}: expected 16 to 1 000 000 cam angles")
    name, cam = the_cam(machine, name)
    speed = machine.design_speed
    return profile_of(name, cam, contacts(cam, machine.mechanism.fixed_points(), name), speed, n)


def profile_of(name: str, cam: Cam, touching: tuple[Contact, ...], speed: float | None, n: int) -> CamProfile:
    """The same from contacts. ``speed``: design speed [rad/s]."""
    flanks = tuple(_flank(contact, n) for contact in touching)
    first = flanks[0]
    rows, size = first.shape.rows, first.contact.sizes
    steepest = max((flank.steepest for flank in flanks), key=lambda joint: abs(joint.value))
    convex = _least([flank.convex for flank in flanks])
    concave = _least([flank.concave for flank in flanks])
    tightest = _least([convex, concave])
    both = opposite(cam, first.contact) if cam.has_opposite else None
    face = None if cam.is_roller else (first.shape.least["along"], first.shape.greatest["along"])
    return CamProfile(
        first.shape.angle,
        rows["lift"],
        rows["lift_d1"],
        rows["lift_d2"],
        rows["lift_d3"],
        rows["pressure_angle"],
        first.curvature_radius,
        name,
        cam.stroke,
        in_time(cam.motion.peaks[0], 1, speed),
        in_time(cam.motion.peaks[1], 2, speed),
        in_time(cam.motion.peaks[2], 3, speed),
        in_time(cam.motion.steady_velocity, 1, speed),
        float(size.base_radius),
        float(size.base_radius + size.roller_radius),
        abs(steepest.value),
        steepest.angle,
        tightest.value if tightest else None,
        tightest.angle if tightest else None,
        convex.value if convex else None,
        concave.value if concave else None,
        both.least.value if both else None,
        both.greatest.value if both else None,
        face[0].value if face else None,
        face[1].value if face else None,
        speed,
        cam,
        flanks,
        both,
    )


def _least(extremes: list[Extreme | None]) -> Extreme | None:
    return min(
        (extreme for extreme in extremes if extreme is not None),
        key=lambda extreme: extreme.value,
        default=None,
    )


def in_time(peak: Any, order: int, speed: Any) -> Any:
    """A derivative by the cam angle as one by time; None without either, or beyond the range of numbers."""
    if peak is None or speed is None:
        return None
    with np.errstate(over="ignore"):
        value = peak * np.power(abs(speed), order)
    return plain(value) if np.isfinite(primal(value)) else None


def radius_beside(bend: Any, roller: Any, sign: float) -> Any:
    """Radius of the profile beside a convex (+1) or concave (−1) pitch curve, 1/κ − r_r."""
    return sign * (1.0 / bend - roller)


def _flank(contact: Contact, n: int) -> Flank:
    shape = contact.kernel.shape(n, (("soundness", 0.0), ("bend", 0.0)))
    high, low = shape.greatest, shape.least
    steep = high["pressure_angle"], low["pressure_angle"]
    if not contact.kernel.is_roller:
        # Under a flat face the cam must be convex everywhere.
        return Flank(contact, shape, *steep, low["bend"], None)
    roller, bends = contact.sizes.roller_radius, (high["bend"], low["bend"])
    convex = (
        Extreme(bends[0].angle, radius_beside(bends[0].value, roller, 1.0)) if bends[0].value > 0 else None
    )
    concave = (
        Extreme(bends[1].angle, radius_beside(bends[1].value, roller, -1.0)) if bends[1].value < 0 else None
    )
    return Flank(contact, shape, *steep, convex, concave)
