"""The string between its stations: displacement, load and stress along the rods over a stroke.

Motion and dynamic load of the polished rod decide what is below: each section is divided, and its pieces
carry the harmonics down exactly.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats, Indices
from linkwright.rods.core import cards_of
from linkwright.rods.diagnosis import CardDiagnosis
from linkwright.rods.model.rod_string import RodString
from linkwright.rods.prediction import RodStringMotion
from linkwright.rods.stress import weight_below


class AlongRods(NamedTuple):
    """A string by depth; a taper is there twice, as the end of the rods above and the top of those below."""

    depth: Floats  # (nodes,) below the polished rod [m]
    section: Indices  # (nodes,) number of the section, from 0
    position: Floats  # (nodes, n) upward [m]
    load: Floats  # (nodes, n) effective tension, with the weight in the fluid below [N]
    stress: Floats  # (nodes, n) by that tension [Pa]


def along_rods(string: RodString, result: RodStringMotion | CardDiagnosis, pieces: int = 40) -> AlongRods:
    """The string of a prediction or of a diagnosed card in so many pieces, at least one a section."""
    parts = list(_parts(string, len(result.time) / result.period, pieces))
    sections = tuple(
        section.with_entries({"length": length})
        for section, lengths in zip(string.sections, parts, strict=True)
        for length in lengths.tolist()
    )
    damping = result.damping if isinstance(result, CardDiagnosis) else float(string.damping_rate)
    fine = string.with_entries({"sections": sections})
    cards = cards_of(fine, result.period, result.position[0], result.load[0], damping)
    # Places in the list of pieces' ends: every piece of a section, and the end of its last.
    section = np.repeat(np.arange(len(parts)), [len(lengths) + 1 for lengths in parts])
    place = np.arange(len(section)) - section
    depth = np.append(0.0, np.cumsum(fine.columns.length))[place]
    load = np.asarray(cards.load)[place] + weight_below(fine)[place][:, None]
    stress = load / string.columns.area[section][:, None]
    return AlongRods(depth, section, np.asarray(cards.position)[place], load, stress)


def _parts(string: RodString, rate: float, pieces: int) -> Iterator[Floats]:
    """Lengths of the pieces of each section; `rate` of the samples [Hz].

    Waves take whole steps to the nodes: between its samples the sum of harmonics of a jump rings.
    """
    columns = string.columns
    steps = columns.length * np.sqrt(columns.mass / columns.rigidity) * rate
    for length, start, step in zip(columns.length, np.cumsum(steps) - steps, steps, strict=True):
        count = int(np.ceil(pieces * length / columns.length.sum()))
        whole = np.unique(np.round(start + step * np.arange(1, count) / count))
        inside = whole[(whole > start + 0.5) & (whole < start + step - 0.5)]
        yield np.diff([0.0, *(inside - start) / step, 1.0]) * length


def cards(string: RodString, result: RodStringMotion | CardDiagnosis) -> Iterator[tuple[str, Floats, Floats]]:
    """Name, position and load of the card of each station, weights of the rods below included."""
    low = result.position[0].min()
    yield result.stations[0], result.rod_position, result.rod_load
    for n, weight in enumerate(weight_below(string)[1:], start=1):
        yield result.stations[n], result.position[n] - low, result.load[n] + weight
