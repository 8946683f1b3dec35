"""``linkwright torsion diagnose FILE CSV``: which cylinder is weak, from a measured speed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import File, Json, Outside, Sets, option_value
from linkwright.kernel.command.parameter import Argument, Option
from linkwright.kernel.errors import InputError

if TYPE_CHECKING:
    from linkwright.machine.machine import Machine
    from linkwright.torsion.diagnosis.record_diagnosis import RecordDiagnosis

Measured = Annotated[
    Path,
    Argument(
        metavar="CSV",
        help="Speed over the crank angle, at even steps over whole cycles; header: angle [deg], speed [rpm].",
    ),
]
On = Annotated[str, Option("--on", metavar="DISC", help="Measured disc.")]
Noise = Annotated[
    str | None,
    Option(
        "--noise",
        metavar="SPEED",
        help='Standard deviation of a sample, such as "0.02 rad/s". Default: from the residuals.',
    ),
]
Zero = Annotated[
    int | None,
    Option(
        "--zero",
        metavar="CYLINDER",
        help="The angle is 0 at the firing dead centre of this cylinder. Default: where throw 1 points to "
        "the vertical.",
    ),
]
Level = Annotated[float, Option("--level", metavar="P", help="Confidence level of the intervals.")]
Rigid = Annotated[bool, Option("--rigid", help="Neglect torsion, for comparison.")]


def diagnose(
    file: File,
    measured: Measured,
    on: On,
    noise: Noise = None,
    zero: Zero = None,
    level: Level = 0.95,
    rigid: Rigid = False,
    set: Sets = None,
    allow_outside: Outside = False,
    json: Json = False,
) -> None:
    """Which cylinder of an engine is weak, from the speed of a disc over the crank angle."""
    from linkwright.kernel.files.points import read_columns
    from linkwright.kernel.units.kinds import ANGLE, SPEED
    from linkwright.kernel.units.marks import positive
    from linkwright.machine.read import read
    from linkwright.torsion.diagnosis.record_diagnosis import record_diagnosis

    if not 0 < level < 1:
        raise InputError(f"--level: found {level:g}, expected a probability between 0 and 1")
    deviation = None if noise is None else option_value("--noise", noise, positive(SPEED))
    machine = read(file, set or [], allow_outside=allow_outside)
    columns = read_columns(measured, {"angle": ANGLE, "speed": SPEED})
    diagnosis = record_diagnosis(
        machine, on, columns["angle"], columns["speed"], noise=deviation, zero=zero, rigid=rigid
    )
    hand_over(_answer(machine, diagnosis, level), json=json)


def _answer(machine: Machine, read: RecordDiagnosis, level: float) -> Answer:
    """What each cylinder gives, and what is wrong with which."""
    from linkwright.torsion.tables.engine import diagnosis_table, diagnosis_words

    diagnosis = read.found
    results = {
        **diagnosis.to_dict(curves=True),
        "disc": read.disc,
        "speed": read.speed,
        "half_width": diagnosis.half_width(level).tolist(),
        "weak": list(read.weak(level)),
        "late": list(read.late(level)),
        "early": list(read.early(level)),
        "leaking": list(read.leaking(level)),
    }
    # They stand beside the results, with those of the record.
    results.pop("warnings")
    return Answer(
        machine=machine.name,
        units=machine.units,
        results=lambda _: {"diagnosis": results},
        warnings=read.warnings,
        tables=lambda: [diagnosis_table(read, level)],
        tail=lambda: diagnosis_words(read, level) + "\n",
    )
