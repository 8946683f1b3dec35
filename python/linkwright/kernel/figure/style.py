"""What all figures share: colours, fonts, axes; a figure of the page with its words."""

from __future__ import annotations

import os
import re
import sys
import warnings
from collections.abc import Callable
from functools import cache, wraps
from typing import TYPE_CHECKING, Any, NamedTuple, ParamSpec, TypeVar

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.reader.angle_marks import mark_angles
from linkwright.kernel.reader.angle_zero import zero_shown
from linkwright.kernel.reader.out_units import reader
from linkwright.kernel.system import away_from

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

P = ParamSpec("P")
R = TypeVar("R")

# Okabe and Ito's colours, distinguished by all kinds of colour vision (jfly.uni-koeln.de/color, 2008); yellow
# is left out, it is too faint for lines on white, and the purple is darker for the same reason.
BLUE = "#0072b2"
RED = "#d55e00"
GREEN = "#009e73"
ORANGE = "#e69f00"
PURPLE = "#a8478a"
SKY = "#56b4e9"
LINES = (BLUE, RED, GREEN, ORANGE, PURPLE, SKY)

INK = "#1d2329"
SOFT = "#6b7480"
GRID = "#d9dde2"
PAPER = "#fefefe"

# One meaning, one colour, in all figures.
SPEED, ACCELERATION = BLUE, RED
DRIVE, LOAD, MOTOR, INERTIA = BLUE, RED, PURPLE, GREEN

# A column of text on A4 [inch].
WIDTH = 7.1

# The smallest letters [points]: 7 pt where a figure is printed in a column of text.
SMALL = 7.5

# For labels of our own with symbols between dollar signs: ``axes.set_ylabel("torque $M$", **MATH)``.
MATH: Any = {"parse_math": True}

STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "mathtext.fontset": "dejavusans",
    # Names of a machine file may hold any letter; formulas are read where `MATH` says so.
    "text.parse_math": False,
    "axes.edgecolor": SOFT,
    "axes.labelcolor": INK,
    "axes.labelsize": 9,
    "axes.titlesize": 9,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.facecolor": "none",
    "figure.facecolor": PAPER,
    "grid.color": GRID,
    "grid.linewidth": 0.7,
    "lines.linewidth": 1.8,
    "lines.solid_capstyle": "round",
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "legend.labelcolor": INK,
    "text.color": INK,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    # Outlines in place of letters look the same where the font is missing.
    "svg.fonttype": "path",
    # Names inside the file are the same in every run.
    "svg.hashsalt": "linkwright",
}


@cache
def load_matplotlib() -> None:
    """Import matplotlib as it is installed: settings beside a machine file are not those of the user.

    A backend of the environment that does not exist is left out: figures are written, and need none.
    """
    if "matplotlib" in sys.modules:
        return
    backend = os.environ.pop("MPLBACKEND", None)
    try:
        with away_from("matplotlibrc"):
            import matplotlib
    finally:
        if backend is not None:
            os.environ["MPLBACKEND"] = backend
    if backend:
        try:
            matplotlib.rcParams["backend"] = backend
        except ValueError:
            return


def styled(draw: Callable[P, R]) -> Callable[P, R]:
    """Let a function draw in the style of all figures, with axes in the units that the reader wants."""

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> R:
        load_matplotlib()
        from matplotlib import rc_context

        with rc_context(STYLE), warnings.catch_warnings():
            # A letter that no font has is drawn as a box.
            warnings.filterwarnings("ignore", message="Glyph .* missing from font")
            drawing = draw(*args, **kwargs)
            if not isinstance(drawing, str | bytes):
                _for_reader(drawing)
            return drawing

    return drawn


def _for_reader(drawing: object) -> None:
    """Finish legends; count crank angles from the zero, and mark axes in the units, that the reader wants."""
    from matplotlib.figure import Figure

    from linkwright.kernel.figure.legends import finish_legends
    from linkwright.kernel.reader.axes import from_zero_of_reader, in_units_of_reader

    if not isinstance(drawing, Figure):
        return
    finish_legends(drawing)
    if reader().chosen or zero_shown().words:
        from_zero_of_reader(drawing)
        in_units_of_reader(drawing)


@cache
def _figure_class() -> type[Figure]:
    """Figures that a notebook shows: those of matplotlib alone are shown there once pyplot is loaded."""
    from matplotlib.figure import Figure

    class ShownFigure(Figure):
        def _repr_png_(self) -> bytes:
            from linkwright.kernel.figure.svg import png

            return png(self)

    return ShownFigure


