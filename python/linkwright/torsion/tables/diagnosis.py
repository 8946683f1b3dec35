"""Table of the cylinders of an engine, and a sentence on the weak ones."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.page.table import Row, Table
from linkwright.torsion.diagnosis.record_diagnosis import RecordDiagnosis


def diagnosis_table(read: RecordDiagnosis, level: float) -> Table:
    """Each cylinder with its factor."""
    found, words = read.found, dict(_verdicts(read, level))
    half, relative = found.half_width(level), found.relative
    rows: list[Row] = []
    for n, name in enumerate(found.cylinders):
        known = bool(np.isfinite(half[n]))
        numbers = (found.factor[n], half[n], relative[n])
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
    """What is wrong with each cylinder that is accused."""
    found = read.found
    for n, name in enumerate(found.cylinders):
        words = ["weak"] if name in read.weak(level) else []
        if name in read.late(level) and found.delay is not None and found.delay_deviation is not None:
            angle, half = np.degrees([found.delay[n], found.coverage(level) * found.delay_deviation[n]])
            words.append(f"late by {angle:.2f}° ± {half:.2f}°")
        if name in read.leaking(level) and found.compression is not None:
            words.append(f"leaking, {found.compression[n]:.3f} of its compression")
        if words:
            yield name, "; ".join(words)


def diagnosis_words(read: RecordDiagnosis, level: float) -> str:
    """Which cylinders are weak, in a sentence."""
    found, weak = read.found, read.weak(level)
    if not read.is_plausible:
        return "No cylinder is judged."
    if not weak and (late := dict(_verdicts(read, level))):
        return (
            f"No cylinder is weak; {', '.join(f'cylinder {name} is {word}' for name, word in late.items())}."
        )
    if not weak:
        return f"No cylinder is weak, as far as can be determined with {100 * level:.4g} %."
    half = found.half_width(level)
    places = map(found.cylinders.index, weak)
    listed = [f"cylinder {found.cylinders[n]} at {found.factor[n]:.3f} ± {half[n]:.3f}" for n in places]
    if len(weak) == len(found.cylinders):
        return f"All cylinders burn less than the file says, most so {listed[0]} of its combustion."
    return f"Weak, the weakest first: {', '.join(listed)} of its combustion."
