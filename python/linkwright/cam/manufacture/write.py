"""Write a drawing for manufacture: each file is read back before it gets its name."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable
from pathlib import Path as File

from linkwright.cam.manufacture.drawing import PROFILE, Drawing, MeasuredOutline, WrittenFile
from linkwright.cam.manufacture.dxf import write_dxf
from linkwright.cam.manufacture.fit import TOLERANCE, Form, fit
from linkwright.cam.manufacture.outline import Outline
from linkwright.cam.manufacture.read_back import read_back
from linkwright.cam.manufacture.spline import Spline
from linkwright.cam.manufacture.step import write_step
from linkwright.cam.manufacture.svg import write_svg
from linkwright.cam.manufacture.table import By, table, write_csv
from linkwright.kernel.errors import InputError
from linkwright.kernel.files.output import file_name, trial, unwritable
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units import ANGLE, LENGTH, positive

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
    if unknown := [each for each in formats if each not in ALL_FORMATS]:
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
    """A file beside others of the same drawing; points in the name stay."""
    return place.with_name(place.name + ending)


def _dxf(place: File, drawing: Drawing, form: Form, tolerance: float) -> WrittenFile:
    """The drawing as DXF, with name, tolerance and what was measured as text."""
    fits = {layer: fit(track, form, tolerance) for layer, track in drawing.tracks.items()}
    paths: dict[str, Outline | Spline] = {layer: path for layer, (path, _) in fits.items()}
    notes = (
        drawing.name,
        f"tolerance {1e3 * tolerance:g} mm",
        *(
            f"{layer}: {found.sides} sides, within {1e3 * found.largest:.3g} mm"
            for layer, (_, found) in fits.items()
        ),
    )
    return _checked(
        _with_ending(place, ".dxf"),
        lambda file: write_dxf(file, drawing, paths, notes),
        lambda file: read_back(file, drawing, tolerance),
    )


def _svg(place: File, drawing: Drawing, form: Form, tolerance: float) -> WrittenFile:
    """The drawing as SVG; splines, which it has not, as arcs."""
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
    """The profile as a solid."""
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
    """The spline nearest to a form."""
    return "cubic" if form == "cubic" else "spline"


def _csv(place: File, drawing: Drawing, layer: str, step: float, by: By) -> WrittenFile:
    """One outline as a table."""
    rows = table(drawing.tracks[layer], step, by)
    tail = "" if layer == PROFILE else f"_{layer.lower()}"
    return _checked(
        _with_ending(place, f"{tail}.csv"),
        lambda file: write_csv(file, rows),
        lambda file: read_back(file, drawing, layers=(layer,)),
    )
