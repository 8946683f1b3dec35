"""Drawings as SVG at true scale: one unit is a millimetre, on paper too.

An outline is one closed path of arcs and lines. y points down in SVG, so places are mirrored; an arc that
turns to the left has sweep 0.

Source: W3C, *Scalable Vector Graphics 1.1*, 8.3 (path data), F.6.5 (arcs from end points).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path as File
from xml.etree import ElementTree
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from linkwright.cam.manufacture.drawing import CENTRE, CUTTER_PATH, PITCH_CURVE, ZERO_ANGLE, Drawing
from linkwright.cam.manufacture.fit import FileOutline
from linkwright.cam.manufacture.outline import Outline
from linkwright.kernel.errors import ExchangeError
from linkwright.kernel.files.output import write_file

_NAMESPACE = "{http://www.w3.org/2000/svg}"

# Space round the largest radius, over it: the zero mark must fit.
_SPACE = 1.2

# Width of lines, in millimetres: a fine line of a technical drawing (ISO 128).
_WIDTH = 0.18

_COLOURS = {PITCH_CURVE: "#2a7", CUTTER_PATH: "#c33", CENTRE: "#36c", ZERO_ANGLE: "#93c"}

_TOKEN = re.compile(r"[MLAZ]|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")

# Numbers after each letter of a path.
_ARGUMENTS = {"M": 2, "L": 2, "A": 7, "Z": 0}


def write_svg(file: File, drawing: Drawing, paths: Mapping[str, Outline]) -> None:
    """Write a drawing as SVG."""
    r = 1e3 * drawing.radius * _SPACE
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * r!r}mm" height="{2 * r!r}mm" '
        f'viewBox="{-r!r} {-r!r} {2 * r!r} {2 * r!r}" fill="none" stroke-width="{_WIDTH}">'
    )
    outlines = [_element(layer, path_data(path)) for layer, path in paths.items()]
    half, ((x, y), (x_1, y_1)) = 1e3 * drawing.cross, (1e3 * drawing.mark).tolist()
    cross = _element(CENTRE, f"M {-half!r} 0 L {half!r} 0 M 0 {-half!r} L 0 {half!r}")
    mark = _element(ZERO_ANGLE, f"M {x!r} {-y!r} L {x_1!r} {-y_1!r}")
    title = f"<title>{escape(drawing.name)}</title>"
    write_file(file, "\n".join([head, title, *outlines, cross, mark, "</svg>", ""]))


def _element(layer: str, data: str) -> str:
    colour = _COLOURS.get(layer, "#000")
    return f'<path id={quoteattr(layer)} stroke="{colour}" d="{data}"/>'


def path_data(outline: Outline) -> str:
    """Path data of an outline, in millimetres with y down."""
    corners = np.column_stack([1e3 * outline.vertices[:, 0], -1e3 * outline.vertices[:, 1]]).tolist()
    parts = [f"M {corners[0][0]!r} {corners[0][1]!r}"]
    sides = outline.sides
    length = np.linalg.norm(sides.chords, axis=1)
    # 1/R = 2 sin(θ/2)/c
    radii = 1e3 * length / np.where(sides.bulges == 0, np.inf, 2 * np.abs(np.sin(0.5 * sides.turns)))
    for (x, y), radius, bulge in zip(corners[1:] + corners[:1], radii.tolist(), sides.bulges, strict=True):
        arc = f"A {radius!r} {radius!r} 0 {int(abs(bulge) > 1)} {int(bulge < 0)}"
        parts.append(f"{arc if bulge else 'L'} {x!r} {y!r}")
    return " ".join([*parts, "Z"])


def read_svg(file: File, layers: tuple[str, ...]) -> dict[str, FileOutline]:
    """Read the outlines of an SVG file."""
    try:
        root = ElementTree.parse(file).getroot()
    except (OSError, ElementTree.ParseError) as error:
        raise ExchangeError(f"{file}: is not an SVG file that can be read ({error})") from None
    _refuse_scale(file, root)
    outlines = {}
    for layer in layers:
        data = [path.get("d", "") for path in root.iter(f"{_NAMESPACE}path") if path.get("id") == layer]
        if len(data) != 1:
            raise ExchangeError(f'{file}: {len(data)} paths have the id "{layer}", expected one')
        outlines[layer] = FileOutline(_outline(file, layer, data[0]), "path")
    return outlines


def _refuse_scale(file: File, root: ElementTree.Element) -> None:
    width, box = root.get("width", ""), root.get("viewBox", "").split()
    try:
        is_true = width.endswith("mm") and float(width[:-2]) == float(box[2])
    except (ValueError, IndexError):
        is_true = False
    if not is_true:
        raise ExchangeError(
            f'{file}: width "{width}" over viewBox "{" ".join(box)}" is not one millimetre a unit'
        )


def _outline(file: File, layer: str, data: str) -> Outline:
    """Corners and bulges of path data; the end of the path must be its start."""
    steps = list(_steps(data))
    if [step[0] for step in steps[:1]] != ["M"] or steps[-1][0] != "Z" or len(steps) < 3:
        raise ExchangeError(f'{file}: the path "{layer}" is not one closed path')
    ends = np.array([step[1][-2:] for step in steps[:-1]]) * [1e-3, -1e-3]
    gap = float(np.linalg.norm(ends[-1] - ends[0]))
    if gap > 0:
        raise ExchangeError(f'{file}: the ends of the path "{layer}" are {1e3 * gap:.3g} mm apart')
    chords = np.linalg.norm(np.diff(ends, axis=0), axis=1)
    bulges = [_bulge(step, chord) for step, chord in zip(steps[1:-1], chords, strict=True)]
    return Outline(ends[:-1], np.array(bulges))


def _bulge(step: tuple[str, list[float]], chord: float) -> float:
    """tan(θ/4) of an arc with sin(θ/2) = c/(2R), and zero of a line."""
    letter, numbers = step
    if letter != "A":
        return 0.0
    radius, _, _, large, sweep = numbers[:5]
    half = float(np.arcsin(min(chord / (2e-3 * radius), 1.0)))
    half = np.pi - half if large else half
    return float(np.tan(0.5 * half)) * (-1 if sweep else 1)


def _steps(data: str) -> Iterator[tuple[str, list[float]]]:
    tokens = _TOKEN.findall(data)
    at = 0
    while at < len(tokens):
        letter = tokens[at]
        count = _ARGUMENTS.get(letter)
        if count is None:
            return
        yield letter, [float(x) for x in tokens[at + 1 : at + 1 + count]]
        at += 1 + count
