"""One drive of paper 1: its printed row, and what comes out in three ways.

| way | is |
| --- | --- |
| `solution` | the steady motion and the run-up of equation (1), solved exactly |
| `limit` | the motion at constant energy, motor and load switched off, at the published mean speed |
| `scheme` | the published step method with the net torque over the gear ratio, `scheme` |
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from linkwright.drive.evenness import constant_energy_of
from linkwright.drive.reduction import Reduction, reduction
from linkwright.drive.run_up import RunUp, run_up
from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.drive.step_method import StepMotion
from linkwright.kernel.files.library import library_path
from linkwright.machine.machine import Machine
from linkwright.machine.program.drive_line import drive_inertia
from linkwright.machine.read import read
from linkwright.papers.claim import Cell
from linkwright.papers.page import filled
from linkwright.papers.paper import printed_values
from linkwright.papers.paper1.scheme import Fit, fitted_inertia, published_scheme, scaled_to, turns_to_steady
from linkwright.sizing.motor import MotorChoice, choose_motor

# Intervals of the revolution for curves; the paper's own step is a degree.
_ANGLES = 1440


@dataclass(frozen=True)
class PublishedDrive:
    """One row of the table of results: its machine in the library, and printed values by quantity [SI]."""

    name: str
    source: str
    machine: str
    carts: int
    motor_printed: bool
    values: dict[str, float]

    @property
    def phase(self) -> float:
        """Between neighbouring cranks where they are spread over the revolution [rad]."""
        return 2 * np.pi / self.carts


def published_drives() -> tuple[PublishedDrive, ...]:
    """The table of results."""
    rows = printed_values(1)["drive"]
    return tuple(
        PublishedDrive(name=row["name"], source=row["source"], values=row["expect"], **row["given"])
        for row in rows
    )


@dataclass(frozen=True)
class ValueCheck:
    """A printed value against what follows from others of the same row by a formula of the paper [SI]."""

    quantity: str
    printed: float
    follows: float
    formula: str

    @property
    def agrees(self) -> bool:
        """Whether both differ by at most one in the last printed digit."""
        return abs(self.follows - self.printed) <= _last_digit(self.printed)


def _last_digit(printed: float) -> float:
    """One in the last printed digit, and a hair more, so that rounding of binary numbers does not count."""
    return 1.000001 * 10.0 ** -len(repr(printed).partition(".")[2])


def recompute(row: Mapping[str, float]) -> list[ValueCheck]:
    """Mean speed, δ, H and k_p of a row, each from other printed values by equations (13) to (15)."""
    mean = row["speed_mean"]
    steepest = max(abs(row["acceleration_min"]), abs(row["acceleration_max"]))
    span = row["speed_max"] - row["speed_min"]
    follows = {
        "speed_mean": (0.5 * (row["speed_min"] + row["speed_max"]), "(ω_min + ω_max)/2"),
        "unevenness": (span / mean, "(ω_max − ω_min)/ω_mean"),
        "dynamism": (steepest / mean**2, "|ε|_max/ω_mean²"),
        "motion_coefficient": (row["unevenness"] ** 2 + row["dynamism"], "δ² + H"),
    }
    return [ValueCheck(name, row[name], *value) for name, value in follows.items()]


@dataclass(frozen=True)
class Drive:
    """One drive: what is published, and what comes out."""

    # The printed row and its file.
    published: PublishedDrive
    machine: Machine
    # The analyses.
    reduced: Reduction
    steady: SteadyState
    up: RunUp
    scheme: StepMotion
    fit: Fit  # the inertia with which the limit comes nearest to the row
    # The motor that passes all checks of `linkwright.sizing`, and those of the one that it has.
    choice: MotorChoice

    @property
    def drive_inertia(self) -> float:
        """Inertia of motor, coupling and gearbox at the crank, I_0 i² [kg m²]."""
        assert self.machine.drive is not None
        return float(drive_inertia(self.machine.drive))

    @property
    def ratio(self) -> float:
        """Of the gearbox [–]."""
        assert self.machine.drive is not None
        return self.machine.drive.gearbox.ratio

    @property
    def sized(self) -> SteadyState | None:
        """Steady motion with the chosen motor."""
        return self.choice.chosen.steady if self.choice.chosen else None

    @property
    def sized_motor(self) -> str:
        """The chosen motor."""
        return self.choice.chosen.type if self.choice.chosen else ""

    @property
    def recomputed(self) -> list[ValueCheck]:
        """The printed row against itself."""
        return recompute(self.published.values)

    @cached_property
    def values(self) -> dict[str, dict[str, float]]:
        """Way → quantity → computed value [SI]."""
        limit = constant_energy_of(self.reduced)
        return {
            "solution": _measures(self.steady) | {"turns": self.up.turns},
            "limit": scaled_to(limit, self.reduced, self.published.values["speed_mean"]),
            "scheme": _measures(self.scheme) | {"turns": float(turns_to_steady(self.scheme))},
        }

    @cached_property
    def cells(self) -> dict[str, dict[str, Cell]]:
        """Way → quantity → published beside computed."""
        return {
            way: {
                name: Cell(
                    published=published,
                    computed=values.get(name),
                    because=self._because(way, name),
                    # The limit has a shape but no speed of its own.
                    given=way == "limit" and name == "speed_mean",
                )
                for name, published in self.published.values.items()
            }
            for way, values in self.values.items()
        }

    def _because(self, way: str, quantity: str) -> str:
        row = self.published
        here = {"way": way, "quantity": quantity, "carts": row.carts}
        known = {"phase": row.phase, "ratio": self.ratio, "motor_printed": row.motor_printed}
        suits = (
            value["text"]
            for value in printed_values(1)["reason"]
            if all(value[key] == here[key] for key in here.keys() & value.keys())
        )
        return filled(next(suits), known)

    @property
    def lines(self) -> list[dict[str, Any]]:
        """The table of this drive: a line for each quantity."""
        return [
            {
                "label": f"{quantity['symbol']} [{quantity['unit']}]"
                if quantity["unit"]
                else quantity["symbol"],
                "published": self.published.values[name],
                **{way: cells[name] for way, cells in self.cells.items()},
            }
            for name, quantity in printed_values(1)["quantities"].items()
        ]

    @property
    def reasons(self) -> list[str]:
        """Why values are not reproduced, each reason once."""
        data = printed_values(1)
        reasons: dict[tuple[str, str], list[str]] = {}
        for way, cells in self.cells.items():
            for name, cell in cells.items():
                if cell.kind == "far":
                    reasons.setdefault((way, cell.because), []).append(data["quantities"][name]["symbol"])
        return [
            f"{data['ways'][way]}: {', '.join(symbols)} not reproduced because {because}."
            for (way, because), symbols in reasons.items()
        ]

    def to_dict(self) -> dict[str, Any]:
        """Its numbers, ready for JSON."""
        return {
            "carts": self.published.carts,
            "name": self.published.name,
            "machine": self.published.machine,
            "published": self.published.values,
            "columns": {
                way: {name: cell.to_dict() for name, cell in cells.items()}
                for way, cells in self.cells.items()
            },
            "drive_inertia": self.drive_inertia,
            "limit_fit": {
                "drive_inertia": self.fit.inertia,
                "misfit": self.fit.misfit,
                "fits": self.fit.fits,
            },
            "printed_row": [
                {name: getattr(row, name) for name in ("quantity", "printed", "follows", "agrees")}
                for row in self.recomputed
            ],
            "sized_motor": self.sized_motor,
            "sized_motion_coefficient": self.sized.motion_coefficient if self.sized else None,
        }


def _measures(motion: SteadyState | StepMotion) -> dict[str, float]:
    names = [name for name in printed_values(1)["quantities"] if name not in ("turns", "speed_mean")]
    return {name: getattr(motion, name) for name in names} | {"speed_mean": motion.speed_mean_extremes}


def drive(row: PublishedDrive) -> Drive:
    """All analyses of one drive.

    The motors of the drives with one, three and four carts are not printed. Their files take the smallest
    motor of the same series whose rated power reaches the required one, by which rule the printed motor of
    the two carts comes out too.
    """
    machine = read(library_path(row.machine))
    assert machine.drive is not None
    reduced, steady = reduction(machine, n=_ANGLES), steady_state(machine, n=_ANGLES)
    now = float(drive_inertia(machine.drive))
    return Drive(
        published=row,
        machine=machine,
        reduced=reduced,
        steady=steady,
        up=run_up(machine, steady=steady),
        scheme=published_scheme(machine),
        fit=fitted_inertia(reduced, now, row.values["unevenness"], row.values["dynamism"]),
        choice=choose_motor(machine),
    )
