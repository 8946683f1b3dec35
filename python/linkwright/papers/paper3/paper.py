"""Paper 3 computed anew: its formulas for inertia and compliance of throws, on a V-12 with articulated rods.

The paper has no worked example, so that its formulas are compared with the exact ones: true motion of master
and articulated rod, geometry of the throw. What a difference means is told in natural frequencies, and what
torsion does to the unevenness of rotation by which cylinders are judged.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from linkwright.kernel.files.library import library_path
from linkwright.machine.read import read
from linkwright.papers.paper3.conclusions import conclusions
from linkwright.papers.paper3.engine import Shift, TrialEngine
from linkwright.papers.paper3.inertia import InertiaChecks, inertia_checks
from linkwright.papers.paper3.rows import rows_of
from linkwright.papers.paper3.swing import SwingChecks, swing_checks
from linkwright.papers.paper3.throw import ThrowChecks, throw_checks
from linkwright.papers.paper3.uneven import UnevennessChecks, unevenness_checks
from linkwright.papers.paper3.weak import WeakChecks, weak_checks
from linkwright.papers.published import printed_values
from linkwright.papers.row import Row


@dataclass(frozen=True)
class Paper3:
    """Paper 3, printed against exact.

    Attributes
    ----------
    published : dict
        What is printed in numbers.
    trial : TrialEngine
        The V-12.
    inertia : InertiaChecks
        (1) to (12).
    swing : SwingChecks
        (13) to (15).
    throw : ThrowChecks
        (16), (17).
    uneven : UnevennessChecks
        Unevenness along the shaft.
    weak : WeakChecks
        Which cylinder is weak, by the elastic and by a rigid train.
    rows : tuple of Row
        Every formula with its verdict.
    """

    published: dict[str, Any]
    trial: TrialEngine
    inertia: InertiaChecks
    swing: SwingChecks
    throw: ThrowChecks
    uneven: UnevennessChecks
    weak: WeakChecks
    rows: tuple[Row, ...] = ()

    @property
    def number(self) -> int:
        """Of the paper."""
        return int(self.published["number"])

    @property
    def title(self) -> str:
        """Of the paper, in English."""
        return str(self.published["title"])

    @property
    def shifts(self) -> tuple[Shift, ...]:
        """What each formula makes of the natural frequencies."""
        return (*self.inertia.shifts, *self.throw.shifts)

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        uneven, weak = self.uneven, self.weak
        return {
            "machine": self.trial.machine.name,
            "exact": {
                "throw_inertia": self.trial.inertia,
                "throw_stiffness": self.trial.stiffness,
                "natural_frequencies": self.trial.frequencies.tolist(),
            },
            "formulas": [_plain(each) for each in self.shifts],
            "restraint_length": self.throw.restraint,
            "stiffness": self.throw.stiffness,
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
            "rows": [vars(row) for row in self.rows],
            "conclusions": conclusions(self),
        }


def _plain(shift: Shift) -> dict[str, Any]:
    """One formula, ready for JSON."""
    return vars(shift) | {
        "frequencies": shift.frequencies.tolist(),
        "changes": shift.changes.tolist(),
    }


def paper3() -> Paper3:
    """Compute paper 3 anew.

    Returns
    -------
    Paper3
        Printed and exact formulas with verdicts.

    References
    ----------
    .. [1] Paper 3, equations (1) to (17).
    """
    data = printed_values(3)
    trial = TrialEngine(read(library_path(data["machine"])))
    printed, chosen = data["printed"], data["chosen"]
    found = Paper3(
        data,
        trial,
        inertia_checks(trial, printed),
        swing_checks(trial.engine.rod, printed, chosen["bore_radius"]),
        throw_checks(trial),
        unevenness_checks(trial, chosen["weak"]),
        weak_checks(trial, chosen["weak_cylinder"], chosen["weak"], ("front", "flywheel", "generator")),
    )
    return replace(found, rows=rows_of(found))
