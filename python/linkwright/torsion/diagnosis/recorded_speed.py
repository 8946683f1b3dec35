r"""A speed recorded over the crank angle, as harmonics.

Samples at even steps over whole cycles, from the angle :math:`\varphi_0` on, are those of `measured_speed`
turned back by :math:`e^{-i\nu\varphi_0}`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.kernel.errors import InputError, ShapeError
from linkwright.torsion.diagnosis.measured_speed import MeasuredSpeed, measured_speed

Floats = NDArray[np.float64]

# Share of a step by which angles may miss even steps: records are printed with a few digits.
_UNEVEN = 0.02
# Fewest samples that show what any engine does.
_FEWEST = 8


@dataclass(frozen=True)
class RecordedSpeed:
    """Speed of a disc at even steps of the crank angle."""

    start: float  # crank angle of the first sample [rad]
    samples: Floats  # (n,) [rad/s]
    turns: int  # of the crank that they span

    @property
    def mean(self) -> float:
        """Mean speed over the angle [rad/s]."""
        return float(self.samples.mean())

    def orders(self, orders: Floats) -> Floats:
        """Those of some orders that the record can tell.

        Orders that repeat in the revolutions of the record, with more than two samples a wave. `orders`:
        (orders,) cycles per revolution.
        """
        waves = orders * self.turns
        whole = np.abs(waves - np.rint(waves)) <= 1e-9 * np.maximum(waves, 1.0)
        found: Floats = orders[whole & (waves >= 1) & (2 * waves < len(self.samples))]
        return found

    def harmonics(self, disc: str, orders: Floats, noise: float | None = None) -> MeasuredSpeed:
        """Its harmonics over the crank angle.

        With angle 0 where the crank angle is 0. `orders`: (orders,); `noise`: standard deviation of a sample
        [rad/s].
        """
        found = measured_speed(disc, self.samples, self.turns, orders, noise)
        turned = found.harmonics * np.exp(-1j * found.orders * self.start)
        return MeasuredSpeed(disc, found.orders, turned, found.noise)


def recorded_speed(angle: ArrayLike, speed: ArrayLike, turns: int) -> RecordedSpeed:
    """A record over one or more whole cycles.

    A last sample that stands where the first does a cycle later is left out. `angle`: (n,) crank angles,
    increasing by even steps [rad]; `speed`: (n,) [rad/s].
    """
    phi, omega = np.asarray(angle, float), np.asarray(speed, float)
    if phi.shape != omega.shape or phi.ndim != 1:
        raise ShapeError(f"{phi.size} angles and {omega.size} speeds: expected as many of both")
    if len(phi) < _FEWEST:
        raise ShapeError(f"{len(phi)} samples of the speed: expected at least {_FEWEST}")
    step = _even_step(phi)
    cycle = 2 * np.pi * turns
    # With the step after the last sample, or with the first sample once more.
    for n in (len(phi), len(phi) - 1):
        cycles = n * step / cycle
        if round(cycles) >= 1 and abs(n * step - round(cycles) * cycle) <= step / 2:
            return RecordedSpeed(float(phi[0]), omega[:n], round(cycles) * turns)
    a, b, whole = np.degrees([phi[0], phi[-1], cycle])
    raise InputError(
        f"speed from {a:.6g}° to {b:.6g}° in steps of {np.degrees(step):.6g}°: expected whole cycles of "
        f"{whole:.6g}°"
    )


def _even_step(phi: Floats) -> float:
    """The step between angles, all of which it is."""
    step = float(phi[-1] - phi[0]) / (len(phi) - 1)
    steps = np.diff(phi)
    wrong = np.flatnonzero(~(np.abs(steps - step) <= _UNEVEN * abs(step))) if step > 0 else np.array([0])
    if len(wrong):
        at, here = np.degrees(phi[wrong[0]]), np.degrees(steps[wrong[0]])
        raise InputError(
            f"a step of {here:.6g}° after {at:.6g}°: expected even steps that increase, "
            f"{np.degrees(step):.6g}°; sample the speed over the angle, by the marks of a disc"
        )
    return step
