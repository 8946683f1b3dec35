"""Centres of the elements of a mesh in an input file of CalculiX or Abaqus.

Read are `*NODE` and `*ELEMENT`; other keywords are passed over. The centre is the mean of the corner nodes.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from linkwright.kernel.errors import InputError
from linkwright.kernel.files.text_file import TextError, text_of
from linkwright.kernel.limits import MESH_BYTES

# Corner nodes of elements by the number that their names end with.
_CORNERS = {20: 8, 8: 8, 10: 4, 4: 4, 15: 6, 6: 6, 3: 3}
# Plane elements and shells of eight and six nodes have them on their sides.
_PLANE = ("CPS", "CPE", "CAX", "S", "M3D")
_PLANE_CORNERS = {8: 4, 6: 3, 4: 4, 3: 3}


class Mesh(NamedTuple):
    """Centres of elements in the plane of the link, by number, in the unit of the mesh."""

    centres: dict[int, tuple[float, float]]


def read_mesh(path: Path) -> Mesh:
    """Read a mesh. Raises InputError: the file cannot be read, or has no elements or nodes that it needs."""
    try:
        text = text_of(path, MESH_BYTES)
    except TextError as error:
        expected = error.expected or "an input file with *NODE and *ELEMENT"
        raise InputError(f"{path}: found {error.found}, expected {expected}") from None
    nodes: dict[int, tuple[float, float]] = {}
    elements: dict[int, list[int]] = {}
    for number, keyword, options, row in _rows(text):
        try:
            if keyword == "*NODE":
                nodes[int(row[0])] = float(row[1]), float(row[2])
            else:
                numbers = [int(cell) for cell in row]
                elements[numbers[0]] = numbers[1 : 1 + _corners(options, len(numbers) - 1)]
        except (ValueError, IndexError):
            raise InputError(
                f"{path}:{number}: found {', '.join(row)}, expected a row of {keyword}"
            ) from None
    if not elements:
        raise InputError(f"{path}: found no *ELEMENT, expected the mesh of the link")
    try:
        centres = {
            element: tuple(np.mean([nodes[corner] for corner in corners], axis=0).tolist())
            for element, corners in elements.items()
        }
    except KeyError as missing:
        raise InputError(f"{path}: found no node {missing}, expected all nodes of the elements") from None
    return Mesh(centres)


def _rows(text: str) -> Iterator[tuple[int, str, dict[str, str], list[str]]]:
    """Line, keyword, its options, and the cells of each row of nodes and elements; continued rows are one."""
    keyword, options, kept = "", {}, list[str]()
    for number, line in enumerate(text.splitlines(), start=1):
        if line.startswith("**") or not line.strip():
            continue
        cells = [cell.strip() for cell in line.split(",")]
        if line.startswith("*"):
            keyword = cells[0].upper()
            options = {
                name.strip().upper(): value.strip().upper()
                for name, _, value in (cell.partition("=") for cell in cells[1:])
            }
            kept = []
        elif keyword in ("*NODE", "*ELEMENT"):
            kept += [cell for cell in cells if cell]
            # A row that ends with a comma goes on in the next line.
            if line.rstrip().endswith(",") and keyword == "*ELEMENT":
                continue
            yield number, keyword, options, kept
            kept = []


def _corners(options: dict[str, str], nodes: int) -> int:
    """How many of the nodes of an element are its corners."""
    is_plane = options.get("TYPE", "").startswith(_PLANE)
    return (_PLANE_CORNERS if is_plane else _CORNERS).get(nodes, nodes)
