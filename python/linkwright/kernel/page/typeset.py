"""A report as PDF on A4, typeset by Typst (extra ``report``), without a browser."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.kernel.errors import InputError
from linkwright.kernel.extras import require
from linkwright.kernel.figure.style import CaptionedFigure
from linkwright.kernel.figure.svg import svg
from linkwright.kernel.page.content import Content, Heading
from linkwright.kernel.page.formulas import INDEX, Formula, typst
from linkwright.kernel.page.table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# A table of more columns is set on a page that lies.
_BROAD = 10

# Letters of a cell from which on it holds a list of words, not a number with its unit and its place.
_WORDY = 30


def pdf(content: Content) -> bytes:
    """A report as PDF, the same for the same content; `InputError` without Typst, or for a bad logo."""
    compiler = _compiler()
    files = {"main.typ": document(content).encode()}
    if content.heading.logo is not None:
        ending, data = content.heading.logo
        files[f"logo.{ending}"] = data
        alone = {"main.typ": f'#image("logo.{ending}")'.encode(), f"logo.{ending}": data}
        _compiled(compiler, alone, "logo: found a file that is no picture")
    if content.sketch is not None:
        files["sketch.svg"] = svg(content.sketch()).encode()
    for part in content.parts:
        files |= {_place(figure): svg(figure.figure).encode() for figure in part.figures}
    return _compiled(compiler, files, "the report cannot be typeset")


def _compiler() -> Any:
    """Typst, whose types do not tell of files in memory."""
    return require("typst", "report", "a PDF needs Typst")


def _compiled(compiler: Any, files: dict[str, bytes], failure: str) -> bytes:
    """What Typst makes of files with the letters that it brings; its error begins with `failure`."""
    try:
        made: bytes = compiler.compile(files, ignore_system_fonts=True, timestamp=0)
    except (compiler.TypstError, RuntimeError) as error:
        raise InputError(f"{failure} ({' '.join(str(error).split())})") from None
    return made


def document(content: Content) -> str:
    """The report as Typst's text; figures are files beside it."""
    return "\n".join(_lines(content)) + "\n"


def _lines(content: Content) -> Iterator[str]:
    code = _string(content.language.code)
    yield _STYLE.format(title=_string(content.title), foot=_foot(content), language=code)
    yield from _head(content)
    words = content.language
    for title, text in content.notes:
        yield _box(title, [text], "care")
    if content.findings:
        yield _box(words("Failed checks"), content.findings, "bad")
    if content.warnings:
        yield _box(words("Warnings"), content.warnings, "care")
    if content.passed:
        yield f"\n*{_text(content.passed)}*\n"
    if content.headline:
        cells = "".join(f"few[{_text(w)}][{_text(v)}][{_text(u)}], " for w, v, u in content.headline)
        yield f"#grid(columns: (1fr,) * 3, gutter: 6pt, {cells})"
    if content.sketch is not None:
        yield f'== {words("The mechanism")}\n#image("sketch.svg", width: 100%)'
    for part in content.parts:
        if part.tables:
            yield f"== {_text(part.title)}"
        yield from (_table(table) for table in part.tables)
        yield from (_figure(figure) for figure in part.figures)
    if content.formulas:
        yield f"== {words('Formulas')}\n{_formulas(content.formulas)}"
        yield f"#note[{_text(content.papers)}.]" if content.papers else ""
    if content.groups:
        yield from _groups(content)
    if content.assumptions:
        yield f"== {words('Assumptions')}\n" + "\n".join(
            f"- {_text(sentence, indices=True)}" for sentence in content.assumptions
        )
    if content.command:
        yield from _repeat(content)


def _head(content: Content) -> Iterator[str]:
    yield from _company(content.heading)
    yield f"= {_text(content.title)}"
    if content.about or content.lead:
        yield _text(" ".join(filter(None, (content.about, content.lead)))) + "\n"
    if content.source:
        yield f"#note[{content.language('Source of the numbers')}: {_text(content.source)}]"
    if rows := content.heading.rows():
        cells = ", ".join(f"note[{_text(content.language(word))}], [{_text(entry)}]" for word, entry in rows)
        yield f"#grid(columns: (auto, 1fr, auto, 1fr), column-gutter: 10pt, row-gutter: 5pt, {cells})"


def _company(heading: Heading) -> Iterator[str]:
    if not heading.company and heading.logo is None:
        return
    picture = "" if heading.logo is None else f'#image("logo.{heading.logo[0]}", height: 14mm)'
    words = f"*{_text(heading.company)}*" + (f" \\ {_text(heading.address)}" if heading.address else "")
    yield f"#grid(columns: (1fr, auto), align: (left + horizon, right + horizon), [{words}], [{picture}])"
    yield "#line(length: 100%, stroke: 0.6pt + soft)"


