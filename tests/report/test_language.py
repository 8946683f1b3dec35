"""Reports in Ukrainian: no words of the product stay English; numbers and names are what they were."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from command_line import invoke

import linkwright as lw
from linkwright import InputError, torsion_study
from linkwright.app.commands.report import _content
from linkwright.kernel.page.content import Content
from linkwright.kernel.page.html import _page_words
from linkwright.kernel.page.translation import in_language
from linkwright.kernel.reader.axes import _said
from linkwright.kernel.reader.language import ENGLISH, Language, _filled, language
from linkwright.machine import machine_parts
from linkwright.torsion import torsion_content

UKRAINIAN = language("uk")

EXAMPLES = Path(__file__).parents[2] / "examples"

# Two words of three letters and more: a sentence or a term, no symbol and no name.
ENGLISH_WORDS = re.compile(r"\b[A-Za-z]{3,} [a-z]{3,}\b")

FOLLOWER = "Штовхач піднімається на 5,5 мм; похідні — за кутом кулачка θ."


@dataclass(frozen=True)
class Watched(Language):
    """A language that keeps what it left as it was."""

    left: list[str] = field(default_factory=list)

    def __call__(self, text: str) -> str:
        words = super().__call__(text)
        if words == text:
            self.left.append(text)
        return words

    def template(self, text: str) -> str:
        words = super().template(text)
        if words == text:
            self.left.append(text)
        return words


MACHINES = sorted((EXAMPLES.parent / "machines").glob("*.toml")) + sorted(EXAMPLES.glob("*/machine.toml"))


@pytest.mark.parametrize("path", MACHINES, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_parts_that_the_file_does_not_name_have_a_word(path: Path) -> None:
    """Names that files give stay as they are; those of fixed tables are words of the language."""
    parts = machine_parts(lw.read(path))
    given = {part.name for part in parts if part.is_named}
    names = {name for part in parts if not part.is_named for name in part.name.split(": ")} - given
    assert {name for name in names if name not in UKRAINIAN.texts} == set()


@pytest.mark.parametrize(
    ("english", "ukrainian"),
    [
        ("907.06 N m", "907,06 Н·м"),
        ("−1.41·10⁻⁸ kg m²", "−1,41·10⁻⁸ кг·м²"),
        ("75.522°", "75,522°"),
        ("0.5 rad/s per N m", "0,5 рад/с на Н·м"),
        ("−0.0041 per rad/s", "−0,0041 на рад/с"),
        ("Steady motion, cycle of 2 revolutions", "Усталений рух, цикл із 2 обертів"),
        ("mean load torque", "середній момент опору"),
        ("velocity v [m/s]", "швидкість v [м/с]"),
        ("pin, A1 on cart1.rod", "шарнір, A1 на cart1.rod"),
        ("Press #3", "Press #3"),
        ("The follower rises by 5.5 mm; derivatives are by the cam angle θ.", FOLLOWER),
        ("≥ 4.85 1/m", "≥ 4,85 1/м"),
        ("Measured angle of front, order 8", "Виміряний кут front, порядок 8"),
        ("trial: torque of line, order 4.5", "trial: момент (line), порядок 4,5"),
        ("Motion of cart 2.5 and cart 3.5", "Рух cart 2.5 і cart 3.5"),
        ("2.5-axle at most 3.5 N", "2.5-axle — не більше 3,5 Н"),
        (
            "The motor slows to 91.18 rad/s in each revolution, below its breakdown speed of 94.95 rad/s: "
            "the machine passes this point on stored kinetic energy alone.",
            "Двигун сповільнюється до 91,18 рад/с у кожному оберті, нижче за критичну швидкість 94,95 рад/с: "
            "машина проходить це місце лише за рахунок кінетичної енергії.",
        ),
        ("something nobody wrote", "something nobody wrote"),
    ],
)
def test_texts(english: str, ukrainian: str) -> None:
    assert UKRAINIAN.label(english) == ukrainian
    assert ENGLISH.label(english) == english


def test_a_paragraph_of_a_figure_is_translated_as_a_whole() -> None:
    broken = "In brackets: referred to\nthe speed of motor.", "speed\n[rpm]"
    assert [_said(text, UKRAINIAN).split() for text in broken] == [
        ["У", "дужках:", "зведено", "до", "швидкості", "двигун."],
        ["швидкість", "[об/хв]"],
    ]


def test_every_translation_has_the_places_of_its_text() -> None:
    for english, ukrainian in UKRAINIAN.texts.items():
        for sign in ("#", "{"):
            assert english.count(sign) == ukrainian.count(sign), english


def test_every_text_is_found_when_it_is_said() -> None:
    """A text with a unit behind a number, or whose place a longer text takes, would stay in English."""
    # The page itself puts in the numbers of these.
    of_pages = {text.rstrip(".") for text in _page_words(Content(title=""))["texts"]}
    for english, ukrainian in UKRAINIAN.texts.items():
        if english in of_pages:
            continue
        numbers, names = (["7"] * english.count(sign) for sign in "#{")
        said = UKRAINIAN(re.sub("#", "7", english.replace("{}", "Qwx")))
        assert said == _filled(ukrainian, numbers, ["Qwx"] * len(names)), english


@pytest.mark.parametrize(
    "words",
    [
        "run roller_two_carts",
        "run press_with_flywheel --zero top --units rpm",
        "cam roller_cam",
        "run topper",
        "torsion v8_diesel",
        "run flywheel_four_stroke",
        f"run {EXAMPLES / 'elastic_coupling_of_carts' / 'machine.toml'}",
        f"torsion {EXAMPLES / 'ice_impacts' / 'machine.toml'}",
        f"torsion {EXAMPLES / 'twin_engine_ship' / 'machine.toml'}",
    ],
)
def test_a_report_has_no_english_left(words: str) -> None:
    content = _content(words.split(), "linkwright run machine.toml")
    # Entries of a manoeuvre are shown as they are in the file.
    own = {content.title, content.lead, content.papers, str(content.groups)}
    watched = Watched(UKRAINIAN.code, UKRAINIAN.texts, UKRAINIAN.units, UKRAINIAN.decimal, UKRAINIAN.keys)
    in_language(content, watched)
    left = {text for text in watched.left if ENGLISH_WORDS.search(text) and text not in own}
    assert not [text for text in left if not any(text in one for one in own)]


def test_numbers_are_the_same() -> None:
    words = ["run", "roller_two_carts"]
    english, ukrainian = (_numbers(in_language(_content(words, ""), language(code))) for code in ("en", "uk"))
    assert len(english) > 100
    assert ukrainian == [number.replace(".", ",") for number in english]


def _numbers(content: object) -> list[str]:
    """Numbers in the cells of all tables."""
    cells = (
        cell for part in content.parts for table in part.tables for row in table.rows for cell in row[2:]
    )
    return [number for cell in cells for number in re.findall(r"−?\d+(?:[.,]\d+)?", cell)]


def test_names_of_the_machine_stay() -> None:
    content = _content(["run", "roller_two_carts", "--set", "name=load"], "")
    named = content.groups[-1][1][0]._replace(name="load")
    changed = in_language(
        content.__class__(title="load", groups=[("Bodies", [named])], warnings=["load", "speed"]), UKRAINIAN
    )
    assert changed.warnings == ["load", "швидкість"]
    assert changed.groups[0][0] == "Тіла"


def test_names_of_a_study_stay(tmp_path: Path) -> None:
    """A variable `rod` is no word of the product; what is said of it is translated."""
    (tmp_path / "study.toml").write_text("""
