"""``linkwright report``: any command's answer as page and PDF, with the head of a company, and variants."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import Result
from command_line import invoke

CARTS = str(Path(__file__).parents[2] / "machines" / "roller_two_carts.toml")

COMPANY = """company = "Forming & Sons"
document = "CALC-12"
date = 2026-03-01
logo = "logo.svg"
"""

LOGO = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1"><rect width="1" height="1"/></svg>'


def called(*words: str) -> Result:
    return invoke("report", *words)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "company.toml").write_text(COMPANY)
    (tmp_path / "logo.svg").write_text(LOGO)
    return tmp_path


def test_page_and_pdf_of_forces_with_head_and_variant(folder: Path) -> None:
    variant = "light: bodies.cart1.mass=500 kg"
    to = ("--to", "a.html", "--to", "a.pdf")
    result = called(*to, "--company", "company.toml", "--variant", variant, "forces", CARTS)
    assert result.exit_code == 0, result.output
    assert (folder / "a.pdf").read_bytes().startswith(b"%PDF-")
    page = (folder / "a.html").read_text()
    for words in ("Forming &amp; Sons", "CALC-12", "2026-03-01", "data:image/svg+xml;base64,", "Variants"):
        assert words in page
    # The variant's own number stands beside that of the machine as it is.
    alone = called("--to", "b.html", "forces", CARTS, "--set", "bodies.cart1.mass=500 kg")
    assert alone.exit_code == 0
    other = (folder / "b.html").read_text()
    row = (
        page[page.index('id="table-variants_forces"') :]
        .split("driving torque at the crank")[1]
        .split("</tr>")[0]
    )
    as_it_is, light = (cell.split("</td>")[0] for cell in row.split("<td>")[1:3])
    assert as_it_is != light
    assert light in other


def test_what_a_command_prints_alone_is_reported_too(folder: Path) -> None:
    assert called("--to", "a.html", "--sections", "results", "size", CARTS).exit_code == 0
    page = (folder / "a.html").read_text()
    assert "Required power" in page
    assert "Reproduce" not in page


def test_finding_is_reported_and_ends_with_1(folder: Path) -> None:
    result = called("--to", "a.html", "forces", CARTS, "--set", "mechanism.sliders.cart1.rod=0.1")
    assert result.exit_code == 1
    assert "Failed checks" in (folder / "a.html").read_text()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--to", "a.doc", "run", CARTS), '--to: found "a.doc", expected a file that ends in .html or .pdf'),
        (("--to", "none/a.pdf", "run", CARTS), "there is no folder none"),
        (("--to", "company.html", "--company", "logo.svg", "run", CARTS), "logo.svg"),
        (("--company", "odd.toml", "run", CARTS), "odd.toml:1: firm"),
        (("--sections", "result", "run", CARTS), 'did you mean "results"'),
        (("--variant", "light", "run", CARTS), "expected a name, a colon and entries"),
        (("run", CARTS, "--json"), "leave out --json and --out"),
        (("run", "nothing.toml"), "no such file"),
        (("nonsense",), "No such command 'nonsense'"),
        ((), "Missing argument"),
    ],
)
def test_wrong_words_are_told_and_nothing_is_written(folder: Path, words: tuple[str, ...], said: str) -> None:
    (folder / "odd.toml").write_text('firm = "x"\n')
    before = sorted(folder.iterdir())
    result = called(*words)
    assert result.exit_code == 2
    assert said in result.output.replace("\n", " ")
    assert sorted(folder.iterdir()) == before


def test_file_that_exists_stays(folder: Path) -> None:
    (folder / "report.html").write_text("mine")
    result = called("run", CARTS)
    assert result.exit_code == 2
    assert "--force replaces it" in result.output
    assert (folder / "report.html").read_text() == "mine"


def test_report_of_a_motion_and_of_a_pose(folder: Path) -> None:
    """The first cart with crank 0.2 m and rod 0.8 m: 1 m and 0.6 m at its dead centres."""
    assert called("--to", "m.html", "motion", CARTS, "--speed", "60 rpm").exit_code == 0
    page = (folder / "m.html").read_text()
    row = page.split("cart1, position")[1].split("</tr>")[0]
    cells = [cell.split("</td>")[0] for cell in row.split("<td>")[1:]]
    assert cells[-4:] == ["0.6 m", "180°", "1 m", "0°"]
    for figure in ("motion_of_slides", "motion_of_links", "motion_of_points"):
        assert f'id="figure-{figure}"' in page or figure in page
    assert called("--to", "p.html", "motion", CARTS, "--at", "90 deg", "--digits", "8").exit_code == 0
    assert "0.77459667" in (folder / "p.html").read_text(), "√(0.8² − 0.2²) m"
    assert called("--to", "l.html", "motion", CARTS, "--law", "2*t").exit_code == 0


@pytest.mark.parametrize("words", [("forces",), ("balance", "--links", "A1"), ("size",), ("motion",)])
def test_a_report_about_a_machine_has_drawing_data_and_assumptions(
    folder: Path, words: tuple[str, ...]
) -> None:
    """Whatever is computed of a machine, its report shows and describes it; forces have captions."""
    command, *options = words
    assert called("--to", "a.html", command, CARTS, *options).exit_code in (0, 1)
    page = (folder / "a.html").read_text()
    for section in ("mechanism", "data", "assumptions", "repeat"):
        assert f'<section id="{section}"' in page or f'id="{section}"' in page
        assert f'href="#{section}"' in page
    assert "torque breakdown <b>215.4 N m</b>" in page
    assert "Dry friction has a constant magnitude" in page
    if command == "forces":
        assert "Joint reactions in steady motion: peak 33960 N at O:A1." in page


def test_the_machine_of_a_report_is_in_the_units_of_its_file(folder: Path) -> None:
    """By its table of units where it has one; else each entry is as it was written."""
    assert called("--to", "a.html", "--sections", "repeat", "run", "press_with_flywheel").exit_code == 0
    page = (folder / "a.html").read_text()
    assert "radius = &#34;80 mm&#34;" in page
    assert "speed = &#34;60 rpm&#34;" in page
    words = ("run", CARTS, "--set", "units.length=mm", "--set", "mechanism.cranks.A2.phase=1.5")
    assert called("--to", "b.html", "--sections", "repeat", *words).exit_code == 0
    page = (folder / "b.html").read_text()
    assert "rod = &#34;800 mm&#34;" in page
    assert "phase = &#34;1.5 rad&#34;" in page


def test_digits_that_are_asked_for(folder: Path) -> None:
    """Four in tables and summary; as many as --digits says; JSON has all of them."""
    for digits, text in (((), "0.08496<"), (("--digits", "7"), "0.08495914<")):
        assert called("--to", "a.html", "--force", "run", CARTS, *digits).exit_code == 0
        assert text in (folder / "a.html").read_text()
    plain, asked = (invoke("run", CARTS, "--json", *more).stdout for more in ((), ("--digits", "2")))
    assert plain == asked
    refused = invoke("run", CARTS, "--digits", "0")
    assert (refused.exit_code, "--digits" in refused.output) == (2, True)
