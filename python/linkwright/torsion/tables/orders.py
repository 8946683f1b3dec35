"""Every order over the speed, and the curves of a manoeuvre: as columns, and as lists for JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.page.table import Row, Table, columns_csv, part_table
from linkwright.kernel.reader.numbers import quantity
from linkwright.torsion.excitation.excited_train import ExcitedTrain
from linkwright.torsion.excitation.harmonics import line_name
from linkwright.torsion.in_time.transient import TorsionTransient
from linkwright.torsion.modes.phase_vectors import PhaseVectors
from linkwright.torsion.response.forced import ForcedVibration

# Share of the largest torque of a disc below which an order is rounding.
_ROUNDING = 1e-9


def order_files(at: ExcitedTrain, forced: ForcedVibration) -> dict[str, str]:
    """Amplitude of every order over the speed as CSV, by name of file."""
    torques = at.exciting
    excited = np.flatnonzero(np.abs(torques).max(axis=(0, 2)) > 0)
    names = tuple(at.referred.discs[disc] for disc in excited)
    tables: dict[str, tuple[tuple[str, ...], Complexes, str]] = {
        "shaft_torque_orders.csv": (forced.shafts, forced.shaft_torques, "N m"),
        "disc_angle_orders.csv": (forced.discs, forced.amplitudes, "rad"),
        "excitation_orders.csv": (names, torques[:, excited], "N m"),
    }
    return {file: columns_csv(_columns(forced, *table)) for file, table in tables.items()}


def _columns(
    forced: ForcedVibration, names: tuple[str, ...], harmonics: Complexes, unit: str
) -> dict[str, Floats]:
    """Speed, then each order of each part. `harmonics`: (orders, parts, speeds)."""
    columns: dict[str, Floats] = {"speed [rad/s]": forced.speeds}
    for part, name in enumerate(names):
        for k, (order, fixed) in enumerate(zip(forced.orders.tolist(), forced.lines, strict=True)):
            line = fixed if forced.offsets[k] else f"{order:.6g}"
            columns[f"{name} order {line} [{unit}]"] = np.abs(harmonics[k, part])
    return columns


def order_results(at: ExcitedTrain, forced: ForcedVibration) -> dict[str, Any]:
    """Amplitude and phase of every order over the speeds, by name of shaft and disc."""

    def listed(names: tuple[str, ...], harmonics: Complexes) -> dict[str, Any]:
        return {
            name: {
                "amplitude": np.abs(harmonics[:, part]).tolist(),
                "phase": np.angle(harmonics[:, part]).tolist(),
            }
            for part, name in enumerate(names)
        }

    return {
        "orders": forced.orders.tolist(),
        **({"fixed": forced.fixed.tolist()} if len(forced.fixed) else {}),
        "speeds": forced.speeds.tolist(),
        "shaft_torque": listed(forced.shafts, forced.shaft_torques),
        "disc_angle": listed(forced.discs, forced.amplitudes),
        "excitation": listed(at.referred.discs, at.exciting),
    }


def manoeuvre_csv(moved: TorsionTransient) -> str:
    """Speeds and torques of a manoeuvre over the time as CSV."""
    columns: dict[str, Floats] = {"time [s]": moved.time}
    columns |= {f"{name} speed [rad/s]": row for name, row in zip(moved.discs, moved.speed, strict=True)}
    columns |= {f"{name} torque [N m]": row for name, row in zip(moved.shafts, moved.torque, strict=True)}
    rubbing = list(zip(moved.frictions, moved.slip, moved.friction_torque, strict=True))
    columns |= {f"{name} slip [rad/s]": slip for name, slip, _ in rubbing}
    columns |= {f"{name} friction torque [N m]": torque for name, _, torque in rubbing}
    return columns_csv(columns)


def excitation_tables(at: ExcitedTrain, place: int) -> Iterator[Table]:
    """Harmonics of the torques on the discs at one speed. `place`: of the speed."""
    size = np.abs(at.exciting[:, :, place])
    shown = _shown(at, size)
    if not shown:
        return
    discs = list(shown.values())
    kept = [k for k in range(len(size)) if (size[k, discs] > _ROUNDING * size[:, discs].max()).any()]
    rows: list[Row] = [
        (
            line_name(at.torques.orders[k], at.torques.offsets[k]),
            "",
            *(cell for disc in discs for cell in _cells(at.exciting[k, disc, place], size[:, disc].max())),
        )
        for k in kept
    ]
    heads = ["order", "", *(head for name in shown for head in (name, "phase"))]
    speed = quantity(float(at.torques.speeds[place]), "rad/s", usual="rpm")
    yield Table("excitation", f"Harmonics of the exciting torques at {speed}", tuple(heads), rows)


def star_table(stars: Sequence[PhaseVectors]) -> Table:
    """Phase vector sums of orders in modes."""
    heads = ("critical speed", "", "{rpm}", "vector sum", "sum of lengths", "torque", "work per angle")
    return part_table(
        "phase_vectors",
        "Phase vector sums of the most severe critical speeds",
        stars,
        heads,
        lambda star: f"mode {star.mode}, order {star.order:.4g}",
        *("", "speed", "vector_sum", "largest_sum", "torque"),
        lambda star: quantity(star.vector_sum * star.torque, "N m"),
    )


def _shown(at: ExcitedTrain, size: Floats) -> Mapping[str, int]:
    """Discs that are excited, of the throws of each engine the first: the others differ by their phase."""
    shown: dict[str, int] = {}
    for disc, name in enumerate(at.referred.discs):
        engine, _, throw = name.rpartition("throw_")
        is_repeated = throw.isdigit() and int(throw) > 1 and f"{engine}throw_1" in at.referred.discs
        if size[:, disc].any() and not is_repeated:
            shown[name] = disc
    return shown


def _cells(wave: complex, largest: float) -> tuple[str, str]:
    if abs(wave) <= _ROUNDING * largest:
        return "–", "–"
    return quantity(abs(wave), "N m"), quantity(float(np.angle(wave)), "rad", usual="deg")
