"""Torques of flexible shafts and couplings in steady motion against what is permitted.

| limit | against |
| --- | --- |
| `torque_permitted` | largest torque either way |
| `vibratory_torque_permitted` | half the peak-to-peak torque |
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from linkwright.kernel.reader.numbers import quantity
from linkwright.machine.machine import Machine
from linkwright.torsion.model.drive_train import CRANKSHAFT, MOTOR_SHAFT

if TYPE_CHECKING:
    from linkwright.driveline.elastic_motion import ElasticMotion


@dataclass(frozen=True)
class TorqueJudgement:
    """One limit, and whether the steady motion keeps it.

    Attributes
    ----------
    part : str
        Name of the shaft.
    what : str
        What is limited, in words.
    found, permitted : float
        [N m].
    """

    part: str
    what: str
    found: float
    permitted: float

    @property
    def is_kept(self) -> bool:
        """Whether the motion stays within the limit."""
        return self.found <= self.permitted

    @property
    def words(self) -> str:
        """The judgement as a sentence."""
        verdict = "within limit" if self.is_kept else "limit exceeded"
        return (
            f"{self.part}: {self.what} {quantity(self.found, 'N m')} in steady motion, permitted "
            f"{quantity(self.permitted, 'N m')}: {verdict}"
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and texts, ready for JSON."""
        state = "ok" if self.is_kept else "exceeds"
        keys = ("part", "what", "found", "permitted", "words")
        return {key: getattr(self, key) for key in keys} | {"unit": "N m", "state": state}


def judged(machine: Machine, motion: ElasticMotion) -> ElasticMotion:
    """The motion with its torques judged; as it is without limits."""
    return replace(motion, judgements=tuple(_judgements(machine, motion)))


def _judgements(machine: Machine, motion: ElasticMotion) -> Iterator[TorqueJudgement]:
    for name, part in _limited(machine):
        if name not in motion.shafts:
            continue
        at = motion.shafts.index(name)
        peak, vibratory = float(motion.torque_peak[at]), float(motion.torque_vibratory[at])
        permitted = getattr(part, "torque_permitted", None)
        if permitted is not None:
            yield TorqueJudgement(name, "torque", peak, permitted)
        permitted = getattr(part, "vibratory_torque_permitted", None)
        if permitted is not None:
            yield TorqueJudgement(name, "vibratory torque", vibratory, permitted)


def _limited(machine: Machine) -> Iterator[tuple[str, Any]]:
    """Shafts with the limit that they have; couplings and gears have theirs themselves."""
    drive, train = machine.drive, machine.train
    if train is not None:
        yield from ((name, shaft.limit) for name, shaft in train.shafts.items())
        yield from train.couplings.items()
        yield from train.gears.items()
    elif drive is not None:
        for name, shaft in ((MOTOR_SHAFT, drive.motor_shaft), (CRANKSHAFT, drive.crankshaft)):
            if shaft is not None:
                yield name, shaft.limit
