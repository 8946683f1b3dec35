"""What each pair can do: wrenches of its unknown forces, and what friction adds to them.

| pair | unknown | friction on the second member |
| --- | --- | --- |
| pin | force along x and y | −μ r R sgn ω_rel − c ω_rel, R the size of the force |
| guide | normal force N, moment | −μ \\|N\\| sgn v − c v along the guide |
| slot | normal force N | −μ \\|N\\| sgn v − c v along the slot |
| mesh, rack | force F along the teeth's path | \\|F\\| tan α apart, the pressure angle's share |
| cable | tension | – |
| drive | torque on a crank, force on a block, normal force of a cam | – |

Teeth press at the pitch point, along the line of action (DIN 3960; Norton, *Design of Machinery*, chapter
9). A belt, and teeth whose pitch point is not where centres and ratio put it, pass on torques in the
relation of their speeds, and the carrier takes what is left over.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import variables_of
from linkwright.kinetostatics.friction import FRICTIONLESS, Friction
from linkwright.kinetostatics.places import Scene, dot, left
from linkwright.kinetostatics.wrench import Wrenches, units_between
from linkwright.linkages.model.element import Gear
from linkwright.linkages.model.structure import FRAME, Drive, Pair

if TYPE_CHECKING:
    from linkwright.kinetostatics.cam_contact import Push

# Relative difference of speeds at a pitch point that counts as rounding.
_ROLLS = 1e-9

# Relative speed, over the crank's times the size of the mechanism, below which a pair stands.
_STANDS = 1e-12


class Sliding(NamedTuple):
    """Friction of a cam's contact: a checked number, which may carry derivatives."""

    coefficient: Any
    radius: float = 0.0
    viscous: float = 0.0
    length: float = 0.0


@dataclass
class PairModel:
    """A pair, or a drive, at all crank angles."""

    # Those of the pair; a drive is a `"torque"`, a `"force"`, or the `"contact"` with a cam.
    name: str
    kind: str
    second: str  # the member that forces are reported on
    unknowns: list[Wrenches]  # what one unit of each unknown does [1 N or 1 N m]
    moments: tuple[bool, ...]  # which unknowns are moments
    extra: Wrenches | None  # what one unit of friction, or of the force that parts teeth, does
    rate: Floats  # (n,): relative angular speed of a pin, relative velocity in a guide or slot [rad/s, m/s]
    sense: Floats  # its sign; zero where the pair stands
    friction: Friction | Sliding  # as given
    spread: float = 0.0  # tangent of the pressure angle
    # What the contacts of a cam do to its follower.
    push: Push | None = None
    pull: Push | None = None

    def slopes(self, x: Floats) -> Floats:
        """Derivatives of the extra force by the unknowns at their values x, (n, unknowns)."""
        if self.kind in ("mesh", "rack"):
            return self.spread * np.sign(x)
        drag = -self.friction.coefficient * self.sense
        if self.kind == "pin":
            size = np.hypot(x[:, 0], x[:, 1])
            return (drag * self.friction.radius / np.where(size > 0, size, 1.0))[:, None] * x
        slopes = [0.0 * drag] * x.shape[1]
        if self.kind == "guide" and self.friction.length:
            share = x[:, 1] / self.friction.length
            ends = np.sign(0.5 * x[:, 0] + share), np.sign(0.5 * x[:, 0] - share)
            slopes = [0.5 * drag * (ends[0] + ends[1]), drag * (ends[0] - ends[1]) / self.friction.length]
        elif self.kind in ("guide", "slot", "contact"):
            slopes[0] = drag * np.sign(x[:, 0])
        return np.stack(slopes, axis=1)

    def acts_on(self, member: str) -> bool:
        """Whether a force or friction of the pair may act on a member."""
        extra = [] if self.extra is None else [self.extra]
        return any(member in wrenches.on for wrenches in (*self.unknowns, *extra))

    @property
    def is_nonlinear(self) -> bool:
        """Whether the extra force depends on the unknowns."""
        mu = self.friction.coefficient
        return self.extra is not None and (
            self.spread != 0 or bool(mu != 0) or variables_of((mu,)) is not None
        )

    @property
    def viscous(self) -> Floats:
        """Extra force in proportion to the rate, (n,)."""
        return -self.friction.viscous * self.rate


def pair_models(scene: Scene, friction: dict[str, Friction], pressure_angle: float) -> list[PairModel]:
    """All pairs and drives of a scene.

    `friction`: friction by name of the pair; `pressure_angle`: of all teeth [rad]. Returns: pairs in the
    order of the structure, then the drives.
    """
    spread = float(np.tan(pressure_angle))
    known = scene.structure.pairs.values()
    made = [_model(scene, pair, friction.get(pair.name, FRICTIONLESS), spread) for pair in known]
    return made + [_drive(scene, drive) for drive in scene.structure.drives]


