"""The force with which a cam drives its follower: along the normal of the contact, whichever side carries.

A spring or a load keeps the follower on the cam as long as the cam has to push. A groove, a second cam or a
second follower takes over where it has to pull; the force counts as negative there. An edge or a face slides
over the cam with friction; a roller rolls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.cam.model.follower import OscillatingFollower, TranslatingFollower
from linkwright.cam.profile.contact import centre_of, contacts, touch, turned_by
from linkwright.kernel.arrays import Floats
from linkwright.kinetostatics.places import Scene, dot, left
from linkwright.kinetostatics.wrench import Wrenches
from linkwright.linkages.model.structure import FRAME

Follower = TranslatingFollower | OscillatingFollower


def follower_at(scene: Scene, name: str) -> Follower:
    """The follower of a cam that drives a member."""
    follower = scene.mechanism.linear_drivers.get(name) or scene.mechanism.cranks[name]
    assert isinstance(follower, Follower)
    return follower


@dataclass
class Push:
    """What a unit of force at a contact does."""

    normal: Wrenches  # 1 N along the normal on the follower, and on the frame through the cam's bearings
    along: Wrenches  # 1 N along the surface, to the left of the normal
    slip: Floats  # (n,): how fast the follower slides over the cam that way, by the crank angle [m/rad]

    def taken_over(self, other: Push, force: Floats) -> Push:
        """This one where a force (n,) is positive, another elsewhere."""
        own = force >= 0
        for mine, its in ((self.normal, other.normal), (self.along, other.along)):
            mine.taken_over(its, own)
        self.slip = np.where(own, self.slip, other.slip)
        return self

    @property
    def lever(self) -> Floats:
        """Torque on the cam by 1 N along the surface, (n,) [m]: the power at the follower less the slip."""
        return self.along.power() - self.slip


def pushes(scene: Scene, follower: Follower, name: str) -> tuple[Push, Push | None]:
    """What the contacts of a cam do; of the second, if any, with its normal force counted as negative."""
    cam, points = follower.cam, scene.mechanism.fixed_points()
    centre = np.stack(centre_of(cam, points))
    sense = turned_by(cam, np.ones(1))
    made = []
    for contact, sign in zip(contacts(cam, points, name), (1.0, -1.0), strict=False):
        at = touch(cam, contact, points, scene.motion.crank_angle)
        surface = left(at.normal)
        apart = scene.moved(name, at.pitch) - sense * left(at.pitch - centre)
        made.append(
            Push(
                Wrenches(scene).between(FRAME, name, sign * at.normal, at.pitch),
                Wrenches(scene).between(FRAME, name, surface, at.pitch),
                dot(apart, surface),
            )
        )
    return made[0], made[1] if len(made) > 1 else None
