"""Tables of the torsional system as forms of classification societies ask for it: masses and stiffnesses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from linkwright.kernel.page.numbers import number, quantity
from linkwright.kernel.page.table import Row, Table
from linkwright.torsion.model.shaft_limit import ShaftLimit, StressedSection
from linkwright.torsion.modes.scheme import Connection, Scheme

_PREFIXES = ((1e6, "M"), (1e3, "k"))

_KINDS = {
    "shaft": "shaft",
    "coupling": "coupling",
    "mesh": "elastic gear stage",
    "gears": "gear stage",
    "damper": "damper",
}


def system_tables(
    scheme: Scheme, sections: Mapping[str, tuple[StressedSection, ShaftLimit]]
) -> Iterator[Table]:
    """Masses, then what joins them. `sections`: where stresses count, by shaft."""
    rows: list[Row] = [
        (
            f"{n + 1} {name}",
            "",
            quantity(float(scheme.inertia[n]), "kg m²"),
            number(float(scheme.speed[n])),
            quantity(float(scheme.inertia_referred[n]), "kg m²"),
        )
        for n, name in enumerate(scheme.discs)
    ]
    heads = ("mass", "", "moment of inertia", "speed ratio n", "referred n² J")
    yield Table("masses", f"Masses, referred to {scheme.discs[0]}", heads, rows)
    if not scheme.connections:
        return
    place = {name: str(n + 1) for n, name in enumerate(scheme.discs)}
    joined: list[Row] = [_joined(one, place, sections) for one in scheme.connections]
    columns: Row = ("connection", "", "between", "kind", "stiffness", "referred n² k", "diameter", "W_p")
    yield Table("stiffnesses", "Stiffnesses, with the sections whose stress counts", columns, joined)


def _joined(
    one: Connection, place: Mapping[str, str], sections: Mapping[str, tuple[StressedSection, ShaftLimit]]
) -> Row:
    """A connection: what it joins, how stiff it is, and its section."""
    between = f"{place.get(one.first, one.first)} – {place.get(one.second, one.second)}"
    section = sections[one.name][0] if one.name in sections else None
    ratio = f"{number(one.ratio)} : 1" if one.kind == "gears" else None
    return (
        one.name,
        "",
        between,
        _KINDS[one.kind],
        ratio or _stiffness(one.stiffness),
        _stiffness(one.stiffness_referred),
        "–" if section is None else quantity(section.diameter, "m", usual="mm"),
        "–" if section is None else quantity(section.section_modulus, "m³", usual="cm³"),
    )


def _stiffness(value: float | None) -> str:
    """A stiffness with the prefix of its size, unless another unit is wanted."""
    prefix = next((prefix for size, prefix in _PREFIXES if value and value >= size), "")
    return quantity(value, "N m/rad", usual=f"{prefix}N m/rad")
