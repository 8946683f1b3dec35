"""A curve as arcs, spline or polygon within a tolerance that is measured, not estimated."""

from __future__ import annotations

from typing import Literal

from linkwright.cam.manufacture.arcs import arcs, polyline
from linkwright.cam.manufacture.curve import Track, size
from linkwright.cam.manufacture.deviation import Deviation, deviation
from linkwright.cam.manufacture.outline import Outline
from linkwright.cam.manufacture.spline import Spline, spline
from linkwright.kernel.errors import ConvergenceError, InputError

Form = Literal["arcs", "spline", "cubic", "polyline"]
FORMS: tuple[Form, ...] = ("arcs", "spline", "cubic", "polyline")

# A hundredth of what good grinding keeps [m].
TOLERANCE = 1e-6

# Below this share of a curve's size its own places are not known well enough to compare: rounding of
# coordinates in a file, and of directions between neighbouring places.
_FINEST = 1e-12

# Share of the size that is kept back for rounding of the coordinates in a file.
_ROUNDING = 1e-14

# What is aimed at if the tolerance was missed by what samples did not see, and how often.
_LESS, _TRIES = 0.98, 6


def fit(
    track: Track, form: Form = "arcs", tolerance: float = TOLERANCE
) -> tuple[Outline | Spline, Deviation]:
    """Approximate a curve within a tolerance.

    ``tolerance``: largest distance between curve and path, both ways [m].
    """
    extent = size(track.parts[0].curve)
    _refuse(form, tolerance, extent)
    aim = kept = tolerance - _ROUNDING * extent
    for _ in range(_TRIES):
        path = _path(track, form, aim)
        found = deviation(path, track)
        if found.largest <= kept:
            return path, found
        aim *= _LESS * kept / found.largest
    raise ConvergenceError(
        f"the curve as {form} is {found.largest:.3g} m off where {tolerance:.3g} m were asked for; "
        "ask for a wider tolerance",
        method="approximating a curve",
        iterations=_TRIES,
        residual=found.largest,
    )


def _path(track: Track, form: Form, tolerance: float) -> Outline | Spline:
    """The path of a form."""
    if form == "arcs":
        return arcs(track, tolerance)
    if form == "polyline":
        return polyline(track, tolerance)
    return spline(track, tolerance, 5 if form == "spline" else 3)


def _refuse(form: Form, tolerance: float, extent: float) -> None:
    """What cannot be asked for."""
    if form not in FORMS:
        raise InputError(f'form "{form}": expected {", ".join(FORMS)}')
    finest = _FINEST * extent
    if not finest <= tolerance < float("inf"):
        raise InputError(
            f"tolerance {tolerance:g} m: expected at least {finest:.1g} m (10⁻¹² of the curve's size), "
            "such as 1e-6 m"
        )