def _model(scene: Scene, pair: Pair, friction: Friction, spread: float) -> PairModel:
    match pair.kind:
        case "pin":
            return _pin(scene, pair, friction)
        case "guide":
            return _guide(scene, pair, friction)
        case "slot":
            return _slot(scene, pair, friction)
        case "mesh":
            return _mesh(scene, pair, spread)
        case "rack":
            return _rack(scene, pair, spread)
    return _cable(scene, pair)


def _moving(scene: Scene, rate: Floats, size: float) -> tuple[Floats, Floats]:
    sense = np.where(np.abs(rate) > _STANDS * size, np.sign(rate), 0.0) * np.sign(scene.motion.speed)
    return rate * scene.motion.speed, sense


def _pin(scene: Scene, pair: Pair, friction: Friction) -> PairModel:
    place = scene.point(pair.point)
    unknowns = units_between(scene, pair.first, pair.second, place)
    if not friction.acts:
        return _without_friction(scene, pair.name, "pin", pair.second, *unknowns)
    one = np.ones(scene.n)
    extra = Wrenches(scene).couple(pair.second, one).couple(pair.first, -one)
    rate, sense = _moving(scene, scene.turning(pair.second) - scene.turning(pair.first), 1.0)
    return PairModel(pair.name, "pin", pair.second, unknowns, (False, False), extra, rate, sense, friction)


def _guide(scene: Scene, pair: Pair, friction: Friction) -> PairModel:
    assert pair.guide is not None
    t = scene.direction(pair.guide)
    unknowns = [Wrenches(scene).on_guide(pair, left(t))]
    if scene.structure.members[pair.second].turns:
        unknowns.append(Wrenches(scene).turning_guide(pair))
    moments = (False, True)[: len(unknowns)]
    if not friction.acts:
        without_friction = _without_friction(scene, pair.name, "guide", pair.second, *unknowns)
        without_friction.moments = moments
        return without_friction
    extra = Wrenches(scene).on_guide(pair, t)
    # The speed along the guide is the power of a unit of force between block and guide.
    rate, sense = _moving(scene, extra.power(), scene.size)
    return PairModel(pair.name, "guide", pair.second, unknowns, moments, extra, rate, sense, friction)


def _slot(scene: Scene, pair: Pair, friction: Friction) -> PairModel:
    assert pair.guide is not None
    t, place = scene.direction(pair.guide), scene.point(pair.point)
    normal = Wrenches(scene).between(pair.first, pair.second, left(t), place)
    if not friction.acts:
        return _without_friction(scene, pair.name, "slot", pair.second, normal)
    extra = Wrenches(scene).between(pair.first, pair.second, t, place)
    rate, sense = _moving(scene, extra.power(), scene.size)
    return PairModel(pair.name, "slot", pair.second, [normal], (False,), extra, rate, sense, friction)


def _cable(scene: Scene, pair: Pair) -> PairModel:
    """The cable pulls its end back towards the arc, and the arc along the cable."""
    assert pair.guide is not None
    t = scene.direction(pair.guide)
    touch = scene.reference(pair.first) + pair.guide.offset * left(t)
    pull = Wrenches(scene).force(pair.second, -t, touch).force(pair.first, t, touch)
    return _without_friction(scene, pair.name, "cable", pair.second, pull)


def _drive(scene: Scene, drive: Drive) -> PairModel:
    driver = scene.mechanism.linear_drivers.get(drive.name) or scene.mechanism.cranks.get(drive.name)
    if driver is not None and driver.pushed:
        return _cam_contact(scene, drive)
    if drive.guide is None:
        one = np.ones(scene.n)
        torque = Wrenches(scene).couple(drive.member, one).couple(FRAME, -one)
        without_friction = _without_friction(scene, drive.name, "torque", drive.member, torque)
        without_friction.moments = (True,)
        return without_friction
    pair = scene.structure.pairs[f"{drive.name}.guide"]
    push = Wrenches(scene).on_guide(pair, scene.direction(drive.guide))
    return _without_friction(scene, drive.name, "force", drive.member, push)


def _cam_contact(scene: Scene, drive: Drive) -> PairModel:
    from linkwright.kinetostatics.cam_contact import follower_at, pushes

    follower = follower_at(scene, drive.name)
    push, pull = pushes(scene, follower, drive.name)
    without_friction = _without_friction(scene, drive.name, "contact", drive.member, push.normal)
    without_friction.friction = Sliding(follower.cam.sliding_friction)
    without_friction.push, without_friction.pull = push, pull
    return _sliding(scene, without_friction, push)


def _sliding(scene: Scene, model: PairModel, push: Push) -> PairModel:
    model.extra = push.along
    model.rate, model.sense = _moving(scene, push.slip, scene.size)
    return model


