"""``linkwright rods FILE``: prediction of a rod string; with ``--card``, diagnosis of a measured card."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Curves, FolderOutput, belong_to, to_folder
from linkwright.kernel.command.parameter import Option, Value
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
    period: Period = None,
    damping: Damping = None,
    harmonics: Harmonics = None,
    *,
    to: To,
) -> None:
    """Rod string of a pumping unit: cards, loads, stresses, gearbox torque, production; or a measured card.

    Exit code 1 if a section, the gearbox or the structure is overloaded.
    """
    machine = file.read()
    if card is not None:
        to.hand_over(_diagnosed(machine, card, period, damping, harmonics))
        return
    belong_to("--card", "period", "damping", "harmonics")
    to.hand_over(_predicted(machine))


def _predicted(machine: Machine) -> Answer:
    from linkwright.rods.prediction import rod_string, string_of
    from linkwright.rods.warnings import string_findings, string_warnings

    motion = rod_string(machine)
    return Answer(
        machine=machine,
        is_described=True,
        results={"rod_string": motion},
        findings=list(string_findings(motion)),
        warnings=list(string_warnings(string_of(machine), motion)),
        head=machine.name,
        tables=later("rods.tables:string_tables", motion),
        figures=later("rods.figures:string_figures", string_of(machine), motion),
        files={"cards.csv": later("rods.tables:cards_csv", motion)},
    )


def _diagnosed(
    machine: Machine, path: Path, period: float | None, damping: float | None, harmonics: int | None
) -> Answer:
    from linkwright.rods.card import read_card
    from linkwright.rods.diagnosis import diagnose_card
    from linkwright.rods.prediction import string_of
    from linkwright.rods.warnings import diagnosis_warnings

    card = read_card(path)
    found = diagnose_card(
        machine,
        card.position,
        card.load,
        period=card.period if period is None else period,
        damping=damping,
        harmonics=harmonics,
    )
    return Answer(
        machine=machine,
        is_described=True,
        results={"card_diagnosis": found},
        warnings=list(diagnosis_warnings(string_of(machine), found)),
        head=machine.name,
        tables=later("rods.tables:diagnosis_tables", found),
        figures=later("rods.figures:compared_figures", machine, found),
        files={"cards.csv": later("rods.tables:cards_csv", found)},
    )
