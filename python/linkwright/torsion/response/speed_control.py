r"""Torque that speed controllers ask of their motors in forced vibration, beside the limit that it has.

A PI controller gives the vibratory torque :math:`-(k_p + k_i/(i\omega))\,i\omega\theta`. A linear vibration
has no limit of the torque: where it would be reached, the answer no longer holds.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.torsion.excitation.excited_train import ExcitedTrain
from linkwright.torsion.excitation.harmonics import span
from linkwright.torsion.response.forced import TorsionResponse


def limited_controllers(at: ExcitedTrain, response: TorsionResponse) -> Iterator[str]:
    """A sentence for each speed controller that would exceed its limit of torque."""
    speeds, place = response.speeds, {name: n for n, name in enumerate(response.discs)}
    for name, driver in at.train.drivers.items():
        control = driver.control
        if control is None or control.torque_max is None:
            continue
        disc = place[driver.on]
        gain = control.integral + 1j * response.omega[:, 0] * control.proportional
        mean = at.torques.mean[disc].copy()
        for load in at.train.loads.values():
            if load.on == driver.on:
                turning = float(at.referred.speed[disc])
                mean += at.torques.load_factor * [
                    load.resistance(turning * speed) for speed in speeds.tolist()
                ]
        greatest, least = span(response.together, -gain * response.amplitudes[:, disc], mean)
        size = np.maximum(greatest, -least)
        beyond = np.flatnonzero(~(size <= control.torque_max))
        if len(beyond):
            rpm = ", ".join(f"{speed * 30 / np.pi:.5g}" for speed in speeds[beyond[:4]])
            yield (
                f"The speed controller of {name} would reach its limit of {control.torque_max:.4g} N m at "
                f"{rpm} rpm: forced vibration there neglects the limit; compute the motion in time."
            )