def panels(rows: int, *, height: float, columns: int = 1, shared: bool = True) -> tuple[Figure, list[Axes]]:
    """A figure of a height [inch] with rows and columns of axes, row by row, that share what is along x."""
    figure = _figure_class()(figsize=(WIDTH, height), layout="constrained")
    axes = figure.subplots(rows, columns, sharex="col" if shared else "none", squeeze=False)
    return figure, list(axes.ravel())


def turn_axis(axes: Axes, degrees: np.ndarray | None = None, *, label: bool = True) -> None:
    """Let x be the crank angle of one revolution in degrees, or the range of some angles [°]."""
    low, high = (0.0, 360.0) if degrees is None else (float(degrees[0]), float(degrees[-1]))
    turns = round((high - low) / 360)
    # Samples of whole revolutions may begin beside zero, clear of a change point.
    if abs(low) < 1 and turns and abs(high - low - 360 * turns) < _WHOLE:
        low, high = 0.0, 360.0 * turns
    if high > low:
        axes.set_xlim(low, high)
        mark_angles(axes, low, high)
    if label:
        axes.set_xlabel("crank angle φ [°]")


# What a range of crank angles may differ from whole revolutions [°].
_WHOLE = 1e-3


def level(axes: Axes, value: float, text: str, colour: str = SOFT) -> None:
    """A dashed line at a height, with its words in the legend."""
    axes.axhline(value, color=colour, linewidth=1.1, linestyle=(0, (5, 3)), label=text)


def log_height(axes: Axes) -> None:
    """A logarithmic scale upwards, with powers of ten at its marks."""
    axes.set_yscale("log")
    _powers_of_ten(axes.yaxis)


def log_width(axes: Axes) -> None:
    """The same along x."""
    axes.set_xscale("log")
    _powers_of_ten(axes.xaxis)


def _powers_of_ten(axis: Axis) -> None:
    """Powers of ten at the marks of an axis."""
    axis.set_major_formatter(lambda value, _: _power_of_ten(value))
    axis.set_minor_formatter(lambda value, _: "")


def _power_of_ten(value: float) -> str:
    """Such as 10⁻³."""
    return "10" + str(round(np.log10(value))).translate(str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"))


# Letters of a name at a mark, in a legend, and of an address that a label has room for: longer ones would
# leave axes none.
MARK_LETTERS, NAME_LETTERS, ADDRESS_LETTERS = 18, 28, 44


def shortened(name: str, letters: int) -> str:
    """A name without its middle where it is long: its end tells it from others."""
    half = letters // 2
    return f"{name[:half]}…{name[-half:]}" if len(name) > letters else name


def named(name: str) -> str:
    """A name of a machine file, or some words, as a label."""
    return _in_legend(name if " " in name else shortened(name, NAME_LETTERS))


def _in_legend(label: str) -> str:
    """A label that begins with an underscore would be left out of a legend."""
    return f" {label}" if label.startswith("_") else label


def broken(name: str, width: int) -> str:
    """A label in lines of about so many letters: a name of a file has no spaces, but underscores."""
    lines = [""]
    # The unit in brackets at the end stays whole.
    for part in re.findall(r"\[[^\[\]]*\]$|[^_ ]*[_ ]|[^_ ]+$", _in_legend(name)):
        if len(lines[-1]) + len(part.rstrip()) > width and lines[-1].strip():
            lines.append("")
        lines[-1] += part
    return "\n".join(line.rstrip(" ") for line in lines)


def zero_line(axes: Axes) -> None:
    """A thin line at zero, where the axes reach below it."""
    if axes.get_ylim()[0] < 0 < axes.get_ylim()[1]:
        axes.axhline(0, color=SOFT, linewidth=0.8)


def roomy(axes: Axes, *values: Floats, share: float = 0.12) -> None:
    """Limits in y that hold values with room around them, also where they are all the same.

    What has no value, as the acceleration of a machine that does not start, is left out.
    """
    known = np.concatenate([np.ravel(value) for value in values])
    known = known[np.isfinite(known)]
    if not known.size:
        return
    low, high = float(known.min()), float(known.max())
    # A constant gets a tenth of itself to both sides, so that rounding does not fill the picture.
    span = high - low if high - low > 1e-6 * max(abs(low), abs(high)) else 0.2 * (abs(high) or 1.0)
    middle = 0.5 * (low + high)
    axes.set_ylim(middle - (0.5 + share) * span, middle + (0.5 + share) * span)


class CaptionedFigure(NamedTuple):
    """A figure, its name in the page, its title, and its caption."""

    name: str
    title: str
    caption: str
    figure: Figure
