"""Files of manufacture, read again and compared with what they are to hold."""

from __future__ import annotations

from pathlib import Path as File

import numpy as np

from linkwright.cam.manufacture.curve import size
from linkwright.cam.manufacture.deviation import deviation
from linkwright.cam.manufacture.drawing import PROFILE, Drawing, MeasuredOutline
from linkwright.cam.manufacture.dxf import read_dxf
from linkwright.cam.manufacture.file_outline import FileOutline
from linkwright.cam.manufacture.fit import TOLERANCE
from linkwright.cam.manufacture.outline import Outline
from linkwright.cam.manufacture.step import read_step
from linkwright.cam.manufacture.svg import read_svg
from linkwright.cam.manufacture.table import Table, curvature, read_csv
from linkwright.cam.manufacture.track import Track
from linkwright.kernel.errors import ExchangeError, InputError

# How far a row of a table may be from its curve, over the curve's size: a table holds the curve itself, and
# an error of 1e-15 of the cam angle moves places of a steep curve by some times that.
_ROW = 1e-13

# How far a curvature may be from that of the curve, over the largest. At joints, where it may jump, the cam
# angle is known to rounding only: either side will do, this far from it [rad].
_BEND, _BESIDE = 1e-6, 1e-9


def read_back(
    file: File, drawing: Drawing, tolerance: float = TOLERANCE, *, layers: tuple[str, ...] | None = None
) -> tuple[MeasuredOutline, ...]:
    """Read a file and compare its outlines with their curves.

    Parameters
    ----------
    file : path
        A DXF, SVG, STEP or CSV file; its name says which.
    drawing : Drawing
        What it is to hold.
    tolerance : float
        Largest distance of an outline from its curve [m]. The rows of a CSV lie on the curve whatever it is.
    layers : tuple of str, optional
        Which of the drawing's layers; without it all. A CSV file has one, a STEP file ``PROFILE`` alone.

    Returns
    -------
    tuple of MeasuredOutline
        One a layer: what was measured.

    Raises
    ------
    ExchangeError
        The file cannot be read, lacks an outline, has it open, in another unit or farther from the curve.
    InputError
        Another kind of file, or a layer that the drawing does not have.
    """
    layers = tuple(drawing.curves) if layers is None else layers
    if unknown := [layer for layer in layers if layer not in drawing.curves]:
        raise InputError(f'layer "{unknown[0]}": the drawing has {", ".join(drawing.curves)}')
    if file.suffix == ".step":
        track = drawing.tracks[PROFILE]
        return (_compare(file, PROFILE, read_step(file, track.sense), track, tolerance),)
    if file.suffix == ".csv":
        return (_compare_rows(file, drawing.tracks[layers[0]], layers[0]),)
    if file.suffix not in _READERS:
        raise InputError(
            f'{file}: files named "{file.suffix}" cannot be read; expected .csv, .step, {", ".join(_READERS)}'
        )
    found = _READERS[file.suffix](file, layers)
    return tuple(_compare(file, layer, found[layer], drawing.tracks[layer], tolerance) for layer in layers)


_READERS = {".dxf": read_dxf, ".svg": read_svg}


def _compare(file: File, layer: str, found: FileOutline, track: Track, tolerance: float) -> MeasuredOutline:
    """The deviation of an outline; refused if larger than the tolerance."""
    try:
        measured = deviation(found.path, track)
    except ExchangeError as error:
        raise ExchangeError(f"{file}: the outline of layer {layer} is not the curve: {error}") from None
    if not measured.largest <= tolerance:
        raise ExchangeError(
            f"{file}: the outline of layer {layer} is {1e3 * measured.largest:.6g} mm from the curve at "
            "cam angle "
            f"{np.degrees(measured.angle):.6g}°; the tolerance is {1e3 * tolerance:.6g} mm"
        )
    return MeasuredOutline(layer, found.form, measured, tolerance)


def _compare_rows(file: File, track: Track, layer: str) -> MeasuredOutline:
    """Each row lies on the curve at its cam angle; the deviation is that of the chords between the rows."""
    rows = read_csv(file)
    tau = track.at_cam_angles(rows.phi)
    off = np.linalg.norm(rows.place - track.points(tau), axis=1)
    allowed = _ROW * size(track.parts[0].curve)
    wrong = np.flatnonzero(~(off <= allowed))
    if wrong.size:
        raise ExchangeError(
            f"{file}: line {wrong[0] + 2}: the place is {1e3 * off[wrong[0]]:.3g} mm from the curve at its "
            "cam angle"
        )
    _compare_curvature(file, rows, track, tau)
    forward = rows.phi[-1] > rows.phi[0]
    corners = rows.place[:-1] if forward else rows.place[:0:-1]
    chords = deviation(Outline(corners, np.zeros(len(corners))), track)
    return MeasuredOutline(layer, "rows", chords, chords.largest)


def _compare_curvature(file: File, rows: Table, track: Track, tau: np.ndarray) -> None:
    """Refuse a curvature that is that of the curve on neither side of the place."""
    sides = [curvature(track, tau + beside) for beside in (-_BESIDE, 0.0, _BESIDE)]
    with np.errstate(invalid="ignore"):
        off = np.min([np.abs(side - rows.curvature) for side in sides], axis=0)
    # A cell that is no number differs from every curve that has a curvature there.
    lost = ~np.isfinite(rows.curvature) & np.isfinite(sides).all(axis=0)
    largest = np.abs(rows.curvature[~lost & np.isfinite(rows.curvature)]).max(initial=0.0)
    wrong = np.flatnonzero((off > _BEND * largest) | lost)
    if wrong.size:
        raise ExchangeError(
            f"{file}: line {wrong[0] + 2}: the curvature is {1e-3 * off[wrong[0]]:.3g}/mm from that of the "
            "curve"
        )