def _foot(content: Content) -> str:
    heading = content.heading
    known = (
        heading.company,
        heading.document,
        heading.revision and f"rev. {heading.revision}",
        content.title,
    )
    return _text(" · ".join(part for part in known if part))


def _box(title: str, texts: Sequence[str], colour: str) -> str:
    listed = "\n".join(f"- {_text(text)}" for text in texts) if len(texts) > 1 else _text(texts[0])
    return f"#notice({colour})[*{_text(title)}*\n\n{listed}]"


def _table(table: Table) -> str:
    """A table that repeats title and heads on each page; one that is too wide is set smaller, or across."""
    n = len(table.heads)
    heads = ", ".join(f"head[{_text(head, indices=True)}]" for head in table.heads)
    cells = ", ".join(
        f"[{_text(cell, indices=place == 1)}]" for row in table.rows for place, cell in enumerate(row)
    )
    wordy = "".join(f"{str(_is_wordy(table, place)).lower()}, " for place in range(1, n))
    set_ = f"#data(({wordy}), [{_text(table.title)}], ({heads},), {cells})"
    return f"#page(flipped: true)[{set_}]" if n > _BROAD else set_


def _is_wordy(table: Table, place: int) -> bool:
    """Whether a column beside the first holds lists of words that are broken into lines."""
    return any(len(row[place]) > _WORDY for row in table.rows)


def _figure(captioned: CaptionedFigure) -> str:
    picture = f'#picture("{_place(captioned)}")'
    text = f"#figure-with([== {_text(captioned.title)}\n{picture}\n#note[{_text(captioned.caption)}]])"
    sheet = _sheet(captioned.figure)
    return f"#page({sheet})[{text}]" if sheet else text


# Sides of the sheets that a report may hold [mm].
_SHEETS = {"a4": (210, 297), "a3": (297, 420), "a2": (420, 594)}

# Scale at which the smallest letters of a figure, `linkwright.kernel.figure.style.SMALL`, have 7 points.
_SCALE = 0.94

# What the margins, and the margins with title and caption, take of a sheet [mm].
_ACROSS, _ALONG = 40, 70


def _sheet(figure: Figure) -> str:
    """The smallest sheet on which the letters of a figure can be read; empty for that of the text."""
    width, height = (25.4 * _SCALE * float(side) for side in figure.get_size_inches())
    for name, (short, long) in _SHEETS.items():
        for across, along in ((short, long), (long, short)):
            if width <= across - _ACROSS and height <= along - _ALONG:
                is_lying = str(across > along).lower()
                return "" if (name, across) == ("a4", short) else f'paper: "{name}", flipped: {is_lying}'
    return ""


def _place(captioned: CaptionedFigure) -> str:
    return "figure-" + captioned.name.encode().hex() + ".svg"


def _formulas(formulas: Sequence[Formula]) -> str:
    cells = ", ".join(
        f"[{_text(formula.words)}], [$ {typst(formula.text)} $], note[{_text(formula.origin)}]"
        for formula in formulas
    )
    # A column as wide as its widest formula: none runs into the words beside it.
    return f"#grid(columns: (1.2fr, auto, 1fr), gutter: 8pt, align: horizon, {cells})"


def _groups(content: Content) -> Iterator[str]:
    words = content.language
    yield f"== {words('Machine data')}"
    cells = []
    for group, parts in content.groups:
        for n, part in enumerate(parts):
            entries = " #h(8pt) ".join(
                f"#box(emph-if({str(not entry.given).lower()})"
                f"[#note[{_text(entry.word)}] {_text(entry.value)}])"
                for entry in part.entries
            )
            cells += [
                f"[{'*' + _text(group) + '*' if n == 0 else ''}]",
                f"[{_text(part.name)}]",
                f"[{entries}]",
            ]
    yield f"#grid(columns: (2.6cm, 2.6cm, 1fr), column-gutter: 6pt, row-gutter: 7pt, {', '.join(cells)})"
    note = words("Entries in italics are not given: they follow from other entries or are defaults.")
    yield f"#note[{note}]"


def _repeat(content: Content) -> Iterator[str]:
    import linkwright

    words = content.language
    made = f"{words('Computed with Linkwright')} {_text(linkwright.__version__)}:"
    code = f"#code({_string(content.command)})"
    yield f"#block(breakable: false)[== {words('Reproduce this report')}\n{made}\n{code}]"
    if content.file:
        sentence = words("The machine as computed, overrides included, as a machine file:")
        yield f"#block(sticky: true)[{sentence}]"
        yield f"#code({_string(content.file)})"


