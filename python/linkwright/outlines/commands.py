"""``linkwright outline FILE.dxf``: mass, centre and moment of inertia of a link by its drawing."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import FolderOutput, belong_to, to_folder
from linkwright.kernel.command.parameter import Argument, Option, Value
from linkwright.kernel.errors import InputError, UnitError
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import DENSITY, LENGTH
from linkwright.kernel.units.marks import positive
from linkwright.kernel.units.reading import parse_list, to_text

Drawing = Annotated[Path, Argument("FILE", "DXF file with the closed outline of a link and its holes.")]
Layers = Annotated[
    list[str] | None,
    Option("--layer", "NAME", "Layer of the outline or its holes; all with curves without it. Repeatable."),
]
Unit = Annotated[
    float | None,
    Value("--unit", positive(LENGTH), 'Unit of the drawing, such as "1 mm", if it does not state it.'),
]
Start = Annotated[
    str | None,
    Option("--start", '"X, Y"', 'Joint in the drawing where the link starts, such as "0, 0 mm".'),
]
End = Annotated[
    str | None,
    Option("--end", '"X, Y"', "Joint where it ends. Default: the link lies along x of the drawing."),
]
Thickness = Annotated[float | None, Value("--thickness", positive(LENGTH), "Thickness of the plate.")]
Density = Annotated[float | None, Value("--density", positive(DENSITY), "Density of the material.")]
On = Annotated[str, Option("--on", "LINK", "Link of the machine file that the lines are written for.")]
Step = Annotated[
    bool, Option("--step", help="With --out: the plate as a STEP solid in the axes of the link.")
]
To = Annotated[
    FolderOutput, to_folder("Write results.json, the lines of the machine file and the drawing there.")
]


def outline(
    file: Drawing,
    layer: Layers = None,
    unit: Unit = None,
    start: Start = None,
    end: End = None,
    thickness: Thickness = None,
    density: Density = None,
    on: On = "link",
    step: Step = False,
    *,
    to: To,
) -> None:
    """Mass, centre and moment of inertia of a link by the drawing of its outline.

    Prints the properties and the lines of a machine file that mean the same; with --step the plate as a
    solid.
    """
    from linkwright.outlines.plate import outline as compute

    if step and (to.out is None or thickness is None):
        raise InputError("--step: found without --out and --thickness, expected both")
    if thickness is None or density is None:
        belong_to("--thickness and --density", "on")
    plate = compute(
        file,
        layers=layer or (),
        unit=unit,
        start=_joint("--start", start),
        end=_joint("--end", end),
        thickness=thickness,
        density=density,
    )
    lines = later(
        "outlines.tables:plate_lines", on, file, _entries(layer, unit, start, end, thickness, density)
    )
    is_whole = thickness is not None and density is not None
    files: dict[str, Any] = {"body.toml": lines} if is_whole else {}
    if step:
        files[f"{file.stem}.step"] = later("outlines.solid:plate_bytes", file.stem, plate.section, thickness)
    hint = [] if is_whole else ["The mass needs --thickness and --density."]
    answer = Answer(
        machine=file.stem,
        names=(file.stem,),
        results=lambda _: {"outline": plate.to_dict(curves=True)},
        warnings=hint,
        tables=later("outlines.tables:plate_tables", plate),
        tail=lines if is_whole else "",
        files=files,
        figures={"outline": later("outlines.figures:outline_figure", plate)},
    )
    to.hand_over(answer)


def _entries(
    layers: list[str] | None,
    unit: float | None,
    start: str | None,
    end: str | None,
    thickness: float | None,
    density: float | None,
) -> dict[str, Any]:
    """What the lines of a machine file say beside the file."""
    texts = {"unit": (unit, LENGTH), "thickness": (thickness, LENGTH), "density": (density, DENSITY)}
    quantities = {name: to_text(value, kind) for name, (value, kind) in texts.items() if value is not None}
    return {"layers": layers, "start": start, "end": end, **quantities}


def _joint(option: str, text: str | None) -> tuple[float, float] | None:
    """x and y of a joint [m]."""
    if text is None:
        return None
    try:
        x, y = parse_list(text, LENGTH)
    except (UnitError, ValueError):
        raise InputError(f'{option}: found "{text}", expected x and y, such as "80, 25 mm"') from None
    return float(x), float(y)
