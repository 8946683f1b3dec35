"""Templates of a paper's texts filled with numbers, and its page.

``{course.deviation_max:.1f %}`` is a name, its steps through mappings, attributes and lists parted by points;
a format; and a unit, in which the number, SI, is given. The unit is written behind the number, unless it
stands in brackets. A pair is a range, a list is an enumeration. ``{is_even:yes|no}`` chooses by a statement.
"""

from __future__ import annotations

import math
import re
from collections import ChainMap
from collections.abc import Mapping
from importlib.resources import files
from string import Formatter
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.figure.svg import svg, with_own_names
from linkwright.kernel.page.html import inline, policy

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.papers.paper import Paper

# Unit → so many of it in one of SI, and how it stands behind a number.
UNITS = {
    "%": (100.0, " %"),
    "°": (180 / math.pi, "°"),
    "mm": (1e3, " mm"),
    "kN": (1e-3, " kN"),
    "rpm": (30 / math.pi, " rpm"),
    "MN m/rad": (1e-6, " MN m/rad"),
}


def named(values: Any, name: str) -> Any:
    """What keys, attributes and places lead to, such as ``"drives.0.steady.speed_min"``."""
    value = values
    for step in name.split("."):
        if isinstance(value, Mapping):
            value = value[step]
        else:
            value = value[int(step)] if step.isdigit() else getattr(value, step)
    return value


class _Words(Formatter):
    """Fields are names with points; formats know units, pairs, lists and statements."""

    def get_field(self, field_name: str, args: Any, kwargs: Any) -> tuple[Any, str]:
        return named(kwargs, field_name), field_name

    def format_field(self, value: Any, format_spec: str) -> str:
        return shown(value, format_spec)


def filled(template: str, values: Any) -> str:
    """A template, its fields in braces filled with what they name; line breaks of the file are spaces."""
    return _Words().vformat(re.sub(r"\s*\n\s*", " ", template.strip()), (), values)


def shown(value: Any, spec: str) -> str:
    """One value as a text; None is a dash, nothing in a list is "none".

    Besides formats of Python with a unit behind, ``share`` is a deviation, ``up2`` has two digits, rounded
    up, and a statement has both of its words.
    """
    if isinstance(value, bool | np.bool_):
        return spec.split("|")[not value]
    if value is None or isinstance(value, str):
        return "–" if value is None else value
    if isinstance(value, tuple | list | np.ndarray):
        return _several(list(value), spec, "…" if isinstance(value, tuple) else ", ")
    return _number(value, spec)


def _several(values: list[Any], spec: str, join: str) -> str:
    if not values:
        return "none"
    form, _, unit = spec.partition(" ")
    texts = [shown(value, f"{form} ({unit.strip('()')})" if unit else form) for value in values]
    return join.join(texts) + (UNITS[unit][1] if unit and not unit.startswith("(") else "")


def _number(value: float, spec: str) -> str:
    form, _, unit = spec.partition(" ")
    factor, behind = UNITS[unit.strip("()")] if unit else (1.0, "")
    if form == "share":
        return share(value)
    scaled = value if factor == 1.0 else factor * value
    text = rounded_up(scaled, int(form[2:])) if form.startswith("up") else format(scaled, form)
    return re.sub(r"^-", "−", text) + ("" if unit.startswith("(") else behind)


def share(value: float) -> str:
    """A deviation with its sign, in percent of two digits, not to be parted at the end of a line."""
    form = "+.2g" if abs(value) < 0.1 else "+.0f"
    text = format(100 * value, form) if value else "0"
    return f"{text}\N{NO-BREAK SPACE}%".replace("-", "−")


def rounded_up(value: float, digits: int) -> str:
    """A positive number of so many digits that is not below the value."""
    scale = 10.0 ** (math.floor(math.log10(value)) + 1 - digits)
    return f"{math.ceil(value / scale) * scale:.{digits}g}"


def conclusion(data: Mapping[str, Any], values: Mapping[str, Any]) -> str:
    """A conclusion of a file of data, marked if the numbers contradict it.

    It has a ``text``; ``holds``, the name of the statement on which it stands; and ``lists``, the
    enumerations in it: name → ``of``, ``text`` and ``join``.
    """
    lists = {
        name: entries["join"].join(filled(entries["text"], item) for item in named(values, entries["of"]))
        for name, entries in data.get("lists", {}).items()
    }
    text = filled(data["text"], ChainMap(lists, dict(values)))
    return text if named(values, data["holds"]) else f"Not so by the numbers computed: {text}"


def page(paper: Paper, figures: Mapping[str, Figure]) -> str:
    """The page of a paper with its figures, by the names of their files, in it."""
    from jinja2 import Environment

    template = files("linkwright.papers").joinpath("paper.html").read_text(encoding="utf-8")
    captions = {name: filled(text, paper.values) for name, text in paper.published["captions"].items()}
    drawn = [(captions[name], _drawing(figure, name)) for name, figure in figures.items()]
    style = files("linkwright.papers").joinpath("paper.css").read_text(encoding="utf-8")
    text: str = (
        Environment(autoescape=True)
        .from_string(template)
        .render(paper=paper, figures=drawn, style=inline("style", style), policy=policy(styles=[style]))
    )
    return text


def _drawing(figure: Figure, name: str) -> str:
    from markupsafe import Markup

    return Markup(with_own_names(svg(figure), name))
