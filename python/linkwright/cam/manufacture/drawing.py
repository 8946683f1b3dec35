"""What is drawn of a cam, and what was measured of a written file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.manufacture.curve import ClosedCurve
from linkwright.cam.manufacture.deviation import Deviation
from linkwright.cam.manufacture.track import Track
from linkwright.kernel.errors import InputError

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
    def mark(self) -> NDArray[np.float64]:
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
