"""What the pages of all reports share: templates by Jinja2, figures and data inside the page.

A file may come from a stranger: its names and texts are escaped wherever they stand, and the page's own
policy lets no script run but those of the templates.

Source: W3C, *Content Security Policy Level 3*, 2.3.1 (hashes of inline scripts and styles).
"""

from __future__ import annotations

import json
import re
from base64 import b64encode
from collections.abc import Iterable
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.kernel.figure.svg import identifier, inline_svg, readout
from linkwright.kernel.page.content import Content
from linkwright.kernel.page.formulas import mathml, with_index
from linkwright.kernel.result import finite

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup

_FOLDER = Path(__file__).with_name("templates")


def html(content: Content) -> str:
    """A report as one self-contained HTML page; the same content gives the same page."""
    import linkwright

    template = environment().get_template("report.html")
    return template.render(
        content=content,
        words=content.language,
        page_words=_page_words(content),
        policy=_policy(),
        version=linkwright.__version__,
    )


# What the scripts of the page say.
_SAID = re.compile(r'\bsay\("([^"]+)"')


def _page_words(content: Content) -> dict[str, Any]:
    scripts = (path.read_text(encoding="utf-8") for path in sorted(_FOLDER.glob("*.js")))
    texts = {text: content.language.template(text) for script in scripts for text in _SAID.findall(script)}
    shown = [
        scene[key][0]
        for scene in content.scenes.values()
        for key in ("speed_unit", "stress_unit")
        if key in scene
    ]
    units = {unit: content.language.unit(unit) for unit in (*shown, "mm", "m/s")}
    return {"texts": texts, "units": units, "decimal": content.language.decimal}


def _picture(figure: Any, name: str, title: str) -> Markup:
    from markupsafe import Markup

    return Markup(inline_svg(figure, name, title))


def _axes(figure: Any) -> Markup:
    from markupsafe import Markup, escape

    known = readout(figure)
    return Markup(f' data-axes="{escape(json.dumps(known, separators=(",", ":")))}"') if known else Markup("")


def _embedded(scene: dict[str, Any]) -> Markup:
    from markupsafe import Markup

    text = json.dumps(finite(scene), separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c"))


def _sections(content: Content) -> list[tuple[str, str, list[tuple[str, str]]]]:
    """Sections of a page for its contents: title, place, and title and place of what is in them."""
    inside = [
        [
            *((table.title, f"table-{identifier(table.name)}") for table in part.tables),
            *((figure.title, f"figure-{identifier(figure.name)}") for figure in part.figures),
        ]
        for part in content.parts
    ]
    before = {"topper": ("The knife over the heads", "knife"), "mechanism": ("The mechanism", "mechanism")}
    after = {
        "formulas": ("Formulas", content.formulas),
        "data": ("Machine data", content.groups),
        "assumptions": ("Assumptions", content.assumptions),
        "repeat": ("Reproduce this report", content.command),
    }
    return [
        *((*words, []) for name, words in before.items() if name in content.scenes),
        *((part.title, f"part-{n}", inside[n - 1]) for n, part in enumerate(content.parts, start=1)),
        *((title, place, []) for place, (title, known) in after.items() if known),
    ]


def _logo(logo: tuple[str, bytes]) -> str:
    kind = {"svg": "svg+xml", "jpg": "jpeg"}.get(logo[0], logo[0])
    return f"data:image/{kind};base64,{b64encode(logo[1]).decode()}"


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
    environment.filters["index"] = with_index
    environment.filters["mathml"] = lambda text: _as_markup(mathml(text))
    environment.filters["embedded"] = _embedded
    environment.filters["identifier"] = identifier
    environment.filters["logo"] = _logo
    environment.filters["sections"] = _sections
    environment.globals["picture"] = _picture
    environment.globals["axes_of"] = _axes
    environment.globals["script"] = lambda name: inline("script", _raw(name))
    environment.globals["style"] = lambda name: inline("style", _raw(name))
    return environment


def _as_markup(text: str) -> Markup:
    """Text that is markup already: formulas of this package, never words of a file."""
    from markupsafe import Markup

    return Markup(text)


def _raw(name: str) -> str:
    return (_FOLDER / name).read_text(encoding="utf-8")


def inline(tag: str, text: str) -> Markup:
    """A script or style of this package inside a page."""
    return _as_markup(f"<{tag}>{text}</{tag}>")


@cache
def _policy() -> str:
    """The policy of the page of a report: of all templates, so that it is the same for every report."""
    return policy(
        scripts=[_raw(path.name) for path in sorted(_FOLDER.glob("*.js"))], styles=[_raw("report.css")]
    )


def policy(*, scripts: Iterable[str] = (), styles: Iterable[str] = ()) -> str:
    """What a page may do: run these scripts, use these styles, show pictures that are in it, load nothing."""
    return (
        f"default-src 'none'; img-src data:; script-src {_sources(scripts)}; style-src {_sources(styles)}; "
        # Attributes of figures: they run nothing, and load nothing that `img-src` does not allow.
        "style-src-attr 'unsafe-inline'; base-uri 'none'; form-action 'none'"
    )


def _sources(texts: Iterable[str]) -> str:
    digests = (b64encode(sha256(text.encode()).digest()).decode() for text in texts)
    return " ".join(f"'sha256-{digest}'" for digest in digests) or "'none'"
