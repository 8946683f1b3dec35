"""What the pages of all reports share: templates by Jinja2, figures and data inside the page."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.kernel.figure.inline import inline_svg
from linkwright.kernel.result import finite

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup

_FOLDER = Path(__file__).with_name("templates")

# A symbol of one letter and its index.
_INDEX = re.compile(r"\b([^\W\d_])_(\w+(?:,\w+)?)")


def picture(figure: Any, name: str, title: str) -> Markup:
    """A figure as markup inside the page."""
    from markupsafe import Markup

    return Markup(inline_svg(figure, name, title))


def embedded(scene: dict[str, Any] | None) -> str:
    """Data for a script element: nothing in it may end that element."""
    return json.dumps(finite(scene), separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def environment() -> Environment:
    """Jinja2 with the templates and filters of all pages."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(_FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["index"] = _with_index
    environment.filters["safe_math"] = _as_markup
    environment.globals["include_raw"] = _raw
    return environment


def _with_index(text: str) -> Markup:
    """A text in which the index of each symbol is lowered."""
    from markupsafe import Markup, escape

    return Markup(_INDEX.sub(r"\1<sub>\2</sub>", str(escape(text))))


def _as_markup(text: str) -> Markup:
    """Text that is markup already: formulas of this package, never words of a file."""
    from markupsafe import Markup

    return Markup(text)


def _raw(name: str) -> Markup:
    """A file of the templates, as it is."""
    return _as_markup((_FOLDER / name).read_text(encoding="utf-8"))
