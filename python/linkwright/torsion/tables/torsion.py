"""Tables of the torsional vibration of a train."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.page.numbers import number, quantity
from linkwright.kernel.page.table import Row, Table
from linkwright.torsion.excitation.drive_line import train_of
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
    """Those at the most severe critical speeds, by speed."""
    severity = [point.resonance_amplitude or 0.0 for point in diagram.critical]
    kept = sorted(np.argsort(severity, kind="stable")[::-1][:_CRITICAL].tolist())
    return tuple(responses[n] for n in kept)


def _damped(study: TorsionStudy, damped: DampedVibration) -> Table:
    """Natural frequencies with their damping."""
    columns = (
        damped.natural_frequencies,
        damped.damped_frequencies,
        damped.damping_ratios,
        damped.logarithmic_decrements,
    )
    rows: list[Row] = [
        (_kind(values[0], values[1]), "", *(_finite(value) for value in values))
        for values in zip(*(column.tolist() for column in columns), strict=True)
    ]
    heads = ("motion", "", "Hz", "damped Hz", "ζ", "log. decrement")
    run = study.machine.train.run if study.machine.train is not None else None
    at = f" at {rpm(run.service)} {per_minute()}, with loads and mean torques" if run and study.forced else ""
    return Table("damped", f"Damped modes{at}", heads, rows)


def _kind(natural: float, damped: float) -> str:
    """What a mode with damping does."""
    if natural == 0:
        return "rigid-body rotation"
    return "underdamped (oscillatory)" if damped > 0 else "overdamped (aperiodic)"


def _critical(diagram: CampbellDiagram) -> Table:
    """The most severe critical speeds, by speed, with peak and amplitude of the mode alone."""
    by_severity = sorted(diagram.critical, key=lambda point: point.resonance_amplitude or 0.0, reverse=True)
    kept = set(by_severity[:_CRITICAL])
    rows: list[Row] = [
        (
            f"order {crossing.order:.4g}",
            "",
            str(crossing.mode),
            f"{crossing.frequency:.5g}",
            rpm(crossing.speed),
            "–" if crossing.peak_speed is None else rpm(crossing.peak_speed),
            _amplitude(crossing.resonance_amplitude),
        )
        for crossing in diagram.critical
        if crossing in kept
    ]
    alone = (f"mode alone: peak [{per_minute()}]", "mode alone: amplitude")
    heads = ("order", "", "mode", "Hz", per_minute(), *alone)
    more = len(diagram.critical) - len(rows)
    title = "Critical speeds" + (f", the most severe of {len(diagram.critical)}" if more else "")
    return Table("critical_speeds", title, heads, rows)


def _amplitude(theta: float | None) -> str:
    """An angle, where an amplitude was found."""
    if theta is None:
        return "–"
    return quantity(theta, "rad", 3, usual="deg") if np.isfinite(theta) else "∞"


def _shafts(study: TorsionStudy, forced: ForcedVibration) -> Table:
    """Torques of every shaft at their worst, and in service."""
    at, peaks = service_place(study, forced), study.peaks
    assert peaks is not None
    rows: list[Row] = []
    for s, name in enumerate(forced.shafts):
        numbers = (
            float(peaks.vibratory[s]),
            forced.mean_torques[s, at],
            forced.shaft_torque_vibratory[s, at],
            forced.shaft_torque_max[s, at],
            forced.shaft_heat[s, at],
        )
        units = ("N m", "N m", "N m", "N m", "W")
        cells = [quantity(float(value), unit) for value, unit in zip(numbers, units, strict=True)]
        rows.append((name, "", cells[0], rpm(float(peaks.speed[s])), *cells[1:]))
    service = rpm(forced.speeds[at])
    heads = ("shaft", "", "vibratory", f"at {per_minute()}", "mean", "vibratory", "maximum", "heat")
    title = f"Shaft torques: maximum over speeds and resonances; at {service} {per_minute()}, with heat"
    return Table("shaft_torques", title, heads, rows)


def _discs(study: TorsionStudy, forced: ForcedVibration) -> Table:
    """Speed fluctuation along the train in service."""
    at = service_place(study, forced)
    parts = [forced.unevenness, forced.unevenness_rigid, forced.unevenness_torsional]
    columns = [[_finite(value, 3) for value in part[:, at].tolist()] for part in parts]
    heads = ["disc", "", "δ", "rigid-body", "torsional"]
    if study.along is not None:
        heads += ["N", "spread of N"]
        columns += [
            [_finite(v, 3) for v in curve.tolist()] for curve in (study.along.unevenness, study.along.spread)
        ]
    rows: list[Row] = [(name, "", *cells) for name, *cells in zip(forced.discs, *columns, strict=True)]
    title = f"Speed fluctuation at {rpm(forced.speeds[at])} {per_minute()}"
    return Table("unevenness", title, tuple(heads), rows)


def service_place(study: TorsionStudy, forced: ForcedVibration) -> int:
    """Where tables and figures look at the train in service.

    Place of the speed next to that of service; of a driveline the middle of its speeds.
    """
    run = study.machine.train.run if study.machine.train is not None else None
    if run is None:
        return len(forced.speeds) // 2
    return int(np.argmin(np.abs(forced.speeds - run.service)))


def _signed(text: str) -> str:
    """A number with a true minus sign; zero has none."""
    return (text if float(text) else text.removeprefix("-")).replace("-", "−")


def _finite(value: float, digits: int | None = None) -> str:
    """A number, or a dash at a resonance that nothing damps."""
    return number(value, digits) if np.isfinite(value) else "–"


def shape_tables(free: FreeVibration) -> Iterator[Table]:
    """Shapes of the modes, some modes beside each other."""
    for start in range(0, len(free.natural_frequencies), _SHAPES):
        yield _shapes(free, range(start, min(start + _SHAPES, len(free.natural_frequencies))))


def _frequencies(free: FreeVibration) -> Table:
    rows: list[Row] = [
        (
            _energy(free, k),
            f"f_{k}",
            number(f),
            number(60 * f),
            str(len(free.nodes[k])) if f > 0 else "–",
            _nodes(free.nodes[k]) if f > 0 else "–",
        )
        for k, f in enumerate(free.natural_frequencies.tolist())
    ]
    heads = ("dominant strain energy; kinetic energy", "", "Hz", "cycles/min", "nodes", "at")
    return Table("natural_frequencies", "Natural frequencies", heads, rows)


def _nodes(nodes: Sequence[Node]) -> str:
    """The first nodes of a mode; results.json has them all."""
    text = ", ".join(map(_node, nodes[:_NODES])) or "–"
    return f"{text}, …" if len(nodes) > _NODES else text


def _node(node: Node) -> str:
    """Where a node is: a disc, or a shaft and the share of its twist."""
    return node.at if node.share == 0 else f"{node.at} {100 * node.share:.0f} %"


def _energy(free: FreeVibration, k: int) -> str:
    """The shafts that twist most and the discs that swing most."""
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
    columns = (table.inertia, table.inertia_squared, table.amplitude, table.torque)
    rows: list[Row] = [
        (name, "", *(number(column[n], 6) for column in columns)) for n, name in enumerate(table.discs)
    ]
    largest = float(np.abs(table.torque).max())
    rows.append(("residual at " + table.end, "", "", "", "", number(table.residual_torque, 6, largest)))
    heads: Row = ("disc", "", "J [kg m²]", "J ω² [N m/rad]", "amplitude θ", "J ω² θ [N m]")
    yield Table("holzer_discs", f"Holzer's table at {quantity(table.frequency, 'Hz', 6)}", heads, rows)
    of_shafts = (table.stiffness, table.twist, table.shaft_torque)
    rows = [
        (name, "", *(number(column[n], 6) for column in of_shafts)) for n, name in enumerate(table.shafts)
    ]
    yield Table(
        "holzer_shafts", "Holzer's table: shafts", ("shaft", "", "k [N m/rad]", "twist", "torque [N m]"), rows
    )
