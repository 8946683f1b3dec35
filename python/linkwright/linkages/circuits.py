"""Circuits and branches: the assembly modes in which a linkage closes, and which of them it passes between.

Each dyad has two assemblies. A *branch* is one choice for every dyad and one range of the crank; at an end of
its range the dyad that limits it is stretched or folded, and the linkage goes on in the other assembly of
that dyad. Branches that meet so make a *circuit*: from one to another the linkage must be taken apart (Chase
and Mirth, *Circuits and branches of single-degree-of-freedom planar linkages*, Journal of Mechanical Design
115 (1993) 223–230).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise, product
from typing import Annotated

import numpy as np

from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record
from linkwright.linkages.closure import closure_of, limiters_at
from linkwright.linkages.dyads import dyads_of
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import Element

# Dyads with two assemblies of which all combinations are examined.
_DYADS_MAX = 8

# Dyads whose sign tells which of two assemblies they have.
_SIGNED = Element.SliderRod | Element.Rocker | Element.GuidedRod | Element.SlottedLever

# Difference of crank angles at which two branches end that is rounding: limits are roots.
_MEET = 1e-6
_TURN = 2 * np.pi

# Revolutions and branches, over all assemblies, after which no further assembly is examined.
_TURNS_MAX, _BRANCHES_MAX = 1024, 4096


_BRANCH_ASSEMBLY = '``"given"`` or ``"other"`` by dyad: as in the machine\'s description, or mirrored.'


@dataclass(frozen=True)
class Branch(Record):
    """One assembly in one range of the crank."""

    assembly: Annotated[dict[str, str], About(_BRANCH_ASSEMBLY)]
    low: Annotated[float, Label("minimum crank angle", "", "rad", "0 of a full revolution.")]
    high: Annotated[float, Label("maximum crank angle", "", "rad", "2π of a full revolution.")]
    turns_fully: Annotated[bool, About("Whether the crank rotates fully.")]


@dataclass(frozen=True)
class Circuit(Record):
    """Branches of one circuit; the linkage passes from one to the next at the limits of crank rotation."""

    branches: Annotated[
        tuple[Branch, ...], About("Those with as many dyads as possible in the given assembly first.")
    ]
    complete: Annotated[
        bool,
        About("Whether all assemblies were looked at; a search ends at 4096 branches or 1024 revolutions."),
    ] = True

    @property
    def turns_fully(self) -> bool:
        """Whether the crank rotates fully in it."""
        return any(branch.turns_fully for branch in self.branches)


@public
def circuits(machine: Machine) -> tuple[Circuit, ...]:
    """The circuits of a linkage.

    Parameters
    ----------
    machine : Machine
        The machine; of a batch, the first.

    Returns
    -------
    tuple of Circuit
        The one with the given assembly first; empty if it closes in no assembly.

    Raises
    ------
    InputError
        More than 8 dyads have two assemblies, or the linkage has gears on swinging links, change points or
        groups: these are known in the given assembly alone.
    """
    compiled = compile_machine(machine).first()
    slots = _slots(compiled, machine)
    branches: list[Ended] = []
    turns, complete = 0, True
    for signs in product((1.0, -1.0), repeat=len(slots)):
        if turns > _TURNS_MAX or len(branches) > _BRANCHES_MAX:
            complete = False
            break
        more, revolutions = _branches(compiled, slots, signs)
        branches += more
        turns += revolutions
    return tuple(Circuit(tuple(one for one, _ in group), complete) for group in _joined(branches))


def _slots(compiled: CompiledMachine, machine: Machine) -> dict[str, int]:
    """Slot of the sign of each dyad with two assemblies; InputError if they cannot be exchanged."""
    if any(_is_tied(element) for element in compiled.elements):
        raise InputError(
            f"{machine.name}: circuits are found for linkages of cranks and dyads; this one has "
            f"{_tied(compiled)}, followed in the given assembly alone; change a length by more than 1e-8 to "
            "leave a change point, or give another assembly and look at its closure"
        )
    slots = {dyad.name: dyad.element.sign for dyad in dyads_of(compiled) if isinstance(dyad.element, _SIGNED)}
    if len(slots) > _DYADS_MAX:
        raise InputError(
            f"{machine.name} has {len(slots)} dyads with two assemblies each; circuits are found for up to "
            f"{_DYADS_MAX}"
        )
    return slots


def _is_tied(element: Element) -> bool:
    """Whether it was made for one assembly: continuous angles, change points, groups."""
    if isinstance(element, Element.Rocker | Element.GuidedRod):
        return bool(element.change_points)
    return isinstance(element, Element.AngleOf | Element.Group)


def _tied(compiled: CompiledMachine) -> str:
    points = [
        f"a change point of {dyad.name} at {', '.join(f'{np.degrees(x):.4g}°' for x in dyad.change_points)}"
        for dyad in dyads_of(compiled)
        if len(dyad.change_points)
    ]
    return " and ".join(points) or "gears on moving links or a group"


# A branch, and at each of its ends the crank angle and the dyad that limits it.
Ended = tuple[Branch, list[tuple[float, str]]]


def _branches(
    compiled: CompiledMachine, slots: dict[str, int], signs: tuple[float, ...]
) -> tuple[list[Ended], int]:
    q = compiled.parameters.copy()
    q[list(slots.values())] *= signs
    other = replace(compiled, parameters=q)
    where = closure_of(other)
    words = dict(zip(slots, ("given" if sign > 0 else "other" for sign in signs), strict=True))
    limits = iter(
        () if where.turns_fully else limiters_at(other, [end for pair in where.ranges for end in pair])
    )
    branches = [
        (Branch(words, low, high, where.turns_fully), list(zip((low, high), limits, strict=False)))
        for low, high in where.ranges
    ]
    return branches, where.turns or 1


def _joined(branches: list[Ended]) -> list[list[Ended]]:
    """Branches in groups that meet at limits; the first group has the given assembly, the first branch."""
    # Two meet if they end at the same angle, by the same dyad, and differ in that dyad alone.
    first = list(range(len(branches)))

    def root(n: int) -> int:
        while first[n] != n:
            first[n] = n = first[first[n]]
        return n

    ends: dict[tuple[str, tuple[str, ...]], list[tuple[float, str, int]]] = {}
    for n, (branch, limits) in enumerate(branches):
        for angle, dyad in limits:
            others = tuple(side for name, side in branch.assembly.items() if name != dyad)
            ends.setdefault((dyad, others), []).append((angle % _TURN, branch.assembly[dyad], n))
    for met in ends.values():
        met.sort()
        # Ends at one angle, across a whole revolution too, from the first gap between two on.
        gaps = [n for n in range(len(met)) if met[n][0] - met[n - 1][0] + (0 if n else _TURN) > _MEET] or [0]
        for low, high in pairwise([*gaps, gaps[0] + len(met)]):
            there = [met[n % len(met)] for n in range(low, high)]
            if len({side for _, side, _ in there}) > 1:
                least = min(root(n) for *_, n in there)
                for *_, n in there:
                    first[root(n)] = least
    groups: dict[int, list[Ended]] = {}
    for n, ended in enumerate(branches):
        groups.setdefault(root(n), []).append(ended)
    return list(groups.values())
