"""Torques of flexible shafts and couplings against what is permitted.

| limit | against |
| --- | --- |
| `torque_permitted` | largest torque either way |
| `vibratory_torque_permitted` | half the peak-to-peak torque, in steady motion alone |
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
    from linkwright.driveline.in_time import ElasticTransient


@dataclass(frozen=True)
class TorqueJudgement:
    """One limit, and whether the motion keeps it.

    Attributes
    ----------
    part : str
        Name of the shaft.
    what : str
        What is limited, in words.
    found, permitted : float
        [N m].
    motion : str
        Which motion is judged, in words.
    """

    part: str
    what: str
    found: float
    permitted: float
    motion: str = "in steady motion"

    @property
    def is_kept(self) -> bool:
        """Whether the motion stays within the limit."""
        return self.found <= self.permitted

    @property
    def words(self) -> str:
        """The judgement as a sentence."""
        verdict = "within limit" if self.is_kept else "limit exceeded"
        return (
            f"{self.part}: {self.what} {quantity(self.found, 'N m')} {self.motion}, permitted "
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


def in_motion(machine: Machine, motion: ElasticTransient, words: str) -> ElasticTransient:
    """A motion in time with its torques judged: it has no vibratory torque that might be permitted."""
    found = (replace(each, motion=words) for each in _judgements(machine, motion) if each.what == "torque")
    return replace(motion, judgements=tuple(found))


def _judgements(machine: Machine, motion: ElasticMotion | ElasticTransient) -> Iterator[TorqueJudgement]:
    for name, part in _limited(machine):
        if name not in motion.shafts:
            continue
        at = motion.shafts.index(name)
        peak, vibratory = (
            float(motion.torque_peak[at]),
            float(0.5 * (motion.torque_max[at] - motion.torque_min[at])),
        )
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