def with_pulls(scene: Scene, models: list[PairModel], x: Floats) -> bool:
    """Second contacts of cams take over where the first would have to pull; `x` (n, unknowns)."""
    at, changed = 0, False
    for model in models:
        force = x[:, at]
        if model.push is not None and model.pull is not None and (force < 0).any():
            _sliding(scene, model, model.push.taken_over(model.pull, force))
            changed = True
        at += len(model.unknowns)
    return changed


def _without_friction(scene: Scene, name: str, kind: str, second: str, *unknowns: Wrenches) -> PairModel:
    still, forces = np.zeros(scene.n), (False,) * len(unknowns)
    return PairModel(name, kind, second, list(unknowns), forces, None, still, still, FRICTIONLESS)


# -- teeth ---------------------------------------------------------------------------------------------------


def _mesh(scene: Scene, pair: Pair, spread: float) -> PairModel:
    gear = scene.mechanism.gears[pair.element]
    ratio = _ratio(gear)
    if gear.kind in ("external", "internal") and ratio != 1.0:
        centre = scene.point(gear.pivot)
        arm = _other_centre(scene, gear) - centre
        # The pitch point divides the line of centres in the ratio of the sizes: there both gears, seen from
        # the carrier, have the same velocity.
        pitch = centre + arm / (1.0 - ratio)
        if _is_rolling(scene, pair, pitch, left(arm)):
            e = arm / np.hypot(arm[:, 0], arm[:, 1])[:, None]
            return _teeth(scene, pair, pitch, left(e), -e if gear.kind == "external" else e, spread)
    carrier = FRAME if gear.carrier is None else gear.carrier
    one = np.ones(scene.n)
    torque = Wrenches(scene).couple(pair.second, one).couple(pair.first, -ratio * one)
    torque.couple(carrier, (ratio - 1.0) * one)
    without_friction = _without_friction(scene, pair.name, "couple", pair.second, torque)
    without_friction.moments = (True,)
    return without_friction


def _ratio(gear: Gear) -> float:
    ratio = gear.size_other / gear.size
    return -ratio if gear.kind in ("external", "crossed_belt") else ratio


def _other_centre(scene: Scene, gear: Gear) -> Floats:
    """The other gear's centre: an end of its link that the carrier holds; at rest, the carrier's start."""
    carrier = None if gear.carrier is None else scene.links[gear.carrier]
    if gear.meshes is None:
        return scene.point("") if carrier is None else scene.reference(gear.carrier or "")
    link = scene.links[gear.meshes]
    ends = (link.start, link.end)
    if carrier is None:
        held = [end for end in ends if scene.structure.carriers.get(end) == FRAME]
    else:
        held = [end for end in ends if end in (carrier.start, carrier.end)]
    if not held or held[0] == link.start:
        return scene.reference(gear.meshes)
    return scene.point(held[0])


def _is_rolling(scene: Scene, pair: Pair, place: Floats, along: Floats) -> bool:
    """Whether both members have the same speed along a direction at a place away from the centre."""
    apart = scene.moved(pair.second, place) - scene.moved(pair.first, place)
    slip = np.abs(dot(apart, along)) / np.maximum(np.hypot(along[:, 0], along[:, 1]), _ROLLS * scene.size)
    arm = place - scene.point(pair.point)
    return bool(
        slip.max() < _ROLLS * scene.size and np.hypot(arm[:, 0], arm[:, 1]).min() > _ROLLS * scene.size
    )


def _teeth(scene: Scene, pair: Pair, pitch: Floats, along: Floats, apart: Floats, spread: float) -> PairModel:
    press = Wrenches(scene).between(pair.first, pair.second, along, pitch)
    without_friction = _without_friction(scene, pair.name, pair.kind, pair.second, press)
    without_friction.extra = Wrenches(scene).between(pair.first, pair.second, apart, pitch)
    without_friction.spread = spread
    return without_friction


def _rack(scene: Scene, pair: Pair, spread: float) -> PairModel:
    """Teeth of a rack; where the gear's centre moves along the rack, a relation of torque and force."""
    assert pair.guide is not None
    rack = scene.mechanism.racks[pair.element]
    radius = rack.radius if rack.side == "right" else -rack.radius
    t = scene.direction(pair.guide)
    pitch = scene.reference(pair.first) - radius * left(t)
    slip = dot(scene.moved(pair.second, pitch) - scene.moved(pair.first, pitch), t)
    if np.abs(slip).max() < _ROLLS * scene.size:
        return _teeth(scene, pair, pitch, t, -np.sign(radius) * left(t), spread)
    guide = scene.structure.pairs[f"{pair.element}.guide"]
    lever = radius * np.ones(scene.n)
    push = Wrenches(scene).on_guide(guide, t).couple(pair.first, -lever)
    if pair.guide.on is not None:
        push.couple(pair.guide.on, lever)
    return _without_friction(scene, pair.name, "couple", pair.second, push)
