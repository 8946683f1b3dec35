"""The drives of paper 2 side by side, as texts of a table."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from linkwright.papers.paper2.alternatives import Alternative

# Heading, unit, text.
COLUMNS: tuple[tuple[str, str, Callable[[Alternative], str]], ...] = (
    ("law", "", lambda each: each.name),
    ("ẋ", "m/s", lambda each: f"{each.velocity_max:.3f}"),
    ("ẍ", "m/s²", lambda each: f"{each.acceleration_max:.3f}"),
    ("jerk", "m/s³", lambda each: f"{each.jerk_max:.2f}"),
    ("step", "m/s³", lambda each: _step(each)),
    ("F", "N", lambda each: f"{each.force_max:.0f}"),
    ("M", "N\u00a0m", lambda each: f"{each.torque_max:.0f}"),
    ("δ", "", lambda each: f"{each.steady.unevenness:.4f}"),
    ("H", "", lambda each: f"{each.steady.dynamism:.3f}"),
    ("γ", "°", lambda each: _degrees(each.pressure_angle_max)),
    ("even", "%", lambda each: f"{100 * each.steady_share:.0f}"),
)


def cells(drives: Sequence[Alternative]) -> list[list[str]]:
    """A row of texts for each drive.

    Parameters
    ----------
    drives : sequence of Alternative
        The drives.

    Returns
    -------
    list of list of str
        As many as `COLUMNS` each.
    """
    return [[text(each) for _, _, text in COLUMNS] for each in drives]


def _step(drive: Alternative) -> str:
    """The step of the jerk, if it is more than rounding."""
    return f"{drive.jerk_step:.2f}" if drive.jerk_step > 1e-9 * drive.jerk_max else "–"


def _degrees(angle: float | None) -> str:
    """An angle with a digit; a crank has none."""
    return "–" if angle is None else f"{np.degrees(angle):.1f}"
