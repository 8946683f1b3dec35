"""Entries with which a machine fails its checks: overloads, stalls, lost contact, undercut, resonance."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator
from typing import Any

# Entries of machine files by their addresses, and by what they are multiplied: what then comes about.
PROVOKED = {
    "an overload": (r"loads\..*\.(force|torque|damping|damping_torsional)", 300),
    "a force against the motion": (r"loads\..*\.(force|torque|direction)", -1),
    "a weak spring": (r"loads\..*\.(stiffness|preload|free_length)", 0.1),
    "a weak motor": (r"drive\.motor\.(power_rated|torque|torque_rated|torque_stall)", 0.02),
    "a strong motor": (r"drive\.motor\.(power_rated|torque|torque_rated|torque_stall)", 30),
    "a low breakdown torque": (r"drive\.motor\.torque_\w+", 0.5),
    "a wrong ratio": (r"drive\.gearbox\.(ratio|efficiency)", 0.3),
    "a speed beyond the design": (r"drive\.speed", 12),
    "links that do not meet": (
        r"mechanism\.(sliders|rockers|bars|cranks)\..*\.(rod|coupler|length|radius)",
        0.3,
    ),
    "links that lock": (r"mechanism\.(sliders|rockers|bars|cranks)\..*\.(rod|rocker|length|radius)", 3),
    "another place": (r"mechanism\.(points|joints|rigid_points|yokes)\..*\.(x|y|along|across|offset)", 3),
    "an undercut cam": (r"mechanism\.cams\..*\.(base_radius|breadth|roller_radius)", 0.25),
    "a thick roller": (r"mechanism\.cams\..*\.(roller_radius|cutter_radius|face_tilt)", 4),
    "a steep cam": (r"mechanism\.cams\..*\.sections\.\d+\.(lift|swing)", 3),
    "a cam held badly": (r"(mechanism\.cams|bodies)\..*\.(mass|inertia|sliding_friction|preload)", 200),
    "a narrow limit": (r".*(limit|permitted|curvature_limit|tensile_strength)\w*", 0.02),
    "a train out of tune": (r"train\.(shafts|couplings|gears)\..*\.(stiffness|diameter)", 0.2),
    "a heavy disc": (r"train\.discs\..*\.inertia", 20),
    "no damping": (r"train\..*\.(damping|loss_factor|ratio)\w*", 0.001),
    "speeds up to a resonance": (r"train\.run\.speed_\w+", 3),
    "an engine overcharged": (
        r"train\.engine\.(gas|.*)\.?(heat|charge_pressure|bore|mean_effective_pressure)",
        3,
    ),
    "a rough manoeuvre": (r"train\.transient\.(.*\.)?(torque|duration|amplitude|speed|start)", 5),
    "a small flywheel": (r"(turning_moment|drive\.flywheel)\.(.*\.)?(inertia|unevenness|radius|areas)", 0.01),
    "a short edge": (r"topper\.(edge_length|stroke|cut_height)", 0.4),
    "an edge that runs backwards": (r"topper\.(edge_angle|knife_speed|root_diameter|offset)", 4),
    "a unit beyond its gear": (r"pumping_unit\.(load\..*|structural_unbalance|[ACGHIPR])", 3),
    "a rotator that cannot turn": (r"rod_rotator\.\w+", 2.5),
    "an end too early": (r"run_up\.\w+", 0.02),
}

_QUANTITY = re.compile(r"([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)( [A-Za-z°%].*)")


def _entries(node: Any, place: tuple[str, ...] = ()) -> Iterator[tuple[str, Any]]:
    """Numbers and quantities of a machine file by their addresses."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    is_number = isinstance(node, (int, float)) and not isinstance(node, bool)
    if is_number or (isinstance(node, str) and _QUANTITY.fullmatch(node)):
        yield ".".join(place), node
    for key, inner in items:
        name = str(key) if re.fullmatch(r"[\w-]+", str(key)) else f'"{key}"'
        yield from _entries(inner, (*place, name))


def _times(value: Any, factor: float) -> str:
    if isinstance(value, str):
        number, unit = _QUANTITY.fullmatch(value).groups()  # type: ignore[union-attr]
        return f'"{float(number) * factor:g}{unit}"'
    return str(round(value * factor)) if isinstance(value, int) else repr(value * factor)


def provoked(tables: dict[str, Any]) -> Iterator[tuple[str, list[str]]]:
    entries = list(_entries({key: value for key, value in tables.items() if key not in ("format", "study")}))
    for what, (pattern, factor) in PROVOKED.items():
        found = [(at, value) for at, value in entries if re.fullmatch(pattern, at.replace('"', ""))]
        if found:
            yield what, [f"{at}={_times(value, factor)}" for at, value in found]
            yield f"{what} at one place", [f"{found[0][0]}={_times(found[0][1], factor)}"]


def shaken(tables: dict[str, Any], seed: int, n: int) -> Iterator[list[str]]:
    entries = [entry for entry in _entries(tables) if not entry[0].startswith(("format", "study", "units"))]
    chance = random.Random(seed)
    for _ in range(n if entries else 0):
        at, value = chance.choice(entries)
        yield [f"{at}={_times(value, chance.choice([0.01, 0.1, 0.3, 0.6, 1.5, 3, 10, 100, -1]))}"]
