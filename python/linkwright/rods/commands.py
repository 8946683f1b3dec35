"""``linkwright rods FILE``: prediction of a rod string; with ``--card``, diagnosis of a measured card, with
``--cards`` of those of a field day.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Curves, FolderOutput, belong_to, to_folder
from linkwright.kernel.command.parameter import Option, Value
from linkwright.kernel.errors import InputError
from linkwright.kernel.extras import require
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import FREQUENCY, TIME
from linkwright.kernel.units.marks import not_negative, positive
from linkwright.machine.file_argument import File
from linkwright.machine.machine import Machine

Card = Annotated[
    Path | None,
    Option(
        "--card",
        "CSV",
        "Measured surface card: one stroke at equal steps of time, with a header such as `position [m], "
        "load [kN]`; a column `time [s]` gives its period.",
    ),
]
Cards = Annotated[
    str | None,
    Option(
        "--cards",
        "FOLDER",
        "Measured surface cards of a field day: a folder of CSV files, a pattern such as `'day/*.csv'`, or a "
        "CSV file with a column `file`.",
    ),
]
Parquet = Annotated[
    bool, Option("--parquet", help="With --cards and --out: also cards.parquet; needs pyarrow.")
]
Period = Annotated[
    float | None,
    Value(
        "--period", positive(TIME), "Period of the stroke of the card. Default: column time, or the speed."
    ),
]
Damping = Annotated[
    float | None,
    Value("--damping", not_negative(FREQUENCY), "Damping c of the rods [1/s]. Default: fitted to the card."),
]
Harmonics = Annotated[
    int | None,
    Option("--harmonics", "N", "Harmonics of the card that count. Default: those above its noise.", min=1),
]
To = Annotated[FolderOutput, to_folder("Write results.json and the cards as CSV there.", curves=Curves)]


def rods(
    file: File,
    card: Card = None,
    cards: Cards = None,
    period: Period = None,
    damping: Damping = None,
    harmonics: Harmonics = None,
    parquet: Parquet = False,
    *,
    to: To,
) -> None:
    """Rod string of a pumping unit: cards, loads, stresses, gearbox torque, production; or a measured card.

    Exit code 1 if a section, the gearbox or the structure is overloaded, or a card of a day has no diagnosis.
    """
    if card is None:
        belong_to("--card", "harmonics")
    if cards is None:
        belong_to("--cards", "parquet")
        belong_to("--card or --cards", *(("period", "damping") if card is None else ()))
    elif card is not None:
        raise InputError("--cards: found --card too, expected one of them")
    if parquet:
        require("pyarrow.parquet", "studies", "Parquet files need pyarrow")
    machine = file.read()
    if cards is not None:
        to.hand_over(_day(machine, cards, parquet=parquet, period=period, damping=damping))
    elif card is not None:
        to.hand_over(_diagnosed(machine, card, period, damping=damping, harmonics=harmonics))
    else:
        to.hand_over(_predicted(machine))


def _answer(
    machine: Machine, name: str, result: Any, kind: str, findings: Any, warnings: Any, **more: Any
) -> Answer:
    """The answer of a result; `kind`: what its tables begin with, `more`: figures and files."""
    return Answer(
        machine=machine,
        is_described=True,
        results={name: result},
        findings=list(findings),
        warnings=list(warnings),
        tables=later(f"rods.{kind}_tables", result),
        **more,
    )


def _predicted(machine: Machine) -> Answer:
    from linkwright.rods.prediction import rod_string, string_of
    from linkwright.rods.warnings import string_findings, string_warnings

    motion, string = rod_string(machine), string_of(machine)
    return _answer(
        *(machine, "rod_string", motion, "tables:string"),
        *(string_findings(motion), string_warnings(string, motion)),
        figures=later("rods.figures:string_figures", string, motion),
        files={"cards.csv": later("rods.tables:cards_csv", motion)},
    )


def _diagnosed(machine: Machine, path: Path, period: float | None, **how: Any) -> Answer:
    from linkwright.rods.card import read_card
    from linkwright.rods.diagnosis import diagnose_card
    from linkwright.rods.prediction import string_of
    from linkwright.rods.warnings import card_findings, diagnosis_warnings

    card = read_card(path)
    period = card.period if period is None else period
    found = diagnose_card(machine, card.position, card.load, period=period, **how)
    return _answer(
        *(machine, "card_diagnosis", found, "tables:diagnosis"),
        *(card_findings(found), diagnosis_warnings(string_of(machine), found)),
        figures=later("rods.figures:compared_figures", machine, found),
        files={"cards.csv": later("rods.tables:cards_csv", found)},
    )


def _day(machine: Machine, place: str, *, parquet: bool, **how: Any) -> Answer:
    from linkwright.kernel.command.console import bar
    from linkwright.rods.field_day import card_files, require_some
    from linkwright.rods.many_cards import diagnose_cards
    from linkwright.rods.warnings import day_findings, day_warnings

    files = card_files(place)
    with bar("cards") as watch:
        day = diagnose_cards(machine, files, watch=watch, **how)
    require_some(day)
    written = {"csv": "rods.field_day:day_csv"} | (
        {"parquet": "rods.field_day:day_parquet"} if parquet else {}
    )
    return _answer(
        *(machine, "card_diagnoses", day, "field_day:day"),
        *(day_findings(machine, day), day_warnings(machine, day)),
        names=day.names,
        figures=later("rods.field_day:day_figures", day),
        files={f"cards.{ending}": later(place, day) for ending, place in written.items()},
    )
