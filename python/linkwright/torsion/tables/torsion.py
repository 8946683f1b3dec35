"""Tables of the torsional vibration of a train."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.page.table import Cell, NamedPart, Row, Table, part_table, parts_of
from linkwright.kernel.reader.numbers import number, quantity
from linkwright.torsion.excitation.drive_line import train_of
from linkwright.torsion.excitation.harmonics import line_name
from linkwright.torsion.limits.critical_response import CriticalResponse
from linkwright.torsion.modes.campbell import CampbellDiagram
from linkwright.torsion.modes.damped import DampedVibration
from linkwright.torsion.modes.free import FreeVibration, Node
from linkwright.torsion.modes.holzer import HolzerTable
from linkwright.torsion.modes.phase_vectors import most_severe
from linkwright.torsion.response.forced import ForcedVibration
from linkwright.torsion.response.stress import stressed
from linkwright.torsion.study import TorsionStudy
from linkwright.torsion.tables.engine import engine_tables
from linkwright.torsion.tables.limits import (
    critical_table,
    fatigue_table,
    limit_tables,
    measured_tables,
    nominal_table,
    per_minute,
    rpm,
)
from linkwright.torsion.tables.manoeuvre import manoeuvre_tables
from linkwright.torsion.tables.orders import excitation_tables, star_table
from linkwright.torsion.tables.system import gear_tables, misfire_gear_table, system_tables

# Parts that share most of the energy, as far as they have a twentieth of it.
_NAMED, _SHARE = 2, 0.05

# Nodes of a mode in a row of its table.
_NODES = 3

# Critical speeds in a table.
_CRITICAL = 12

# Columns of shapes beside each other on a terminal.
_SHAPES = 5


def study_tables(study: TorsionStudy) -> Iterator[Table]:
    """All tables of a study of torsional vibration."""
    yield from verdict_tables(study)
    yield from system_part(study)
    yield from free_tables(study)
    yield from forced_tables(study)
    if study.transient is not None:
        yield from manoeuvre_tables(study.transient)
    yield from detail_tables(study)


def verdict_tables(study: TorsionStudy) -> Iterator[Table]:
    """Limits, gear stages, measured peaks."""
    yield from limit_tables(study)
    for fatigue in study.fatigue:
        yield fatigue_table(fatigue)
    if study.meshes is not None and study.forced is not None:
        place = service_place(study, study.forced)
        yield from gear_tables(study.meshes, place)
        if study.misfire is not None and study.misfire.gears:
            yield misfire_gear_table(study.misfire, float(study.forced.speeds[place]))
    yield from measured_tables(study.overlays)


def system_part(study: TorsionStudy) -> Iterator[Table]:
    """Masses, stiffnesses, engines."""
    yield from system_tables(study.scheme, stressed(train_of(study.machine).shafts))
    if study.engines:
        yield from engine_tables(study.engines)


def free_tables(study: TorsionStudy) -> Iterator[Table]:
    """Natural frequencies, damping, critical speeds."""
    yield _frequencies(study.free)
    if study.damped is not None:
        yield _damped(study, study.damped)
    if study.campbell is not None and study.campbell.critical:
        yield _critical(study.campbell)
        if study.critical_responses:
            yield critical_table(_severest(study.campbell, study.critical_responses))
        if study.stars:
            yield star_table(most_severe(study.campbell, study.stars, _CRITICAL))


def forced_tables(study: TorsionStudy) -> Iterator[Table]:
    """Torques of the shafts, speed fluctuation."""
    if study.forced is not None:
        yield _shafts(study, study.forced)
        yield _discs(study, study.forced)


def detail_tables(study: TorsionStudy) -> Iterator[Table]:
    """Excitation by orders, shapes by numbers, Holzer's tables that were asked for."""
    if study.forced is not None and study.excited is not None:
        yield from excitation_tables(study.excited, service_place(study, study.forced))
    for fatigue in study.fatigue:
        yield nominal_table(fatigue)
    yield from shape_tables(study.free)
    for table in study.holzer:
        yield from holzer_tables(table)


