"""Write a drawing: each file is read back and compared with the profile before it gets its name."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable
from pathlib import Path as File

import numpy as np

from linkwright.cam.manufacture.curve import Track, size
from linkwright.cam.manufacture.drawing import PROFILE, Drawing, MeasuredOutline, WrittenFile
from linkwright.cam.manufacture.dxf import read_dxf, write_dxf
from linkwright.cam.manufacture.fit import TOLERANCE, FileOutline, Form, deviation, fit
from linkwright.cam.manufacture.outline import Outline
from linkwright.cam.manufacture.spline import Spline
from linkwright.cam.manufacture.step import read_step, write_step
from linkwright.cam.manufacture.svg import read_svg, write_svg
from linkwright.cam.manufacture.table import By, Table, curvature, read_csv, table, write_csv
from linkwright.kernel.errors import ExchangeError, InputError
from linkwright.kernel.files.output import file_name, trial, unwritable
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units.kinds import ANGLE, LENGTH
from linkwright.kernel.units.marks import positive

# How far a row of a table may be from its curve, over the curve's size: a table holds the curve itself, and
# an error of 1e-15 of the cam angle moves places of a steep curve by some times that.
_ROW = 1e-13

# How far a curvature may be from that of the curve, over the largest. At joints, where it may jump, the cam
# angle is known to rounding only: either side will do, this far from it [rad].
_BEND, _BESIDE = 1e-6, 1e-9


def read_back(
    file: File, drawing: Drawing, tolerance: float = TOLERANCE, *, layers: tuple[str, ...] | None = None
) -> tuple[MeasuredOutline, ...]:
    """What is measured in each layer of a DXF, SVG, STEP or CSV file, against the curves of a drawing.

    `tolerance`: largest distance of an outline from its curve [m]; `layers`: all without it. An
    `ExchangeError` if the file cannot be read, lacks an outline, has it open, in another unit or too far.
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
    outlines = _READERS[file.suffix](file, layers)
    return tuple(_compare(file, layer, outlines[layer], drawing.tracks[layer], tolerance) for layer in layers)


_READERS = {".dxf": read_dxf, ".svg": read_svg}


def _compare(file: File, layer: str, outline: FileOutline, track: Track, tolerance: float) -> MeasuredOutline:
    try:
        measured = deviation(outline.path, track)
    except ExchangeError as error:
        raise ExchangeError(f"{file}: the outline of layer {layer} is not the curve: {error}") from None
    if not measured.largest <= tolerance:
        raise ExchangeError(
            f"{file}: the outline of layer {layer} is {1e3 * measured.largest:.6g} mm from the curve at "
            f"cam angle θ = {np.degrees(measured.angle):.6g}°; the tolerance is {1e3 * tolerance:.6g} mm"
        )
    return MeasuredOutline(layer, outline.form, measured, tolerance)


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


# Step of tables [rad].
STEP = math.radians(1)

FORMATS = ("dxf", "csv", "svg")

# Those and the one that needs an extra.
ALL_FORMATS = (*FORMATS, "step")


