"""A train with all that stands for discs and shafts written out; how fast each disc turns.

An engine is a disc a throw, with the mean of its inertia over the revolution, and shafts between them. A
coupling is a shaft with the slope of its curve without torque; a damper is a disc, its ring, on a shaft
without stiffness or with that of its spring; an elastic freewheel locks a ring on a shaft. A shaft with an
inertia of its own gives it to the discs at its ends; where it is distributed, the shaft keeps its pieces,
from which exact vibration follows.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple, TypeVar

import numpy as np
from pydantic import Field

from linkwright.kernel.numerics.tangent import plain, primal
from linkwright.torsion.model.clutch import Freewheel
from linkwright.torsion.model.coupling import Coupling, Damper, Pendulum
from linkwright.torsion.model.engine.engine_motion import mean_throw_inertia, throw_stiffness
from linkwright.torsion.model.shaft_row import RodPiece, end_inertias, rod_pieces
from linkwright.torsion.model.train import GROUND, Disc, Shaft, ShaftInertia, Train, TrainGear
from linkwright.torsion.model.train_torques import InstalledEngine


def whole_train(train: Train) -> Train:
    """A train of discs, then rings of dampers; shafts, then couplings, then what holds the rings.

    Pendulums are rings, too, with the stiffness that they have at the speed of service.
    """
    heavy = any(shaft.is_heavy for shaft in train.shafts.values())
    elastic = {name: wheel for name, wheel in train.freewheels.items() if wheel.stiffness is not None}
    parts = (train.couplings, train.dampers, train.pendulums, train.installed, train.planetaries, elastic)
    if not (any(parts) or heavy):
        return train
    throws: dict[str, Disc] = {}
    cranks: dict[str, Shaft] = {}
    for engine in train.installed:
        discs, shafts = _crankshaft(engine)
        throws |= discs
        cranks |= shafts
    # All that is made here is unchecked: it was checked where it is described.
    ringed: dict[str, Damper | Pendulum] = {**train.dampers, **train.pendulums}
    rings = {name: Disc.model_construct(inertia=ring.ring_inertia) for name, ring in ringed.items()}
    planets, meshes = _planets(train)
    locked, wheels, springs = _sprung(elastic)
    couplings = {name: _coupling(coupling) for name, coupling in train.couplings.items()}
    held = {name: _spring(name, ring) for name, ring in ringed.items()}
    expanded = train.model_copy(
        update={
            "discs": _loaded({**throws, **train.discs, **planets, **rings, **locked}, train.shafts),
            "shafts": {**cranks, **_light(train), **couplings, **held, **springs},
            "freewheels": {**train.freewheels, **wheels},
            "gears": {**train.gears, **meshes},
            "planetaries": {},
            # The first disc may be a throw now.
            "driver": train.driver or (None if train.drivers else next(iter(train.discs), None)),
            "engine": None,
            "engines": {},
            "couplings": {},
            "dampers": {},
            "pendulums": {},
        }
    )
    return _at_service(train, expanded) if train.pendulums else expanded


def _at_service(train: Train, expanded: Train) -> Train:
    """A train whose pendulums have the stiffness of the speed of service, or of the start of a manoeuvre."""
    start = 0.0 if train.transient is None else train.transient.speed
    service, turning = start if train.run is None else train.run.service, speeds(expanded).discs
    swinging = {
        name: expanded.shafts[name].model_copy(
            update={"stiffness": pendulum.stiffness(service * turning[pendulum.on])}
        )
        for name, pendulum in train.pendulums.items()
    }
    return expanded.model_copy(update={"shafts": {**expanded.shafts, **swinging}})


def _crankshaft(installed: InstalledEngine) -> tuple[dict[str, Disc], dict[str, Shaft]]:
    engine, names = installed.engine, installed.throws
    n = len(names)
    disc = Disc.model_construct(inertia=mean_throw_inertia(engine), damping=engine.damping)
    stiffness, limit = throw_stiffness(engine) if n > 1 else 0.0, engine.crank_limit
    shafts = {
        name: Shaft.model_construct(
            between=pair, stiffness=stiffness, loss_factor=engine.loss_factor, limit=limit
        )
        for name, pair in zip(installed.cranks, pairwise(names), strict=True)
    }
    return dict.fromkeys(names, disc), shafts


def _planets(train: Train) -> tuple[dict[str, Disc], dict[str, TrainGear]]:
    discs: dict[str, Disc] = {}
    meshes: dict[str, TrainGear] = {}
    for name, stage in train.planetaries.items():
        discs |= dict.fromkeys(stage.planet_names(name), Disc.model_construct(inertia=stage.planet_inertia))
        meshes |= stage.meshes(name)
    return discs, meshes


def _loaded(discs: dict[str, Disc], shafts: Mapping[str, Shaft]) -> dict[str, Disc]:
    for shaft in shafts.values():
        for name, J in zip(shaft.between, _end_inertias(shaft), strict=True):
            if name in discs and J:
                discs[name] = discs[name].model_copy(update={"inertia": discs[name].inertia + J})
    return discs


def _end_inertias(shaft: Shaft) -> tuple[float, float]:
    """Inertia that a shaft contributes to the discs at its ends [kg m²]."""
    if shaft.own_inertia is not None:
        return shaft.own_inertia / 2, shaft.own_inertia / 2
    if shaft.density is None or shaft.sections is None:
        return 0.0, 0.0
    return end_inertias(shaft.sections, shaft.density)


class RodShaft(Shaft):
    """A shaft whose inertia is distributed, and counted with the discs at its ends as well."""

    pieces: tuple[RodPiece, ...] = Field(description="From its first end to its second.")
    end_inertias: tuple[float, float] = Field(description="Shares of its inertia in its two discs [kg m²].")


def _light(train: Train) -> dict[str, Shaft]:
    return {
        name: _counted(shaft, shaft.inertia or train.inertia) if shaft.is_heavy else shaft
        for name, shaft in train.shafts.items()
    }


def _counted(shaft: Shaft, inertia: ShaftInertia) -> Shaft:
    if inertia == "ends":
        return shaft.model_copy(update={"density": None, "own_inertia": None})
    entries = {name: getattr(shaft, name) for name in type(shaft).model_fields}
    entries |= {"density": None, "own_inertia": None, "pieces": rod_pieces(shaft)}
    return RodShaft.model_construct(**entries, end_inertias=_end_inertias(shaft))


def _coupling(coupling: Coupling) -> Shaft:
    return Shaft.model_construct(
        between=coupling.between,
        stiffness=plain(coupling.slope()) if coupling.stiffness is None else coupling.stiffness,
        damping=coupling.damping,
        loss_factor=coupling.loss_factor,
    )


def _spring(name: str, ring: Damper | Pendulum) -> Shaft:
    # No shaft of a file has the stiffness 0, which a fluid has.
    stiffness, loss = (ring.stiffness or 0.0, ring.loss_factor) if isinstance(ring, Damper) else (0.0, 0.0)
    return Shaft.model_construct(
        between=(ring.on, name), stiffness=stiffness, damping=ring.damping, loss_factor=loss
    )


def _sprung(
    elastic: Mapping[str, Freewheel],
) -> tuple[dict[str, Disc], dict[str, Freewheel], dict[str, Shaft]]:
    """Rings of elastic freewheels, the freewheels that lock them, and their springs to the driven discs."""
    rings, wheels, springs = dict[str, Disc](), dict[str, Freewheel](), dict[str, Shaft]()
    for name, wheel in elastic.items():
        driving, driven = wheel.between
        ring, spring = wheel.parts(name)
        assert wheel.ring_inertia is not None
        rings[ring] = Disc.model_construct(inertia=wheel.ring_inertia)
        wheels[name] = wheel.model_copy(update={"between": (driving, ring), "stiffness": None})
        springs[spring] = Shaft.model_construct(
            between=(ring, driven), stiffness=wheel.stiffness, damping=wheel.damping
        )
    return rings, wheels, springs


Node = TypeVar("Node", bound=Hashable)

# Ratios that differ by less are the same within rounding of what was typed.
_EQUAL = 1e-9


class Contradiction(NamedTuple):
    """A connection whose discs turn otherwise than it asks."""

    # `table`, `name`: of the connection.
    table: str
    name: str
    # `wanted`, `found`: speed of its first disc over that of its second: by itself, and by the way around the
    # loop.
    wanted: float
    found: float


class Joint(NamedTuple):
    """A connection of two discs."""

    # `table`, `name`: where it is described.
    table: str
    name: str
    # `first`, `second`: the discs.
    first: str
    second: str
    ratio: float  # speed of the first over that of the second


def parts_of(names: Iterable[Node], pairs: Iterable[tuple[Node, Node]]) -> list[list[Node]]:
    """The connected parts of a graph. Each part in the order of its names."""
    part = {name: [name] for name in names}
    for a, b in pairs:
        one, other = part[a], part[b]
        if one is not other:
            one += other
            part |= dict.fromkeys(other, one)
    order = {name: n for n, name in enumerate(part)}
    return [
        sorted(member, key=order.__getitem__)
        for member in {id(member): member for member in part.values()}.values()
    ]


def joints(train: Train) -> Iterator[Joint]:
    """All connections between discs: shafts, gears, clutches; those to the ground are left out."""
    for name, shaft in train.shafts.items():
        if GROUND not in shaft.between:
            yield Joint("shafts", name, *shaft.between, 1.0)
    for name, gear in train.gears.items():
        yield Joint("gears", name, *gear.between, gear.speed_ratio)
    for name, pair in train.coaxial.items():
        yield Joint("clutches" if name in train.clutches else "freewheels", name, *pair, 1.0)


class Speeds(NamedTuple):
    """Speeds of the discs when the train rotates as a rigid body."""

    # Over that of the first disc of its part, with the sense; 0 at rest.
    discs: dict[str, float]
    contradictions: list[Contradiction]  # connections that close a loop and ask for another ratio
    undetermined: tuple[str, ...] = ()  # discs whose speed nothing sets; theirs is 1


def speeds(train: Train) -> Speeds:
    """Speeds of the discs when the train rotates as a rigid body.

    On a carrier gears turn as Willis has it, ω_a − ω_c = i (ω_b − ω_c); what a shaft holds to the ground
    rests there, as a held ring or a housing on its seat.
    """
    if any(gear.carrier for gear in train.gears.values()):
        return _about_carriers(train)
    listed = list(joints(train))
    about: dict[str, list[tuple[str, float]]] = {name: [] for name in train.discs}
    for speed in listed:
        about[speed.first].append((speed.second, 1.0 / speed.ratio))
        about[speed.second].append((speed.first, speed.ratio))
    turning: dict[str, float] = {}
    for root in train.discs:
        if root not in turning:
            _spread(root, about, turning)
    wrong = (_checked(speed, turning) for speed in listed)
    return Speeds(
        {name: turning[name] for name in train.discs}, [speed for speed in wrong if speed is not None]
    )


class _Relation(NamedTuple):
    """Σ f ω = 0 of a connection."""

    table: str
    name: str
    ratio: float
    factors: dict[str, float]


def _relations(train: Train) -> Iterator[_Relation]:
    for name, shaft in train.shafts.items():
        yield _Relation("shafts", name, 1.0, dict(zip(shaft.between, (1.0, -1.0), strict=True)))
    for name, pair in train.coaxial.items():
        table = "clutches" if name in train.clutches else "freewheels"
        yield _Relation(table, name, 1.0, dict(zip(pair, (1.0, -1.0), strict=True)))
    first = next(iter(train.discs))
    for name, gear in train.gears.items():
        a, b, c, i = *gear.between, gear.carrier or GROUND, gear.speed_ratio
        yield _Relation("gears", name, i, {a: 1.0, b: -i, c: i - 1.0})
        if gear.carrier_speed is not None and c != first:
            yield _Relation("gears", name, gear.carrier_speed, {c: 1.0, first: -gear.carrier_speed})


def _about_carriers(train: Train) -> Speeds:
    known: dict[str, float] = {next(iter(train.discs)): 1.0, GROUND: 0.0}
    waiting, wrong = list(_relations(train)), list[Contradiction]()
    while waiting:
        open_ends = [[name for name in relation.factors if name not in known] for relation in waiting]
        n = next((n for n, ends in enumerate(open_ends) if len(ends) < 2), None)
        if n is None:
            if not _solve_together(waiting, known):
                break
            continue
        relation = waiting.pop(n)
        rest = {name: f * known[name] for name, f in relation.factors.items() if name in known}
        if open_ends[n]:
            (end,) = open_ends[n]
            known[end] = -sum(rest.values()) / relation.factors[end]
        elif abs(primal(sum(rest.values()))) > _EQUAL * max(map(abs, map(primal, rest.values()))):
            a, b, *c = relation.factors
            carried = known[c[0]] if c else 0.0
            apart = plain(known[b] - carried)
            found = plain(known[a] - carried) / apart if apart else np.inf
            wrong.append(Contradiction(relation.table, relation.name, plain(relation.ratio), found))
    undetermined = tuple(name for name in train.discs if name not in known)
    at_rest = {name for name, n in known.items() if abs(primal(n)) < _EQUAL}
    turning = {name: 0.0 if name in at_rest else known.get(name, 1.0) for name in train.discs}
    return Speeds(turning, wrong, undetermined)


def _solve_together(relations: list[_Relation], known: dict[str, float]) -> bool:
    """Speeds that several relations set only together; whether they set them."""
    names = list(dict.fromkeys(name for one in relations for name in one.factors if name not in known))
    A = np.array([[primal(one.factors.get(name, 0.0)) for name in names] for one in relations])
    if np.linalg.matrix_rank(A) < len(names):
        return False
    inverse = np.linalg.pinv(A)
    at = dict.fromkeys(names, 0.0)
    # The second step carries the tangents of the ratios.
    for _ in range(2):
        every = known | at
        left = [sum(f * every[name] for name, f in one.factors.items()) for one in relations]
        steps = (sum(w * x for w, x in zip(row.tolist(), left, strict=True)) for row in inverse)
        at = {name: at[name] - step for name, step in zip(names, steps, strict=True)}
    known |= at
    return True


def _spread(root: str, about: Mapping[str, list[tuple[str, float]]], ratios: dict[str, float]) -> None:
    ratios[root] = 1.0
    waiting = [root]
    while waiting:
        at = waiting.pop(0)
        for name, factor in about[at]:
            if name not in ratios:
                ratios[name] = ratios[at] * factor
                waiting.append(name)


def _checked(joint: Joint, ratios: Mapping[str, float]) -> Contradiction | None:
    ratio = ratios[joint.first] / ratios[joint.second]
    if abs(ratio - joint.ratio) <= _EQUAL * abs(joint.ratio):
        return None
    return Contradiction(joint.table, joint.name, joint.ratio, ratio)
