"""A curve as a polygon with its corners on the curve: a chord of length s errs by κ s²/8."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.manufacture.curve import Stretch
from linkwright.cam.manufacture.mesh import equal_errors
from linkwright.cam.manufacture.outline import Outline
from linkwright.cam.manufacture.sides import Sides
from linkwright.cam.manufacture.track import Track

Floats = NDArray[np.float64]

# Error of a chord by its length.
_ORDER = 2.0

# Shares of a chord at which it is compared with the curve; the largest distance is near the middle.
_SHARES = np.linspace(0.05, 0.95, 19)


def polyline(track: Track, tolerance: float) -> Outline:
    """Approximate a curve by chords.

    Parameters
    ----------
    track : Track
        The curve.
    tolerance : float
        Largest distance from the curve [m].

    Returns
    -------
    Outline
        Lines only; as few as equal errors give.

    Raises
    ------
    ConvergenceError
        The tolerance asks for too many chords.
    """
    vertices = np.concatenate([_corners(part, tolerance) for part in track.parts])
    return Outline(vertices, np.zeros(len(vertices)))


def _corners(part: Stretch, tolerance: float) -> Floats:
    """Starts of the chords of a stretch, (n, 2)."""

    def errors(cuts: Floats) -> Floats:
        """Largest distance of the curve from each chord, at samples."""
        p = part.points(cuts)
        chords = Sides(p[:-1], np.diff(p, axis=0), np.zeros(len(p) - 1))
        places = part.points(cuts[:-1, None] + np.diff(cuts)[:, None] * _SHARES)
        return np.asarray(chords.distances(places).max(axis=1))

    cuts = equal_errors(errors, part.low, part.high, _ORDER, tolerance)
    return part.points(cuts[:-1])
