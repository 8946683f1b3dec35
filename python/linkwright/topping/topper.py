"""The knife of a topper over the heads of a row: published lengths and exact ones, what is left, how it
slices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.extreme import greatest, least
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.topping.edge import Edge, barely_advances, edges_of, require_topper
from linkwright.topping.knife import KnifeDrive, knife_drive
from linkwright.topping.model.topper import Topper
from linkwright.topping.required_length import constant_speed_lengths, every_phase_length, published_lengths
from linkwright.topping.roots import cap_volume, head_diameter
from linkwright.topping.slicing import edge_use, slicing
from linkwright.topping.worst_head import every_head, unknown_heads

# A share of the head that is rounding: ends of one that is cut all through differ from its rim by as much.
NOTHING = 1e-12


_OBSTACLE = (
    "Why the cut could not be computed. Lengths for the motion of the knife, except that for every phase "
    "of an edge that never retreats, and uncut shares are then NaN."
)


@dataclass(frozen=True)
class TopperStudy(Result):
    """What the knife cuts."""

    phase: Annotated[
        Floats, Label("phase of the knife", "φ", "rad", "When the middle of the edge is abreast of a head.")
    ]
    length_by_phase: Annotated[Floats, Label("required length in a phase", "L", "m", "At the worst offset.")]
    uncut_by_phase: Annotated[
        Floats, Label("uncut share of the head in a phase", "", "", "At the worst offset.")
    ]
    edge_place: Annotated[
        Floats, Label("position along the edge from its middle", "", "m", shape="(k,)", over="edge_place")
    ]
    edge_use: Annotated[
        Floats, Label("mean path through a head", "", "m", "Of each place of the edge.", over="edge_place")
    ]
    head_diameter: Annotated[
        float, Label("diameter of the head", "d", "m", "Of the disc in the plane of the cut.")
    ]
    cap_volume: Annotated[float, Label("volume of the slice", "V", "m³", "Of the root above the cut.")]
    stroke: Annotated[
        float, Label("stroke of the knife", "S", "m", "Zero if it does not turn back over a head.")
    ]
    frequency: Annotated[float, Label("knife frequency", "f", "1/s")]
    knife_speed: Annotated[float, Label("mean speed across the row", "v_h", "m/s", "Over the time.")]
    knife_speed_max: Annotated[float, Label("maximum speed across the row", "ẏ_max", "m/s")]
    knife_acceleration_max: Annotated[
        float,
        Label(
            "maximum acceleration of the knife", "ÿ_max", "m/s²", "Infinite at constant speed back and forth."
        ),
    ]
    strokes_per_head: Annotated[
        float, Label("strokes over a head", "", "", "While the edge passes a head on the row.")
    ]
    travel_along: Annotated[float, Label("travel along the row", "S_x", "m", "Of the paper, with Δ.")]
    travel_across: Annotated[float, Label("travel across the row", "S_y", "m", "Of the paper, with Δ.")]
    time_along: Annotated[
        float, Label("time of the travel along the row", "t_x", "s", "Of the paper, with Δ.")
    ]
    time_across: Annotated[
        float,
        Label(
            "time of the travel across the row",
            "t_y",
            "s",
            "Of the paper, with Δ; infinite for a knife at rest.",
        ),
    ]
    condition_holds: Annotated[bool, About("Whether t_y ≥ t_x, the paper's (1).")]
    length_published: Annotated[float, Label("minimum length by the paper's (10)", "", "m")]
    length_consistent: Annotated[float, Label("minimum length that follows from the paper's (4)", "", "m")]
    length_at_rest: Annotated[
        float, Label("minimum length of an edge that does not move across the row", "", "m")
    ]
    length_exact_constant_speed: Annotated[
        float,
        Label(
            "minimum length for a knife that keeps its mean speed over the head",
            "",
            "m",
            "The worse of both directions.",
        ),
    ]
    length_exact: Annotated[
        float,
        Label(
            "minimum length for the motion of the knife",
            "L",
            "m",
            "At the worst offset, in the worst phase or the given one.",
        ),
    ]
    worst_phase: Annotated[float, Label("phase of the head with the maximum required length", "", "rad")]
    worst_offset: Annotated[float, Label("offset of the head with the maximum required length", "", "m")]
    last_x: Annotated[float, Label("x of the point of that head cut last", "", "m", "From its centre.")]
    last_y: Annotated[float, Label("y of the point of that head cut last", "", "m", "From its centre.")]
    length_best_phase: Annotated[float, Label("required length in the best phase", "", "m")]
    best_phase: Annotated[float, Label("phase of the minimum required length", "", "rad")]
    uncut_share: Annotated[float, Label("maximum uncut share of a head", "", "")]
    uncut_phase: Annotated[float, Label("phase of the head with the maximum uncut share", "", "rad")]
    uncut_offset: Annotated[float, Label("offset of the head with the maximum uncut share", "", "m")]
    uncut_right: Annotated[float, Label("uncut share of that head beyond the right end", "", "")]
    uncut_left: Annotated[float, Label("uncut share of that head beyond the left end", "", "")]
    uncut_between: Annotated[float, Label("uncut share of that head between two passes", "", "")]
    uncut_share_mean: Annotated[
        float,
        Label("mean uncut share of a head", "", "", "Over phases and offsets, both even."),
    ]
    edge_retreats: Annotated[bool, About("Whether the edge runs backwards at times.")]
    least_advance: Annotated[float, Label("minimum advance normal to the edge", "u_n,min", "m/s")]
    slicing_ratio_min: Annotated[
        float, Label("minimum draw-cut ratio", "", "", "Speed along the edge over speed normal to it.")
    ]
    slicing_ratio_mean: Annotated[float, Label("mean draw-cut ratio", "", "", "Over what is cut.")]
    slicing_ratio_max: Annotated[float, Label("maximum draw-cut ratio", "", "")]
    cutting_speed_min: Annotated[
        float, Label("minimum cutting speed", "", "m/s", "Speed of the edge against the head.")
    ]
    cutting_speed_max: Annotated[
        float, Label("maximum cutting speed", "", "m/s", "Speed of the edge against the head.")
    ]
    knife_mass: Annotated[
        float | None,
        Label(
            "mass of the knife",
            "m",
            "kg",
            "Of the bodies on it, where a mechanism moves it.",
            table="topper_drive",
        ),
    ]
    inertia_force_max: Annotated[
        float | None, Label("maximum inertia force of the knife", "m ÿ_max", "N", table="topper_drive")
    ]
    drive_torque_max: Annotated[
        float | None,
        Label(
            "maximum driving torque",
            "M_max",
            "N m",
            "At the crank, at the design speed.",
            table="topper_drive",
        ),
    ]
    drive_torque_min: Annotated[
        float | None,
        Label(
            "minimum driving torque",
            "M_min",
            "N m",
            "At the crank, at the design speed.",
            table="topper_drive",
        ),
    ]
    drive_torque_mean: Annotated[
        float | None,
        Label(
            "mean driving torque", "M_mean", "N m", "At the crank, at the design speed.", table="topper_drive"
        ),
    ]
    drive_power_mean: Annotated[
        float | None,
        Label("mean power", "P_mean", "W", "At the crank, at the design speed.", table="topper_drive"),
    ]
    obstacle: Annotated[str | None, About(_OBSTACLE)]


@public
def topper(machine: Machine, *, charts: bool = True) -> TopperStudy:
    """Study the knife of a topper.

    Parameters
    ----------
    machine : Machine
        A machine with a topper.
    charts : bool
        Whether to follow all phases for their curves and for the mean that is left; else these are NaN, and
        so is what is left where the edge is long enough.

    Returns
    -------
    TopperStudy
        Lengths, what is left, how it slices.

    Raises
    ------
    InputError
        The machine has no topper.
    AssemblyError
        The mechanism of the knife does not close all round.
    FindingError
        The member that is the knife does not come back with each revolution.

    References
    ----------
    .. [1] Paper 5 for the published lengths; the exact ones are derived in the modules beside this.
    """
    described = require_topper(machine)
    edges = edges_of(machine, described)
    numbers: dict[str, Any] = {name: float(number) for name, number in closed_forms(described, edges).items()}
    d = numbers["head_diameter"]
    place, use = edge_use(edges, d, described.offset)
    reasons = [barely_advances(edge, d, described.offset) for edge in edges]
    obstacle = next((reason for reason in reasons if reason), None)
    cut = _closed(described, edges[0], d) if obstacle else every_head(described, edges, d, charts=charts)
    return TopperStudy(
        **numbers,
        condition_holds=numbers["time_across"] >= numbers["time_along"],
        edge_place=place,
        edge_use=use,
        edge_retreats=any(edge.retreats for edge in edges),
        obstacle=obstacle,
        **cut,
        **_driven(knife_drive(machine, edges[0].knife)),
    )


def leaves(study: TopperStudy) -> bool:
    """Whether a head is not cut completely."""
    return study.uncut_share > NOTHING


def _closed(described: Topper, edge: Edge, d: float) -> dict[str, Any]:
    """What is known without following the edge: the length for every phase, if it never retreats."""
    cut = unknown_heads()
    if described.motion.phase is None and not edge.retreats:
        needed = every_phase_length(d, described.offset, edge.angle, edge.knife.stroke)
        cut["length_exact"] = float(needed)
    return cut


def closed_forms(described: Topper, edges: Sequence[Edge]) -> dict[str, Any]:
    """Scalars in closed form, with derivatives if the description and the edges have some."""
    d = head_diameter(described.root_diameter, described.cut_height)
    head = {"head_diameter": d, "cap_volume": cap_volume(described.root_diameter, described.cut_height)}
    return head | _knife(edges[0], d) | _lengths(described, edges[0], d) | _slices(edges)


def _knife(edge: Edge, d: Any) -> dict[str, Any]:
    knife = edge.knife
    passing = d / (edge.forward_speed * np.cos(edge.angle))
    return {
        "stroke": knife.stroke,
        "frequency": knife.frequency,
        "knife_speed": knife.mean_speed,
        "knife_speed_max": knife.speed_max,
        "knife_acceleration_max": knife.acceleration_max,
        "strokes_per_head": 2 * knife.frequency * passing,
    }


def _lengths(described: Topper, edge: Edge, d: Any) -> dict[str, Any]:
    alpha, v, v_h = described.edge_angle, described.forward_speed, edge.knife.mean_speed
    band = d + 2 * described.offset
    published = published_lengths(band, alpha, described.edge_length, v, v_h)
    steady = constant_speed_lengths(d, described.offset, alpha, v, v_h)
    return {
        "travel_along": published.travel_along,
        "travel_across": published.travel_across,
        "time_along": published.time_along,
        "time_across": published.time_across,
        "length_published": published.length_published,
        "length_consistent": published.length_consistent,
        # One without a stroke.
        "length_at_rest": every_phase_length(d, described.offset, alpha, 0.0),
        "length_exact_constant_speed": greatest(*steady),
    }


def _slices(edges: Sequence[Edge]) -> dict[str, Any]:
    sliced = slicing(edges)
    return {
        "least_advance": least(*(edge.least_advance for edge in edges)),
        "slicing_ratio_min": sliced.ratio_min,
        "slicing_ratio_mean": sliced.ratio_mean,
        "slicing_ratio_max": sliced.ratio_max,
        "cutting_speed_min": sliced.speed_min,
        "cutting_speed_max": sliced.speed_max,
    }


def _driven(drive: KnifeDrive | None) -> dict[str, Any]:
    return {
        "knife_mass": drive and drive.mass,
        "inertia_force_max": drive and drive.inertia_force_max,
        "drive_torque_max": drive and drive.torque_max,
        "drive_torque_min": drive and drive.torque_min,
        "drive_torque_mean": drive and drive.torque_mean,
        "drive_power_mean": drive and drive.power_mean,
    }
