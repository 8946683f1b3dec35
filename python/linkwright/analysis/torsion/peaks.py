"""The largest torques of shafts over all speeds, also at resonances between the speeds of a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.result import Result
from linkwright.analysis.torsion.survey import Survey

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class TorquePeaks(Result):
    """Where each shaft swings most.

    Attributes
    ----------
    shafts : tuple of str
        As in `ForcedVibration`.
    vibratory : ndarray, shape (shafts,)
        Half of greatest less least torque; infinite at a resonance that nothing damps [N m].
    speed : ndarray, shape (shafts,)
        There, of the first disc [rad/s].
    """

    shafts: tuple[str, ...]
    vibratory: Floats
    speed: Floats


def torque_peaks(seen: Survey) -> TorquePeaks:
    """Largest vibratory torques over the speeds of a run and all resonances between them.

    Parameters
    ----------
    seen : Survey
        The train looked at closely.

    Returns
    -------
    TorquePeaks
        A peak that damping broadens is met by the speeds of the run, a sharp one lies at its resonance.
    """
    every, vibratory = seen.at.torques.speeds, seen.found.shaft_torque_vibratory
    resonant = np.unique([each.speed for each in seen.resonances])
    if len(resonant):
        beside = seen.carried_at(resonant).shaft_torque_vibratory
        every = np.concatenate([every, resonant])
        vibratory = np.concatenate([vibratory, beside], axis=1)
    size = np.where(np.isfinite(vibratory), vibratory, np.inf)
    worst = size.argmax(axis=1)
    return TorquePeaks(seen.found.shafts, size[np.arange(len(size)), worst], every[worst])
