"""Properties of a plate as tables, and as lines of a machine file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from linkwright.kernel.page.table import Table, known_rows, part_table, parts_of
from linkwright.outlines.plate import PlateProperties


def plate_tables(plate: PlateProperties) -> Iterator[Table]:
    """Area, mass and moments of a plate, and its holes."""
    rows = known_rows(plate, "plate", length="mm")
    yield Table("plate", "Plate", ("quantity", "", "value", ""), rows)
    if plate.holes:
        heads = ("hole", "", "along the link [{mm}]", "across the link [{mm}]", "diameter [{mm}]")
        cells = ("name", "", "hole_along", "hole_across", "hole_diameter")
        yield part_table("holes", "Holes", parts_of(plate, "holes"), heads, *cells)


def plate_lines(name: str, path: Path, entries: dict[str, Any]) -> str:
    """The body of a machine file with the plate; `entries` beside the file, texts and lists of texts."""
    import tomlkit

    plate = tomlkit.inline_table()
    plate.update({"file": path.name, **{key: value for key, value in entries.items() if value}})
    body, bodies, document = tomlkit.inline_table(), tomlkit.table(), tomlkit.document()
    body["plate"] = plate
    bodies[name] = body
    document["bodies"] = bodies
    return tomlkit.dumps(document)
