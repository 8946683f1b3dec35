"""The knife of a topper over the heads of a row: published lengths and exact ones, what is left, how it
slices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.public import public
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.topping.constant_speed import constant_speed_lengths
from linkwright.topping.edge import Edge, edges_of, hardly_goes_on, require_topper
from linkwright.topping.every_head import every_head, unknown_heads
from linkwright.topping.every_phase import every_phase_length
from linkwright.topping.head import cap_volume, head_diameter
from linkwright.topping.knife_drive import KnifeDrive, knife_drive
from linkwright.topping.model.topper import Topper
from linkwright.topping.published import published_lengths
from linkwright.topping.slicing import edge_use, slicing

Floats = NDArray[np.float64]

# A share of the head that is rounding: ends of one that is cut all through differ from its rim by as much.
NOTHING = 1e-12


@dataclass(frozen=True)
class TopperStudy(Result):
    """What the knife cuts.

    Attributes
    ----------
    phase : ndarray, shape (n,)
        Phase of the knife when the middle of the edge is abreast of a head [rad].
    length_by_phase : ndarray, shape (n,)
        Length that heads in this phase need, at the worst offset [m].
    uncut_by_phase : ndarray, shape (n,)
        Share of the head that is left in this phase, at the worst offset [–].
    edge_place, edge_use : ndarray, shape (k,)
        Places along the edge from its middle, and the way each goes through a head on average [m].
    head_diameter : float
        d of the disc that is cut [m].
    cap_volume : float
        Volume of the root above the cut [m³].
    stroke : float
        Of the knife [m]; zero if it does not turn back over a head.
    frequency : float
        Turns of its phase in a second [1/s].
    knife_speed, knife_speed_max : float
        v_h, mean over the time, and greatest speed across the row [m/s].
    knife_acceleration_max : float
        Greatest acceleration across the row [m/s²]; infinite at constant speed to and fro.
    strokes_per_head : float
        Strokes while the edge passes a head on the row [–].
    travel_along, travel_across, time_along, time_across : float
        S_x, S_y [m], t_x, t_y [s] of the paper, with Δ.
    condition_holds : bool
        Whether t_y ≥ t_x, the paper's (1).
    length_published : float
        Least length by the paper's (10) [m].
    length_consistent : float
        Least length that follows from the paper's (4) [m].
    length_at_rest : float
        Least length of an edge that does not move across the row [m].
    length_exact_constant_speed : float
        Least length for a knife that keeps its mean speed over the head, the worse of both directions [m].
    length_exact : float
        Least length for the motion of the knife: at the worst offset, in the worst phase or the given one
        [m].
    worst_phase, worst_offset : float
        Of the head that needs it [rad, m].
    last_x, last_y : float
        The point of that head that is reached last, from its centre [m].
    length_best_phase, best_phase : float
        Length that heads in the best phase need [m], and that phase [rad].
    uncut_share : float
        Greatest share of a head that the edge leaves [–].
    uncut_phase, uncut_offset : float
        Of that head [rad, m].
    uncut_right, uncut_left, uncut_between : float
        Share that is left there on the right of the edge, on its left, and between two passes [–].
    uncut_share_mean : float
        Mean over phases and offsets, both even [–].
    edge_retreats : bool
        Whether the edge runs backwards at times.
    least_advance : float
        Least speed of the edge along its normal [m/s].
    slicing_ratio_min, slicing_ratio_mean, slicing_ratio_max : float
        Draw-cut ratio: speed along the edge over speed normal to it [–].
    cutting_speed_min, cutting_speed_max : float
        Speed of the edge against the head [m/s].
    knife_mass, inertia_force_max : float or None
        Of the bodies on the knife [kg], and greatest inertia force [N], where a mechanism moves it.
    drive_torque_max, drive_torque_min, drive_torque_mean, drive_power_mean : float or None
        At the crank, at the design speed [N m, W].
    obstacle : str or None
        Why what is cut could not be computed: lengths for the motion of the knife, but for that in every
        phase of an edge that never retreats, and shares that are left are then NaN.
    """

    phase: Floats
    length_by_phase: Floats
    uncut_by_phase: Floats
    edge_place: Floats
    edge_use: Floats
    head_diameter: float
    cap_volume: float
    stroke: float
    frequency: float
    knife_speed: float
    knife_speed_max: float
    knife_acceleration_max: float
    strokes_per_head: float
    travel_along: float
    travel_across: float
    time_along: float
    time_across: float
    condition_holds: bool
    length_published: float
    length_consistent: float
    length_at_rest: float
    length_exact_constant_speed: float
    length_exact: float
    worst_phase: float
    worst_offset: float
    last_x: float
    last_y: float
    length_best_phase: float
    best_phase: float
    uncut_share: float
    uncut_phase: float
    uncut_offset: float
    uncut_right: float
    uncut_left: float
    uncut_between: float
    uncut_share_mean: float
    edge_retreats: bool
    least_advance: float
    slicing_ratio_min: float
    slicing_ratio_mean: float
    slicing_ratio_max: float
    cutting_speed_min: float
    cutting_speed_max: float
    knife_mass: float | None
    inertia_force_max: float | None
    drive_torque_max: float | None
    drive_torque_min: float | None
    drive_torque_mean: float | None
    drive_power_mean: float | None
    obstacle: str | None


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
        The member that is the knife does not come back with each turn.

    References
    ----------
    .. [1] Paper 5 for the published lengths; the exact ones are derived in the modules beside this.
    """
    described = require_topper(machine)
    d = float(head_diameter(described.root_diameter, described.cut_height))
    edges = edges_of(machine, described)
    reasons = [hardly_goes_on(edge, d, described.offset) for edge in edges]
    obstacle = next((each for each in reasons if each), None)
    cut = _closed(described, edges[0], d) if obstacle else every_head(described, edges, d, charts=charts)
    return TopperStudy(
        head_diameter=d,
        cap_volume=float(cap_volume(described.root_diameter, described.cut_height)),
        **_knife(edges[0], d),
        **_lengths(described, edges[0], d),
        obstacle=obstacle,
        **cut,
        **_slices(described, edges, d),
        **_driven(knife_drive(machine, edges[0].knife)),
    )


