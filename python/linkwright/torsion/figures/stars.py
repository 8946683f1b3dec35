"""Star diagrams: the phase vectors of orders in modes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import BLUE, INK, RED, SMALL, SOFT, WIDTH, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.torsion.modes.phase_vectors import PhaseVectors

# Diagrams beside each other, and the height of a row of them [in].
_COLUMNS, _ROW = 4, 2.3

# Angle within which vectors share one word [rad], and share of the longest below which one has none.
_TOGETHER, _SHORT = 0.25, 0.03

# Words stand beyond the tip of their vector, and outside the middle, where vectors meet: shares of the
# longest one.
_BEYOND, _MIDDLE = 0.22, 0.5


@styled
def star_figure(stars: Sequence[PhaseVectors]) -> Figure:
    """Draw the star of each order: vectors from the middle, and their sum."""
    from matplotlib.figure import Figure

    rows = max(math.ceil(len(stars) / _COLUMNS), 1)
    figure = Figure(figsize=(WIDTH, _ROW * rows + 0.1), layout="constrained")
    panels = figure.subplots(rows, _COLUMNS, squeeze=False).ravel()
    for panel, star in zip(panels, stars, strict=False):
        _star(panel, star)
    for panel in panels[len(stars) :]:
        panel.set_axis_off()
    return figure


def _star(axes: Axes, star: PhaseVectors) -> None:
    longest = float(np.abs(star.vectors).max())
    size = 1.55 * longest
    axes.set_aspect("equal")
    axes.set_xlim(-size, size)
    axes.set_ylim(-size, size)
    axes.set_axis_off()
    axes.plot([-longest, longest], [0, 0], color=SOFT, linewidth=0.4)
    axes.plot([0, 0], [-longest, longest], color=SOFT, linewidth=0.4)
    for vector in star.vectors.tolist():
        _arrow(axes, vector, BLUE, 1.0)
    _arrow(axes, complex(star.vectors.sum()) * longest / star.largest_sum, RED, 2.0)
    for words, vector in _named(star, longest):
        place = (max(abs(vector), _MIDDLE * longest) + _BEYOND * longest) * vector / abs(vector)
        axes.text(place.real, place.imag, words, fontsize=SMALL, ha="center", va="center", color=INK)
    rpm = star.speed * 30 / math.pi
    title = f"mode {star.mode}, order {star.order:.4g}\n{rpm:.0f} rpm, sum {star.vector_sum:.3g}"
    axes.set_title(title, fontsize=8)


def _arrow(axes: Axes, vector: complex, colour: str, width: float) -> None:
    axes.annotate(
        "",
        (vector.real, vector.imag),
        (0, 0),
        arrowprops={
            "arrowstyle": "-|>",
            "mutation_scale": 7,
            "color": colour,
            "linewidth": width,
            "shrinkA": 0,
            "shrinkB": 0,
        },
    )


def _named(star: PhaseVectors, longest: float) -> list[tuple[str, complex]]:
    groups: list[tuple[list[str], complex]] = []
    for name, vector in zip(star.discs, star.vectors.tolist(), strict=True):
        if abs(vector) < _SHORT * longest:
            continue
        for n, (names, other) in enumerate(groups):
            if abs(np.angle(vector * other.conjugate())) < _TOGETHER:
                groups[n] = ([*names, _short(name)], max(vector, other, key=abs))
                break
        else:
            groups.append(([_short(name)], vector))
    return [("\n".join(_rows(names)), at) for names, at in groups]


def _rows(names: list[str]) -> list[str]:
    return [" ".join(names[n : n + 3]) for n in range(0, len(names), 3)]


def _short(name: str) -> str:
    """The number of a throw, with the first letter of one of several engines; another disc in full."""
    engine, _, number = name.rpartition("throw_")
    return f"{engine[:1]}{number}" if number.isdigit() else name
