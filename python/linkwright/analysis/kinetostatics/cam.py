"""The force with which a cam drives its follower: along the normal of the contact, whichever side carries.

A spring or a load keeps the follower on the cam as long as the cam has to push. A groove, a second cam or a
second follower takes over where it has to pull; the force counts as negative there.
"""

from __future__ import annotations

import numpy as np

from linkwright.analysis.cam.contact import contacts, touch
from linkwright.analysis.kinetostatics.scene import Floats, Scene
from linkwright.analysis.kinetostatics.wrench import Wrenches
from linkwright.machine.cam import OscillatingFollower, TranslatingFollower
from linkwright.machine.structure import FRAME

Follower = TranslatingFollower | OscillatingFollower


def follower_at(scene: Scene, name: str) -> Follower | None:
    """The follower of a cam that drives a member; None if something else does."""
    found = scene.mechanism.linear_drivers.get(name) or scene.mechanism.cranks.get(name)
    return found if isinstance(found, Follower) else None


def pushes(scene: Scene, follower: Follower, name: str) -> tuple[Wrenches, Wrenches | None]:
    """What a unit of force at the first contact does, and a unit of pull where a second contact takes it.

    Parameters
    ----------
    scene : Scene
        The machine and its motion.
    follower : TranslatingFollower or OscillatingFollower
        The driver.
    name : str
        Its name.

    Returns
    -------
    push : Wrenches
        Of 1 N on the follower, and on the frame through the cam's bearings.
    pull : Wrenches or None
        The same with the sign of a pull; None if there is no second contact.
    """
    cam, points = follower.cam, scene.mechanism.fixed_points()
    made = []
    for contact, sign in zip(contacts(cam, points, name), (1.0, -1.0), strict=False):
        at = touch(cam, contact, points, scene.motion.crank_angle)
        made.append(Wrenches(scene).between(FRAME, name, sign * at.normal, at.pitch))
    return made[0], made[1] if len(made) > 1 else None


def taken_over(push: Wrenches, pull: Wrenches, force: Floats) -> Wrenches:
    """The push where a force (n,) is positive, the pull elsewhere."""
    push.values = np.where((force >= 0)[:, None, None], push.values, pull.values)
    return push
