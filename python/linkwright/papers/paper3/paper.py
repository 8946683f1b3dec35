"""Paper 3 computed anew: its formulas for inertia and compliance of throws, on a V-12 with articulated rods.

The paper has no worked example, so that its formulas are compared with the exact ones: true motion of master
and articulated rod, geometry of the throw. What a difference means is reported in natural frequencies, and
what torsion does to the speed fluctuation by which cylinders are judged.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from linkwright.kernel.files.library import library_path
from linkwright.machine.read import read
from linkwright.papers.claim import holding, tolerance
from linkwright.papers.page import share, shown
from linkwright.papers.paper import Paper, printed_values
from linkwright.papers.paper3.checks import UnevennessChecks, WeakChecks, unevenness_checks, weak_checks
from linkwright.papers.paper3.crank_train import (
    PENDULUM,
    Shift,
    TrialEngine,
    inertia_checks,
    swing_checks,
    throw_checks,
)


@dataclass(frozen=True)
class Paper3(Paper):
    """Paper 3, printed against exact."""

    trial: TrialEngine  # the V-12
    # (1) to (12), (13) to (15), (16) and (17), each against the exact value.
    inertia: dict[str, Any]
    swing: dict[str, Any]
    throw: dict[str, Any]
    uneven: UnevennessChecks  # speed fluctuation along the shaft
    weak: WeakChecks  # which cylinder is weak, by the elastic and by a rigid train

    @property
    def shifts(self) -> tuple[Shift, ...]:
        """What each formula makes of the natural frequencies."""
        return (*self.inertia["shifts"], *self.throw["shifts"])

    def quantities(self) -> dict[str, Any]:
        """Formula over exact, trains side by side, and what torsion does to the speed fluctuation."""
        return self._of_rods() | self._of_throws() | self._of_unevenness() | self._of_weakness()

    def _of_rods(self) -> dict[str, Any]:
        inertia, swing, (low, high) = self.inertia, self.swing, self.published["printed"]["k"]
        literal, reduced, low_k = inertia["shifts"][0], inertia["shifts"][1], inertia["shifts"][3]
        disc_off = max(abs(inertia["one_rod"]), abs(inertia["series"]))
        allowed = tolerance("digits")
        return {
            "usual": (low, high),
            "usual_centres": (1 - math.sqrt(low), 1 - math.sqrt(high)),
            "usual_fits": low <= inertia["share"] <= high,
            "usual_is_small_end": not low <= inertia["share"] <= high and low <= 1 - inertia["share"] <= high,
            "small_share": 1 - inertia["share"],
            "low_k_takes": -low_k.deviation,
            "simple_printed": (1 + inertia["simple"]) * (1 + inertia["printed"]) - 1,
            "articulated_deviation": inertia["articulated_printed"] / inertia["articulated"] - 1,
            "articulated_times": inertia["articulated_printed"] / inertia["articulated_share"],
            "disc_off": disc_off,
            "discs_agree": disc_off < allowed.near and disc_off < abs(inertia["simple"]),
            "literal_times": 1 + literal.deviation,
            "reduced_off": abs(reduced.deviation),
            "articulated_misread": abs(literal.deviation) > allowed.near > abs(reduced.deviation),
            "pendulum": PENDULUM,
            "two_point_is_exact": abs(swing["two_point_exact"]) < 1e-12,
            # Counted over a minute, single swings are right to one.
            "rounding_is_small": max(swing["edge"], swing["centre"], swing["axis"]) < 1 / swing["swings"][0],
        }

    def _of_throws(self) -> dict[str, Any]:
        trial, throw = self.trial, self.throw
        first, *others = throw["stiffness"].values()
        off = (min(others) / first - 1, max(others) / first - 1)
        stiff = sorted(
            (shift for shift in self.shifts if shift.what == "k"), key=lambda shift: shift.critical
        )
        discs = max(abs(shift.changes[1]) for shift in self.shifts[1:] if shift.what == "J")
        words, kind = holding(throw["inertia"], tolerance("digits"))
        return {
            "trains": [self._exact_train(), *(_train(shift) for shift in self.shifts)],
            "critical": trial.critical(float(trial.frequencies[1])),
            "rebuilt_inertia": words,
            "rebuilt_inertia_holds": kind != "far",
            "stiffness": [f"{name} {1e-6 * stiffness:.3g}" for name, stiffness in throw["stiffness"].items()],
            "others": off,
            "rebuilt_stiffness_is_usual": off[0] < 0 < off[1],
            "softest": stiff[0],
            "stiffest": stiff[-1],
            "compliance_decides": stiff[-1].critical / stiff[0].critical - 1 > discs,
        }

    def _exact_train(self) -> dict[str, Any]:
        trial = self.trial
        return {
            "name": "exact mean of J(φ), (17) with k by Castigliano",
            "throw": f"J = {trial.inertia:.4f} kg m², k = {1e-6 * trial.stiffness:.3f} MN m/rad",
            "frequencies": [f"{frequency:.1f}" for frequency in trial.frequencies],
            "critical": trial.critical(float(trial.frequencies[1])),
        }

    def _of_unevenness(self) -> dict[str, Any]:
        uneven = self.uneven
        N = [float(uneven.N[at]) for at in (0, uneven.flywheel, -1)]
        free, wheel = uneven.rise[:, 0] - 1, uneven.rise[:, uneven.flywheel] - 1
        rise = {"rigid": uneven.rise_rigid - 1, "free": free, "wheel": wheel}
        return {
            "N": N,
            "N_times": [number / uneven.N_rigid for number in N],
            "rise": {name: (gain.min(), gain.max()) for name, gain in rise.items()},
            "smoothed": int((free < 0).sum()),
            "cylinders": len(free),
            "torsion_counts": N[0] > N[1] > uneven.N_rigid > N[2],
            "weak_may_smooth": bool((free < 0).any() and (rise["rigid"] > 0).all()),
        }

    def _of_weakness(self) -> dict[str, Any]:
        weak, factor = self.weak, self.published["chosen"]["weak"]
        at = weak.cylinder - 1
        within = float(abs(weak.elastic[:2, at] - factor).max())
        against = weak.against_sound[:, at].tolist()
        points = (weak.against_sound[:2].argmin(axis=1) == at).all()
        wrong = max(abs(value - factor) for value in against)
        sees_smoother = bool((self.uneven.rise[:, 0] < 1).any())
        return {
            "found_within": within,
            "rigid_range": (float(weak.rigid[0].min()), float(weak.rigid[0].max())),
            "against_sound": against,
            # A thousandth tells 0.8 from 0.801, far less than cylinders of one engine differ.
            "elastic_finds_it": within < 1e-3 < wrong and bool(points),
            "paper_is_right": self.uneven.N[0] > 2 * self.uneven.N_rigid and sees_smoother and wrong > 0.1,
        }

    def entries(self) -> dict[str, Any]:
        """Computed values, ready for JSON."""
        uneven, weak = self.uneven, self.weak
        return {
            "machine": self.trial.machine.name,
            "exact": {
                "throw_inertia": self.trial.inertia,
                "throw_stiffness": self.trial.stiffness,
                "natural_frequencies": self.trial.frequencies.tolist(),
            },
            "formulas": [_shift_dict(shift) for shift in self.shifts],
            "restraint_length": self.throw["restraint"],
            "stiffness": self.throw["stiffness"],
            "unevenness": {
                "speed": uneven.speed,
                "discs": uneven.discs,
                "N": uneven.N.tolist(),
                "N_rigid": uneven.N_rigid,
                "delta": uneven.delta.tolist(),
                "delta_rigid": uneven.delta_rigid,
                "delta_weak": uneven.weak.tolist(),
                "delta_weak_rigid": uneven.weak_rigid.tolist(),
            },
            "diagnosis": {
                "weak_cylinder": weak.cylinder,
                "discs": weak.discs,
                "factors": weak.elastic.tolist(),
                "factors_rigid": weak.rigid.tolist(),
                "factors_rigid_against_sound": weak.against_sound.tolist(),
            },
        }


def _shift_dict(shift: Shift) -> dict[str, Any]:
    arrays = {"frequencies": shift.frequencies.tolist(), "changes": shift.changes.tolist()}
    return vars(shift) | arrays


def _train(shift: Shift) -> dict[str, Any]:
    pairs = zip(shift.frequencies.tolist(), shift.changes.tolist(), strict=True)
    texts = [f"{shown(frequency, '.1f')} ({share(change)})" for frequency, change in pairs]
    throw = f"{shift.what} {share(shift.deviation)}"
    return {"name": shift.name, "throw": throw, "frequencies": texts, "critical": shift.critical}


def paper3() -> Paper3:
    """Compute paper 3 anew. Source: Paper 3, equations (1) to (17)."""
    data = printed_values(3)
    trial = TrialEngine(read(library_path(data["machine"])))
    printed, chosen = data["printed"], data["chosen"]
    return Paper3(
        data,
        trial=trial,
        inertia=inertia_checks(trial, printed),
        swing=swing_checks(trial.engine.rod, printed, chosen["bore_radius"]),
        throw=throw_checks(trial),
        uneven=unevenness_checks(trial, chosen["weak"]),
        weak=weak_checks(trial, chosen["weak_cylinder"], chosen["weak"], ("front", "flywheel", "generator")),
    )
