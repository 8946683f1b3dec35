"""A linkage as tables of text: travel, transmission angles, four-bar loops, dead points."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.reader.numbers import (
    crank_angle,
    cycle_of_angles,
    degrees,
    measured,
    number,
    parted,
    quantity,
)
from linkwright.linkages.cycle import END, DeadPoint, ElementMotion, Linkage

# More dead points than this are the regular ones of many outputs, and tell nothing.
_DEAD_POINTS_MAX = 24

# A transmission angle follows from a root: what changes less is constant within rounding [rad].
_CONSTANT = 1e-7


def motion_tables(linkage: Linkage) -> list[Table]:
    """Strokes, swings and time ratios of the outputs, and transmission angles of the dyads."""
    return _with_rows(_travel(linkage), _transmission(linkage))


def loop_tables(linkage: Linkage) -> list[Table]:
    """Four-bar loops and dead points, where there are such."""
    return _with_rows(_loops(linkage), _dead(linkage))


def _with_rows(*tables: Table) -> list[Table]:
    return [table for table in tables if table.rows]


def _travel(linkage: Linkage) -> Table:
    heads = ("output", "", "travel", "from φ", "to φ", "time ratio", "velocity ratio", "mechanical advantage")
    names = [element.output for element in linkage.elements]
    cycle = cycle_of_angles(linkage.crank_angle)
    rows = [_travel_row(element, names.count(element.output) > 1, cycle) for element in linkage.elements]
    return Table("linkage", "Linkage over its cycle", heads, rows)


def _travel_row(element: ElementMotion, of_two: bool, cycle: float) -> Row:
    # `of_two`: whether link and slide have one name, as of a slotted lever; `cycle`: of the crank [rad].
    places = crank_angle(element.low_angle, cycle=cycle), crank_angle(element.high_angle, cycle=cycle)
    if element.turns is not None:
        turns = number(element.turns)
        travel, ends = f"{turns} revolution{'' if turns == '1' else 's'}", ("–", "–")
    elif element.swing is not None:
        travel, ends = measured(element.swing, "rad"), places
    else:
        travel, ends = measured(element.stroke, "m"), places
    low, high = element.velocity_ratio_min, element.velocity_ratio_max
    # Of what goes in a straight line, a length per angle.
    per = "m/rad" if element.stroke is not None else ""
    ratios = "–" if low is None else f"{parted(low, per)[0]} to {quantity(high, per)}"
    unit = "1/m" if element.stroke is not None else ""
    advantage = element.mechanical_advantage_min
    gain = measured(advantage, unit, before="≥ ")
    kind = ", position" if element.stroke is not None else ", angle"
    return (
        element.output + (kind if of_two else ""),
        "",
        travel,
        *ends,
        number(element.time_ratio),
        ratios,
        gain,
    )


def _transmission(linkage: Linkage) -> Table:
    heads = ("dyad", "", "minimum", "at φ", "maximum", "at φ")
    rows: dict[str, Row] = {}
    cycle = cycle_of_angles(linkage.crank_angle)
    for element in linkage.elements:
        low, high = element.transmission_angle_min, element.transmission_angle_max
        at = element.transmission_angle_min_angle, element.transmission_angle_max_angle
        if low is not None and high is not None and at[0] is not None and at[1] is not None:
            # One that is constant has no place.
            places = (
                [crank_angle(angle, cycle=cycle) for angle in at] if high - low > _CONSTANT else ["–", "–"]
            )
            extremes = measured(low, "rad"), places[0], measured(high, "rad"), places[1]
            rows[element.element] = (element.element, "μ", *extremes)
    return Table("transmission", "Transmission angle", heads, list(rows.values()))


def _loops(linkage: Linkage) -> Table:
    heads = ("four-bar loop", "", "driver", "coupler", "follower", "ground", "s + l", "p + q")
    names = ("driver", "coupler", "follower", "ground", "sum_extremes", "sum_others")
    rows: list[Row] = [
        (f"{element.element}: {loop.grashof}", "", *(measured(getattr(loop, name), "m") for name in names))
        for element in linkage.elements
        if (loop := element.four_bar) is not None
    ]
    return Table("grashof", "Four-bar loops", heads, rows)


def _dead(linkage: Linkage) -> Table:
    points = linkage.dead_points if len(linkage.dead_points) <= _DEAD_POINTS_MAX else ()
    names = [element.output for element in linkage.elements]
    cycle = cycle_of_angles(linkage.crank_angle)
    rows: list[Row] = [
        (f"{_turning(point, names)}: {point.kind}", "φ", crank_angle(point.angle, cycle=cycle))
        for point in points
    ]
    is_crank = all(point.kind != END for point in points)
    return Table(
        "dead_points", "Dead points", ("element", "", "crank angle" if is_crank else "drive angle"), rows
    )


def _turning(point: DeadPoint, names: list[str]) -> str:
    """The element of a dead point; of two with one name, whether link or slide turns back."""
    return f"{point.element}, {point.turns_back}" if names.count(point.element) > 1 else point.element


# Outputs among the few numbers.
_OUTPUTS = 2

# Ways forth and back that take as long, within rounding.
_EVEN = 1e-6


def linkage_headline(linkage: Linkage) -> Iterator[tuple[str, str, str]]:
    """Strokes, swings and time ratios, and the worst transmission angle."""
    moving = [element for element in linkage.elements if element.turns is None]
    last = [*{element.output: element for element in moving[::-1]}.values()][::-1]
    for moved in last if len(moving) <= _OUTPUTS else ():
        if moved.stroke is not None:
            yield f"stroke of {moved.output}", *parted(moved.stroke, "m")
        elif moved.swing is not None:
            yield f"swing of {moved.output}", degrees(moved.swing), ""
        if moved.time_ratio is not None and abs(moved.time_ratio - 1) > _EVEN:
            yield f"time ratio of {moved.output}", number(moved.time_ratio), ""
    worst = worst_transmission(linkage)
    if worst is not None:
        yield "worst transmission angle", degrees(worst[0]), ""


def worst_transmission(linkage: Linkage) -> tuple[float, str] | None:
    """Worst transmission angle [rad] and the element that has it; None without one."""
    angles = ((element.transmission_angle_worst, element.element) for element in linkage.elements)
    return min(((angle, name) for angle, name in angles if angle is not None), default=None)
