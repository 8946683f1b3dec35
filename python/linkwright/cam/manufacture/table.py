r"""Tables of an outline: places on the curve itself at equal steps of the cam angle, or of the polar angle.

The curvature is :math:`\kappa = (x'y'' - y'x'')/\lVert\mathbf p'\rVert^3`, here counted positive where the
outline is convex.
"""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path as File
from typing import Literal

import numpy as np

from linkwright.cam.manufacture.curve import Track
from linkwright.cam.manufacture.outline import cross, dot
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ExchangeError, InputError, require_within
from linkwright.kernel.files.output import write_file
from linkwright.kernel.limits import ROWS_OUT
from linkwright.kernel.page.table import csv_text

By = Literal["cam", "polar"]

COLUMNS = ("phi_deg", "x_mm", "y_mm", "radius_mm", "polar_angle_deg", "curvature_per_mm")

# How far 360°/step may be from a whole number.
_WHOLE = 1e-9

# Polar angles of one place, seen from both sides of a joint, differ by rounding [rad].
_ROUNDING = 1e-9

# Rounds of Newton from samples to a polar angle; quadratic from a two-thousandth of a revolution.
_ROUNDS = 6


@dataclass(frozen=True)
class Table:
    """Rows of an outline; the last is the first, one revolution on."""

    phi: Floats  # (n,): cam angle [rad]
    place: Floats  # (n, 2): [m]
    polar_angle: Floats  # (n,): of the place, continuous [rad]
    curvature: Floats  # (n,): positive where convex [1/m]; at a joint that of the stretch that follows

    @property
    def radius(self) -> Floats:
        """Distance from the centre, (n,) [m]."""
        return np.asarray(np.hypot(self.place[:, 0], self.place[:, 1]))


def table(track: Track, step: float, by: By = "cam") -> Table:
    """Places of a curve at equal steps [rad], a whole number of which makes a revolution."""
    n = _count(step)
    angles: Floats = np.arange(n + 1, dtype=float) * (2 * math.pi / n)
    tau = track.at_cam_angles(angles) if by == "cam" else _at_polar_angles(track, angles)
    columns = track.points(tau[:-1]), curvature(track, tau[:-1])
    place, bend = (np.concatenate([column, column[:1]]) for column in columns)
    phi: Floats = angles if by == "cam" else track.angles(tau)
    unwrapped = np.unwrap(np.arctan2(place[:, 1], place[:, 0]))
    polar: Floats = angles if by == "polar" else unwrapped
    return Table(phi, place, polar, bend)


def curvature(track: Track, tau: Floats) -> Floats:
    """Curvature [1/m] at ``tau`` (n,) [rad], positive where convex; at a joint that of the next stretch."""
    t, t2 = track.tangents(tau), track.seconds(tau)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(cross(t, t2) / dot(t, t) ** 1.5 * track.sense)


def _count(step: float) -> int:
    n = 2 * math.pi / step if step > 0 else math.nan
    if not math.isnan(n):
        remedy = f"take {360 / ROWS_OUT.most:.3g}° or more"
        require_within(ROWS_OUT, n, f"step of {math.degrees(step):.3g}°", remedy)
    if not (math.isfinite(n) and n >= 3 and abs(n - round(n)) <= _WHOLE * n):
        near = [360 / max(3, math.floor(n)), 360 / max(3, math.ceil(n))] if 0 < n < 1e9 else [1.0, 0.5]
        raise InputError(
            f"step of {math.degrees(step):.9g}°: expected a whole number of steps per revolution, 3 or more, "
            f"as {near[0]:.6g}° or {near[1]:.6g}°"
        )
    return round(n)


def _at_polar_angles(track: Track, angles: Floats) -> Floats:
    """τ of polar angles, by Newton from samples; decreasing where rows run against the curve."""
    tau, place = track.sampled
    polar = np.unwrap(np.arctan2(place[:, 1], place[:, 0]))
    is_round = abs(abs(polar[-1] - polar[0]) - 2 * math.pi) < _ROUNDING
    if not is_round or (np.diff(track.sense * polar) < -_ROUNDING).any():
        raise ExchangeError(
            "the outline is not a function of its polar angle: it is re-entrant, or does not enclose the "
            "centre; take a table by the cam angle"
        )
    # Counted in the sense of the curve from its start, both grow.
    wanted = track.sense * (angles[:-1] - polar[0]) % (2 * math.pi)
    x = np.interp(wanted, track.sense * (polar - polar[0]), tau)
    for _ in range(_ROUNDS):
        p, t = track.points(x), track.tangents(x)
        off = (angles[:-1] - np.arctan2(p[:, 1], p[:, 0]) + math.pi) % (2 * math.pi) - math.pi
        x = np.clip(x + off * dot(p, p) / cross(p, t), 0, track.period)
    return np.concatenate([x, x[:1] + track.sense * track.period])


def write_csv(file: File, rows: Table) -> None:
    """Write a table as CSV, with numbers that read back exactly."""
    columns = np.column_stack(
        [
            np.degrees(rows.phi),
            1e3 * rows.place,
            1e3 * rows.radius,
            np.degrees(rows.polar_angle),
            1e-3 * rows.curvature,
        ]
    )
    write_file(file, csv_text(COLUMNS, columns.tolist()))


def read_csv(file: File) -> Table:
    """Read a table, and check that its columns agree with one another and that it is closed."""
    try:
        with file.open(encoding="utf-8", newline="") as stream:
            head, *body = list(csv.reader(stream))
        values = np.array([[float(cell) for cell in row] for row in body])
    except (OSError, ValueError) as error:
        raise ExchangeError(f"{file}: is not a table that can be read ({error})") from None
    if tuple(head) != COLUMNS or values.ndim != 2 or values.shape[0] < 4:
        raise ExchangeError(f"{file}: columns {', '.join(head)}; expected {', '.join(COLUMNS)}")
    phi, x, y, radius, polar, bend = values.T
    rows = Table(np.radians(phi), 1e-3 * np.column_stack([x, y]), np.radians(polar), 1e3 * bend)
    _refuse(file, rows, 1e-3 * radius)
    return rows


def _refuse(file: File, rows: Table, radius: Floats) -> None:
    if (rows.place[0] != rows.place[-1]).any():
        raise ExchangeError(f"{file}: the last row is not the place of the first")
    x, y = radius * np.cos(rows.polar_angle), radius * np.sin(rows.polar_angle)
    off = np.hypot(x - rows.place[:, 0], y - rows.place[:, 1])
    # Angles in degrees up to a revolution, and their radians, are rounded: some units of 1e-16 of the radius.
    wrong = np.flatnonzero(~(off <= 1e-14 * np.abs(radius).max()))
    if wrong.size:
        raise ExchangeError(
            f"{file}: line {wrong[0] + 2}: radius and polar angle are {1e3 * off[wrong[0]]:.3g} mm from "
            "x and y"
        )
