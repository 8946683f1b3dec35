r"""One pose: everything about a mechanism at one crank angle.

.. math:: v = p'\omega, \qquad a = p''\omega^2 + p'\varepsilon
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record
from linkwright.kernel.units.kinds import ANGLE, ANGULAR_ACCELERATION, SPEED
from linkwright.kernel.units.marks import Quantity
from linkwright.linkages.closure import has_levers, require_closed, require_finite_rates, turn_angles
from linkwright.linkages.dyads import dyads_of, transmission, transmission_channels
from linkwright.linkages.kinematics import everything, kinematics_of, motion_arrays
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine

# A dyad whose links are nearer than this to one line, as the sine of the angle between them, is near a limit;
# so is a slotted lever whose pin is nearer to its pivot than this share of what it reaches.
_NEAR = 0.1

# Angles at which the reach of a slotted lever is looked for.
_LOOKS = 180


@dataclass(frozen=True)
class PosePoint:
    """A point: place [m], velocity [m/s], acceleration [m/s²], each as x and y."""

    position: tuple[float, float]
    velocity: tuple[float, float]
    acceleration: tuple[float, float]


@dataclass(frozen=True)
class PoseCoordinate:
    """A link or a slide: its angle [rad] or place [m], with rate and acceleration per second."""

    position: float
    velocity: float
    acceleration: float


@dataclass(frozen=True)
class Pose(Record):
    """A mechanism at one crank angle."""

    crank_angle: Annotated[float, Label("crank angle", "φ", "rad")]
    speed: Annotated[float, Label("speed of the crank", "ω", "rad/s")]
    acceleration: Annotated[float, Label("angular acceleration of the crank", "ε", "rad/s²")]
    points: Annotated[dict[str, PosePoint], About("Points by name.")]
    links: Annotated[dict[str, PoseCoordinate], About("Links by name, directions from −π to π [rad].")]
    slides: Annotated[dict[str, PoseCoordinate], About("Slides by name [m].")]
    transmission_angles: Annotated[dict[str, float], About("μ of each dyad [rad].")]
    near_limit: Annotated[
        tuple[str, ...],
        About("Dyads whose links are within some 6° of one line, levers with the pin near the pivot."),
    ]

    def to_dict(self) -> dict[str, Any]:
        """Everything by name, ready for JSON. Returns: SI numbers; x and y as lists."""
        parts = {
            part: {name: _part_dict(motion) for name, motion in getattr(self, part).items()}
            for part in ("points", "links", "slides")
        }
        state = {"crank_angle": self.crank_angle, "speed": self.speed, "acceleration": self.acceleration}
        results = {"transmission_angles": dict(self.transmission_angles), "near_limit": list(self.near_limit)}
        return state | parts | results


def _part_dict(part: PosePoint | PoseCoordinate) -> dict[str, Any]:
    return {name: list(x) if isinstance(x, tuple) else x for name, x in vars(part).items()}


@public
def pose(machine: Machine, crank_angle: float, *, speed: float = 1.0, acceleration: float = 0.0) -> Pose:
    """The pose at a crank angle.

    Parameters
    ----------
    machine : Machine
        The machine; of a batch, the first.
    crank_angle : float
        [rad].
    speed, acceleration : float
        Of the crank [rad/s, rad/s²]; with a speed of 1, velocities are transfer functions.

    Returns
    -------
    Pose
        Places, rates, transmission angles.

    Raises
    ------
    AssemblyError
        The mechanism does not close there.
    InputError
        A number is not finite, or beyond its range.
    """
    in_range(
        crank_angle=(crank_angle, Quantity(ANGLE)),
        speed=(speed, Quantity(SPEED)),
        acceleration=(acceleration, Quantity(ANGULAR_ACCELERATION)),
    )
    compiled = compile_machine(machine).first()
    at = np.array([crank_angle], dtype=np.float64)
    require_closed(compiled, machine, at)
    what = everything(compiled)
    require_finite_rates(motion_arrays(compiled, at, what), compiled, machine, at)
    kinematics = kinematics_of(compiled, at, what)
    rates = (speed, acceleration)
    mu, short = {}, _short_levers(compiled, at)
    for dyad in dyads_of(compiled):
        if dyad.kind != "group":
            channels = transmission_channels(compiled, dyad)
            mu[dyad.name] = float(transmission(compiled.parameters, dyad, compiled.motion(channels, at))[0])
    return Pose(
        crank_angle=float(crank_angle),
        speed=float(speed),
        acceleration=float(acceleration),
        points={name: _point(point, *rates) for name, point in kinematics.points.items()},
        links={name: _coordinate(link.angle, link, *rates) for name, link in kinematics.links.items()},
        slides={
            name: _coordinate(slide.position, slide, *rates) for name, slide in kinematics.slides.items()
        },
        transmission_angles=mu,
        near_limit=tuple(name for name, angle in mu.items() if np.sin(angle) < _NEAR or name in short),
    )


def _short_levers(compiled: CompiledMachine, at: Floats) -> set[str]:
    if not has_levers(compiled):
        return set()
    reach = np.nanmax(compiled.gaps(turn_angles(_LOOKS)), axis=1)
    share = np.sqrt(np.abs(compiled.gaps(at)[:, 0]) / reach)
    levers = {dyad.name for dyad in dyads_of(compiled) if dyad.kind == "RPR"}
    return {name for name, near in zip(compiled.dyads, share < _NEAR, strict=True) if near and name in levers}


def _point(motion: Any, speed: float, acceleration: float) -> PosePoint:
    v, a = motion.d1[0] * speed, motion.d2[0] * speed**2 + motion.d1[0] * acceleration
    (x, y), (vx, vy), (ax, ay) = (pair.tolist() for pair in (motion.position[0], v, a))
    return PosePoint((x, y), (vx, vy), (ax, ay))


def _coordinate(position: Any, motion: Any, speed: float, acceleration: float) -> PoseCoordinate:
    d1, d2 = float(motion.d1[0]), float(motion.d2[0])
    return PoseCoordinate(float(position[0]), d1 * speed, d2 * speed**2 + d1 * acceleration)
