"""Derivatives of the motion of an elastic driveline by all entries, those of mounted mechanisms among them.

The core differentiates by the numbers of the driveline and of the mechanism at whose crank angle the motion
is computed, the first one of a train. Which one that is does not change the motion: by entries of another
mechanism it is differentiated where that stands first. What counts per revolution of the first crank is
converted by the ratio of both speeds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from linkwright.driveline.gradient import tangents_on_crank
from linkwright.driveline.train_chain import driveline_chain
from linkwright.kernel.description.place import join
from linkwright.kernel.errors import LinkwrightError
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine.address import known_place
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives

# Share by which the period of the same motion differs where another mechanism stands first.
_SAME_MOTION = 1e-8


def elastic_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Numbers of the elastic motion by some entries: ``period``, ``torque_max.crankshaft``.

    Raises what `elastic_motion` raises.
    """
    if machine.train is None or not machine.has_mounted_mechanisms:
        return tangents_on_crank(machine, variables, {})
    mounted = {name: dict(_entries(machine, name, variables)) for name in machine.train.mechanisms}
    of_mechanisms = {address for entries in mounted.values() for address in entries}
    others = [name for name in variables if name not in of_mechanisms]
    first, *further = mounted
    found = tangents_on_crank(machine, others, mounted[first])
    for name in further:
        if mounted[name]:
            found = _with_mechanism(machine, found, name, mounted[name])
    return found


def _entries(machine: Machine, mechanism: str, variables: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Entries of a mechanism of a train with their addresses in its own machine."""
    assert machine.train is not None
    is_own = machine.train.mechanisms[mechanism].machine is None
    above = ("train", "mechanisms", mechanism, "machine")
    for name in variables:
        place = known_place(machine, name)
        if place[:4] == above:
            yield name, join(place[4:])
        elif is_own and place[0] != "train":
            yield name, name


def _with_mechanism(
    machine: Machine, found: Derivatives, name: str, entries: Mapping[str, str]
) -> Derivatives:
    """Derivatives with those by entries of a further mechanism, of the motion at its crank angle."""
    try:
        part = tangents_on_crank(_with_first(machine, name), [], entries)
    except LinkwrightError as error:
        # silent: the motion is found, and these entries have no derivative of it, with the reason
        return _refusing(found, dict.fromkeys(entries, " ".join(str(error).split())))
    if not part.variables:
        return _refusing(found, part.refused)
    factors = dict(_per_revolution(machine, name))
    own = {name: factors.get(name, 1.0) * x for name, x in part.tangents.items()}
    part = replace(part, tangents=own)
    if not found.variables:
        return _refusing(part, found.refused)
    if abs(found.tangents["period"].value / own["period"].value - 1) > _SAME_MOTION:
        why = "from its crank another of several steady motions is found; compare two motions"
        return _refusing(found, dict.fromkeys(entries, why))
    return _joined(found, part)


def _refusing(found: Derivatives, refused: Mapping[str, str]) -> Derivatives:
    return replace(found, refused={**found.refused, **refused})


def _with_first(machine: Machine, name: str) -> Machine:
    """The same machine with a mechanism of its train as the first one."""
    assert machine.train is not None
    mechanisms = machine.train.mechanisms
    ordered = {name: mechanisms[name], **mechanisms}
    return machine.with_entries({"train": machine.train.with_entries({"mechanisms": ordered})})


def _per_revolution(machine: Machine, name: str) -> Iterator[tuple[str, float]]:
    """What counts by the first crank, as a multiple of what counts by the crank of a further mechanism."""
    assert machine.train is not None
    chain = driveline_chain(machine)
    ratio = float(chain.ratio[chain.stations.index(machine.train.mechanisms[name].on)])
    yield from (("speed_mean_time", 1 / ratio), ("energy_drive", ratio), ("energy_load", ratio))


def _joined(one: Derivatives, other: Derivatives) -> Derivatives:
    """Derivatives by the entries of both; an entry of both acts in both."""
    variables = (*one.variables, *(name for name in other.variables if name not in one.variables))
    places = [[variables.index(name) for name in part.variables] for part in (one, other)]
    tangents = {}
    for name in one.tangents:
        if name in other.tangents:
            d = np.zeros((2, len(variables)))
            d[0, places[0]], d[1, places[1]] = one.tangents[name].d, other.tangents[name].d
            tangents[name] = Tangent(one.tangents[name].value, d.sum(axis=0))
    ties = {**other.ties, **one.ties}
    return replace(
        one,
        variables=variables,
        tangents=tangents,
        ties={name: why for name, why in ties.items() if name in tangents},
        missing={**other.missing, **one.missing},
        refused={**other.refused, **one.refused},
        lost={**other.lost, **one.lost},
    )
