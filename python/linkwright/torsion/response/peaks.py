"""The largest torques of shafts over all speeds, also at resonances between the speeds of a run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.quantities import About, Shown
from linkwright.kernel.result import Result
from linkwright.torsion.limits.exceedance import peaks_between
from linkwright.torsion.response.survey import Survey

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class TorquePeaks(Result):
    """Where each shaft swings most."""

    shafts: Annotated[tuple[str, ...], About("As in `ForcedVibration`.")]
    vibratory: Annotated[
        Floats,
        Shown(
            "vibratory torque in each shaft",
            "",
            "N m",
            "Half the peak-to-peak torque; infinite at a resonance that nothing damps.",
            shape="(shafts,)",
            over="vibratory",
        ),
    ]
    speed: Annotated[
        Floats, Shown("speed of the first disc there", "ω", "rad/s", shape="(shafts,)", over="speed")
    ]


def torque_peaks(seen: Survey) -> TorquePeaks:
    """Largest vibratory torques over the speeds of a run and all resonances between them.

    The highest of all speeds and resonances, sought between its neighbours as well.
    """
    resonant = np.setdiff1d([each.speed for each in seen.resonances], seen.at.torques.speeds)
    every, vibratory = seen.at.torques.speeds, seen.found.shaft_torque_vibratory
    if len(resonant):
        every = np.concatenate([every, resonant])
        vibratory = np.concatenate([vibratory, seen.carried_at(resonant).shaft_torque_vibratory], axis=1)
    order = np.argsort(every)
    every, size = every[order], _finite(vibratory[:, order])
    worst = size.argmax(axis=1)
    about = np.clip(worst[:, None] + [-1, 1], 0, len(every) - 1)
    speed = np.array(
        peaks_between(
            lambda at: _finite(seen.carried_at(at).shaft_torque_vibratory),
            [(row, *every[pair].tolist()) for row, pair in enumerate(about)],
            [(float(every[k]), float(size[row, k])) for row, k in enumerate(worst)],
        )
    )
    rows = np.arange(len(size))
    return TorquePeaks(
        seen.found.shafts, _finite(seen.carried_at(speed).shaft_torque_vibratory)[rows, rows], speed
    )


def _finite(torque: Floats) -> Floats:
    """Torques, infinite at a resonance that nothing damps."""
    return np.where(np.isfinite(torque), torque, np.inf)