def _severest(
    diagram: CampbellDiagram, responses: Sequence[CriticalResponse]
) -> tuple[CriticalResponse, ...]:
    severity = [point.resonance_amplitude or 0.0 for point in diagram.of_orders]
    kept = sorted(np.argsort(severity, kind="stable")[::-1][:_CRITICAL].tolist())
    return tuple(responses[n] for n in kept)


def _damped(study: TorsionStudy, damped: DampedVibration) -> Table:
    heads = ("motion", "", "{Hz}", "damped {Hz}", "ζ", "log. decrement")
    cells = ("natural_frequencies", "damped_frequencies", "damping_ratios", "logarithmic_decrements")
    run = study.machine.train.run if study.machine.train is not None else None
    at = f" at {rpm(run.service)} {per_minute()}, with loads and mean torques" if run and study.forced else ""
    modes = parts_of(damped, "natural_frequencies")
    return part_table("damped", f"Damped modes{at}", modes, heads, _motion, "", *cells)


def _motion(mode: NamedPart) -> str:
    if mode.natural_frequencies == 0:
        return "rigid-body rotation"
    return "underdamped (oscillatory)" if mode.damped_frequencies > 0 else "overdamped (aperiodic)"


def _critical(diagram: CampbellDiagram) -> Table:
    """The most severe critical speeds, by speed, with peak and amplitude of the mode alone."""
    by_severity = sorted(diagram.critical, key=lambda point: point.resonance_amplitude or 0.0, reverse=True)
    kept = set(by_severity[:_CRITICAL])
    more = f", the most severe of {len(diagram.critical)}" if len(diagram.critical) > _CRITICAL else ""
    heads = ("order", "", "mode", "Hz", "{rpm}", "mode alone: peak [{rpm}]", "mode alone: amplitude")
    return part_table(
        "critical_speeds",
        f"Critical speeds{more}",
        [crossing for crossing in diagram.critical if crossing in kept],
        heads,
        lambda crossing: line_name(crossing.order, crossing.fixed),
        "",
        "mode",
        lambda crossing: f"{crossing.frequency:.5g}",
        "speed [rad/s]",
        "peak_speed [rad/s]",
        lambda crossing: _amplitude(crossing.resonance_amplitude),
    )


def _amplitude(theta: float | None) -> str:
    if theta is None:
        return "–"
    return quantity(theta, "rad", 3, usual="deg") if np.isfinite(theta) else "∞"


def _shafts(study: TorsionStudy, forced: ForcedVibration) -> Table:
    at, peaks = service_place(study, forced), study.peaks
    assert peaks is not None
    service = rpm(forced.speeds[at])
    return part_table(
        "shaft_torques",
        f"Shaft torques: maximum over speeds and resonances; at {service} {per_minute()}, with heat",
        parts_of(forced, "shafts", at),
        ("shaft", "", "vibratory", f"at {per_minute()}", "mean", "vibratory", "maximum", "heat"),
        "name",
        "",
        lambda shaft: quantity(float(peaks.vibratory[shaft.place[0]]), "N m"),
        lambda shaft: rpm(float(peaks.speed[shaft.place[0]])),
        *("mean_torques", "shaft_torque_vibratory", "shaft_torque_max", "shaft_heat"),
    )


def _discs(study: TorsionStudy, forced: ForcedVibration) -> Table:
    at = service_place(study, forced)
    title = f"Speed fluctuation at {rpm(forced.speeds[at])} {per_minute()}"
    heads: Row = ("disc", "", "δ", "rigid-body", "torsional")
    cells: list[Cell] = ["name", "", "unevenness", "unevenness_rigid", "unevenness_torsional"]
    if (along := study.along) is not None:
        heads = (*heads, "N", "spread of N")
        cells.append(lambda disc: number(float(along.unevenness[disc.place[0]]), 3))
        cells.append(lambda disc: number(float(along.spread[disc.place[0]]), 3))
    return part_table("unevenness", title, parts_of(forced, "discs", at), heads, *cells, digits=3)


