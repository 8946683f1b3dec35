"""Findings and warnings on a topper and on its field: sentences with numbers.

What a topper cannot do, what speaks against it over its field, and what its user should know; whether an edge
is long enough, seen at few heads, as a check asks.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.machine.machine import Machine
from linkwright.topping.coverage import coverage
from linkwright.topping.edge import Edge, barely_advances, edges_of
from linkwright.topping.field import TopperField
from linkwright.topping.knife import Knife
from linkwright.topping.model.field import RandomField
from linkwright.topping.model.topper import Topper
from linkwright.topping.roots import head_diameter
from linkwright.topping.topper import NOTHING, TopperStudy, leaves, topper

# Lengths that differ by less than this share are the same: rounding of their formulas.
_SAME = 1e-12


def topper_findings(described: Topper, study: TopperStudy) -> Iterator[str]:
    """What the knife does not do."""
    length = described.edge_length
    if study.obstacle:
        yield study.obstacle
    elif not np.isfinite(study.length_exact):
        yield "The edge moves along itself and cuts nothing: no length is enough."
    elif study.length_exact > length * (1 + _SAME) and leaves(study):
        yield (
            f"The edge of {length:.6g} m does not cut through every head: it leaves up to "
            f"{100 * study.uncut_share:.3g} % of {_head(study)}; it needs {study.length_exact:.6g} m."
        )


def _head(study: TopperStudy) -> str:
    place, side = abs(study.uncut_offset), "left" if study.uncut_offset > 0 else "right"
    where = f"a head {place:.4g} m to the {side} of the row" if place else "a head on the row"
    return f"{where}, at the phase {round(np.degrees(study.uncut_phase), 3):.6g}°" if study.stroke else where


def topper_warnings(described: Topper, study: TopperStudy) -> Iterator[str]:
    """What should be known although every head is cut."""
    if described.cut_height > 0.5 * described.root_diameter:
        yield (
            f"The cut passes below the middle of the root, {described.cut_height:.4g} m below its top: the "
            "head is narrower there than the root above it."
        )
    if study.edge_retreats:
        speed = -study.least_advance
        yield (
            f"The edge runs backwards at times, by up to {speed:.4g} m/s along its normal: there its back "
            "meets the head; reduce the edge angle or the knife speed."
        )


# Phases of a row that count as few, how far they may wander along it [turns], and roots that share each at
# minimum.
_FEW, _WANDER, _SHARING = 4, 0.25, 4


def field_findings(field: TopperField, topper: Topper) -> Iterator[str]:
    """Limits of the machine file that are not kept; without any in the file, none."""
    if "limits" not in topper.model_fields_set:
        return
    limits = topper.limits
    if field.share_complete < limits.complete_min:
        least = field.length_at(limits.complete_min)
        remedy = f"; {least:.4g} m suffices" if least < float("inf") else ""
        yield (
            f"{100 * field.share_complete:.4g} % of the heads are cut through; "
            f"{100 * limits.complete_min:.4g} % are required{remedy}."
        )
    if limits.haulm_max is not None and field.haulm_mean > limits.haulm_max:
        yield (
            f"{100 * field.haulm_mean:.3g} % of the head is left uncut on average; "
            f"{100 * limits.haulm_max:.3g} % is permitted."
        )
    if limits.slicing_min is not None and field.slicing_ratio_mean < limits.slicing_min:
        yield (
            f"The mean draw-cut ratio is {field.slicing_ratio_mean:.4g}; "
            f"{limits.slicing_min:.4g} is required."
        )
    if limits.length_max is not None and field.edge_length > limits.length_max:
        yield f"The edge is {field.edge_length:.4g} m long; {limits.length_max:.4g} m is permitted."


def field_warnings(field: TopperField, topper: Topper, knife: Knife) -> Iterator[str]:
    """What the designer should know of a field."""
    if topper.field is None:
        yield "There is no [topper.field]: all roots are alike, their axes even within the offset."
    if field.n_missed:
        share = 100 * field.n_missed / field.n_roots
        yield f"The knife passes above {share:.3g} % of the heads: no length of the edge cuts them."
    if field.n_lost:
        share = 100 * field.n_lost / field.n_roots
        yield f"The cut passes below {share:.3g} % of the roots, which are lost as a whole."
    if isinstance(topper.field, RandomField):
        yield from _locked(topper.field, topper.forward_speed, knife)


def _locked(field: RandomField, forward_speed: float, knife: Knife) -> Iterator[str]:
    spacing = field.spacing
    if spacing is None or not spacing.is_constant or not knife.rate:
        return
    turns = spacing.ends[0] * knife.frequency / forward_speed
    in_row = field.roots / field.rows
    for phases in range(1, _FEW + 1):
        drift = abs(phases * turns - round(phases * turns)) / phases
        if drift * in_row <= _WANDER and in_row >= _SHARING * phases:
            met = "in one phase" if phases == 1 else f"in no more than {phases} phases"
            yield (
                f"The knife makes {turns:.5g} cycles from root to root: roots of a row meet it {met}, and "
                "rows differ the more. Take the result of many rows, or let spacing scatter."
            )
            return


# Heads that are examined: phases, and offsets with both ends.
_PHASES, _OFFSETS = 24, 3

# Share of a head that is certainly left: far above rounding.
_LEFT = 1e3 * NOTHING


def knife_look(machine: Machine, described: Topper) -> Iterator[str]:
    """What a knife fails to do, as sentences, if the study finds any; all heads if a few do not decide."""
    d = float(head_diameter(described.root_diameter, described.cut_height))
    edges = edges_of(machine, described)
    if not any(barely_advances(edge, d, described.offset) for edge in edges):
        looks = [_look(described, edge, d) for edge in edges]
        needed, left = max(looks)[0], max(look[1] for look in looks)
        if left > _LEFT and np.isfinite(needed):
            yield (
                f"The edge of {described.edge_length:.6g} m does not cut through every head: some need "
                f"{needed:.4g} m or more; `linkwright run` gives the length required for all heads."
            )
            return
        if all(needed + room < described.edge_length for needed, _, room in looks):
            return
    yield from topper_findings(described, topper(machine, charts=False))


def _look(described: Topper, edge: Edge, d: float) -> tuple[float, float, float]:
    """Length needed at most [m], the share left there, and what heads in between may need more [m]."""
    knife = edge.knife
    given = described.motion.phase
    n = _PHASES if knife.rate and given is None else 1
    phases = np.linspace(0.0, 2 * np.pi, n, endpoint=False) if given is None else np.array([given])
    offsets = np.linspace(-described.offset, described.offset, _OFFSETS if described.offset else 1)
    phi, delta = (values.ravel() for values in np.meshgrid(phases, offsets))
    needed = coverage(edge, d, delta, phi).length_needed
    worst = slice(k := int(np.argmax(needed)), k + 1)
    there = coverage(edge, d, delta[worst], phi[worst], length=described.edge_length)
    left = float(there.uncut[0] / (0.25 * np.pi * d**2))
    moved = knife.speed_max / knife.rate * np.pi / n if n > 1 else 0.0
    beside = described.offset / (_OFFSETS - 1) if described.offset else 0.0
    return float(needed[k]), left, 2 * (moved + beside) * _along(edge)


def _along(edge: Edge) -> float:
    """Farthest that the place of a cut moves along the edge when the knife is moved by one across the row."""
    if edge.retreats:
        return np.inf
    # The point lies farther along by cos α, and is met later or earlier by sin α over the advance.
    along = edge.forward_speed * abs(np.sin(edge.angle)) + edge.knife.speed_max * np.cos(edge.angle)
    return float(np.cos(edge.angle) + abs(np.sin(edge.angle)) * along / edge.least_advance)
