"""``linkwright plot FILE QUANTITY…``: curves of a machine as a picture, a table, CSV."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from linkwright.kernel.command.answer import Answer, as_wanted, finish, hand_over
from linkwright.kernel.command.common import Json, ZeroAt
from linkwright.kernel.command.out import Force, output_folder, put, say_written
from linkwright.kernel.command.parameter import Argument, Option
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import later
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.app.curves import Curve
    from linkwright.app.study import Study
    from linkwright.kernel.page.table import Row, Table

Quantities = Annotated[
    list[str] | None,
    Argument(
        "QUANTITY",
        "Curves such as ram.place, ram.velocity or steady_state.speed; without any, a list of all.",
    ),
]
Over = Annotated[
    str | None,
    Option(
        "--over",
        "QUANTITY",
        "Abscissa: a curve of the same analysis, such as time or ram.place. Default: the crank angle.",
    ),
]
Outs = Annotated[
    list[str] | None,
    Option(
        "--out",
        "FILE|DIR",
        "A figure (.png, .svg, .pdf), a table (.csv), or a folder for all of them. Repeatable.",
    ),
]
Csv = Annotated[bool, Option("--csv", help="Print CSV.")]

_PICTURES = (".png", ".svg", ".pdf")

# The place of a flat peak is known to the root of rounding: beside this, what is left of zero is rounding.
_PLACE = 2e4

# Digits of the largest value of a column: what the cycle is computed to.
_DIGITS = 12

# Intervals of the table on the terminal.
_ROWS = 12


def plot(
    file: File,
    quantity: Quantities = None,
    over: Over = None,
    zero: ZeroAt = None,
    csv: Csv = False,
    json: Json = False,
    out: Outs = None,
    force: Force = False,
) -> None:
    """Draw curves of a machine, those of one unit on one axis.

    Any curve that `linkwright run` computes, and motion of points, links and slides; over the crank angle of
    a revolution unless it runs over something else.
    """
    from linkwright.app.curves import chosen, curves_of, from_zero, on_common_points
    from linkwright.app.study import study
    from linkwright.linkages.zero import zero_of

    machine = file.read()
    counted = zero_of(machine, zero)
    results = study(machine)
    if not quantity:
        hand_over(_list_of(results, curves_of(results)), json=json)
        return
    curves = [from_zero(curve, counted.angle) for curve in chosen(results, quantity, over)]
    listed = on_common_points(curves)
    with as_wanted(machine.units):
        written = _write(curves, listed, counted.words, out or [], force=force)
        if csv:
            put(_csv(listed), None)
    answer = Answer(
        machine=machine,
        is_described=True,
        results=lambda _: {"plot": _curve_data(results, curves, counted.angle)},
        findings=results.findings,
        warnings=results.warnings,
        tables=lambda: [_extremes(results, curves, counted.angle), _values(listed)],
        figures={"curves": later("app.curves:curves_figure", curves, counted.words)},
        head=later("kernel.reader.numbers:zero_words", counted),
    )
    if written:
        say_written(written, quiet=True)
    if csv:
        finish(answer)
        return
    hand_over(answer, json=json)


def _list_of(study: Study, curves: dict[str, Curve]) -> Answer:
    from linkwright.kernel.page.table import Table

    rows: list[Row] = [(curve.name, curve.unit or "–", curve.over) for curve in curves.values()]
    return Answer(
        machine=study.machine,
        results={
            "curves": {curve.name: {"unit": curve.unit, "over": curve.over} for curve in curves.values()}
        },
        findings=study.findings,
        warnings=study.warnings,
        tables=Table("curves", "Curves that can be drawn", ("curve", "", "over"), rows, is_whole=True),
    )


def _curve_data(study: Study, curves: Sequence[Curve], zero: float) -> dict[str, Any]:
    from linkwright.app.curves import extremes

    return {
        "angle_zero": zero,
        "curves": {
            curve.name: {
                "unit": curve.unit,
                "over": curve.over,
                "over_unit": curve.over_unit,
                "x": curve.x.tolist(),
                "values": curve.values.tolist(),
                **extremes(study, curve, zero)._asdict(),
            }
            for curve in curves
        },
    }


def _write(
    curves: Sequence[Curve], listed: Sequence[Curve], zero: str, outs: Sequence[str], *, force: bool
) -> list[Path]:
    from linkwright.app.curves import bytes_of, curves_figure
    from linkwright.kernel.files.output import write_file

    written: list[Path] = []
    for place in map(Path, outs):
        ending = place.suffix.lower()
        if ending == ".csv":
            write_file(place, _csv(listed), replace=force)
        elif ending in _PICTURES:
            write_file(place, bytes_of(curves_figure(curves, zero), ending), replace=force)
        elif ending:
            endings = ", ".join((*_PICTURES, ".csv"))
            raise InputError(f"--out: found {place}, expected a file that ends in {endings}, or a folder")
        else:
            folder = output_folder(place, force=force)
            assert folder is not None
            pictures = {
                f"plot{kind}": bytes_of(curves_figure(curves, zero), kind) for kind in (".png", ".svg")
            }
            written += folder.write({"plot.csv": _csv(listed), **pictures})
            continue
        written.append(place)
    return written


def _csv(curves: Sequence[Curve]) -> str:
    import numpy as np

    from linkwright.kernel.page.table import columns_csv
    from linkwright.kernel.reader.out_units import reader

    most = max(len(curve.x) for curve in curves)
    columns: dict[str, Any] = {}
    last = None
    for curve in curves:
        unit, factor = reader().shown(curve.over_unit, _usual(curve.over_unit))
        if last is None or len(curve.x) != len(last) or not np.array_equal(curve.x, last):
            name = f"{curve.over} [{unit or '-'}]"
            columns[name if name not in columns else f"{curve.over} of {curve.name} [{unit or '-'}]"] = _long(
                _known(curve.x / factor), most
            )
            last = curve.x
        unit, factor = reader().shown(curve.unit, _usual(curve.unit))
        columns[f"{curve.name} [{unit or '-'}]"] = _long(
            _known(curve.values / factor, curve.scale / factor), most
        )
    return columns_csv(columns)


def _known(values: Any, scale: float = 0.0) -> Any:
    """Values without the digits that are rounding beside the largest one, or a scale."""
    import numpy as np

    largest = max(float(np.nanmax(np.abs(values), initial=0.0)), scale)
    if not 0 < largest < np.inf:
        return values
    # The sum turns -0 into 0.
    return np.round(values, _DIGITS - int(np.ceil(np.log10(largest)))) + 0.0


def _long(values: Any, length: int) -> Any:
    import numpy as np

    return np.concatenate([values, np.full(length - len(values), np.nan)])


def _extremes(study: Study, curves: Sequence[Curve], zero: float) -> Table:
    from linkwright.app.curves import CRANK_ANGLE, extremes
    from linkwright.kernel.page.table import Table

    rows: list[Row] = []
    rough = []
    for curve in curves:
        extreme = extremes(study, curve, zero)
        if not extreme.is_exact:
            rough.append(curve.name)
        scale = max(abs(extreme.minimum), abs(extreme.maximum), curve.scale)
        values = [_shown(value, curve.unit, scale) for value in (extreme.minimum, extreme.maximum)]
        places = [_shown(at, curve.over_unit, _PLACE) for at in (extreme.minimum_at, extreme.maximum_at)]
        rows.append((curve.name, "", values[0], places[0], values[1], places[1]))
    at = "at φ" if curves[0].over == CRANK_ANGLE else f"at {curves[0].over_words}"
    heads = ("curve", "", "minimum", at, "maximum", at)
    title = f"Extremes; of {', '.join(rough)} among the points of the curve" if rough else "Extremes"
    return Table("extremes", title, heads, rows)


def _values(curves: Sequence[Curve]) -> Table:
    import numpy as np

    from linkwright.kernel.page.table import Table

    first = curves[0]
    same = [curve for curve in curves if len(curve.x) == len(first.x) and np.array_equal(curve.x, first.x)]
    at = np.unique(np.linspace(0, len(first.x) - 1, _ROWS + 1).round().astype(int))
    rows: list[Row] = [
        (
            _cell(first.x, int(k), first.over_unit),
            "",
            *(_cell(curve.values, int(k), curve.unit, curve.scale) for curve in same),
        )
        for k in at
    ]
    return Table("values", "Values", (first.over_words, "", *(curve.words for curve in same)), rows)


def _cell(values: Any, k: int, si: str, scale: float = 0.0) -> str:
    """A value with its unit; zero where nothing but rounding is left beside the largest one, or a scale."""
    import numpy as np

    return _shown(float(values[k]), si, max(float(np.nanmax(np.abs(values))), scale))


def _shown(value: float, si: str, scale: float = 0.0) -> str:
    """A value with its unit; zero where it is rounding beside a scale."""
    from linkwright.kernel.reader.numbers import quantity

    return quantity(value, si, scale=scale, usual=_usual(si))


def _usual(si: str) -> str:
    return "deg" if si == "rad" else ""
