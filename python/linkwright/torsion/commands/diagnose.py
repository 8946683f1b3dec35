"""``linkwright torsion diagnose FILE CSV``: which cylinder is weak, from a measured speed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Level, Output, to_screen
from linkwright.kernel.command.parameter import Argument, Option, Value
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import ANGLE, SPEED
from linkwright.kernel.units.marks import positive
from linkwright.machine.file_argument import File

Measured = Annotated[
    Path,
    Argument(
        "CSV",
        "Speed over the crank angle, at even steps over whole cycles; header: angle [deg], speed [rpm].",
    ),
]
On = Annotated[str, Option("--on", "DISC", "Measured disc.")]
Noise = Annotated[
    float | None,
    Value(
        "--noise",
        positive(SPEED),
        'Standard deviation of a sample, such as "0.02 rad/s". Default: from the residuals.',
    ),
]
Zero = Annotated[
    int | None,
    Option(
        "--zero",
        "CYLINDER",
        "The angle is 0 at the firing dead centre of this cylinder. Default: where throw 1 points to "
        "the vertical.",
    ),
]
Rigid = Annotated[bool, Option("--rigid", help="Neglect torsion, for comparison.")]


def diagnose(
    file: File,
    measured: Measured,
    on: On,
    noise: Noise = None,
    zero: Zero = None,
    level: Level = 0.95,
    rigid: Rigid = False,
    *,
    to: Annotated[Output, to_screen()],
) -> None:
    """Which cylinder of an engine is weak, from the speed of a disc over the crank angle."""
    from linkwright.kernel.files.points import read_columns
    from linkwright.torsion.diagnosis.record_diagnosis import record_diagnosis

    if not 0 < level < 1:
        raise InputError(f"--level: found {level:g}, expected a probability between 0 and 1")
    machine = file.read()
    columns = read_columns(measured, {"angle": ANGLE, "speed": SPEED})
    read = record_diagnosis(
        machine, on, columns["angle"], columns["speed"], noise=noise, zero=zero, rigid=rigid
    )
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
    answer = Answer(
        machine=machine,
        results={"diagnosis": results},
        warnings=read.warnings,
        tables=later("torsion.tables.engine:diagnosis_table", read, level),
        tail=later("torsion.tables.engine:diagnosis_words", read, level),
    )
    to.hand_over(answer)
