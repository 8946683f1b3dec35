"""Tables of a cam, its sizes, joints, forces and laws, and of motion laws: factors and theoretical bounds."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

from linkwright.cam.dynamics.loaded import LoadedCam
from linkwright.cam.law_factors import LawFactors, law_factors
from linkwright.cam.laws.catalogue import BOUNDS, LAWS
from linkwright.cam.profile.least_sizes import LeastSizes
from linkwright.cam.profile.profile import CamProfile
from linkwright.kernel.page.table import Row, Table, known_rows
from linkwright.kernel.reader.numbers import crank_angle, degrees, measured, number, quantity

# Laws that sections are compared with: the usual ones, from the gentlest velocity on.
_COMPARED = (
    "harmonic",
    "cycloidal",
    "modified_trapezoid",
    "modified_sine",
    "polynomial_3_4_5",
    "polynomial_4_5_6_7",
)

# A section counts as one of rest to rest if its ends are slower than this share of its mean velocity.
_REST = 1e-9


def cam_tables(
    cams: Sequence[CamProfile], sizes: Sequence[LeastSizes] = (), loaded: Sequence[LoadedCam] = ()
) -> Iterator[Table]:
    """The tables of all cams of a machine."""
    loads = {cam.name: cam for cam in loaded}
    least = {size.name: size for size in sizes}
    for profile in cams:
        yield profile_table(profile)
        if profile.name in least:
            yield size_table(least[profile.name])
        yield section_table(profile)
        yield joint_table(profile)
        if profile.name in loads:
            yield force_table(loads[profile.name])
        table = comparison_table(profile)
        if table.rows:
            yield table


def profile_table(profile: CamProfile) -> Table:
    """Sizes and extremes of a cam."""
    rows = [*_motion_rows(profile), *_size_rows(profile)]
    return Table(f"cam_{profile.name}", f"Cam {profile.name}", ("quantity", "", "value", "where"), rows)


def _motion_rows(profile: CamProfile) -> Iterator[Row]:
    """Zero of the cam angle, lift, and its derivatives in time at the design speed."""
    unit = "rad" if profile.cam.is_oscillating else "m"
    start = crank_angle(float(profile.cam.phase) % (2 * math.pi), "φ = ")
    yield "start of the programme", "θ = 0", start, "crank angle"
    yield "lift", "h", _lift(profile, profile.stroke), ""
    at = "" if profile.speed is None else f"at {quantity(profile.speed, 'rad/s')}"
    for word, symbol, value, per in (
        ("constant velocity", "v", profile.speed_constant, "/s"),
        ("maximum velocity", "v_max", profile.velocity_max, "/s"),
        ("maximum acceleration", "a_max", profile.acceleration_max, "/s²"),
        ("maximum jerk", "j_max", profile.jerk_max, "/s³"),
    ):
        if value is not None:
            yield word, symbol, measured(value, unit + per), at


def _lift(profile: CamProfile, value: float) -> str:
    return degrees(value) if profile.cam.is_oscillating else _mm(value)


def _mm(value: float | None) -> str:
    return measured(value, "m", usual="mm")


def _size_rows(profile: CamProfile) -> Iterator[Row]:
    """Circles, pressure angle, curvature, and what is declared with this table: diameter, width of a face."""
    yield "base circle", "r_0", _mm(profile.base_radius), ""
    if profile.prime_radius > profile.base_radius:
        yield "prime circle", "r_p", _mm(profile.prime_radius), ""
    limit = f"limit {degrees(profile.cam.limit)}"
    steep = f"at θ = {degrees(profile.pressure_angle_max_angle % (2 * math.pi))}, {limit}"
    yield "maximum pressure angle", "γ_max", degrees(profile.pressure_angle_max), steep
    flanks = profile.flanks if profile.cam.closure == "conjugate" else profile.flanks[:1]
    for flank in flanks:
        which = f" of the {flank.contact.name}" if len(flanks) > 1 else ""
        for word, extreme in (("convex", flank.convex), ("concave", flank.concave)):
            if extreme is not None:
                where = f"at θ = {degrees(extreme.angle % (2 * math.pi))}"
                yield f"minimum {word} radius{which}", "ρ_min", _mm(extreme.value), where
    yield from known_rows(profile, "cam", length="mm")


def size_table(sizes: LeastSizes) -> Table:
    """Minimum dimensions of a cam, other parameters fixed."""
    wanted = [
        (sizes.base_radius_sound, "without undercut"),
        (sizes.base_radius_pressure_angle, f"for {degrees(sizes.pressure_angle_limit)} pressure angle"),
    ]
    if sizes.curvature_limit is not None:
        limit = f"for {_mm(sizes.curvature_limit)} radius of curvature"
        wanted.append((sizes.base_radius_curvature, limit))
    rows: list[Row] = [
        ("minimum base circle", "r_0", "any" if value == 0 else _mm(value), what) for value, what in wanted
    ]
    if sizes.roller_radius_max is not None:
        rows.append(("largest roller", "r_r", _mm(sizes.roller_radius_max), "on this pitch curve"))
    title = f"Minimum dimensions of cam {sizes.name}, other parameters fixed"
    return Table(f"cam_{sizes.name}_sizes", title, ("quantity", "", "value", "where"), rows)


def section_table(profile: CamProfile) -> Table:
    """What each section demands of the follower: peak absolute velocity, acceleration and jerk."""
    speed, length = profile.speed, "rad" if profile.cam.is_oscillating else "m"
    rows: list[Row] = []
    for count, section in enumerate(profile.sections, start=1):
        span = f"{degrees(section['start'])} to {degrees(section['end'])}"
        place = f"{count}, θ = {span}, {_law_words(section)}"
        cells: list[str] = []
        for order, name in enumerate(("lift_d1", "lift_d2", "lift_d3"), start=1):
            ends = (f"{name}_max", f"{name}_min")
            end = "max" if abs(section[ends[0]]) >= abs(section[ends[1]]) else "min"
            value, at = section[f"{name}_{end}"], section[f"{name}_{end}_angle"]
            unit = _PER_RAD[order] if speed is None else _PER_SECOND[order]
            cells += [
                measured(value * (1.0 if speed is None else abs(speed) ** order), length + unit),
                degrees(at) if value else "",
            ]
        rows.append((place, "", *cells))
    heads = ("section", "", "velocity", "at θ", "acceleration", "at θ", "jerk", "at θ")
    by = "by the cam angle θ" if speed is None else f"at {quantity(speed, 'rad/s')}"
    title = f"Extremes of the sections of cam {profile.name}, {by}"
    return Table(f"cam_{profile.name}_sections", title, heads, rows)


def _law_words(section: Mapping[str, Any]) -> str:
    return str(section["law"]).replace("_", " ")


# Units of the derivatives of a lift.
_PER_RAD = ("", "/rad", "/rad²", "/rad³")
_PER_SECOND = ("", "/s", "/s²", "/s³")


def joint_table(profile: CamProfile) -> Table:
    """How smoothly the sections of a cam meet."""
    unit = "rad" if profile.cam.is_oscillating else "m"
    rows: list[Row] = [
        (joint.words(unit).replace("-", "−"), "", degrees(joint.angle))
        for joint in profile.cam.programme.joints
    ]
    heads = ("continuity at segment boundaries", "", "cam angle θ")
    return Table(f"cam_{profile.name}_joints", f"Segment boundaries of cam {profile.name}", heads, rows)


def force_table(loaded: LoadedCam) -> Table:
    """Forces on a cam."""
    rows: list[Row] = [
        (f"{word} contact force", symbol, measured(force, "N"), crank_angle(angle, "at φ = "))
        for word, symbol, force, angle in (
            ("maximum", "N_max", loaded.force_max, loaded.force_max_angle),
            ("minimum", "N_min", loaded.force_min, loaded.force_min_angle),
        )
    ]
    if loaded.side_changes:
        rows.append(("contact-side reversals per revolution", "", str(loaded.side_changes), ""))
    if loaded.speed_lost is not None and loaded.speed_lost_angle is not None:
        at = crank_angle(loaded.speed_lost_angle, "at φ = ")
        rows.append(("speed at which contact is lost", "ω_off", measured(loaded.speed_lost, "rad/s"), at))
    if loaded.pressure_max is not None and loaded.pressure_max_angle is not None:
        at = crank_angle(loaded.pressure_max_angle, "at φ = ")
        rows.append(
            ("maximum contact pressure", "p_max", measured(loaded.pressure_max, "Pa", usual="MPa"), at)
        )
    if loaded.shear_max is not None:
        deep = f"{_mm(loaded.shear_depth)} below the surface"
        rows.append(("maximum shear stress", "τ_max", measured(loaded.shear_max, "Pa", usual="MPa"), deep))
    heads = ("quantity", "", "value", "where")
    return Table(
        f"cam_{loaded.name}_force",
        f"Forces on cam {loaded.name} at {quantity(loaded.speed, 'rad/s')}",
        heads,
        rows,
    )


_COLUMNS = {
    "C_v": "C_v",
    "C_a": "C_a",
    "C_j": "C_j",
    "C_M": "C_M",
    "acceleration_squared": "∫a²",
    "jerk_squared": "∫j²",
}

# Those of a cam beside other laws.
_FACTORS = {name: head for name, head in _COLUMNS.items() if name != "acceleration_squared"}


def comparison_table(profile: CamProfile) -> Table:
    """The sections from rest to rest beside what other laws would make of them."""
    laws = dict(_own(profile))
    if laws:
        laws |= {name.replace("_", " "): law_factors(LAWS[name].normalised()) for name in _COMPARED}
    title = f"Laws of cam {profile.name} compared with others, for unit lift and unit length"
    return _factor_table(f"cam_{profile.name}_laws", title, laws, _FACTORS)


def _factor_table(name: str, title: str, laws: Mapping[str, LawFactors], columns: Mapping[str, str]) -> Table:
    rows = [
        (
            law,
            factors.remarks[0].split(" ", 1)[0] if factors.remarks else "",
            *("∞" if (value := getattr(factors, factor)) is None else number(value) for factor in columns),
        )
        for law, factors in laws.items()
    ]
    return Table(name, title, ("law", "jumps", *columns.values()), rows)


def _own(profile: CamProfile) -> Iterator[tuple[str, LawFactors]]:
    law, seen = profile.cam.lift, []
    ends = [joint.angle for joint in profile.cam.programme.joints] + [law.end]
    for n, (low, high) in enumerate(pairwise(ends), start=1):
        stretch = law.stretch(low, high)
        rise = float(stretch.at(high, side="before") - stretch.at(low))
        slopes = abs(float(stretch.at(low, 1))), abs(float(stretch.at(high, 1, "before")))
        if abs(rise) <= _REST * profile.stroke or max(slopes) > _REST * abs(rise) / (high - low):
            continue
        factors = law_factors(stretch)
        key = tuple(number(getattr(factors, factor)) for factor in _FACTORS)
        if key not in seen:
            seen.append(key)
            yield f"section {n} of this cam", factors


def law_table(factors: Mapping[str, LawFactors]) -> Table:
    """Factors of laws, a law a row."""
    laws = {_named(name): law for name, law in factors.items()}
    title = "Motion laws between two dwells, for unit lift and unit length"
    return _factor_table("cam_laws", title, laws, _COLUMNS)


def bound_table() -> Table:
    """Theoretical lower bounds, and which law gets there."""
    rows: list[Row] = [
        (bound.holds_for, _COLUMNS[bound.name], number(bound.value), _named(bound.reached_by))
        for bound in BOUNDS
    ]
    return Table(
        "cam_law_bounds", "Theoretical lower bound", ("for laws with", "factor", "bound", "reached by"), rows
    )


def _named(name: str) -> str:
    order = LAWS[name].parameters.get("order") if name in LAWS else None
    return name if order is None else f"{name}, order {order}"
