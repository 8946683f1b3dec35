"""Tables of an engine: its data, its cylinders and the weak ones among them, a damper for its train."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.reader.numbers import measured, number, quantity
from linkwright.torsion.damper.damper_design import DamperDesign
from linkwright.torsion.diagnosis.record_diagnosis import RecordDiagnosis
from linkwright.torsion.excitation.engine_torques import EngineData


def engine_tables(engines: Mapping[str, EngineData]) -> Iterator[Table]:
    """A table for each kind of engine."""
    named: list[tuple[list[str], EngineData]] = []
    for name, data in engines.items():
        same = next((names for names, other in named if other == data), None)
        if same is None:
            named.append(([name], data))
        else:
            same.append(name)
    for names, data in named:
        yield engine_table(data, " and ".join(names))


def engine_table(data: EngineData, names: str = "") -> Table:
    """Discs and stiffness of throws by every formula, and the gas."""
    rows: list[Row] = [
        ("rotating inertia of a throw", "J_k", measured(data.own_inertia, "kg m²"), ""),
        ("disc of a throw, mean of the exact inertia", "J", measured(data.throw_inertia, "kg m²"), "used"),
        _beside(
            "disc of a throw as printed in paper 3, (7) and (12)",
            data.throw_inertia_published,
            data.throw_inertia,
            "kg m²",
        ),
    ]
    if data.stiffness is not None:
        if data.stiffness_by == "given":
            rows.append(("stiffness from throw to throw", "k", measured(data.stiffness, "N m/rad"), "given"))
        for name, stiffness in data.stiffness_formulas.items():
            word = f"stiffness by formula {name}"
            if name == data.stiffness_by:
                rows.append((word, "k", measured(stiffness, "N m/rad"), "used"))
            else:
                rows.append(_beside(word, stiffness, data.stiffness, "N m/rad"))
    rows += [
        (f"{word}, bank {n + 1}", "", measured(value / 1e5, "bar"), "")
        for word, values in (
            ("indicated mean pressure", data.mean_effective_pressure),
            ("peak pressure", data.peak_pressure),
        )
        for n, value in enumerate(values)
    ]
    is_engine = data.machine == "engine"
    word, cycle = ("Engine", "firing") if is_engine else ("Compressor", "working")
    rows.append((f"{cycle} order", "", "-".join(data.firing), ""))
    title = f"{word}s {names}" if " and " in names else f"{word} {names}".rstrip()
    steps = sorted({f"{np.degrees(interval):.5g}°" for interval in data.intervals})
    rows.append((f"{cycle} intervals", "", ", ".join(steps) or "a cycle", ""))
    return Table(
        "engine",
        f"{title}, gas at {data.speed * 30 / np.pi:.5g} rpm",
        ("quantity", "", "value", ""),
        rows,
    )


def _beside(word: str, value: float, used: float, unit: str) -> Row:
    return word, "", measured(value, unit), f"{100 * (value / used - 1):+.3g} %".replace("-", "−")


def diagnosis_table(read: RecordDiagnosis, level: float) -> Table:
    """Each cylinder with its factor."""
    diagnosis, words = read.found, dict(_verdicts(read, level))
    half, relative = diagnosis.half_width(level), diagnosis.relative
    rows: list[Row] = []
    for n, name in enumerate(diagnosis.cylinders):
        known = bool(np.isfinite(half[n]))
        numbers = (diagnosis.factor[n], half[n], relative[n])
        cells = [f"{value:.3f}" if known else "–" for value in numbers]
        rows.append(
            (f"cylinder {name}", "", *cells, words.get(name, "" if known else "cannot be determined"))
        )
    title = (
        f"Share of the combustion, from {read.orders} orders of the speed of {read.disc}; crank at "
        f"{read.speed * 30 / np.pi:.5g} rpm"
    )
    heads = ("", "", "factor", f"± ({100 * level:.4g} %)", "over their mean", "verdict")
    return Table("cylinders", title, heads, rows)


def _verdicts(read: RecordDiagnosis, level: float) -> Iterator[tuple[str, str]]:
    diagnosis = read.found
    for n, name in enumerate(diagnosis.cylinders):
        words = ["weak"] if name in read.weak(level) else []
        is_off = name in (*read.late(level), *read.early(level))
        if is_off and diagnosis.delay is not None and diagnosis.delay_deviation is not None:
            angle, half = np.degrees(
                [diagnosis.delay[n], diagnosis.coverage(level) * diagnosis.delay_deviation[n]]
            )
            words.append(f"{'late' if angle > 0 else 'early'} by {abs(angle):.2f}° ± {half:.2f}°")
        if name in read.leaking(level) and diagnosis.compression is not None:
            words.append(f"leaking, {diagnosis.compression[n]:.3f} of its compression")
        if words:
            yield name, "; ".join(words)


def diagnosis_words(read: RecordDiagnosis, level: float) -> str:
    """Which cylinders are weak, in a sentence."""
    diagnosis, weak = read.found, read.weak(level)
    if not read.is_plausible:
        return "No cylinder is judged."
    if not weak and (late := dict(_verdicts(read, level))):
        return (
            f"No cylinder is weak; {', '.join(f'cylinder {name} is {word}' for name, word in late.items())}."
        )
    if not weak:
        return f"No cylinder is weak at a confidence level of {100 * level:.4g} %."
    half = diagnosis.half_width(level)
    places = map(diagnosis.cylinders.index, weak)
    listed = [
        f"cylinder {diagnosis.cylinders[n]} at {diagnosis.factor[n]:.3f} ± {half[n]:.3f}" for n in places
    ]
    if len(weak) == len(diagnosis.cylinders):
        return f"All cylinders burn less than in the file, the weakest {listed[0]} of its combustion."
    return f"Weak, the weakest first: {', '.join(listed)} of its combustion."


def damper_table(design: DamperDesign) -> Table:
    """The damper by the mode alone and the optimum for the train, side by side."""
    values = (
        ("damping", "c [N m s/rad]", design.damping, design.damping_best),
        ("stiffness", "k [N m/rad]", design.stiffness, design.stiffness_best),
        ("loss factor", "η", design.loss_factor, design.loss_factor_best),
        ("largest magnification", "", design.magnification_rule, design.magnification_best),
    )
    rows: list[Row] = [
        (word, symbol, number(rule), number(best)) for word, symbol, rule, best in values if best > 0
    ]
    title = (
        f"Damper on {design.on} for mode {design.mode}, {quantity(design.natural_frequency, 'Hz')}; its "
        f"ring of "
        f"{quantity(design.ring_inertia, 'kg m²')} is {100 * design.mass_ratio:.4g} % "
        "of the modal inertia there"
    )
    return Table("damper", title, ("", "", "by the mode alone", "optimum for the train"), rows)


def damper_lines(design: DamperDesign) -> str:
    """The best damper as a table of a machine file. TOML."""
    entries = [f'on = "{design.on}"', f'kind = "{"viscous" if design.kind == "viscous" else "tuned"}"']
    entries.append(f"ring_inertia = {design.ring_inertia!r}")
    best = {
        "damping": design.damping_best,
        "stiffness": design.stiffness_best,
        "loss_factor": design.loss_factor_best,
    }
    entries += [f"{key} = {float(f'{value:.6g}')!r}" for key, value in best.items() if value > 0]
    return "\n".join(["[train.dampers.damper]", *entries]) + "\n"