def _string(text: str) -> str:
    """A text as a string of Typst: nothing in it is a command."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\r", "")
    return f'"{escaped}"'


def _text(text: str, *, indices: bool = False) -> str:
    """A text as it stands; the index of each symbol lowered, if there may be some."""
    if not text:
        return ""
    if not indices:
        return f"#{_string(text)};"
    pieces = INDEX.split(text)
    # Three by three: what stands before, a letter, its index.
    parts = [f"#{_string(pieces[0])};" if pieces[0] else ""]
    for letter, index, rest in zip(pieces[1::3], pieces[2::3], pieces[3::3], strict=True):
        parts.append(f"#{_string(letter)};#sub[#{_string(index)};]" + (f"#{_string(rest)};" if rest else ""))
    return "".join(parts)


_STYLE = """#set document(title: {title}, date: none)
#let soft = rgb("#5c6570")
#let bad = rgb("#b3261e")
#let care = rgb("#8a5a00")
#set page(paper: "a4", margin: (x: 20mm, top: 18mm, bottom: 20mm), footer: context [
  #set text(8pt, fill: soft)
  {foot} #h(1fr) #counter(page).display("1 / 1", both: true)
])
#set text(lang: {language}, font: "Libertinus Serif", size: 10pt, number-width: "tabular")
#set par(leading: 0.55em)
#show heading.where(level: 1): set text(17pt)
#show heading.where(level: 2): set text(12pt)
#show heading: set block(above: 1.4em, below: 0.8em)
#show raw: set text(font: "DejaVu Sans Mono", size: 7pt)
#let emph-if(wanted, body) = if wanted {{ emph(body) }} else {{ body }}
#let note(body) = text(8.5pt, fill: soft, body)
// Of a column: no larger than what stands below.
#let head(body) = text(fill: soft, body)
#let code(text) = block(width: 100%, fill: rgb("#f4f6f8"), inset: 6pt, radius: 3pt, raw(text, block: true))
#let notice(colour, body) = block(width: 100%, stroke: (left: 3pt + colour), inset: (x: 8pt, y: 4pt), body)
// A cell, not a block: those of one row are of one height.
#let few(word, value, unit) = grid.cell(fill: rgb("#f4f6f8"), inset: 7pt)[
  #note(word) \\ #text(14pt, value) #note(unit)
]
#let data(wordy, title, heads, ..cells) = layout(page => {{
  let set_in(letters, first, other) = {{
    set text(letters)
    let others = wordy.map(is => if is {{ other }} else {{ auto }})
    let line = table.hline(stroke: 0.4pt + soft)
    let named = table.cell(colspan: heads.len(), inset: (x: 0pt, y: 4pt), strong(title))
    // A column of no width holds the rows at both ends together, four each: none stands alone on a page.
    let rows = cells.pos().chunks(heads.len())
    let last = rows.len() - 4
    let held(n) = if last < 4 {{ if n == 0 {{ rows.len() }} else {{ 0 }} }} else {{
      if n == 0 or n == last {{ 4 }} else if n < 4 or n > last {{ 0 }} else {{ 1 }}
    }}
    let hold(n) = if n > 0 {{ (table.cell(rowspan: n, breakable: false, inset: 0pt)[],) }} else {{ () }}
    let body = rows.enumerate().map(((n, row)) => row + hold(held(n)))
    table(columns: (first,) + others + (0pt,), stroke: none, inset: (x: 0pt, y: 3pt),
      column-gutter: (9pt,) * (heads.len() - 1) + (0pt,),
      table.header(named, [], line, ..heads, []), ..body.flatten(), line)
  }}
  let fits(letters) = measure(set_in(letters, 38mm, 38mm)).width <= page.width
  let letters = if fits(9pt) {{ 9pt }} else if fits(8pt) {{ 8pt }} else {{ 7pt }}
  // As wide as its words: in a row that is drawn out over the page, the eye loses the value of a name.
  let is_narrow = measure(set_in(letters, auto, auto)).width <= page.width
  let share(size) = if fits(letters) and not is_narrow {{ size }} else {{ auto }}
  block(above: 1.2em, below: 1.2em, set_in(letters, share(1.6fr), share(1fr)))
}})
// It stands where the text has it: one that floats would cut a table or a list in two.
#let figure-with(body) = block(width: 100%, breakable: false, above: 1.2em, align(left, body))
#let picture(place) = layout(page => {{
  // One that is drawn for less than the width of the page is not made larger.
  let wide = calc.min(page.width, measure(image(place)).width)
  let tall = measure(image(place, width: wide)).height
  // Two of those that take little more than half a page stand on one, with letters of 7 pt.
  let most = if tall <= 104mm {{ tall }} else if tall <= 119mm {{ 104mm }} else {{ page.height - 44mm }}
  align(center, if tall > most {{ image(place, height: most) }} else {{ image(place, width: wide) }})
}})
"""