def leaves(found: TopperStudy) -> bool:
    """Whether anything is left of a head.

    Parameters
    ----------
    found : TopperStudy
        The study.

    Returns
    -------
    bool
        False for a share that is rounding, and for one that could not be computed.
    """
    return found.uncut_share > NOTHING


def _closed(described: Topper, edge: Edge, d: float) -> dict[str, Any]:
    """What is known without following the edge: the length for every phase, if it never retreats."""
    cut = unknown_heads()
    if described.motion.phase is None and not edge.retreats:
        needed = every_phase_length(d, described.offset, edge.angle, edge.knife.stroke)
        cut["length_exact"] = float(needed)
    return cut


def _knife(edge: Edge, d: float) -> dict[str, Any]:
    """How the knife moves."""
    knife = edge.knife
    passing = d / (edge.forward_speed * np.cos(edge.angle))
    return {
        "stroke": knife.stroke,
        "frequency": knife.frequency,
        "knife_speed": knife.mean_speed,
        "knife_speed_max": knife.speed_max,
        "knife_acceleration_max": knife.acceleration_max,
        "strokes_per_head": float(2 * knife.frequency * passing),
    }


def _lengths(described: Topper, edge: Edge, d: float) -> dict[str, Any]:
    """Lengths in closed form."""
    alpha, v, v_h = described.edge_angle, described.forward_speed, edge.knife.mean_speed
    band = d + 2 * described.offset
    published = published_lengths(band, alpha, described.edge_length, v, v_h)
    steady = constant_speed_lengths(d, described.offset, alpha, v, [0.0, v_h])
    return {
        "travel_along": published.travel_along,
        "travel_across": published.travel_across,
        "time_along": published.time_along,
        "time_across": published.time_across,
        "condition_holds": published.holds,
        "length_published": published.length_published,
        "length_consistent": published.length_consistent,
        "length_at_rest": float(steady[0, 0]),
        "length_exact_constant_speed": float(steady[:, 1].max()),
    }


def _slices(described: Topper, edges: list[Edge], d: float) -> dict[str, Any]:
    """How the edge slices."""
    found = slicing(edges)
    place, use = edge_use(edges, d, described.offset)
    return {
        "edge_place": place,
        "edge_use": use,
        "edge_retreats": any(edge.retreats for edge in edges),
        "least_advance": min(edge.least_advance for edge in edges),
        "slicing_ratio_min": found.ratio_min,
        "slicing_ratio_mean": found.ratio_mean,
        "slicing_ratio_max": found.ratio_max,
        "cutting_speed_min": found.speed_min,
        "cutting_speed_max": found.speed_max,
    }


def _driven(drive: KnifeDrive | None) -> dict[str, Any]:
    """What it takes to move the knife."""
    return {
        "knife_mass": drive and drive.mass,
        "inertia_force_max": drive and drive.inertia_force_max,
        "drive_torque_max": drive and drive.torque_max,
        "drive_torque_min": drive and drive.torque_min,
        "drive_torque_mean": drive and drive.torque_mean,
        "drive_power_mean": drive and drive.power_mean,
    }
