"""The knife of a topper over the heads of a row: published lengths and exact ones, what is left, how it
slices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.result import Result
from linkwright.analysis.topper.constant_speed import constant_speed_lengths
from linkwright.analysis.topper.coverage import SPARING, Edge, coverage, hardly_goes_on, worst_head
from linkwright.analysis.topper.head import cap_volume, head_diameter
from linkwright.analysis.topper.knife import knives
from linkwright.analysis.topper.knife_drive import KnifeDrive, knife_drive
from linkwright.analysis.topper.published import published_lengths
from linkwright.analysis.topper.slicing import edge_use, slicing
from linkwright.errors import InputError
from linkwright.machine import Machine, Topper

Floats = NDArray[np.float64]

# Phases of the curves, and offsets at which the worst is looked for.
_PHASES, _OFFSETS = 180, 9

# Phases and offsets of the mean, amid even steps so that all count alike: it is good to three digits, of an
# edge that retreats to two.
_MEAN_PHASES, _MEAN_OFFSETS = 90, 41


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
        Why what is cut could not be computed: lengths for the motion of the knife and shares that are left
        are then NaN.
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


def topper(machine: Machine) -> TopperStudy:
    """Study the knife of a topper.

    Parameters
    ----------
    machine : Machine
        A machine with a topper.

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

    References
    ----------
    .. [1] Paper 5 for the published lengths; the exact ones are derived in the modules beside this.
    """
    described = machine.topper
    if described is None:
        raise InputError(f"{machine.name} has no [topper]: expected one")
    d = float(head_diameter(described.root_diameter, described.cut_height))
    edges = edges_of(machine, described)
    reasons = [hardly_goes_on(edge, d, described.offset) for edge in edges]
    obstacle = next((each for each in reasons if each), None)
    cut = _unknown() if obstacle else _cut(described, edges, d)
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


def edges_of(machine: Machine, described: Topper) -> list[Edge]:
    """The edge of a topper; in both directions if its knife does not turn back over a head.

    Parameters
    ----------
    machine : Machine
        What may move the knife.
    described : Topper
        The topper.

    Returns
    -------
    list of Edge
        One or two.

    Raises
    ------
    AssemblyError
        The mechanism of the knife does not close all round.
    """
    ways = knives(machine, described)
    return [Edge(way, described.edge_angle, described.forward_speed) for way in ways]


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


def _cut(described: Topper, edges: list[Edge], d: float) -> dict[str, Any]:
    """What heads need, and what is left of them."""
    return _needed(described, edges, d) | _left(described, edges, d) | _by_phase(described, edges, d)


def _unknown() -> dict[str, Any]:
    """The same of an edge that cannot be followed."""
    scalars = ("length_exact", "worst_phase", "worst_offset", "last_x", "last_y", "length_best_phase")
    left = ("uncut_share", "uncut_phase", "uncut_offset", "uncut_right", "uncut_left", "uncut_between")
    nothing = np.full(_PHASES + 1, np.nan)
    curves = {"length_by_phase": nothing, "uncut_by_phase": nothing}
    numbers = dict.fromkeys((*scalars, *left, "best_phase", "uncut_share_mean"), float("nan"))
    return {"phase": np.linspace(0.0, 2 * np.pi, _PHASES + 1)} | curves | numbers


def _needed(described: Topper, edges: list[Edge], d: float) -> dict[str, Any]:
    """The head that needs most, and the phase that needs least."""
    phase = described.motion.phase

    def needs(edge: Edge, offset: Floats, angle: Floats) -> Floats:
        return coverage(edge, d, offset, angle).length_needed

    worst = worst_head(edges, d, described.offset, phase, needs)
    there = coverage(worst.edge, d, worst.offset, worst.phase)
    return {
        "length_exact": worst.value,
        "worst_phase": worst.phase,
        "worst_offset": worst.offset,
        "last_x": float(there.last_x[0]),
        "last_y": float(there.last_y[0]),
    }


def _left(described: Topper, edges: list[Edge], d: float) -> dict[str, Any]:
    """The head of which most is left, and the mean."""
    area, length = 0.25 * np.pi * d**2, described.edge_length

    def left(edge: Edge, offset: Floats, angle: Floats) -> Floats:
        return coverage(edge, d, offset, angle, length=length).uncut / area

    worst = worst_head(edges, d, described.offset, described.motion.phase, left)
    there = coverage(worst.edge, d, worst.offset, worst.phase, length=length)
    return {
        # All of it, but for rounding.
        "uncut_share": min(worst.value, 1.0),
        "uncut_phase": worst.phase,
        "uncut_offset": worst.offset,
        "uncut_right": float(there.uncut_right[0] / area),
        "uncut_left": float(there.uncut_left[0] / area),
        "uncut_between": float(there.uncut_between[0] / area),
    }


def _by_phase(described: Topper, edges: list[Edge], d: float) -> dict[str, Any]:
    """What each phase needs and leaves, at its worst offset."""
    phases = np.linspace(0.0, 2 * np.pi, _PHASES + 1)
    n_offsets = _OFFSETS // SPARING + 1 if any(edge.retreats for edge in edges) else _OFFSETS
    offsets = np.linspace(-described.offset, described.offset, n_offsets if described.offset else 1)
    phi, delta = np.meshgrid(phases, offsets, indexing="ij")
    length = described.edge_length
    found = [coverage(edge, d, delta.ravel(), phi.ravel(), length=length) for edge in edges]
    needed = np.stack([each.length_needed.reshape(phi.shape) for each in found])
    left = np.stack([each.uncut.reshape(phi.shape) for each in found]) / (0.25 * np.pi * d**2)
    by_phase = needed.max(axis=(0, 2))
    best = int(np.argmin(by_phase))
    return {
        "phase": phases,
        "length_by_phase": by_phase,
        "uncut_by_phase": left.max(axis=(0, 2)),
        "length_best_phase": float(by_phase[best]),
        "best_phase": float(phases[best]),
        "uncut_share_mean": _mean_left(described, edges, d),
    }


def _mean_left(described: Topper, edges: list[Edge], d: float) -> float:
    """Mean share that is left, over offsets, over directions, and over phases if none is given."""
    offset, phase = described.offset, described.motion.phase
    sparing = SPARING if any(edge.retreats for edge in edges) else 1
    offsets = offset * _amid(_MEAN_OFFSETS // sparing) if offset else np.zeros(1)
    moves = phase is None and any(edge.knife.rate for edge in edges)
    phases = np.pi * (1 + _amid(_MEAN_PHASES // sparing)) if moves else np.array([phase or 0.0])
    phi, delta = (each.ravel() for each in np.meshgrid(phases, offsets))
    left = [coverage(edge, d, delta, phi, length=described.edge_length).uncut for edge in edges]
    return float(np.mean(left) / (0.25 * np.pi * d**2))


def _amid(n: int) -> Floats:
    """Middles of even steps from −1 to 1, (n,)."""
    return np.asarray((2 * np.arange(n) + 1) / n - 1, dtype=np.float64)


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
