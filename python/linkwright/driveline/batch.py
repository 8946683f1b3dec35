"""Steady motion of thousands of elastic drivelines that differ in some entries.

The core solves them in lanes and threads, each from where a machine alone begins, so that it comes to the
same one of several steady motions, and measures the error of each (its module `driveline::batch`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from linkwright.drive.batch import columns_of
from linkwright.drive.load_checks import require_same_turns
from linkwright.driveline.chain import Chain, chain_of, fastest_of, has_hysteresis, listed
from linkwright.driveline.coexisting import MULTIPLES
from linkwright.driveline.elastic_motion import ElasticMotion, measures
from linkwright.driveline.solving import ANGLES, CYCLES
from linkwright.driveline.train_chain import driveline_chain
from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.errors import InputError, LinkwrightError
from linkwright.kernel.numerics.tangent import lifted
from linkwright.kernel.quantities import Label, declared
from linkwright.linkages.closure import turn_angles
from linkwright.linkages.whole_cycle import over_whole_cycle, row_turns
from linkwright.machine.address import get, replace
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import DrivelineRows
from linkwright.machine.tangents import seeded

# Relative accuracy of speeds and twists of every machine.
_ACCURACY = 1e-7

# Entries in which the numbers of a driveline are linear as long as nothing vanishes.
_LINEAR = ("stiffness", "damping", "inertia", "wheel_inertia")

# Quantities of a motion that a batch has.
QUANTITIES = frozenset(
    name
    for name, (_, mark) in declared(ElasticMotion).items()
    if isinstance(mark, Label)
    and mark.shape in ("", "(stations,)", "(shafts,)", "(motors,)")
    and name.partition("_")[0]
    in ("speed", "acceleration", "torque", "twist", "power", "energy", "unevenness")
    and not name.endswith("_angle")
) - {"torque_drive", "torque_load"} | {"period", "multiplier_max"}


@dataclass(frozen=True)
class ElasticMotions:
    """Steady motion of n elastic drivelines, NaN where it is a machine to be solved alone."""

    chain: Chain
    turns: int
    numbers: Mapping[str, Floats]  # (n,), or (parts, n)

    def number(self, quantity: str, part: str = "") -> Floats:
        """A quantity of every machine, of one of its stations or shafts, (n,)."""
        values = self.numbers[quantity]
        if not part:
            return values
        _, mark = declared(ElasticMotion)[quantity]
        names: tuple[str, ...] = getattr(self.chain, mark.shape.strip("(,)"))
        return np.asarray(values[names.index(part)])


def elastic_motions(machine: Machine, entries: Mapping[str, Any]) -> ElasticMotions:
    """Steady motion of machines that differ from one in some entries, arrays of one length [SI].

    A motion whose `multiplier_max` is not below 1 is unstable, as it is of the machine alone.

    Raises MachineError for values that are not possible, InputError where the machine has no elastic
    driveline with a motor, and what `chain_of` raises of the machine itself.
    """
    drive = machine.drive
    if machine.has_mounted_mechanisms:
        # Each is solved alone.
        chain, n = driveline_chain(machine), len(next(iter(entries.values())))
        return ElasticMotions(
            chain, 1, {name: np.full((*size, n), np.nan) for name, size in _shapes(chain).items()}
        )
    if drive is None or not drive.twists or drive.motor is None:
        raise InputError(f"{machine.name}: many machines at once need a motor and an elastic driveline")
    columns = columns_of(machine, entries)
    require_same_turns(machine)
    compiled = compile_machine(replace(machine, columns))
    first = over_whole_cycle(compiled.first())
    chain = chain_of(machine)
    numbers, ratios, is_alike = _drivelines(machine, columns, chain)
    is_alike &= row_turns(compiled) == first.turns
    members = np.flatnonzero(is_alike).astype(np.int32)
    found = {name: np.full((*shape, len(is_alike)), np.nan) for name, shape in _shapes(chain).items()}
    if len(members):
        part = compiled.over_turns(first.turns).rows(members)
        of_members: dict[str, Any] = {name: values[:, members] for name, values in ratios.items()}
        own = chain._replace(**of_members)
        for name, column in _solved(part, own, numbers[members], first.turns).items():
            found[name][..., members] = column
    return ElasticMotions(chain, first.turns, found)


def _shapes(chain: Chain) -> dict[str, tuple[int, ...]]:
    parts = {f"({name},)": (len(getattr(chain, name)),) for name in ("stations", "shafts", "motors")}
    marks = {name: mark for name, (_, mark) in declared(ElasticMotion).items() if name in QUANTITIES}
    return {name: parts.get(mark.shape, ()) for name, mark in marks.items() if isinstance(mark, Label)}


# Ratios of stations, shafts and motors to the crank.
_RATIOS = ("ratio", "lead", "motor_ratio")


def _solved(compiled: CompiledMachine, chain: Chain, numbers: Floats, turns: int) -> dict[str, Floats]:
    """Quantities of motions of one structure."""
    n = len(numbers)
    speed = np.broadcast_to(compiled.speed_guesses, (n,)).copy()
    period = compiled.cycle / speed
    inertia = compiled.least_inertias(turn_angles(ANGLES, compiled.turns))
    rows = compiled.driveline_rows(
        chain.core,
        accuracy=_ACCURACY,
        numbers=numbers,
        speed=speed,
        fastest=fastest_of(chain, numbers, inertia, period),
        cycles_max=CYCLES,
        multiples=MULTIPLES,
    )
    made = measures(rows, chain, turns)
    whole = SimpleNamespace(**made, turns=turns, ratio=chain.ratio)
    made["multiplier_max"] = _multipliers(rows, chain)
    # Properties stand behind those that they are made of.
    for name in declared(ElasticMotion):
        if name in QUANTITIES and name not in made:
            made[name] = getattr(ElasticMotion, name).fget(whole)
            setattr(whole, name, made[name])
    return made


def _multipliers(rows: DrivelineRows, chain: Chain) -> Floats:
    """Size of the largest Floquet multiplier of every machine, (n,)."""
    m = round(len(rows.monodromy) ** 0.5)
    matrices = rows.monodromy.T.reshape(-1, m, m)
    known = np.isfinite(matrices).all(axis=(1, 2))
    sizes = np.full(len(matrices), np.nan)
    sizes[known] = np.abs(np.linalg.eigvals(matrices[known])).max(axis=1, initial=0.0)
    return sizes


def _drivelines(
    machine: Machine, columns: Mapping[str, Floats], chain: Chain
) -> tuple[Floats, dict[str, Floats], Bools]:
    """Numbers of the driveline of every machine, (n, numbers), ratios to the crank, (parts, n), and whether
    its structure is that of the first.
    """
    n = len(next(iter(columns.values())))
    own = {place: column for place, column in columns.items() if _is_of_drive(machine, place)}
    if all(place.rpartition(".")[2] in _LINEAR and column.all() for place, column in own.items()):
        ratios = {name: np.repeat(getattr(chain, name)[:, None], n, axis=1) for name in _RATIOS}
        return _linear(machine, own, chain, n), ratios, np.ones(n, dtype=bool)
    return _one_by_one(machine, own, chain, n)


def _is_of_drive(machine: Machine, place: str) -> bool:
    drive = machine.drive
    assert drive is not None
    # Viscous damping for a loss factor depends on the mean inertia of the mechanism.
    return place.startswith("drive.") or has_hysteresis(drive)


def _linear(machine: Machine, columns: Mapping[str, Floats], chain: Chain, n: int) -> Floats:
    """Numbers that are linear in what varies."""
    base = np.asarray(listed(chain))
    places = [place for place in columns if get(machine, place) is not None]
    if not places:
        return np.repeat(base[None], n, axis=0)
    slopes = lifted(listed(chain_of(seeded(machine, places))), len(places)).d
    changes = np.stack([columns[place] - float(get(machine, place)) for place in places], axis=1)
    return np.ascontiguousarray(base + changes @ slopes.T)


def _one_by_one(
    machine: Machine, columns: Mapping[str, Floats], chain: Chain, n: int
) -> tuple[Floats, dict[str, Floats], Bools]:
    numbers = np.full((n, len(listed(chain))), np.nan)
    ratios = {name: np.ones((len(getattr(chain, name)), n)) for name in _RATIOS}
    is_alike = np.zeros(n, dtype=bool)
    for row in range(n):
        try:
            own = chain_of(replace(machine, {place: float(column[row]) for place, column in columns.items()}))
        except LinkwrightError:
            # silent: solved alone, such a machine says what is wrong with it
            continue
        is_alike[row] = _form(own) == _form(chain)
        if is_alike[row]:
            numbers[row] = listed(own)
            for name, values in ratios.items():
                values[:, row] = getattr(own, name)
    return numbers, ratios, is_alike


def _form(chain: Chain) -> tuple[Any, ...]:
    links = chain.links
    ends = (links["first"].tolist(), links["second"].tolist(), chain.held)
    knots = [None if curve is None else len(curve[0]) for curve in links["curves"]]
    return chain.stations, chain.shafts, chain.mass.tolist(), knots, *ends