@public
def write_drawing(
    directory: str | os.PathLike[str],
    drawing: Drawing,
    *,
    formats: Iterable[str] = FORMATS,
    form: Form = "arcs",
    tolerance: float = TOLERANCE,
    step: float = STEP,
    by: By = "cam",
    stem: str = "",
) -> tuple[WrittenFile, ...]:
    """Write a drawing in several formats, each read back and compared with the curves.

    Parameters
    ----------
    directory : path
        Where; made if it is not there. Files of the same names are replaced.
    drawing : Drawing
        What is drawn.
    formats : iterable of str
        ``"dxf"``: all layers. ``"svg"``: all layers, as arcs or chords. ``"csv"``: one file a layer.
        ``"step"``: the profile, as a spline, as a solid of the drawing's width; needs the extra ``step``.
    form : {"arcs", "spline", "cubic", "polyline"}
        What the DXF holds: arcs and lines without kinks, a B-spline of degree 5 or 3, or chords.
    tolerance : float
        Largest distance of an outline from its curve [m].
    step : float
        Step of tables [rad].
    by : {"cam", "polar"}
        Whether it is one of the cam angle or of the polar angle.
    stem : str
        What the names of the files begin with; without it, the drawing's name.

    Returns
    -------
    tuple of WrittenFile
        The files, with the deviations that were measured in them.

    Raises
    ------
    ExchangeError
        A curve has no outline, or a file that was read back does not keep the tolerance; it is not kept then.
    InputError
        A format, form, tolerance or step that does not exist, or a directory that cannot be written.
    """
    in_range(tolerance=(tolerance, positive(LENGTH)), step=(step, positive(ANGLE)))
    formats = tuple(formats)
    if unknown := [ending for ending in formats if ending not in ALL_FORMATS]:
        raise InputError(f'format "{unknown[0]}": expected {", ".join(ALL_FORMATS)}')
    place = File(directory) / (stem or file_name(drawing.name) or "cam")
    written: list[WrittenFile] = []
    try:
        File(directory).mkdir(parents=True, exist_ok=True)
        if "dxf" in formats:
            written.append(_dxf(place, drawing, form, tolerance))
        if "svg" in formats:
            written.append(_svg(place, drawing, form, tolerance))
        if "step" in formats:
            written.append(_step(place, drawing, form, tolerance))
        if "csv" in formats:
            written += [_csv(place, drawing, layer, step, by) for layer in drawing.curves]
    except OSError as error:
        raise unwritable(File(directory), error) from None
    return tuple(written)


def _checked(
    file: File, write: Callable[[File], None], check: Callable[[File], tuple[MeasuredOutline, ...]]
) -> WrittenFile:
    """Write under another name, check, and only then take the name."""
    with trial(file) as part:
        write(part)
        measured = check(part)
    return WrittenFile(file, measured)


def _with_ending(place: File, ending: str) -> File:
    return place.with_name(place.name + ending)


def _dxf(place: File, drawing: Drawing, form: Form, tolerance: float) -> WrittenFile:
    fits = {layer: fit(track, form, tolerance) for layer, track in drawing.tracks.items()}
    paths: dict[str, Outline | Spline] = {layer: path for layer, (path, _) in fits.items()}
    notes = (
        drawing.name,
        f"tolerance {1e3 * tolerance:g} mm",
        *(
            f"{layer}: {side.sides} sides, within {1e3 * side.largest:.3g} mm"
            for layer, (_, side) in fits.items()
        ),
    )
    return _checked(
        _with_ending(place, ".dxf"),
        lambda file: write_dxf(file, drawing, paths, notes),
        lambda file: read_back(file, drawing, tolerance),
    )


def _svg(place: File, drawing: Drawing, form: Form, tolerance: float) -> WrittenFile:
    paths = {}
    for layer, track in drawing.tracks.items():
        path, _ = fit(track, "polyline" if form == "polyline" else "arcs", tolerance)
        assert isinstance(path, Outline)
        paths[layer] = path
    return _checked(
        _with_ending(place, ".svg"),
        lambda file: write_svg(file, drawing, paths),
        lambda file: read_back(file, drawing, tolerance),
    )


def _step(place: File, drawing: Drawing, form: Form, tolerance: float) -> WrittenFile:
    if drawing.width is None or PROFILE not in drawing.tracks:
        raise InputError(
            f"{drawing.name}: a STEP file is a solid: give the cam a width, and the layer {PROFILE}"
        )
    width, (path, _) = drawing.width, fit(drawing.tracks[PROFILE], _spline(form), tolerance)
    assert isinstance(path, Spline)
    return _checked(
        _with_ending(place, ".step"),
        lambda file: write_step(file, drawing.name, path, width),
        lambda file: read_back(file, drawing, tolerance),
    )


def _spline(form: Form) -> Form:
    return "cubic" if form == "cubic" else "spline"


def _csv(place: File, drawing: Drawing, layer: str, step: float, by: By) -> WrittenFile:
    rows = table(drawing.tracks[layer], step, by)
    tail = "" if layer == PROFILE else f"_{layer.lower()}"
    return _checked(
        _with_ending(place, f"{tail}.csv"),
        lambda file: write_csv(file, rows),
        lambda file: read_back(file, drawing, layers=(layer,)),
    )
