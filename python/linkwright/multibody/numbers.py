"""Numbers and elements of XML: every digit of a number is kept."""

from __future__ import annotations

from xml.etree import ElementTree


def numbers(*values: float) -> str:
    """Numbers as a list of XML, in as few digits as give the same numbers again."""
    return " ".join(repr(float(value) + 0.0).removesuffix(".0") for value in values)


def element(parent: ElementTree.Element | None, tag: str, /, **attributes: str) -> ElementTree.Element:
    """An element of XML below another."""
    if parent is None:
        return ElementTree.Element(tag, attributes)
    return ElementTree.SubElement(parent, tag, attributes)


def text_of(root: ElementTree.Element) -> str:
    """The document, indented; containers without content are left out."""
    for child in list(root):
        if len(child) == 0 and not child.attrib:
            root.remove(child)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"