machine = "roller_two_carts"
[variables.rod]
address = "mechanism.sliders.cart1.rod"
range = ["-100 mm", "1 m"]
[responses]
speed = "steady_state.speed_mean_time"
""")
    content = _content(["tolerance", str(tmp_path / "study.toml"), "--rows", "100"], "")
    changed = in_language(content, UKRAINIAN)
    tables = {table.name: table for part in changed.parts for table in part.tables}
    assert [tables[name].rows[0][0] for name in ("variables", "scatter")] == ["rod", "speed"]
    assert changed.warnings[0].startswith("Без результату")


def test_an_unknown_language_is_refused() -> None:
    with pytest.raises(InputError, match='--lang: found "xx", expected one of en, uk'):
        language("xx")


def test_only_names_of_the_file_stay() -> None:
    """A table of the file such as `limit` is no name; `coupling`, so named by the file, is one."""
    told = in_language(torsion_content(torsion_study(lw.read("v8_survey"))), UKRAINIAN)
    heads = [head for part in told.parts for table in part.tables for head in table.heads]
    assert "межа" in heads
    assert "limit" not in heads
    rows = [row for part in told.parts for table in part.tables for row in table.rows]
    assert any(row[0] == "coupling" for row in rows)


@pytest.mark.parametrize(
    "words",
    [
        "size roller_two_carts",
        "size roller_two_carts --keep-motor",
        "motors",
        "check roller_two_carts",
        "cam laws",
        "motion press_motion --zero top",
        "motion press_motion --at 30deg",
        "forces press_with_flywheel --at 40deg",
        "run four_stroke_speed",
        "torsion damper v8_diesel --on front --ring-inertia 0.12 --mode 2",
        "torsion drill_pipe",
        "loads drawn_connecting_rod",
        f"outline {EXAMPLES / 'drawn_connecting_rod' / 'rod.dxf'} --thickness 20mm --density 2700",
        "fmu roller_two_carts",
    ],
)
def test_reports_of_commands_have_no_english(words: str, tmp_path: Path) -> None:
    """Texts of the product; names, keys, types of motors and sources stay as they are."""
    page = tmp_path / "page.html"
    command = ["report", "--lang", "uk", "--to", str(page), *words.split()]
    done = invoke(*command)
    assert done.exit_code == 0, done.output
    written = page.read_text("utf-8")
    assert '<html lang="uk">' in written
    text = re.sub(r"<(script|style|code|pre|math)\b.*?</\1>", "", written, flags=re.DOTALL)
    text = re.sub(r'<[^>]*class="(where|data|lead)[^>]*>.*?</', "<", text, flags=re.DOTALL)
    said = [one.strip() for one in re.findall(r">([^<]+)<", text)]
    left = [one for one in said if ENGLISH_WORDS.search(one) and not _is_kept(one)]
    assert left == []


def _is_kept(text: str) -> bool:
    """Whether a text is a name of a file, a source, or a key of the machine file in words."""
    names = ("installation", "flywheel", "generator", "engine", "brake", "press", "pipe", "pole", "4-pole")
    sources = ("paper", "Стаття", "Theory", "Wittrick", "Den Hartog", "(1) without", "Джерело")
    keys = ("constant torque", "force angle", "damping torsional", "speed start", "turns max")
    return any(one in text for one in (*names, *sources)) or text in keys
