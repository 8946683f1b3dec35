"""Read a study: a file beside its machine, or the table ``study`` of a machine file."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, MachineError, MachineFileError, Problem, show
from linkwright.kernel.files.library import library, studies
from linkwright.kernel.files.lines import located
from linkwright.kernel.files.named_file import named_file
from linkwright.kernel.files.points import read_columns
from linkwright.kernel.files.text_file import TextError, text_of
from linkwright.kernel.limits import FILE_BYTES
from linkwright.kernel.public import public
from linkwright.kernel.units.kinds import COUNT
from linkwright.kernel.units.reading import is_number
from linkwright.machine.address import kind
from linkwright.machine.machine import Machine
from linkwright.machine.overrides import Override, apply, parse_all
from linkwright.machine.read import Overrides, read, tables_of
from linkwright.studies.choices import choice_names
from linkwright.studies.model import StudyFile
from linkwright.studies.parquet import parquet_columns
from linkwright.studies.plan import StudyPlan, plan

# The table of a machine file that is a study.
TABLE = "study"


@public
def read_study(
    path: str | os.PathLike[str],
    overrides: Overrides = (),
    *,
    allow_outside: bool = False,
) -> StudyPlan:
    """Read a study and its machine, and check them against each other.

    Parameters
    ----------
    path : path
        A study file, whose entry ``machine`` names the machine file; a machine file with a table
        ``study``; or the name of an example with a study.
    overrides : sequence of str or Mapping
        Entries that replace or add to those of the machine, texts ``PATH=VALUE`` or path → value; those that
        begin with ``study.`` are of the study.
    allow_outside : bool
        Whether entries `machine` and `file` may lead out of the folder of the file that they stand in.

    Returns
    -------
    StudyPlan
        Ready to run.

    Raises
    ------
    MachineFileError
        Something is wrong in one of the files; all problems of the first are listed with line and key.
    InputError
        An override is malformed.
    """
    place = study_file(Path(path))
    text = _text(place)
    tables = tables_of(text, str(place))
    is_machine = isinstance(tables.get(TABLE), Mapping)
    if "format" in tables and not is_machine:
        raise MachineFileError([_no_study(place)])
    of_study, of_machine = _divided(parse_all(overrides))
    given = tables[TABLE] if is_machine else tables
    for change in of_study:
        apply(given, change)
    at = (TABLE,) if is_machine else ()
    try:
        study = StudyFile.model_validate(given)
        source = place if is_machine else _machine_of(place, study, allow_outside=allow_outside)
        options = {path.address: path.value for path in of_machine}
        described = read(source, options, allow_outside=allow_outside)
        # Results are those of the machine and of this study, whatever other study stands in its file.
        machine = described if described.study is None else described.with_entries({"study": None})
        return plan(machine, study, _listed(place, machine, study, allow_outside=allow_outside))
    except MachineError as error:
        if any(problem.path for problem in error.problems):  # of the machine file, or of one of rows
            raise
        raise MachineFileError(located(error.problems, text, str(place), at)) from None


@public
def new_study(machine: Machine, tables: Mapping[str, Any]) -> StudyPlan:
    """Make a study of a machine from the tables of a study file.

    Parameters
    ----------
    machine : Machine
    tables : Mapping
        ``variables``, ``responses``, ``fit`` and so on.

    Returns
    -------
    StudyPlan
        Ready to run.

    Raises
    ------
    MachineError
        Something in it is wrong; all problems are listed with keys.
    """
    return plan(machine, StudyFile.model_validate(dict(tables)))


def study_file(path: Path) -> Path:
    """The file; of a name alone that is no file, the study of the example."""
    is_name = path == Path(path.name) and not path.suffix and not path.exists()
    return studies().get(path.name, path) if is_name else path


def _text(path: Path) -> str:
    try:
        return text_of(path, FILE_BYTES)
    except TextError as error:
        expected = error.expected or "a study file"
        remedy = error.remedy or ("" if path.exists() else suggestion(path.name, studies()))
        problem = Problem(found=error.found, expected=expected, remedy=remedy, path=str(path))
        raise MachineFileError([problem]) from None


def _no_study(path: Path) -> Problem:
    remedy = (
        f'write the table [{TABLE}] into it, or a study into a file of its own with machine = "{path.name}"'
    )
    expected = f"a study file, or a machine file with a table [{TABLE}]"
    return Problem(TABLE, "a machine file without that table", expected, remedy, str(path))


def _divided(changes: Sequence[Override]) -> tuple[list[Override], list[Override]]:
    """Overrides of the study, without the name of its table, and those of the machine."""
    mark = f"{TABLE}."
    own = [
        replace(change, address=change.address[len(mark) :])
        for change in changes
        if change.address.startswith(mark)
    ]
    return own, [change for change in changes if not change.address.startswith(mark)]


def _machine_of(path: Path, study: StudyFile, *, allow_outside: bool) -> Path:
    if study.machine is None:
        remedy = 'machine = "FILE", or a table [study] in the machine file'
        raise MachineError([Problem("machine", "nothing", "the machine file", remedy)])
    beside = named_file(study.machine, path.parent, "machine", allow_outside=allow_outside, document="study")
    if beside.exists():
        return beside
    # A name alone may be one of the library.
    if study.machine not in library():
        remedy = suggestion(study.machine, library())
        expected = "a machine file, from the folder of the study, or a machine of the library"
        raise MachineError([Problem("machine", f"{show(study.machine)}, no such file", expected, remedy)])
    return Path(study.machine)


def _listed(path: Path, machine: Machine, study: StudyFile, *, allow_outside: bool) -> Floats | None:
    """Rows of a list in SI, (n, variables)."""
    if study.sweep.file is None:
        return None
    place = named_file(study.sweep.file, path.parent, "sweep.file", allow_outside=allow_outside)
    if not place.exists():
        found = f"{show(study.sweep.file)}, no such file"
        raise MachineError(
            [Problem("sweep.file", found, "a CSV or Parquet file, from the folder of the study")]
        )
    names = list(study.variables)
    choices = {
        name: choice_names(variable.values)
        for name, variable in study.variables.items()
        if variable.values
        and kind(machine, variable.address[0]) is None
        and not all(map(is_number, variable.values))
    }
    if place.suffix == ".parquet":
        columns = parquet_columns(place, names, choices)
    else:
        kinds = {
            name: kind(machine, variable.address[0]) or COUNT
            for name, variable in study.variables.items()
            if name not in choices
        }
        columns = read_columns(place, kinds, choices)
    rows = np.stack([columns[name] for name in names], axis=1)
    if not len(rows):
        raise InputError(f"{place}: found no rows, expected at least one")
    if not np.isfinite(rows).all():
        row = int(np.flatnonzero(~np.isfinite(rows).all(axis=1))[0])
        raise InputError(f"{place}: row {row}: found a number that is not finite, or an empty cell")
    return rows
