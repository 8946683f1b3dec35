r"""Derivatives of the steady motion of an elastic driveline by entries of the machine.

The core differentiates the collocation itself, with ends of steps at kinks that move (its module
`derivatives::elastic`): dX/dp = −R_X⁻¹ R_p. Numbers of the driveline follow from the entries by plain
arithmetic, which tangents go through (`chain_of`), and what is worked out of both comes from the formulas of
`ElasticMotion`. An extreme has the derivative of its curve at its place (envelope theorem); where two places
have it there is one on either side, and `ties` says so. A multiplier λ of the monodromy matrix M, with its
vectors on both sides, has

.. math:: \mathrm d\lambda = \frac{w^T\,\mathrm dM\,v}{w^T v}

References
----------
.. [1] Ascher, Mattheij and Russell, Numerical Solution of Boundary Value Problems, 1995, chapter 5.
.. [2] Haftka and Gürdal, Elements of Structural Optimization, 3rd ed. 1992, chapter 7.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from linkwright.driveline.chain import Chain, chain_of, has_hysteresis, listed
from linkwright.driveline.elastic_motion import (
    ElasticMotion,
    measures,
    result_of,
    solved_motion,
)
from linkwright.driveline.solving import multipliers_of
from linkwright.driveline.train_chain import driveline_chain, driven_train
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.extreme import ALIKE_OF_SOLVED, Kinks, as_high, chosen, occurs_at
from linkwright.kernel.numerics.tangent import Tangent, lifted
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.quantities import Label, declared, shown
from linkwright.linkages.closure import turn_angles
from linkwright.machine.address import entry_of
from linkwright.machine.machine import Machine
from linkwright.machine.own_motors import on_crankshaft, without_drive
from linkwright.machine.program.compiled import CompiledMachine
from linkwright.machine.program.core import DrivelineGradient, DrivelineMotion
from linkwright.machine.tangents import Derivatives, Directions, directions, followed
from linkwright.torsion.excitation.drive_line import mean_inertia, mechanism_alone, mounted_machine

# Relative accuracy of the motion whose derivatives are taken.
_ACCURACY = 1e-11

# Angles of a revolution at which rivals of an extreme are looked for, rounds in which each is closed in on,
# and how far apart [rad] they are two.
_LOOK, _ROUNDS, _APART = 1440, 6, 1e-3

# Share of a value for an entry doubled below which derivatives of rivals do not differ: rounding.
_ROUNDING = 1e-9

# A disturbance of which no more than this is left has died out: what is left is rounding.
_DIED_OUT = 1e-9

_LOAD_JUMPS = (
    "a load of a further mechanism jumps at an angle that the motion moves; smooth the jump, or compare two "
    "motions"
)
_KINKS_MEET = (
    "two kinks of links, motors or mechanisms occur at one angle, and move apart with these entries; compare "
    "two motions"
)


def tangents_on_crank(machine: Machine, variables: Sequence[str], own: Mapping[str, str]) -> Derivatives:
    """Numbers of the elastic motion by some entries: ``period``, ``torque_max.crankshaft``.

    `own`: addresses of entries of the first mechanism of a train, with those in its own machine.
    Raises what `elastic_motion` raises.
    """
    solved = solved_motion(machine, _ACCURACY)
    compiled, chain, motion = solved.driven.compiled, solved.chain, solved.motion
    refused: dict[str, str] = {}
    along, moved, values = _directions(machine, variables, own, refused)
    steady = result_of(machine, motion, chain, np.zeros(1), solved.turns)
    if not along.variables:
        return Derivatives((), {}, {}, {}, refused)
    gradient = motion.gradient(values)
    numbers = SimpleNamespace(**dict(_tangents(motion, gradient)))
    whole = replace(steady, ratio=moved.ratio, **measures(numbers, moved, solved.turns))
    named = dict(_named(whole))
    missing = {name: "it has no value" for name, x in named.items() if not np.isfinite(x.value)}
    missing |= dict.fromkeys(
        _held(named, chain), "the motor keeps its speed: it is zero within rounding error"
    )
    largest = _largest_multiplier(motion, gradient, chain)
    named["multiplier_max"] = Tangent(steady.multiplier_max, largest)
    if steady.multiplier_max <= _DIED_OUT:
        missing["multiplier_max"] = "disturbances die out: it is zero within rounding error"
    if np.isnan(gradient.period).all():
        missing |= dict.fromkeys(named, _LOAD_JUMPS)
    tangents = {name: x for name, x in named.items() if name not in missing}
    ties = {name: _KINKS_MEET for name, x in tangents.items() if np.isnan(x.d).any()}
    ties |= {
        f"{name}.{part}": why for name, part, why in _ties(compiled, motion, steady, chain, along, values)
    }
    words, units = _words(tangents)
    lost = along.lost(_lost(compiled, along))
    return Derivatives(
        along.variables, tangents, _with_made(ties, tangents), missing, refused, lost, words, units
    )


def _directions(
    machine: Machine, variables: Sequence[str], own: Mapping[str, str], refused: dict[str, str]
) -> tuple[Directions, Chain, Floats]:
    """Entries with derivatives, the driveline with tangents, and directions of all numbers of the core."""
    if machine.has_mounted_mechanisms:
        return _directions_of_train(machine, variables, own, refused)
    program = directions(machine, variables)
    refused.update(program.refused)
    inertia = mean_inertia(machine) if _is_lossy(machine) else None
    known, moved = followed(machine, program.variables, lambda along: chain_of(along, inertia), refused)
    along, n = program.only(known), len(known)
    of_chain = lifted(listed(moved), n).d if n else np.zeros((0, 0))
    if inertia is not None and n:
        by_inertia = lifted(listed(chain_of(machine, Tangent(inertia, np.ones(1)))), 1).d
        of_chain = of_chain + by_inertia * _mean_inertia_along(machine, known)
    return along, moved, np.ascontiguousarray(np.vstack([along.values, of_chain]))


def _directions_of_train(
    machine: Machine, variables: Sequence[str], own: Mapping[str, str], refused: dict[str, str]
) -> tuple[Directions, Chain, Floats]:
    """The same of a train: its entries are numbers of the driveline, `own` those of its first mechanism."""
    known, moved = followed(machine, variables, driveline_chain, refused)
    of_mechanism, by_inertia, alone = _of_first_mechanism(machine, own, refused)
    names, n = (*known, *alone), len(known) + len(alone)
    of_chain = lifted(listed(moved), len(known)).d

    def wider(number: Any) -> Tangent:
        along = lifted(number, len(known))
        return Tangent(along.value, np.concatenate([along.d, np.zeros((*along.shape, len(alone)))], axis=-1))

    ratios = {name: wider(getattr(moved, name)) for name in ("ratio", "lead", "motor_ratio")}
    moved = moved._replace(**ratios)
    of_chain = np.hstack([of_chain, by_inertia]) if n else np.zeros((0, 0))
    own_numbers = np.hstack([np.zeros((len(of_mechanism), len(known))), of_mechanism])
    sizes = np.abs([float(entry_of(machine, name)) for name in names])
    along = Directions(names, own_numbers, np.where(sizes > 0, sizes, 1.0), {})
    return along, moved, np.ascontiguousarray(np.vstack([along.values, of_chain]) if n else of_chain)


def _of_first_mechanism(
    machine: Machine, own: Mapping[str, str], refused: dict[str, str]
) -> tuple[Floats, Floats, list[str]]:
    """Directions of the numbers of the first mechanism and of the driveline by its entries, and these."""
    assert machine.train is not None
    first = next(iter(machine.train.mechanisms))
    alone = without_drive(on_crankshaft(mounted_machine(machine, first)))
    count = len(driven_train(machine).compiled.one)
    idle = [name for name, inner in own.items() if inner.startswith("drive.")]
    refused |= dict.fromkeys(idle, "the drive of a mechanism on a train does not count")
    names = {inner: name for name, inner in own.items() if name not in idle}
    along = directions(alone, [*names])
    refused |= {names[inner]: why for inner, why in along.refused.items()}
    if not along.variables:
        return np.zeros((count, 0)), np.zeros((len(listed(driveline_chain(machine))), 0)), []
    mean = mean_inertia(alone)
    by_inertia = lifted(listed(driveline_chain(machine, Tangent(mean, np.ones(1)))), 1).d
    slopes = _mean_inertia_along(alone, along.variables)
    return along.values, by_inertia * slopes, [names[inner] for inner in along.variables]


def _is_lossy(machine: Machine) -> bool:
    return machine.drive is not None and has_hysteresis(machine.drive)


def _mean_inertia_along(machine: Machine, variables: Sequence[str]) -> Floats:
    """Derivatives of the mean inertia of the mechanism by entries, (variables,)."""
    alone = mechanism_alone(machine)
    own = [name for name in variables if not name.startswith(("drive.", "loads."))]
    along = directions(without_drive(on_crankshaft(machine)), own)
    if not along.variables:
        return np.zeros(len(variables))

    def slopes(phi: Floats) -> Floats:
        inertia: Floats = alone.inertias_along(along.values, phi)[0].T
        return inertia

    mean = turn_curve(slopes, alone.kinks(), "derivatives of the reduced inertia").mean()
    by = dict(zip(along.variables, mean.tolist(), strict=True))
    return np.array([by.get(name, 0.0) for name in variables])


def _tangents(motion: DrivelineMotion, gradient: DrivelineGradient) -> Iterator[tuple[str, Any]]:
    """Numbers of the core with their derivatives, as `measures` takes them."""
    for name in _SCALARS:
        yield name, Tangent(getattr(motion, name), getattr(gradient, name))
    for name in ("speed", "acceleration", "twist", "torque", "torque_drive"):
        extremes = getattr(motion, name)
        ends = {
            end: Tangent(getattr(extremes, end), getattr(gradient, f"{name}_{short}"))
            for end, short in _ENDS.items()
        }
        yield name, SimpleNamespace(**ends)


_SCALARS = (
    "period",
    "energy_load",
    "torque_mean",
    "torque_rms",
    "loss",
    "torque_drive_mean",
    "energy_drive",
)
_ENDS = {"least": "min", "greatest": "max"}


def _named(steady: ElasticMotion) -> Iterator[tuple[str, Tangent]]:
    """Scalars of a motion, and numbers of its shafts and stations by their names."""
    for name, (_, mark) in declared(ElasticMotion).items():
        if not isinstance(mark, Label) or name in ("multiplier_max", "ratio"):
            continue
        value, parts = getattr(steady, name), mark.shape.strip("(,)")
        if not isinstance(value, Tangent):
            continue
        if not value.shape:
            yield name, value
        elif parts in ("stations", "shafts", "motors"):
            yield from ((f"{name}.{part}", value[k]) for k, part in enumerate(getattr(steady, parts)))


def _held(names: Iterable[str], chain: Chain) -> list[str]:
    """What does not change of stations that a motor of constant speed turns."""
    held: Any = [] if chain.held is None else np.flatnonzero(chain.mass == chain.held)
    still = {f"{name}.{chain.stations[k]}" for k in held for name in _STILL}
    return [name for name in names if name in still]


_STILL = ("acceleration_min", "acceleration_max", "unevenness")


def _words(names: Iterable[str]) -> tuple[dict[str, str], dict[str, str]]:
    """Words and units of numbers of shafts and stations, by their names."""
    words, units = {}, {}
    for name in names:
        quantity, _, part = name.partition(".")
        mark = shown(ElasticMotion, quantity)
        if part:
            words[name], units[name] = f"{mark.word}, {part} {mark.symbol}", mark.unit
    return words, units


def _largest_multiplier(motion: DrivelineMotion, gradient: DrivelineGradient, chain: Chain) -> Floats:
    """Derivatives of the size of the largest multiplier, (variables,)."""
    M, largest = motion.monodromy, multipliers_of(motion, chain)[0]
    found, right = np.linalg.eig(M)
    at = int(np.abs(found - largest).argmin())
    left = np.linalg.inv(right)[at]
    moved = np.einsum("r,rcz,c->z", left, gradient.monodromy.reshape(*M.shape, -1), right[:, at])
    slopes: Floats = (moved * found[at].conj()).real / np.abs(found[at])
    return slopes


def _lost(compiled: CompiledMachine, along: Directions) -> Floats:
    """Of every entry the angle of a kink whose move was not found, NaN where there is none [rad]."""
    angles = compiled.kinks()
    is_lost = np.isnan(compiled.kinks_along(along.values, angles))
    return np.where(is_lost.any(axis=0), angles[is_lost.argmax(axis=0)], np.nan)


def _ties(
    compiled: CompiledMachine,
    motion: DrivelineMotion,
    steady: ElasticMotion,
    chain: Chain,
    along: Directions,
    values: Floats,
) -> Iterator[tuple[str, str, str]]:
    """Extremes that the motion has twice, each with its part and why it has only one-sided derivatives."""
    cycle = compiled.cycle * motion.multiple
    look = turn_angles(_LOOK, compiled.turns * motion.multiple)[:-1]
    first = motion.curves(look)
    masses = len(motion.speed.least)
    row = 0
    for name in ("speed", "acceleration", "twist", "torque"):
        extremes = getattr(motion, name)
        of_stations = name in ("speed", "acceleration")
        for part in range(masses if of_stations else len(chain.shafts)):
            for (end, short), sign in zip(_ENDS.items(), (-1.0, 1.0), strict=True):

                def read(at: Floats, name: str = name, part: int = part, sign: float = sign) -> Floats:
                    order, back = np.unique(at % cycle, return_inverse=True)
                    heights: Floats = sign * getattr(motion.curves(order), name)[part]
                    return heights[back.reshape(at.shape)]

                top = getattr(extremes, f"{end}_at")[part], sign * getattr(extremes, end)[part]
                looked = look, sign * getattr(first, name)[part]
                rivals = as_high(read, looked, top, cycle, near=_APART, rounds=_ROUNDS)
                if len(rivals) < 2:
                    continue
                why = _why(compiled, motion, along, values, rivals, row + part, top[1])
                names = chain.stations if of_stations else chain.shafts
                of_part = chain.mass if of_stations else np.arange(len(names))
                for k in np.flatnonzero(of_part == part) if why else ():
                    yield f"{name}_{short}", names[k], why
        row += masses if of_stations else len(chain.shafts)


def _why(
    compiled: CompiledMachine,
    motion: DrivelineMotion,
    along: Directions,
    values: Floats,
    angles: list[float],
    row: int,
    height: float,
) -> str:
    """By which entries rivals at some angles have derivatives that differ; empty if by none."""
    at = np.array(angles)
    slopes = motion.curves_along(values, at).reshape(-1, len(at), values.shape[1])[row]
    size = np.maximum(ALIKE_OF_SOLVED * np.abs(slopes).max(axis=0), _ROUNDING * abs(height) / along.sizes)
    differs = np.ptp(slopes, axis=0) > size
    kinks = Kinks.of(compiled, along)
    for angle in angles:
        differs = differs | kinks.moved_at(angle, _APART)
    by = chosen(along.variables, differs)
    return occurs_at(angles, by) if by else ""


# What is made of extremes.
_MADE_OF = {
    "speed": ("unevenness",),
    "torque": ("torque_peak", "torque_vibratory", "torque_ratio"),
}


def _with_made(ties: dict[str, str], tangents: Iterable[str]) -> dict[str, str]:
    """Ties, and those of what is made of the extremes that tie."""
    made = {
        f"{name}.{part}": why
        for extreme, why in ties.items()
        for quantity, _, part in [extreme.partition(".")]
        for name in _MADE_OF.get(quantity.partition("_")[0], ())
    }
    return {name: why for name, why in (made | ties).items() if name in tangents}
