"""Drawings of a cam, one for each part that is made: outlines, marks, notes, what was measured of the file.

| closure | parts | outlines |
| --- | --- | --- |
| spring, constant diameter or breadth | the cam | ``PROFILE`` |
| groove | the cam | ``PROFILE`` and ``PROFILE_OUTER``, the flanks of the groove |
| conjugate | the cam, and the second | ``PROFILE`` each |

``PITCH_CURVE`` is the path of the roller's centre seen from the cam. ``CUTTER_PATH`` is that of the cutter's
centre, where the cam has one; a groove has one for each flank unless the cutter is as large as the roller.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from linkwright.cam.manufacture.curve import ClosedCurve, Side, Track
from linkwright.cam.manufacture.fit import Deviation
from linkwright.cam.manufacture.outline import turned
from linkwright.cam.profile.profile import CamProfile, Flank
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public

# Usual layers of outlines, and those of what is drawn beside them.
PROFILE, PITCH_CURVE, CUTTER_PATH = "PROFILE", "PITCH_CURVE", "CUTTER_PATH"
CENTRE, ZERO_ANGLE, TEXT = "CENTRE", "ZERO_ANGLE", "TEXT"

# Letters that a name of a layer may not have, in DXF.
_FORBIDDEN = set('<>/\\":;?*|=`,')

# Half the centre mark, and from where to where the zero mark goes, over the largest radius.
_CROSS, _MARK = 0.05, (1.03, 1.13)


@dataclass(frozen=True)
class Drawing:
    """Outlines about the cam's centre, which is the origin.

    Attributes
    ----------
    name : str
        Of the part.
    curves : mapping of str to ClosedCurve
        Layer → curve, such as ``PROFILE``, ``PITCH_CURVE``, ``CUTTER_PATH``.
    zero_angle : float
        Direction of the mark by which the cam is set up [rad].
    width : float, optional
        Thickness of the part, for a solid [m].
    """

    name: str
    curves: Mapping[str, ClosedCurve]
    zero_angle: float = 0.0
    width: float | None = None

    def __post_init__(self) -> None:
        """Refuse what no drawing can hold."""
        if not self.curves:
            raise InputError(f"{self.name}: a drawing needs at least one curve")
        for layer in self.curves:
            if not layer or set(layer) & _FORBIDDEN or layer in (CENTRE, ZERO_ANGLE, TEXT, "0"):
                raise InputError(
                    f'layer "{layer}": expected a name of its own, such as {PROFILE}, '
                    f"without any of {''.join(sorted(_FORBIDDEN))}"
                )

    @cached_property
    def tracks(self) -> dict[str, Track]:
        """Layer → the curve to follow; refuses what has no outline."""
        return {layer: Track.of(curve) for layer, curve in self.curves.items()}

    @cached_property
    def radius(self) -> float:
        """The largest distance from the centre, as far as samples show it [m]."""
        return max(float(np.linalg.norm(track.sampled[1], axis=1).max()) for track in self.tracks.values())

    @property
    def cross(self) -> float:
        """Half the length of the centre mark [m]."""
        return _CROSS * self.radius

    @property
    def mark(self) -> Floats:
        """Ends of the zero mark, (2, 2) [m]."""
        direction = np.array([np.cos(self.zero_angle), np.sin(self.zero_angle)])
        return np.outer(np.multiply(_MARK, self.radius), direction)


@dataclass(frozen=True)
class MeasuredOutline:
    """An outline of a file, read back and compared with its curve.

    Attributes
    ----------
    layer : str
        Its name in the file.
    form : str
        How the file holds it, such as ``LWPOLYLINE``.
    deviation : Deviation
        Its distance from the curve, both ways.
    tolerance : float
        What was to be kept [m].
    """

    layer: str
    form: str
    deviation: Deviation
    tolerance: float


@dataclass(frozen=True)
class WrittenFile:
    """A file that was written and read back.

    Attributes
    ----------
    path : Path
        The file.
    outlines : tuple of MeasuredOutline
        What it holds.
    """

    path: Path
    outlines: tuple[MeasuredOutline, ...]


@dataclass(frozen=True)
class TurnedCurve:
    """A curve turned about the centre of the cam."""

    curve: ClosedCurve
    angle: float  # by how much [rad]

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
    angle = flank.contact.turned
    return TurnedCurve(curve, angle) if angle else curve


def _curves(profile: CamProfile, flank: Flank) -> Iterator[tuple[str, ClosedCurve]]:
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
