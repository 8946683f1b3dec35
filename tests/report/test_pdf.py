"""A report as PDF: it is made of the same content as the page, and names of a file are words in it."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from matplotlib.figure import Figure

import linkwright as lw
from linkwright import study
from linkwright.app.report.page import content
from linkwright.kernel.figure.style import WIDTH
from linkwright.kernel.page.formulas import Formula, typst
from linkwright.kernel.page.table import Table
from linkwright.kernel.page.typeset import _STYLE, _sheet, _table, document, pdf

MACHINES = Path(__file__).parents[2] / "machines"

# What Typst would take for commands, and what ends its texts.
HOSTILE = r"""format = 1
name = '#panic("x") $ * _ ] [ \ "quoted" <label> @ref // https://x'
description = '= heading #import "y"'
[mechanism.cranks.'#A] \"$']
radius = 0.1
"""


@pytest.fixture(scope="module")
def two_carts() -> lw.Machine:
    return lw.read(MACHINES / "roller_two_carts.toml")


def test_same_study_gives_the_same_file(two_carts: lw.Machine) -> None:
    told = content(study(two_carts)).only(("summary", "sketch", "formulas", "data", "assumptions", "repeat"))
    made = pdf(told)
    assert made.startswith(b"%PDF-")
    assert pdf(told) == made


def test_all_tables_findings_and_assumptions_are_in_it(two_carts: lw.Machine) -> None:
    told = content(study(two_carts))
    text = document(told)
    for part in told.parts:
        for table in part.tables:
            assert table.title in text
            assert all(str(cell) in text for row in table.rows for cell in (row[0], *row[2:]))
        assert all(figure.caption.replace('"', '\\"') in text for figure in part.figures)
    assert told.warnings
    assert all(sentence in text for sentence in told.warnings)
    assert two_carts.name in text


def test_a_passed_machine_says_so_in_a_paragraph_of_its_own() -> None:
    """Without warnings the sentence would follow the source of the numbers on its line."""
    told = content(study(lw.read("topper")))
    assert told.source
    assert told.passed
    assert '\n\n*#"All checks passed.";*\n' in document(told)


def test_one_card_is_no_wider_than_three() -> None:
    text = document(content(study(lw.read("jansen_leg"))))
    assert "#grid(columns: (1fr,) * 3, gutter: 6pt, few" in text


@pytest.mark.parametrize(("remark", "is_broad"), [("dead centre", False), ("slow return, " * 12, True)])
def test_a_short_table_is_as_wide_as_its_words(remark: str, is_broad: bool) -> None:
    """Names and values stand together; words that would not fit are broken over the width of the text."""
    typst = pytest.importorskip("typst")
    table = Table("limits", "Limits", ("quantity", "", "value", "remark"), [("swing", "ψ", "60°", remark)])
    text = _STYLE.format(title='"x"', foot="", language='"en"') + _table(table)
    drawn = typst.compile({"main.typ": text.encode()}, ignore_system_fonts=True, format="svg").decode()
    # The lines above and below the rows [pt]; the text is 170 mm wide.
    lengths = [float(end) for end in re.findall(r'd="M 0 0h ([0-9.]+)"', drawn)]
    assert (max(lengths) > 400) == is_broad


def test_names_are_words_never_commands() -> None:
    assert pdf(content(study(lw.loads(HOSTILE)))).startswith(b"%PDF-")


def test_sections_that_are_left_out_are_not_there(two_carts: lw.Machine) -> None:
    text = document(content(study(two_carts)).only(("data",)))
    headings = re.findall(r'^== (?:#")?([^"\n]*)', text, re.MULTILINE)
    assert headings == ["Machine data"]


@pytest.mark.parametrize(
    ("formula", "written"),
    [
        ("δ = frac(ω_max − ω_min|ω_mean)", 'δ = frac(ω_"max" − ω_"min", ω_"mean")'),
        ("J′ ( φ ) Ω^2", 'J\' ( φ ) Ω^"2"'),
        ("2 max [ root(d) ]", '2 op("max") [ sqrt(d) ]'),
    ],
)
def test_formulas_in_the_notation_of_typst(formula: str, written: str) -> None:
    assert typst(Formula("", formula, "").text) == written


@pytest.mark.parametrize(
    ("width", "height", "millimetres"),
    [(600, 2400, 215.0), (600, 600, 170.0), (600, 410, 104.0), (600, 300, 85.0), (200, 200, 25.4 * 200 / 72)],
)
def test_a_picture_fits_on_its_page(width: int, height: int, millimetres: float) -> None:
    """A picture has the width of the text, 170 mm, at most; one that would be longer than a page is made
    smaller, and one of little more than half a page, so that two stand on it with letters that can be read.
    """
    typst = pytest.importorskip("typst")
    style = _STYLE.format(title='""', foot="", language='"en"')
    asked = '#layout(page => [#metadata(measure(..page, picture("a.svg")).height.mm()) <height>])'
    drawn = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}pt" height="{height}pt"></svg>'
    files = {"main.typ": (style + asked).encode(), "a.svg": drawn.encode()}
    (found,) = json.loads(typst.query(files, "<height>", field="value"))
    assert found == pytest.approx(millimetres, abs=0.01)


def test_a_picture_stands_where_the_text_has_it() -> None:
    """A picture that does not fit goes to the next page, and what follows it stays behind it: in front of it,
    a list or a table would be cut in two.
    """
    typst = pytest.importorskip("typst")
    style = _STYLE.format(title='""', foot="", language='"en"')
    picture = "#figure-with([== Picture\n#rect(height: 100mm) #metadata(none) <picture>])"
    page = f"- First\n#rect(height: 150mm)\n{picture}\n\n- Second #metadata(none) <text>\n"
    tell = "#context [#metadata((<picture>, <text>).map(it => locate(it).position())) <places>]"
    files = {"main.typ": (style + page + tell).encode()}
    ((drawn, text),) = json.loads(typst.query(files, "<places>", field="value"))
    assert (drawn["page"], text["page"]) == (2, 2)
    assert float(text["y"].removesuffix("pt")) > float(drawn["y"].removesuffix("pt"))


def test_a_table_over_two_pages_has_its_title_on_both() -> None:
    typst = pytest.importorskip("typst")
    style = _STYLE.format(title='""', foot="", language='"en"')
    cells = ", ".join(f"[{n}], [x]" for n in range(80))
    page = f"#data((false,), [Title #metadata(none) <title>], ([head], [value],), {cells})"
    tell = "#context [#metadata(query(<title>).map(it => it.location().page())) <pages>]"
    files = {"main.typ": (style + page + tell).encode()}
    assert json.loads(typst.query(files, "<pages>", field="value")) == [[1, 2]]


@pytest.mark.parametrize("rows", [1, 2, 5, 7, 8, 9, 60])
@pytest.mark.parametrize("above", range(200, 250, 5))
def test_no_row_of_a_table_stands_alone(rows: int, above: int) -> None:
    """Wherever a table begins, its title stands above four rows or all, and four rows at least go over."""
    typst = pytest.importorskip("typst")
    style = _STYLE.format(title='""', foot="", language='"en"')
    cells = ", ".join(f"[#metadata(none) <row>{n}], [x]" for n in range(rows))
    table = f"#data((false,), [Title], ([head], [value],), {cells})"
    page = f"#rect(height: {above}mm)\n== Heading #metadata(none) <heading>\n{table}"
    where = "query({}).map(it => it.location().page())"
    tell = f"#context [#metadata(({where.format('<row>')}, {where.format('<heading>')})) <pages>]"
    files = {"main.typ": "\n".join((style, page, tell)).encode()}
    ((pages, (heading,)),) = json.loads(typst.query(files, "<pages>", field="value"))
    assert heading == pages[0]
    assert all(pages.count(number) >= min(4, rows) for number in set(pages))


@pytest.mark.parametrize(
    ("width", "height", "sheet"),
    [
        (WIDTH, 4.2, ""),
        (7.5, 11.9, 'paper: "a3", flipped: false'),
        (10.0, 3.0, 'paper: "a4", flipped: true'),
        (12.6, 7.0, 'paper: "a3", flipped: true'),
    ],
)
def test_a_broad_figure_has_a_sheet_on_which_it_keeps_its_letters(
    width: float, height: float, sheet: str
) -> None:
    """What is larger than a page is not made smaller: letters of 7.5 points would be less than 7."""
    assert _sheet(Figure(figsize=(width, height))) == sheet
