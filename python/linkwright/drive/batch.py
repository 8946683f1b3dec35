"""Steady motion of thousands to millions of machines that differ in some entries."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.drive import evenness
from linkwright.drive.load_checks import require_same_turns
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.steady_state import START_WORDS, known_start_limits
from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.errors import InputError, MachineError, Problem, ShapeError
from linkwright.kernel.extras import require
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import array
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record
from linkwright.linkages.whole_cycle import over_whole_cycle, row_turns
from linkwright.machine.address import get, replace
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import SENTENCES, Status

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

# Numbers of a steady motion that the core gives, and of which it gives the derivatives.
COLUMNS = (
    "speed_min",
    "speed_max",
    "acceleration_min",
    "acceleration_max",
    "period",
    "multiplier",
    "energy_motor",
    "energy_drive",
    "energy_load",
    "torque_motor_mean",
    "torque_motor_rms",
)

# What each status means.
STATUS = SENTENCES | {
    int(Status.TWO_TURNS): "masses and loads do not repeat within 24 revolutions of the crank"
}

# What each number of `SteadyStates.fast_starts` means; fast starts settle where it is 0.
_OUTCOMES = ("runs away", "undecided")
FAST_STARTS = {
    1: "From fast starts the machine runs away, or accelerates into a range of periodic motions; it "
    "reaches the steady motion from slower starts.",
    2: START_WORDS["undecided"].format("fast starts"),
}


def fast_starts(machine: Machine) -> int:
    """Outcome of starts faster than steady motion, a key of `FAST_STARTS`; 0 if none, or none solved."""
    above = [limit.outcome for limit in known_start_limits(machine) if limit.side == "above"]
    return max((_OUTCOMES.index(outcome) + 1 for outcome in above), default=0)


_FAST_STARTS = (
    "0, or 1 where the machine runs away from fast starts and reaches the motion from slower ones, 2 "
    "where that was not decided, as `linkwright.drive.batch.FAST_STARTS` says; `steady_state` gives the "
    "speeds."
)
_STATUS_WORDS = "0 where solved; else a key of `linkwright.drive.batch.STATUS`."


@dataclass(frozen=True)
class SteadyStates(Record, evenness.Evenness[Floats]):
    """Steady motion of ``n`` machines; every array has shape (n,), NaN where there is no answer."""

    entries: Annotated[dict[str, Floats], About("Varied entries by address.")]
    status: Annotated[NDArray[np.uint8], About(_STATUS_WORDS, "(rows,)")]
    speed_min: Annotated[Floats, Label("minimum speed", "ω_min", "rad/s")]
    speed_max: Annotated[Floats, Label("maximum speed", "ω_max", "rad/s")]
    acceleration_min: Annotated[Floats, Label("minimum acceleration", "ε_min", "rad/s²")]
    acceleration_max: Annotated[Floats, Label("maximum acceleration", "ε_max", "rad/s²")]
    period: Annotated[Floats, Label("period", "T", "s")]
    multiplier: Annotated[Floats, Label("Floquet multiplier", "G", "")]
    energy_motor: Annotated[Floats, Label("work of the motor per revolution", "A_m", "J")]
    energy_drive: Annotated[Floats, Label("work at the crank per revolution", "A_d", "J")]
    energy_load: Annotated[Floats, Label("work of the loads per revolution", "A_r", "J")]
    torque_motor_mean: Annotated[Floats, Label("mean torque of the motor", "M_mean", "N m", "Over time.")]
    torque_motor_rms: Annotated[
        Floats, Label("root mean square torque of the motor", "M_rms", "N m", "Over time.")
    ]
    fast_starts: Annotated[NDArray[np.uint8], About(_FAST_STARTS, "(rows,)")]
    turns_swept: Annotated[int, About("Revolutions computed by the solver in total.")]
    turns: Annotated[Integers, Label("revolutions of a cycle", "", "")]

    @property
    def speed_mean_time(self) -> Annotated[Floats, Label("mean speed over time", "ω_m", "rad/s")]:
        """Angle of a cycle over its duration."""
        return 2 * np.pi * self.turns / self.period

    def plot(self, *names: str) -> Figure:
        """Quantities of the machines over the entry that varies, an axis for each.

        Parameters
        ----------
        *names : str
            Attributes, such as ``"speed_max"``; the coefficient of speed fluctuation without any.

        Returns
        -------
        matplotlib.figure.Figure
            A notebook shows it; ``figure.savefig(path)`` writes it.

        Raises
        ------
        InputError
            There is no such quantity.
        """
        from linkwright.kernel.figure.plotted import batch_plotted

        return batch_plotted(self, names or ("unevenness",))

    def _repr_html_(self) -> str:
        from linkwright.kernel.page.notebook import batch_html

        return batch_html(self)

    def to_frame(self) -> pd.DataFrame:
        """Entries and results as a table, a row for each machine; an `InputError` without pandas."""
        require("pandas", "frame", "to_frame needs pandas")
        import pandas as pd

        names = [*COLUMNS, "unevenness", "dynamism", "motion_coefficient"]
        columns = {name: getattr(self, name) for name in names}
        states = {"status": self.status, "fast_starts": self.fast_starts}
        return pd.DataFrame({**self.entries, **columns, **states})


@public
def steady_states(
    machine: Machine, entries: Mapping[str, ArrayLike], *, accuracy: float = 1e-8
) -> SteadyStates:
    """Steady motion of many machines that differ from one in some entries.

    Parameters
    ----------
    machine : Machine
        What all have in common.
    entries : mapping
        Address of an entry → its values, all of one length [SI], such as
        ``{"mechanism.cranks.A2.phase": np.linspace(0, np.pi, 1000)}``. A single number counts for all.
    accuracy : float
        Relative accuracy for machines that must be solved one by one. Machines on smooth characteristics
        are solved in lanes with a fixed mesh: speeds, periods and work to 1e-7, peaks of acceleration to
        1e-6. A row of which rounding forbids that, with a very steep motor, has no numbers but the status
        that says so.

    Returns
    -------
    SteadyStates
        One row a machine, in the order of the arrays; each over its own cycle.

    Raises
    ------
    MachineError
        An address does not exist, or a value is not possible there.
    ShapeError
        Arrays of different lengths.
    InputError
        The machine has no motor, or one of constant speed.
    FindingError
        Masses and loads of the first machine do not repeat within 24 revolutions of the crank.
    SteadyStateError
        A load changes with time itself.
    """
    if machine.drive is None or machine.drive.motor is None:
        raise InputError(f"{machine.name}: steady motion needs a motor; add [drive.motor]")
    if not 1e-13 <= accuracy <= 1e-2:
        raise InputError(f"accuracy {accuracy:g}: expected a number from 1e-13 to 1e-2")
    if isinstance(machine.drive.motor, ConstantSpeedMotor):
        raise InputError(
            f"{', '.join(entries)}: the motor of each machine holds its speed, so that there is no steady "
            "motion to solve for; a batch needs a drive.motor of another kind"
        )
    require_same_turns(machine)
    arrays = columns_of(machine, entries)
    compiled = compile_machine(replace(machine, arrays))
    if not len(compiled.slots):
        raise InputError(
            f"{', '.join(arrays)}: no effect on the steady motion of {machine.name}; vary an entry of the "
            "motor's characteristic, the mechanism, its bodies or its loads"
        )
    over_whole_cycle(compiled.first())
    return SteadyStates(entries=arrays, **_solved_rows(compiled, accuracy))


def _solved_rows(compiled: CompiledMachine, accuracy: float) -> dict[str, Any]:
    turns, swept = row_turns(compiled), 0
    status = np.full(len(turns), int(Status.TWO_TURNS), dtype=np.uint8)
    fast = np.zeros(len(turns), dtype=np.uint8)
    columns = {name: np.full(len(turns), np.nan) for name in COLUMNS}
    for cycle in np.unique(turns[turns > 0]).tolist():
        members = np.flatnonzero(turns == cycle).astype(np.int32)
        part = compiled.over_turns(cycle)
        motions = (part if len(members) == len(turns) else part.rows(members)).steady_rows(accuracy)
        status[members], fast[members] = motions.status, motions.fast_starts
        for name, column in columns.items():
            per = cycle if name.startswith("energy") else 1
            column[members] = getattr(motions, name) / per
        swept += motions.turns_swept
    return {"status": status, "fast_starts": fast, "turns_swept": swept, "turns": turns, **columns}


def columns_of(machine: Machine, entries: Mapping[str, ArrayLike]) -> dict[str, Floats]:
    """Entries of many machines as arrays of one length.

    Raises `ShapeError` where they are not, and `MachineError` for values that are not possible.
    """
    arrays = {
        address: np.atleast_1d(array(address, value, finite=False)) for address, value in entries.items()
    }
    if any(column.size == 0 for column in arrays.values()):
        raise ShapeError("arrays of at least one number are needed, found an empty one")
    lengths = {column.shape for column in arrays.values()} - {(1,)}
    if not arrays or len(lengths) > 1 or any(len(shape) != 1 for shape in lengths):
        raise ShapeError(f"arrays of one length are needed, found shapes {sorted(lengths)}")
    shape = lengths.pop() if lengths else (1,)
    columns = {
        address: np.ascontiguousarray(np.broadcast_to(column, shape)) for address, column in arrays.items()
    }
    _check(machine, columns)
    return columns


def _check(machine: Machine, columns: Mapping[str, Floats]) -> None:
    """Raise unless all values are finite, and rows with the extremes of entries are possible machines."""
    # Bounds of entries are intervals, so an impossible value is an extreme or lies beyond a possible one; of
    # entries that depend on each other only these rows are examined.
    for address, column in columns.items():
        get(machine, address)
        if not np.isfinite(column).all():
            raise MachineError([Problem(address, "NaN or infinite values", "finite numbers")])
    rows = {int(pick(column)) for column in columns.values() for pick in (np.argmin, np.argmax)}
    for row in sorted(rows):
        entries = {address: float(column[row]) for address, column in columns.items()}
        Machine.model_validate(_tables(replace(machine, entries)))


def _tables(machine: Machine) -> dict[str, object]:
    return machine.model_dump(by_alias=True, exclude_unset=True)
