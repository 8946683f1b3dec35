"""Paper 1 computed anew: four drives of roller-forming machines, published against computed in three ways.

| way | is |
| --- | --- |
| `solution` | the steady motion and the run-up of equation (1), solved exactly |
| `limit` | the motion at constant energy, motor and load switched off, at the published mean speed |
| `scheme` | the published step method with the net torque over the gear ratio, `paper1_scheme` |
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.drive.constant_energy import constant_energy_of
from linkwright.drive.reduction import Reduction, reduction
from linkwright.drive.run_up import RunUp, run_up
from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.drive.step_method import StepMotion
from linkwright.kernel.files.library import library_path
from linkwright.machine.address import replace as with_entries
from linkwright.machine.machine import Machine
from linkwright.machine.program.drive_line import drive_inertia
from linkwright.machine.read import read
from linkwright.papers.cell import Cell
from linkwright.papers.paper1.conclusions import conclusions
from linkwright.papers.paper1.limit import Fit, fitted_inertia, scaled_to
from linkwright.papers.paper1.scheme import best_step, published_scheme, turns_to_steady
from linkwright.papers.published import QUANTITIES, Published, PublishedDrive, published
from linkwright.sizing.motor import choose_motor
from linkwright.sizing.power import required_power

WAYS = {"solution": "solution of (1)", "limit": "constant energy", "scheme": "published scheme"}

# Intervals of the turn for curves; the paper's own step is a degree.
_ANGLES = 1440

Track = Callable[[Sequence[PublishedDrive]], Iterable[PublishedDrive]]


@dataclass(frozen=True)
class Recomputed:
    """A printed value against what follows from other printed values of the same row.

    Attributes
    ----------
    quantity : str
        Which.
    printed, follows : float
        As printed; from the others, by the paper's own formula [SI].
    formula : str
        That formula.
    """

    quantity: str
    printed: float
    follows: float
    formula: str

    @property
    def agrees(self) -> bool:
        """Whether both differ by at most one in the last printed digit."""
        decimals = len(repr(self.printed).partition(".")[2])
        # A hair more than one unit, so that rounding of the binary numbers does not count.
        return abs(self.follows - self.printed) <= 1.000001 * 10.0**-decimals


@dataclass(frozen=True)
class Drive:
    """One drive: what is published, and what comes out.

    Attributes
    ----------
    published : PublishedDrive
        The printed row.
    machine : Machine
        Its file.
    reduced, steady, up, scheme : Reduction, SteadyState, RunUp, StepMotion
        The analyses.
    values : dict of str to dict
        Way → quantity → computed value [SI].
    cells : dict of str to dict
        Way → quantity → `Cell`.
    fit : Fit
        The inertia with which the limit comes nearest to the row.
    recomputed : tuple of Recomputed
        The row against itself.
    sized : SteadyState or None
        Steady motion with the motor that passes all checks of `linkwright.sizing`.
    sized_motor : str
        That motor.
    """

    published: PublishedDrive
    machine: Machine
    reduced: Reduction
    steady: SteadyState
    up: RunUp
    scheme: StepMotion
    values: dict[str, dict[str, float]]
    cells: dict[str, dict[str, Cell]]
    fit: Fit
    recomputed: tuple[Recomputed, ...]
    sized: SteadyState | None
    sized_motor: str

    @property
    def drive_inertia(self) -> float:
        """Inertia of motor, coupling and gearbox at the crank, I_0 i² [kg m²]."""
        assert self.machine.drive is not None
        return float(drive_inertia(self.machine.drive))


@dataclass(frozen=True)
class Paper1:
    """Paper 1, published against computed.

    Attributes
    ----------
    published : Published
        What is printed.
    drives : tuple of Drive
        The four drives.
    intermediates : dict of str to Cell
        Values that the paper prints on the way.
    steps : dict of float to float
        Step of the angle in degrees → deviation of the scheme from the published speeds of two carts [–].
    opposed : Fit
        Row 4 by four carts at 180° between neighbours, two against two.
    """

    published: Published
    drives: tuple[Drive, ...]
    intermediates: dict[str, Cell]
    steps: dict[float, float]
    opposed: Fit

    @property
    def rankings(self) -> dict[str, list[int]]:
        """Numbers of carts from the most even drive to the least, by k_p, for each way of finding it."""
        ways: dict[str, Callable[[Drive], float]] = {
            "published": lambda each: each.published.values["motion_coefficient"],
            "solution of (1), motors by rated power": lambda each: each.steady.motion_coefficient,
            "solution of (1), motors by all checks": _sized_coefficient,
            "constant energy": lambda each: each.values["limit"]["motion_coefficient"],
        }
        return {
            way: [each.published.carts for each in sorted(self.drives, key=value)]
            for way, value in ways.items()
        }

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        return {
            "drives": [_drive_dict(each) for each in self.drives],
            "intermediates": {name: cell.to_dict() for name, cell in self.intermediates.items()},
            "scheme_step_deviation": {f"{step:g} deg": off for step, off in self.steps.items()},
            "rankings": self.rankings,
            "conclusions": conclusions(self),
        }


def _sized_coefficient(drive: Drive) -> float:
    return drive.sized.motion_coefficient if drive.sized else np.inf


def _drive_dict(drive: Drive) -> dict[str, Any]:
    """One drive, ready for JSON."""
    return {
        "carts": drive.published.carts,
        "name": drive.published.name,
        "machine": drive.published.machine,
        "published": drive.published.values,
        "columns": {
            way: {name: cell.to_dict() for name, cell in cells.items()} for way, cells in drive.cells.items()
        },
        "drive_inertia": drive.drive_inertia,
        "limit_fit": {"drive_inertia": drive.fit.inertia, "misfit": drive.fit.misfit, "fits": drive.fit.fits},
        "printed_row": [
            {
                "quantity": each.quantity,
                "printed": each.printed,
                "follows": each.follows,
                "agrees": each.agrees,
            }
            for each in drive.recomputed
        ],
        "sized_motor": drive.sized_motor,
        "sized_motion_coefficient": drive.sized.motion_coefficient if drive.sized else None,
    }


def paper1(track: Track = iter) -> Paper1:
    """Compute paper 1 anew.

    Parameters
    ----------
    track : callable, optional
        Takes the drives and gives them back one by one, to show how far it is.

    Returns
    -------
    Paper1
        Published and computed values with verdicts.

    Notes
    -----
    The motors of the drives with one, three and four carts are not printed. Their files take the smallest
    motor of the same series whose rated power reaches the required one, by which rule the printed motor of
    the two carts comes out too.

    References
    ----------
    .. [1] Paper 1, whole.
    """
    data = published(1)
    drives = tuple(_drive(each) for each in track(data.drives))
    two = next(each for each in drives if each.published.carts == 2)
    four = next(each for each in drives if each.published.carts == 4)
    printed = two.published.values
    return Paper1(
        published=data,
        drives=drives,
        intermediates=_intermediates(data, two),
        steps=best_step(two.machine, printed["speed_min"], printed["speed_max"]),
        opposed=_opposed(four),
    )


def _drive(row: PublishedDrive) -> Drive:
    """All analyses of one drive."""
    machine = read(library_path(row.machine))
    assert machine.drive is not None
    reduced = reduction(machine, n=_ANGLES)
    steady = steady_state(machine, n=_ANGLES)
    up = run_up(machine, steady=steady)
    scheme = published_scheme(machine)
    limit = scaled_to(constant_energy_of(reduced), reduced, row.values["speed_mean"])
    values = {
        "solution": _measures(steady) | {"turns": up.turns},
        "limit": limit,
        "scheme": _measures(scheme) | {"turns": float(turns_to_steady(scheme))},
    }
    now = float(drive_inertia(machine.drive))
    chosen = choose_motor(machine).chosen
    return Drive(
        published=row,
        machine=machine,
        reduced=reduced,
        steady=steady,
        up=up,
        scheme=scheme,
        values=values,
        cells={way: _cells(row, way, values[way]) for way in WAYS},
        fit=fitted_inertia(reduced, now, row.values["unevenness"], row.values["dynamism"]),
        recomputed=tuple(recompute(row.values)),
        sized=chosen.steady if chosen else None,
        sized_motor=chosen.type if chosen else "",
    )


def _measures(motion: SteadyState | StepMotion) -> dict[str, float]:
    """The columns of the table that a steady motion has."""
    found = {name: getattr(motion, name) for name in QUANTITIES if name not in ("turns", "speed_mean")}
    return found | {"speed_mean": motion.speed_mean_extremes}


def _cells(row: PublishedDrive, way: str, values: dict[str, float]) -> dict[str, Cell]:
    """Every column of a row against one way of computing it."""
    return {
        name: Cell(
            published=row.values[name],
            computed=values.get(name),
            because=_because(row, way, name),
            # The limit has a shape but no speed of its own.
            given=way == "limit" and name == "speed_mean",
        )
        for name in QUANTITIES
    }


def _because(row: PublishedDrive, way: str, quantity: str) -> str:
    """Why a value differs, if it does."""
    unknown = "" if row.motor_printed else ", and the motor of this drive is not printed"
    if way == "limit":
        if quantity == "turns":
            return "at constant energy there is no run-up"
        if row.carts == 4:
            return "four carts at 90° keep an almost constant inertia, whatever the motor's"
        return f"the limit has neither motor nor load{unknown}"
    if way == "solution":
        if quantity == "turns":
            return "the full torque runs the machine up; the published run-up has 1/9.8 of it" + unknown
        if row.carts == 4:
            return "four carts at 90° keep an almost constant inertia; the published row contradicts (1)"
        return f"the published row does not solve (1): only 1/9.8 of the net torque acts in it{unknown}"
    if row.carts == 4:
        return "four carts at 90° turn evenly by this scheme too"
    return f"the paper prints neither its step nor its count of turns{unknown}"


def recompute(row: dict[str, float]) -> list[Recomputed]:
    """Set a printed row against itself.

    Parameters
    ----------
    row : dict of str to float
        Quantity → printed value.

    Returns
    -------
    list of Recomputed
        Mean speed, δ, H and k_p, each from other printed values by equations (13) to (15).
    """
    mean = row["speed_mean"]
    steepest = max(abs(row["acceleration_min"]), abs(row["acceleration_max"]))
    span = row["speed_max"] - row["speed_min"]
    follows = {
        "speed_mean": (0.5 * (row["speed_min"] + row["speed_max"]), "(ω_min + ω_max)/2"),
        "unevenness": (span / mean, "(ω_max − ω_min)/ω_mean"),
        "dynamism": (steepest / mean**2, "|ε|_max/ω_mean²"),
        "motion_coefficient": (row["unevenness"] ** 2 + row["dynamism"], "δ² + H"),
    }
    return [Recomputed(name, row[name], *found) for name, found in follows.items()]


def _intermediates(data: Published, two: Drive) -> dict[str, Cell]:
    """The values printed on the way, for two carts."""
    power = required_power(two.machine)
    because = {each["quantity"]: each.get("note", "") for each in data.intermediates}
    return {
        each["name"]: Cell(each["value"], getattr(power, each["quantity"]), because[each["quantity"]])
        for each in data.intermediates
    }


def _opposed(four: Drive) -> Fit:
    """Row 4 by carts two against two."""
    phases = {f"mechanism.cranks.A{n + 1}.phase": n * np.pi for n in range(4)}
    reduced = reduction(with_entries(four.machine, phases), n=360)
    row = four.published.values
    return fitted_inertia(reduced, four.drive_inertia, row["unevenness"], row["dynamism"])
