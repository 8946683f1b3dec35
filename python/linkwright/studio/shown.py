"""Results for the page: scalars with their words, curves grouped into plots, all from declared quantities."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.quantities import DeclaredQuantity, Label, quantities_of
from linkwright.kernel.quantities import declared as marks
from linkwright.kernel.reader.numbers import NOISE
from linkwright.kernel.result import Result

# A column of a result's part, "A1_x [N]".
_COLUMN = re.compile(r"(.*) \[(.*)\]")


def shown(name: str, result: Result) -> dict[str, Any]:
    """A result of an analysis, by its name in ``--json``, as the page shows it.

    ``name``; ``scalars`` with name, words, symbol, unit and SI value; ``plots``, each with an abscissa and
    the curves that have one unit.
    """
    declared = [
        quantity._replace(
            unit=result.unit_of(quantity.name), word=result.word_of(quantity.name, quantity.word)
        )
        for quantity in _declared_of(result)
    ]
    return {
        "name": name,
        "scalars": list(_scalars(result, declared)),
        "plots": [
            *_plots(name, result, declared),
            *_of_parts(name, result, declared),
            *_of_columns(name, result),
        ],
    }


def _declared_of(result: Result) -> tuple[DeclaredQuantity, ...]:
    owner: type = type(result)
    return _declared(owner)


@cache
def _declared(owner: type) -> tuple[DeclaredQuantity, ...]:
    """What a class of results declares, once for all changes."""
    return tuple(quantities_of(owner))


def _scalars(result: Result, declared: list[DeclaredQuantity]) -> Iterator[dict[str, Any]]:
    """Finite scalars; zero for what is rounding beside the quantities of its unit."""
    values = {
        quantity: getattr(result, quantity.name, None) for quantity in declared if quantity.kind == "scalar"
    }
    known = {
        quantity: float(value)
        for quantity, value in values.items()
        if isinstance(value, int | float | np.number) and math.isfinite(value)
    }
    scales = _scales(result, declared, known)
    for quantity, value in known.items():
        scale = quantity.scale or (scales[quantity.unit] if quantity.unit else 0.0)
        is_rounding = abs(value) <= NOISE * scale
        yield {**_words(quantity), "value": 0.0 if is_rounding else value}


def _scales(
    result: Result, declared: list[DeclaredQuantity], known: dict[DeclaredQuantity, float]
) -> dict[str, float]:
    scales: dict[str, float] = {}
    for quantity in declared:
        curve = _list_of(result, quantity.name) if quantity.kind == "curve" else None
        sizes = [abs(known.get(quantity, 0.0))]
        if curve is not None and len(curve):
            # The peak of a curve with gaps is that of what is there.
            sizes += [float(np.fmax.reduce(curve)), -float(np.fmin.reduce(curve))]
        scales[quantity.unit] = max(scales.get(quantity.unit, 0.0), *filter(math.isfinite, sizes))
    return scales


def _words(quantity: DeclaredQuantity) -> dict[str, str]:
    return {"name": quantity.name, "word": quantity.word, "symbol": quantity.symbol, "unit": quantity.unit}


# What goes to infinity where others of its unit do not stands alone.
_ALONE = ("curvature_radius",)


def _plots(name: str, result: Result, declared: list[DeclaredQuantity]) -> Iterator[dict[str, Any]]:
    known = {quantity.name: quantity for quantity in declared if quantity.kind == "curve"}
    groups: dict[tuple[str, str, str], list[DeclaredQuantity]] = {}
    for quantity in known.values():
        if quantity.over in known:
            alone = quantity.name if quantity.name in _ALONE else ""
            groups.setdefault((quantity.over, quantity.unit, alone), []).append(quantity)
    for (over, unit, _), curves in groups.items():
        x = _list_of(result, over)
        listed = [(curve, _list_of(result, curve.name)) for curve in curves]
        drawn = [
            (quantity, y) for quantity, y in listed if y is not None and x is not None and y.shape == x.shape
        ]
        if x is not None and drawn and len(x) >= _LINE:
            yield {
                "key": f"{name}.{drawn[0][0].name}",
                "title": drawn[0][0].word if len(drawn) == 1 else _common(drawn),
                "unit": unit,
                "x": {**_words(known[over]), "values": x},
                "curves": [{**_words(quantity), "values": y} for quantity, y in drawn],
            }


# Samples of a card on the page.
_CARD = 720


def cards_plot(key: str, string: Any, result: Any, compared: Any = None) -> dict[str, Any]:
    """Cards of a rod string as a plot: position and load of each station; `compared`: a prediction beside
    a diagnosis.
    """
    from linkwright.rods.along import cards

    angle = getattr(result, "crank_angle", None)
    own, turn = (result.time, result.period) if angle is None else (angle % (2 * np.pi), 2 * np.pi)
    order = np.argsort(own)[:: max(1, len(own) // _CARD)]
    drawn = [(name, position[order], load[order]) for name, position, load in cards(string, result)]
    if compared is not None:
        places = np.linspace(0, len(compared.time) - 1, len(order)).astype(int)
        ends = list(cards(string, compared))[:: len(compared.stations) - 1]
        drawn += [(f"predicted: {name}", u[places], load[places]) for name, u, load in ends]
    name, word, symbol, unit = (
        ("time", "time", "t", "s") if angle is None else ("crank_angle", "crank angle", "φ", "rad")
    )
    x = {"name": name, "word": word, "symbol": symbol, "unit": unit}
    return {
        "key": key,
        "title": "dynamometer cards" if key == "cards" else "measured dynamometer card",
        "unit": "N",
        "isHodograph": True,
        "isCard": True,
        "x": x | {"values": np.append(own[order], own[order[0]] + turn)},
        "curves": [
            {"name": f"{name}.{unit}", "word": name, "symbol": "", "unit": unit}
            | {"values": np.append(values, values[0])}
            for name, position, load in drawn
            for unit, values in (("m", position), ("N", load))
        ],
    }


def _common(drawn: list[tuple[DeclaredQuantity, Floats]]) -> str:
    """Title of a plot of several curves: their words, as many as a line holds."""
    words = [quantity.word for quantity, _ in drawn]
    return ", ".join(words[:2]) + (", …" if len(words) > 2 else "")


def _list_of(result: Result, name: str) -> Floats | None:
    values = getattr(result, name, None)
    is_list = isinstance(values, np.ndarray) and values.ndim == 1 and values.dtype.kind in "fiu"
    return np.asarray(values, dtype=float) if is_list else None


def _of_parts(name: str, result: Result, declared: list[DeclaredQuantity]) -> Iterator[dict[str, Any]]:
    """Arrays with a row for each shaft or disc over one abscissa: a plot each, a curve for each part."""
    known = {quantity.name: quantity for quantity in declared if quantity.kind == "curve"}
    for quantity in known.values():
        parts, x = (
            _parts(result, quantity),
            _list_of(result, quantity.over) if quantity.over in known else None,
        )
        rows = np.asarray(getattr(result, quantity.name, None)) if parts and x is not None else None
        if x is None or rows is None or rows.shape != (len(parts), len(x)) or len(x) < _LINE:
            continue
        if not np.isfinite(rows.astype(float)).any():
            # Nothing of it was asked for, such as stresses over limits that no file gives.
            continue
        yield {
            "key": f"{name}.{quantity.name}",
            "title": quantity.word,
            "unit": quantity.unit,
            "x": {**_words(known[quantity.over]), "values": x},
            "curves": [
                {
                    **_words(quantity),
                    "name": part,
                    "word": part.replace("_", " "),
                    "symbol": "",
                    "own": True,
                    "values": row,
                }
                for part, row in zip(parts, rows.astype(float), strict=True)
            ],
        }


# Points that make a line; fewer are the columns of a table, such as modes.
_LINE = 40


def _parts(result: Result, quantity: DeclaredQuantity) -> tuple[str, ...]:
    """Names of the rows of a quantity, as its shape ``(shafts, speeds)`` says; of modes, numbers."""
    _, mark = marks(type(result))[quantity.name]
    axes = mark.shape.strip("()").split(", ") if isinstance(mark, Label) else []
    if len(axes) != 2:
        return ()
    names = getattr(result, axes[0], None)
    if isinstance(names, tuple) and all(isinstance(name, str) for name in names):
        return names
    rows = getattr(result, quantity.name, None)
    return tuple(f"{n + 1}" for n in range(len(rows))) if axes[0] == "modes" and rows is not None else ()


def _of_columns(name: str, result: Result) -> Iterator[dict[str, Any]]:
    columns = result.columns()
    first = next((quantity for quantity in _declared_of(result) if quantity.kind == "curve"), None)
    x = _list_of(result, first.name) if first else None
    if first is None or x is None:
        return
    groups: dict[tuple[str, str], list[tuple[str, Floats]]] = {}
    for head, values in columns.items():
        match = _COLUMN.fullmatch(head)
        if match and values.shape == x.shape:
            groups.setdefault((_title(name, match[1], match[2]), match[2]), []).append((match[1], values))
    for (title, unit), drawn in groups.items():
        yield {
            "key": f"{name}.{drawn[0][0]}",
            "title": title,
            "unit": unit,
            "x": {**_words(first), "values": x},
            "curves": [
                {
                    "name": head,
                    "word": head.replace("_", " "),
                    "symbol": "",
                    "own": not head.startswith("shaking_"),
                }
                | {"unit": unit, "values": y}
                for head, y in drawn
            ],
        }


# What forces are called, by the end of a column's name.
_FORCES = {"x": "force in {}", "y": "force in {}", "moment": "moment in {}"}


def _title(name: str, column: str, unit: str) -> str:
    part, _, last = column.rpartition("_")
    if column.startswith("loads."):
        return f"load {column.removeprefix('loads.')}"
    words = (part or column).replace("_", " ")
    if name != "forces" or part.startswith("shaking_"):
        return words
    drive = "force of the drive {}" if unit == "N" else "torque of the drive {}"
    return _FORCES.get(last, drive if last == "drive" else "{}").format(words)
