"""Cams in the moving sketch: outlines that turn, rollers, edges and faces that they move.

A cam is drawn in the frame of its contact, which stands at the direction of the follower, or of the line to
the follower's pivot, when the programme begins, and turns with or against the crank from there.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from linkwright.cam.model.cam import Cam
from linkwright.cam.model.follower import to_arm_pivot
from linkwright.cam.profile.contact import CamCurve, Contact, contacts
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import LinkwrightError
from linkwright.linkages.model.topology import ORIGIN
from linkwright.machine.machine import Machine

Scene = dict[str, Any]

# Places of an outline: between them the page draws straight.
_PLACES = 360

# Digits of a place, over the radius of the cam.
_FINE = 1e-4

# Length of the stem of a translating follower, over the base circle.
_STEM = 0.7

# Half a face over the base circle, where it reaches farther than the contact.
_FACE = 0.3


def cam_parts(machine: Machine, series: dict[str, int]) -> Iterator[Scene]:
    """Drawing parts of cams and followers; `series`: number of the colour of each element."""
    for name, cam in machine.mechanism.cams.items():
        touching = _contacts(machine, name, cam)
        for k, contact in enumerate(touching):
            if k == 0 or cam.closure == "conjugate":
                yield _cam(name, cam, contact, series[name], second=k > 0)
        for k, contact in enumerate(touching):
            yield _follower(machine, name, cam, contact, series[name], second=k > 0)


def cam_headings(machine: Machine, angles: Floats) -> dict[str, Floats]:
    """Angles of the cams at crank angles (n,), by the name of the cam's heading [rad]."""
    sense = {"same": 1.0, "opposite": -1.0}
    return {
        heading(name): _direction(machine, cam) + sense[cam.rotation] * (angles - cam.phase)
        for name, cam in machine.mechanism.cams.items()
    }


def heading(name: str) -> str:
    """Name of a cam's heading, which no link can have."""
    return f"{name}, cam"


def reach(machine: Machine) -> Iterator[tuple[str, float]]:
    """Centre and largest radius of each cam, for the frame of the picture: name of the point, and [m]."""
    for name, cam in machine.mechanism.cams.items():
        for contact in _contacts(machine, name, cam):
            outer = contact.sizes.roller_radius if cam.closure == "groove" else -contact.sizes.roller_radius
            yield _centre(cam), float(np.linalg.norm(_outline(CamCurve(contact, outer)), axis=1).max())


def _contacts(machine: Machine, name: str, cam: Cam) -> tuple[Contact, ...]:
    try:
        return contacts(cam, machine.mechanism.fixed_points(), name)
    except LinkwrightError:
        # silent: a cam without room for its second follower is reported by the study
        return ()


def _centre(cam: Cam) -> str:
    return cam.pivot or ORIGIN


def _direction(machine: Machine, cam: Cam) -> float:
    """Direction of the contact's frame when the programme begins [rad]."""
    if not cam.is_oscillating:
        return float(cam.direction)
    dx, dy = to_arm_pivot(cam, machine.mechanism.fixed_points())
    return math.atan2(dy, dx)


def _outline(curve: CamCurve) -> Floats:
    """Places of a curve with those at its joints, (n, 2) [m]."""
    phi = np.unique([*np.linspace(0, 2 * math.pi, _PLACES, endpoint=False), *curve.breaks[:-1]])
    return curve.points(phi)


def _cam(name: str, cam: Cam, contact: Contact, series: int, *, second: bool) -> Scene:
    radius = contact.sizes.roller_radius
    away = (-radius, radius) if cam.closure == "groove" else (-radius,)
    outlines = [_outline(CamCurve(contact, point)) for point in away]
    digits = max(0, math.ceil(-math.log10(_FINE * float(np.abs(outlines[0]).max()))))
    return {
        "kind": "cam",
        "name": f"{name}, second cam" if second else name,
        "at": _centre(cam),
        "link": heading(name),
        "angle": contact.turned,
        "outlines": [np.round(outline, digits).tolist() for outline in outlines],
        "series": series,
    }


def _follower(machine: Machine, name: str, cam: Cam, contact: Contact, series: int, *, second: bool) -> Scene:
    """What touches the cam: at the place of the follower on a slide, or on its arm about the pivot."""
    look: Scene = {"name": name, "at": name, "link": None, "series": series, "rod": [0.0, 0.0]}
    if cam.is_oscillating:
        return _on_arm(name, cam, contact, look, second=second)
    look["angle"] = float(cam.direction)
    place = [-_apart(cam, contact), 0.0] if second else [0.0, 0.0]
    # The second follower is held by the first; that goes on to where its work is.
    look["rod"] = [0.0, 0.0] if second else [_STEM * contact.sizes.base_radius, 0.0]
    if contact.kernel.is_roller:
        return {"kind": "roller", **look, "place": place, "radius": contact.sizes.roller_radius}
    rows = contact.kernel.shape(_PLACES)
    ends = _ends(rows.least["along"].value, rows.greatest["along"].value, contact.sizes.base_radius)
    across = float(cam.face_tilt) + 0.5 * math.pi
    return {"kind": "face", **look, "place": place, "along": across, "ends": ends}


def _apart(cam: Cam, contact: Contact) -> float:
    """Distance of the second follower from the first, along their line [m]."""
    if cam.second is not None and cam.second.distance is not None:
        return float(cam.second.distance)
    return float(cam.breadth) if cam.breadth is not None else 2 * contact.start + cam.stroke


def _on_arm(name: str, cam: Cam, contact: Contact, look: Scene, *, second: bool) -> Scene:
    look |= {"rod": [0.0, 0.0] if second else None, "at": cam.arm_pivot, "link": name, "angle": 0.0}
    if not contact.kernel.is_roller:
        rows = contact.kernel.shape(_PLACES)
        ends = _ends(rows.least["along"].value, rows.greatest["along"].value, contact.sizes.base_radius)
        side = 1.0 if cam.side == "left" else -1.0
        return {
            "kind": "face",
            **look,
            "place": [0.0, side * contact.sizes.offset],
            "along": 0.0,
            "ends": ends,
        }
    turn = 0.0
    if second and cam.second is not None and cam.second.angle is not None:
        turn = float(cam.second.angle) * (1.0 if cam.side == "left" else -1.0)
    place = [contact.sizes.arm * math.cos(turn), contact.sizes.arm * math.sin(turn)]
    return {"kind": "roller", **look, "place": place, "radius": contact.sizes.roller_radius}


def _ends(low: float, high: float, base: float) -> list[float]:
    """From where to where a face is drawn, a little beyond its contact [m]."""
    more = _FACE * base
    return [float(low) - more, float(high) + more]
