"""Forces as tables of text."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping

from linkwright.kernel.arrays import Floats
from linkwright.kernel.page.table import Row, Table, part_table, parts_of
from linkwright.kernel.quantities import declared, shown
from linkwright.kernel.reader.numbers import (
    crank_angle,
    cycle_of_angles,
    degrees,
    measured,
    number,
    parted,
    quantity,
)
from linkwright.kinetostatics.balancing import Balance
from linkwright.kinetostatics.envelope import Extent, envelope
from linkwright.kinetostatics.result import Forces
from linkwright.kinetostatics.shaking_orders import ShakingOrders

_KINDS = {
    "pin": "pin",
    "guide": "guide, normal force",
    "slot": "slot, normal force",
    "mesh": "teeth",
    "rack": "teeth of the rack",
    "cable": "cable, tension",
}


def envelope_table(forces: Forces) -> Table:
    """Peak, its angle, root mean square and mean of every force."""
    extents = envelope(forces)
    scales = _scales(extents)
    rows = [_row(extent, forces, scales[extent.unit]) for extent in extents]
    return Table("forces", "Forces", ("quantity", "", "peak", "at φ", "rms", "mean"), rows)


def envelope_tables(forces: Forces) -> tuple[Table]:
    """The same table, for a report."""
    return (envelope_table(forces),)


def forces_headline(forces: Forces) -> Iterator[tuple[str, str, str]]:
    """Peak torque of each drive with a law, the largest force of a pair, and where."""
    for name, value in forces.drive_max.items() if forces.laws else ():
        unit = forces.drive_unit(name)
        yield f"peak {'torque' if unit == 'N m' else 'force'} of {name}", *parted(value, unit)
    known = {name: force for name, force in forces.reaction_max.items() if math.isfinite(force)}
    if known and any(known.values()):
        pair = max(known, key=lambda name: known[name])
        yield f"maximum force of {pair}", *parted(known[pair], "N")


def _row(extent: Extent, forces: Forces, scale: float) -> Row:
    word, symbol = _words(extent.name, forces)
    peak, rms, mean = (
        measured(value, extent.unit, scale) for value in (extent.peak, extent.rms, extent.mean)
    )
    cycle = cycle_of_angles(forces.crank_angle)
    # Rounding is largest somewhere, which says nothing.
    at = "–" if peak == measured(0.0, extent.unit) else crank_angle(extent.peak_angle, cycle=cycle)
    return word, symbol, peak, at, rms, mean


def _scales(extents: Iterable[Extent]) -> dict[str, float]:
    scales: dict[str, float] = {}
    for extent in extents:
        scales[extent.unit] = max(scales.get(extent.unit, 0.0), abs(extent.peak))
    return scales


def _words(name: str, forces: Forces) -> tuple[str, str]:
    if name == "torque_drive" and forces.shaft:
        return forces.shaft, shown(Forces, name).symbol
    if name.endswith(" drive") and name.removesuffix(" drive") in forces.drives:
        drive = name.removesuffix(" drive")
        return "force of the drive" if forces.drive_unit(drive) == "N" else "torque of the drive", drive
    if name in declared(Forces):
        mark = shown(Forces, name)
        return mark.word, mark.symbol
    if name.endswith(" moment"):
        return "guide, moment", name.removesuffix(" moment")
    pair = forces.pairs[name]
    return f"{_KINDS[pair.kind]}, {pair.first} on {pair.second}", name


# Orders above these of engines and presses say little.
_ORDERS = 6


def orders_table(orders: ShakingOrders) -> Table:
    """Primary, secondary and higher shaking forces and couples at a constant speed."""
    title = f"Shaking force and couple of inertia at {quantity(orders.speed, 'rad/s')}"
    heads, parts = ("", "", "maximum force", "maximum couple"), parts_of(orders, "order")
    cells = (lambda one: f"order {one.order:.4g}", "", "force_max", "couple_max")
    return part_table("shaking_orders", title, [one for one in parts if one.order <= _ORDERS], heads, *cells)


def cases_table(cases: Mapping[str, Forces]) -> Table:
    """Peaks of several load cases, by name, side by side."""
    columns = {case: {extent.name: extent for extent in envelope(forces)} for case, forces in cases.items()}
    first = next(iter(cases.values()))
    names = list(dict.fromkeys(name for column in columns.values() for name in column))
    scales = _scales(extent for column in columns.values() for extent in column.values())
    rows: list[Row] = []
    for name in names:
        extents = [column.get(name) for column in columns.values()]
        peaks = (
            measured(extent.peak, extent.unit, scales[extent.unit]) if extent else "–" for extent in extents
        )
        rows.append((*_words(name, first), *peaks))
    return Table("load_cases", "Peaks by load case", ("quantity", "", *cases), rows)


def pose_tables(cases: Mapping[str, Forces]) -> list[Table]:
    """Components of every force at one crank angle, and the share of each source; for each load case."""
    tables = []
    for case, forces in cases.items():
        part = "" if len(cases) == 1 else case
        tables += [pose_table(forces, part), _pose_shares(forces, part)]
    return tables


def pose_table(forces: Forces, case: str = "") -> Table:
    """Size, components, direction and moment of every force at the only crank angle of `forces`."""
    scales = _scales(envelope(forces))
    newtons, torques = scales.get("N", 0.0), scales.get("N m", 0.0)
    rows: list[Row] = []
    for name in ("torque_drive", "shaking_moment"):
        moment = measured(float(getattr(forces, name)[0]), "N m", torques)
        rows.append((*_words(name, forces), "", "", "", "", moment))
    for name, values in forces.drives.items() if len(forces.drives) > 1 or forces.laws else ():
        given = float(values[0])
        unit = forces.drive_unit(name)
        cells = ("", "", "", "", measured(given, unit, torques))
        if unit == "N":
            cells = (measured(abs(given), unit, newtons), "", "", "", "")
        rows.append((*_words(f"{name} drive", forces), *cells))
    rows.append((*_words("shaking_force", forces), *_components(forces.shaking_force[0], newtons), ""))
    for name, pair in forces.pairs.items():
        turning = pair.normal if pair.kind == "mesh" and not pair.force.any() else pair.moment
        moment = measured(float(turning[0]), "N m", torques) if turning[0] else ""
        word = f"{_KINDS[pair.kind].partition(',')[0]}, {pair.first} on {pair.second}"
        rows.append((word, name, *_components(pair.force[0], newtons), moment))
    heads = ("force", "", "size", "x", "y", "direction", "moment")
    title = f"Forces at φ = {crank_angle(forces.crank_angle[0])}" + (f", {case}" if case else "")
    return Table("forces_at", title, heads, rows)


def _components(force: Floats, scale: float) -> Row:
    """Size, components and direction of a force (2,) [N]; rounding is zero and has no direction."""
    x, y = force.tolist()
    size = measured(math.hypot(x, y), "N", scale)
    has_direction = size != measured(0.0, "N")
    # A component that is rounding beside the force itself is zero in the direction too.
    near = [0.0 if abs(part) < 1e-9 * math.hypot(x, y) else part for part in (x, y)]
    direction = degrees(math.atan2(near[1], near[0])) if has_direction else "–"
    return size, *(measured(part, "N", max(scale, math.hypot(x, y))) for part in (x, y)), direction


def _pose_shares(forces: Forces, case: str) -> Table:
    shares = contribution_table(forces)
    title = "Contributions" + (f", {case}" if case else "")
    return shares._replace(title=title, heads=("source", "", "of M_d", "of the shaking force"))


def contribution_table(forces: Forces) -> Table:
    """Shares of the sources in the peaks of torque and shaking force; they add up to the peak."""
    extents = {extent.name: extent for extent in envelope(forces)}
    at = [
        int(abs(forces.crank_angle - extents[name].peak_angle).argmin())
        for name in ("torque_drive", "shaking_force")
    ]
    total = forces.shaking_force[at[1]]
    size = float((total**2).sum() ** 0.5) or 1.0
    torques = {name: float(share.torque_drive[at[0]]) for name, share in forces.contributions.items()}
    along = {
        name: float(share.shaking_force[at[1]] @ total) / size for name, share in forces.contributions.items()
    }
    # Where the shares cancel, what is left of them is rounding of the reactions.
    scales = _scales(extents.values())
    rows: list[Row] = [
        (name, "", measured(torques[name], "N m", scales["N m"]), measured(along[name], "N", scales["N"]))
        for name in forces.contributions
    ]
    heads = ("source", "", "of the peak of M_d", "of the peak shaking force")
    return Table("contributions", "Contributions to the peaks", heads, rows)


def balance_tables(balance: Balance) -> list[Table]:
    """The counterweights, and root mean squares before and after."""
    heads: Row = ("link", "", "mass", "radius", "direction from the link", "moment")
    cells = ["link", "", "mass", "radius", "angle", "moment"]
    if any(counterweight.axial for counterweight in balance.counterweights):
        heads, cells = (*heads, "along the crankshaft"), [*cells, "axial"]
    weights = part_table("counterweights", "Counterweights", balance.counterweights, heads, *cells)
    rows: list[Row] = []
    measures = balance.measures()
    scales: dict[str, float] = {}
    for name, values in measures.items():
        unit = shown(Forces, name).unit
        scales[unit] = max(scales.get(unit, 0.0), *values)
    for name, values in measures.items():
        mark = shown(Forces, name)
        before, after = (measured(value, mark.unit, scales[mark.unit]) for value in values)
        # The share by which rounding changes says nothing.
        is_zero = before == measured(0.0, mark.unit)
        change = "–" if is_zero else f"{number(100 * (values[1] / values[0] - 1))} %"
        rows.append((f"{mark.word}, rms", mark.symbol, before, after, change))
    return [
        weights,
        Table("balance", "Effect of the counterweights", ("quantity", "", "before", "after", "change"), rows),
    ]