def service_place(study: TorsionStudy, forced: ForcedVibration) -> int:
    """Index of the speed next to that of service; of a driveline the middle of its speeds."""
    run = study.machine.train.run if study.machine.train is not None else None
    if run is None:
        return len(forced.speeds) // 2
    return int(np.argmin(np.abs(forced.speeds - run.service)))


def _signed(text: str) -> str:
    """A number with a true minus sign; zero has none."""
    return (text if float(text) else text.removeprefix("-")).replace("-", "−")


def shape_tables(free: FreeVibration) -> Iterator[Table]:
    """Shapes of the modes, some modes beside each other."""
    for start in range(0, len(free.natural_frequencies), _SHAPES):
        yield _shapes(free, range(start, min(start + _SHAPES, len(free.natural_frequencies))))


def _frequencies(free: FreeVibration) -> Table:
    frequency, nodes = free.natural_frequencies, free.nodes
    return part_table(
        "natural_frequencies",
        "Natural frequencies",
        range(len(frequency)),
        ("dominant strain energy; kinetic energy", "", "Hz", "cycles/min", "nodes", "at"),
        lambda k: _energy(free, k),
        lambda k: f"f_{k}",
        lambda k: number(float(frequency[k])),
        lambda k: number(60 * float(frequency[k])),
        lambda k: str(len(nodes[k])) if frequency[k] > 0 else "–",
        lambda k: _nodes(nodes[k]) if frequency[k] > 0 else "–",
    )


def _nodes(nodes: Sequence[Node]) -> str:
    text = ", ".join(map(_node, nodes[:_NODES])) or "–"
    return f"{text}, …" if len(nodes) > _NODES else text


def _node(node: Node) -> str:
    return node.at if node.share == 0 else f"{node.at} {100 * node.share:.0f} %"


def _energy(free: FreeVibration, k: int) -> str:
    if free.natural_frequencies[k] == 0:
        moving = [name for name, q in zip(free.discs, free.mode_shapes[k], strict=True) if q]
        return "rigid-body rotation" if len(moving) > 1 else f"{moving[0]} rotates alone"
    parts = (
        _most(free.shafts, free.potential_shares[k]),
        _most(free.discs, free.kinetic_shares[k]),
    )
    # Where inertia is distributed, it may be the shafts that move.
    return "; ".join(filter(None, parts))


def _most(names: tuple[str, ...], shares: Floats) -> str:
    order = np.argsort(-shares, kind="stable")[:_NAMED]
    return ", ".join(f"{names[n]} {100 * shares[n]:.0f} %" for n in order if shares[n] >= _SHARE)


def _shapes(free: FreeVibration, modes: range) -> Table:
    rows: list[Row] = [
        (name, "", *(_signed(f"{free.mode_shapes[k, n]:.6f}") for k in modes))
        for n, name in enumerate(free.discs)
    ]
    heads = ("disc", "", *(f"mode {k}" for k in modes))
    return Table("mode_shapes", "Mode shapes, largest amplitude 1", heads, rows)


def holzer_tables(table: HolzerTable) -> Iterator[Table]:
    """Holzer's table: discs, then shafts."""
    heads: Row = ("disc", "", "J [{kg m²}]", "J ω² [{N m/rad}]", "amplitude θ", "J ω² θ [{N m}]")
    cells: tuple[Cell, ...] = (
        "name",
        "",
        "inertia",
        "inertia_squared",
        lambda disc: number(disc.amplitude, 6),
        "torque",
    )
    title = f"Holzer's table at {quantity(table.frequency, 'Hz', 6)}"
    discs = part_table("holzer_discs", title, parts_of(table, "discs"), heads, *cells, digits=6)
    residual = number(table.residual_torque, 6, float(np.abs(table.torque).max()))
    yield discs._replace(rows=[*discs.rows, ("residual at " + table.end, "", "", "", "", residual)])
    heads = ("shaft", "", "k [{N m/rad}]", "twist", "torque [{N m}]")
    cells = ("name", "", "stiffness", lambda shaft: number(shaft.twist, 6), "shaft_torque")
    title = "Holzer's table: shafts"
    yield part_table("holzer_shafts", title, parts_of(table, "shafts"), heads, *cells, digits=6)
