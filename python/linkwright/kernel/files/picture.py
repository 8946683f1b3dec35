"""Pictures that a document names, such as logos: an SVG is a document itself, which could run and load."""

from __future__ import annotations

import re
from collections.abc import Iterator
from xml.etree import ElementTree

# What is shown and does nothing: other elements run, load, link or hold HTML.
_ELEMENTS = """
svg g defs symbol use title desc metadata style path rect circle ellipse line polyline polygon text tspan
textPath linearGradient radialGradient stop clipPath mask pattern marker image filter switch view
"""

# Vocabularies, as ElementTree writes them.
_SVG, _HTML = "{http://www.w3.org/2000/svg", "{http://www.w3.org/1999/xhtml"

# A picture within the picture, whole in its address.
_WITHIN = re.compile(r"data:image/(?:png|jpeg|gif|webp);base64,[\w+/=\s]*")

# What a style loads, unless it is an element of the same picture.
_LOADED = re.compile(r"@import|\\|url\(\s*['\"]?(?!\s*['\"]?#)", re.IGNORECASE)


def svg_fault(data: bytes) -> str:
    """What of an SVG a report does not take, such as a script or a link; empty if it takes all of it."""
    if b"<!ENTITY" in data:
        return "an entity"
    try:
        root = ElementTree.fromstring(data)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        return f"no SVG that can be read ({error})"
    if _local(root.tag) != "svg":
        return "no SVG"
    return next((fault for element in root.iter() for fault in _faults(element)), "")


def _faults(element: ElementTree.Element) -> Iterator[str]:
    """What of an element a report does not take; those of other vocabularies say things about the picture."""
    space, _, name = element.tag.rpartition("}")
    is_shown = space in ("", _SVG)
    if space == _HTML or (is_shown and name not in _ELEMENTS.split() and not name.startswith("fe")):
        yield f"an element <{name}>"
    if is_shown and name == "style" and _LOADED.search(element.text or ""):
        yield "a style that loads something"
    for key, value in element.attrib.items():
        yield from _attribute_faults(_local(key).lower(), value.strip())


def _attribute_faults(key: str, value: str) -> Iterator[str]:
    """What of an attribute a report does not take."""
    if key.startswith("on"):
        yield f"a script ({key})"
    elif (
        key in ("href", "src") and not (value.startswith("#") or _WITHIN.fullmatch(value))
    ) or _LOADED.search(value):
        yield f"a link ({key})"


def _local(name: str) -> str:
    """A name without its vocabulary."""
    return name.rpartition("}")[2]
