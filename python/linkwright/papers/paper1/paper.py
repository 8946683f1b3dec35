"""Paper 1 computed anew: four drives of roller-forming machines, published against computed in three ways."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.drive.model.motor import InductionMotor
from linkwright.drive.reduction import Reduction, reduction
from linkwright.drive.step_method import StepMotion
from linkwright.kinetostatics.model.loads.force import DryFriction
from linkwright.machine.address import replace as with_entries
from linkwright.papers.claim import cell_of
from linkwright.papers.paper import Paper, printed_values
from linkwright.papers.paper1.drive import Drive, drive, published_drives
from linkwright.papers.paper1.scheme import Fit, fitted_inertia, schemes
from linkwright.sizing.power import RequiredPower, required_power

# Between neighbouring cranks of four carts that go two against two [rad].
_OPPOSED = np.pi


@dataclass(frozen=True)
class Paper1(Paper):
    """Paper 1, published against computed."""

    drives: tuple[Drive, ...]  # the four drives
    power: RequiredPower  # values that the paper prints on the way, for two carts
    trials: dict[float, StepMotion]  # step of the angle in degrees → two carts by the published scheme
    opposed: Fit  # row 4 by four carts at 180° between neighbours, two against two

    @property
    def steps(self) -> dict[float, float]:
        """Step of the angle in degrees → deviation of the scheme from two published speeds [–]."""
        row = self.drives[1].published.values
        off = {
            step: (motion.speed_min / row["speed_min"] - 1, motion.speed_max / row["speed_max"] - 1)
            for step, motion in self.trials.items()
        }
        return {step: float(np.sqrt(0.5 * (low**2 + high**2))) for step, (low, high) in off.items()}

    @property
    def rankings(self) -> dict[str, list[int]]:
        """Numbers of carts in order of increasing k_p, for each way of finding it."""
        ways: dict[str, Callable[[Drive], float]] = {
            "published": lambda drive: drive.published.values["motion_coefficient"],
            "solution of (1), motors by rated power": lambda drive: drive.steady.motion_coefficient,
            "solution of (1), motors by all checks": _sized_coefficient,
            "constant energy": lambda drive: drive.values["limit"]["motion_coefficient"],
        }
        return {
            way: [drive.published.carts for drive in sorted(self.drives, key=value)]
            for way, value in ways.items()
        }

    def quantities(self) -> dict[str, Any]:
        """Drives by number of carts, loads on the way, and what the table of results comes to."""
        _, two, _, four = self.drives
        return {
            "two": two,
            "four": four,
            "phases": {"four": four.published.phase, "opposed": _OPPOSED},
            "fitted": [
                drive for drive in self.drives if not drive.published.motor_printed and drive.fit.fits
            ],
            "four_fits_not": not four.fit.fits and self.opposed.misfit < four.fit.misfit,
            **self._of_two(two),
            **self._of_rows(),
            **self._of_rankings(four),
        }

    def _of_two(self, two: Drive) -> dict[str, Any]:
        row, machine, mean = two.published.values, two.machine, self.published["claim"][0]["value"]
        assert machine.drive is not None
        assert isinstance(machine.drive.motor, InductionMotor)
        step = float(np.degrees(two.scheme.step))
        best = sorted(sorted(self.steps, key=lambda drive: self.steps[drive])[:2])
        alone = [
            drive
            for drive in best
            if round(self.trials[drive].speed_max, 3) == row["speed_max"]
            and round(load_by_steps(two.reduced, drive), 2) == mean
        ]
        at_degrees = load_by_steps(two.reduced, step)
        halves = two.steady.unevenness / two.values["limit"]["unevenness"]
        far = two.cells["solution"]["unevenness"].kind == "far"
        cells = [cell_of(claim, {"power": self.power}).kind for claim in self.published["claim"]]
        return {
            "step": np.radians(step),
            "best_steps": [np.radians(drive) for drive in best],
            "step_deviations": list(self.steps.items()),
            "load_closed": _load_in_closed_form(two),
            "load_at_degrees": at_degrees,
            "load_lost": two.reduced.torque_load_mean - at_degrees,
            "rated_speed": (machine.drive.motor.speed_rated or np.nan) / machine.drive.gearbox.ratio,
            # To a tenth, as the word is used.
            "row_solves_not": far and abs(halves - 0.5) < 0.05,
            "scheme_gives_row": alone == [step] and two.values["scheme"]["turns"] == row["turns"],
            "values_on_the_way_hold": cells == ["reproduced"] * 3 and round(at_degrees, 2) == mean,
        }

    def _of_rows(self) -> dict[str, Any]:
        symbols = self.published["quantities"]
        rows = [
            vars(row)
            | {
                "drive": one.published.name.split(",")[0],
                "carts": one.published.carts,
                "symbol": symbols[row.quantity]["symbol"],
                "agrees": row.agrees,
                "kind": "reproduced" if row.agrees else "far",
            }
            for one in self.drives
            for row in one.recomputed
        ]
        wrong = [row for row in rows if not row["agrees"]]
        four = self.drives[3].published.values
        follows = {row.quantity: row.follows for row in self.drives[3].recomputed}
        k_p = follows["unevenness"] ** 2 + four["dynamism"]
        means = [row["carts"] for row in wrong if row["quantity"] == "speed_mean"]
        others = [row["carts"] for row in wrong if row["quantity"] != "speed_mean"]
        return {
            "recomputed": rows,
            "disagreeing": wrong,
            "unrounded": follows,
            "rows_disagree": (means, others) == ([3, 4], [4]) and round(k_p, 4) == four["motion_coefficient"],
            "rows_fit": [drive.published.carts for drive in self.drives if drive.fit.fits] == [1, 2, 3],
        }

    def _of_rankings(self, four: Drive) -> dict[str, Any]:
        published, *computed = self.rankings.values()
        carts = four.published.carts
        by_power = {drive.published.carts: drive.steady.motion_coefficient for drive in self.drives}
        small = [
            drive.published.carts
            for drive in self.drives
            if any(check.passed is False for check in drive.choice.present if check.name.startswith("torque"))
        ]
        return {
            "ranked": list(self.rankings.items()),
            "published_place": published.index(carts) + 1,
            "four_is_most_even": published[0] != carts and all(order[0] == carts for order in computed),
            "sized": [drive for drive in self.drives if drive.sized],
            # Estimated inertias are off by more than a percent.
            "motors_are_small": small == [1, 2, 3] and abs(by_power[2] / by_power[3] - 1) < 0.01,
        }

    def entries(self) -> dict[str, Any]:
        """Computed values, ready for JSON."""
        claims = self.published["claim"]
        return {
            "drives": [drive.to_dict() for drive in self.drives],
            "intermediates": {claim["name"]: cell_of(claim, self.values).to_dict() for claim in claims},
            "scheme_step_deviation": {f"{step:g} deg": off for step, off in self.steps.items()},
            "rankings": self.rankings,
        }


def _sized_coefficient(one: Drive) -> float:
    return one.sized.motion_coefficient if one.sized else np.inf


def load_by_steps(reduced: Reduction, degrees: float) -> float:
    """Mean load torque [N m] as a table by steps of an angle [°] gives it; a step has whole intervals."""
    every = round(degrees * (len(reduced.crank_angle) - 1) / 360)
    return float(reduced.torque_load[:-1:every].mean())


def _load_in_closed_form(two: Drive) -> float:
    """Each cart travels 4r per revolution against its resistance; gravity does no net work [N m]."""
    loads = [load.force for load in two.machine.loads.values() if isinstance(load, DryFriction)]
    radii = [crank.radius for crank in two.machine.mechanism.cranks.values()]
    return sum(4 * r * float(F or 0.0) for r, F in zip(radii, loads, strict=True)) / (2 * np.pi)


def paper1() -> Paper1:
    """Compute paper 1 anew. Source: Paper 1, whole."""
    drives = tuple(drive(given) for given in published_drives())
    two, four = drives[1], drives[3]
    return Paper1(
        printed_values(1),
        drives=drives,
        power=required_power(two.machine),
        trials=schemes(two.machine),
        opposed=_opposed(four),
    )


def _opposed(four: Drive) -> Fit:
    """Row 4 by carts two against two."""
    phases = {f"mechanism.cranks.A{n + 1}.phase": n * _OPPOSED for n in range(4)}
    reduced = reduction(with_entries(four.machine, phases), n=360)
    row = four.published.values
    return fitted_inertia(reduced, four.drive_inertia, row["unevenness"], row["dynamism"])
