"""Formulas of the pages, a hook of MkDocs: a fence ``math`` holds LaTeX and is set as MathML, and so are the
formulas of docstrings; in a sentence ``M_k`` has its index below, ``e^{iφ}`` its exponent above.

The browser lays MathML out by itself, so that a page needs no script. What LaTeX cannot set ends the build.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import Element

from markdown import Extension, Markdown
from markdown.inlinepatterns import InlineProcessor, SimpleTextInlineProcessor
from markdown.preprocessors import Preprocessor
from math_core import LatexToMathML

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig

# An index follows one letter, with which a symbol begins; longer words with _ are names, as `energy_motor`.
LETTER, SIGN = "A-Za-zÀ-ÿΑ-ωḀ-ỿ", "A-Za-zΑ-ω0-9"
INDEX = rf"(?<=(?<![{LETTER}_])[{LETTER}])_(?:\{{([^}}]+)\}}|(\d\.\d|[{SIGN}]+(?:,[{SIGN}]+)?)(?![_{SIGN}]))"
EXPONENT = rf"(?<=\S)\^(?:\{{([^}}]+)\}}|\(([^()]+)\)|(−?(?:\d+(?:\.\d+)?|[{LETTER}¼]))(?![{LETTER}]))"
# Formulas of docstrings as Sphinx reads them: between paragraphs with what is indented below, in sentences.
DIRECTIVE = re.compile(r"^( *)\.\. math::(.*(?:\n+\1 +\S.*)*)", re.MULTILINE)
ROLE = r":math:`([^`]+)`"
# The number of a source in docstrings, and the source itself at their end.
CITED = r"(\[\d+\])_(?!\w)"
SOURCE = re.compile(r"^( *)\.\. \[(\d+)\] ", re.MULTILINE)
# Before code in backticks, and before what is fenced.
ROLE_PRIORITY, DIRECTIVE_PRIORITY = 195, 26
# Dots above a letter: as accents many fonts have them in the letter, three of them beside it.
DOTTED = re.compile(r'<mover accent="true">(<mi>[^<]*</mi>)<mo>([˙¨⃛])</mo>')
DOTS = {"˙": ".", "¨": "‥", "⃛": "…"}
# Below links, whose addresses have underscores; above emphasis, which begins with them, too.
PRIORITY = 65


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Fences ``math`` are formulas, beside those that hold code; indices and docstrings follow."""
    fence = {"name": "math", "class": "formula", "format": formula}
    config.mdx_configs.setdefault("pymdownx.superfences", {})["custom_fences"] = [fence]
    config.markdown_extensions.append(Sentences())
    return config


def formula(latex: str, language: str, css_class: str, *_: Any, **__: Any) -> str:
    """Formulas between two paragraphs, in a box that scrolls where the page is narrower than one of them."""
    return f'<div class="{css_class}" tabindex="0">{"".join(map(mathml, separate(latex)))}</div>'


def separate(latex: str) -> list[str]:
    """Formulas beside each other, which a narrow page sets below each other; a table stays whole."""
    return [latex] if r"\begin" in latex else latex.split(r"\qquad")


def mathml(latex: str, display: str = "block") -> str:
    """A formula as MathML; LaTeX that is not understood is an error with its place."""
    # The sign of a derivative is raised already; as an exponent it would be too small to count.
    primes = re.sub("'+", lambda marks: rf"\text{{{'′″‴'[len(marks[0]) - 1]}}}", latex)
    found = LatexToMathML(fancy_error=False).convert_with_local_state(primes, displaystyle=display == "block")
    return DOTTED.sub(lambda match: f"<mover>{match[1]}<mo>{DOTS[match[2]]}</mo>", found)


class Sentences(Extension):
    """Indices and exponents of symbols in a sentence, and formulas of docstrings."""

    def extendMarkdown(self, md: Markdown) -> None:
        md.preprocessors.register(Directives(md), "directives", DIRECTIVE_PRIORITY)
        md.inlinePatterns.register(Role(ROLE, md), "role", ROLE_PRIORITY)
        md.inlinePatterns.register(SimpleTextInlineProcessor(CITED), "cited", ROLE_PRIORITY)
        # An exponent may have an index.
        md.inlinePatterns.register(Shifted(EXPONENT, "sup"), "exponent", PRIORITY + 1)
        md.inlinePatterns.register(Shifted(INDEX, "sub"), "index", PRIORITY)


class Directives(Preprocessor):
    """Formulas between the paragraphs of a docstring as fences, its sources as a list."""

    def run(self, lines: list[str]) -> list[str]:
        return SOURCE.sub(r"\1\2. ", DIRECTIVE.sub(fenced, "\n".join(lines))).split("\n")


def fenced(directive: re.Match[str]) -> str:
    """A fence with the formula of a directive; one of several lines is a table, as in Sphinx."""
    indent, latex = directive[1], [line.strip() for line in directive[2].splitlines() if line.strip()]
    several = any(line.endswith(r"\\") for line in latex) and not latex[0].startswith(r"\begin")
    table = [r"\begin{aligned}", *latex, r"\end{aligned}"] if several else latex
    return "\n".join(indent + line for line in ("```math", *table, "```"))


class Role(InlineProcessor):
    """A formula within a sentence of a docstring."""

    def handleMatch(self, m: re.Match[str], data: str) -> tuple[str, int, int]:
        return self.md.htmlStash.store(mathml(m[1], "inline")), m.start(), m.end()


class Shifted(InlineProcessor):
    """What a pattern finds, smaller and off the line."""

    def __init__(self, pattern: str, tag: str) -> None:
        super().__init__(pattern)
        self.tag = tag

    def handleMatch(self, m: re.Match[str], data: str) -> tuple[Element, int, int]:
        element = Element(self.tag)
        element.text = next(filter(None, m.groups()))
        return element, m.start(), m.end()
