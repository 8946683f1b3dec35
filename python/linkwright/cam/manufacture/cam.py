"""The drawings of a cam: one for each part that is made.

| closure | parts | outlines |
| --- | --- | --- |
| spring, constant diameter or breadth | the cam | ``PROFILE`` |
| groove | the cam | ``PROFILE`` and ``PROFILE_OUTER``, the flanks of the groove |
| conjugate | the cam, and the second | ``PROFILE`` each |

``PITCH_CURVE`` is the path of the roller's centre seen from the cam. ``CUTTER_PATH`` is that of the cutter's
centre, where the cam has one; a groove has one for each flank unless the cutter is as large as the roller.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.manufacture.curve import ClosedCurve, Side
from linkwright.cam.manufacture.drawing import CUTTER_PATH, PITCH_CURVE, PROFILE, Drawing
from linkwright.cam.manufacture.sides import turned
from linkwright.cam.profile.profile import CamProfile, Flank
from linkwright.kernel.public import public

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class TurnedCurve:
    """A curve turned about the centre of the cam.

    Attributes
    ----------
    curve : ClosedCurve
        The curve.
    angle : float
        By how much [rad].
    """

    curve: ClosedCurve
    angle: float

    @property
    def breaks(self) -> tuple[float, ...]:
        """Those of the curve [rad]."""
        return self.curve.breaks

    def points(self, phi: Floats, side: Side = "after") -> Floats:
        """Places over cam angles of shape (n,), (n, 2) [m]."""
        return self._turned(self.curve.points(phi, side))

    def tangents(self, phi: Floats, side: Side = "after") -> Floats:
        """First derivative by the cam angle, (n, 2) [m/rad]."""
        return self._turned(self.curve.tangents(phi, side))

    def seconds(self, phi: Floats, side: Side = "after") -> Floats:
        """Second derivative by the cam angle, (n, 2) [m/rad²]."""
        return self._turned(self.curve.seconds(phi, side))

    def _turned(self, vectors: Floats) -> Floats:
        return turned(vectors, np.full(len(vectors), self.angle))


@public
def cam_drawings(profile: CamProfile) -> tuple[Drawing, ...]:
    """The drawings of a cam.

    Parameters
    ----------
    profile : CamProfile
        The cam.

    Returns
    -------
    tuple of Drawing
        One a part, as the cam stands where its programme begins: its first follower on the zero mark. Parts
        of one cam share that frame.
    """
    flanks = profile.flanks if profile.cam.closure == "conjugate" else profile.flanks[:1]
    names = (profile.name, f"{profile.name} second")
    return tuple(
        Drawing(
            name,
            {layer: _turned(curve, flank) for layer, curve in _curves(profile, flank)},
            width=profile.cam.width,
        )
        for name, flank in zip(names, flanks, strict=False)
    )


def _turned(curve: ClosedCurve, flank: Flank) -> ClosedCurve:
    """A curve in the frame of the first contact."""
    angle = flank.contact.turned
    return TurnedCurve(curve, angle) if angle else curve


def _curves(profile: CamProfile, flank: Flank) -> Iterator[tuple[str, ClosedCurve]]:
    """Layers and curves of one part."""
    roller = flank.contact.sizes.roller_radius
    is_groove = profile.cam.closure == "groove"
    yield PROFILE, flank.curve()
    if is_groove:
        yield f"{PROFILE}_OUTER", flank.curve(roller)
    if roller > 0:
        yield PITCH_CURVE, flank.curve(0.0)
    cutter = profile.cam.cutter_radius
    # A cutter as large as the roller goes along the pitch curve.
    if cutter is not None and cutter != roller:
        yield CUTTER_PATH, flank.curve(cutter - roller)
        if is_groove:
            yield f"{CUTTER_PATH}_OUTER", flank.curve(roller - cutter)
