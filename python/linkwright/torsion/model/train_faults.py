"""What is wrong with a train as a whole: names that mean nothing, unconnected parts, loops."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise

from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import close_match, fault, suggestion
from linkwright.kernel.description.place import keys, look
from linkwright.kernel.errors import AssemblyError, InputError
from linkwright.kernel.limits import DISCS
from linkwright.torsion.model.train import GROUND, Planetary, Train
from linkwright.torsion.model.train_torques import crank_names, throw_names
from linkwright.torsion.model.train_transient import transient_faults
from linkwright.torsion.model.whole_train import Contradiction, RodShaft, parts_of, speeds, whole_train

# Tables whose entries join two discs, and those whose entries sit on one.
_TABLES = ("shafts", "couplings", "gears", "clutches", "freewheels")
# What holds a disc where the table of a connection does not.
_HELD_BY = {
    "clutches": "hold a disc by a brake, [train.brakes.NAME]",
    "freewheels": 'a backstop is between = ["ground", DISC]',
}

_MEMBERS = ("sun", "ring", "carrier")
_NUMBERS = re.compile(r"[+-]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d++)?")
_ON = ("brakes", "dampers", "pendulums", "loads", "excitations", "drivers", "motors", "mechanisms")


def train_faults(train: object) -> Iterator[InitErrorDetails]:
    """Faults between the parts of a train. Each with its keys from the machine down."""
    if train is None:
        return
    own = keys(look(train, "discs")) if isinstance(look(train, "discs"), dict) else ()
    discs = (*_throw_names(train), *own, *_planet_names(train))
    if not discs:
        remedy = 'describe the rotating parts as [train.discs], NAME = { inertia = "2 kg m^2" }'
        yield fault("train", "discs", expected="at least one disc", remedy=remedy)
        return
    if len(discs) > DISCS.most:
        yield fault("train", "discs", found=f"{len(discs)} of them", expected=DISCS.words)
        return
    if GROUND in discs:
        remedy = "it is the name of the fixed frame"
        yield fault("train", "discs", GROUND, found=GROUND, expected="another name", remedy=remedy)
        return
    if keys(look(train, "pendulums")) and look(train, "run") is None and look(train, "transient") is None:
        remedy = "give [train.run] speed_min and speed_max"
        yield fault(
            "train", "pendulums", expected="speeds, which set the stiffness of pendulums", remedy=remedy
        )
        return
    wrong = [*_same_names(train), *_name_faults(train, discs), *_engine_faults(train)]
    yield from wrong
    if wrong:
        return
    yield from _parts_faults(train, discs)
    if isinstance(train, Train):
        try:
            expanded = whole_train(train)
        except AssemblyError as error:
            yield _short_rod(error)
            return
        except (InputError, ArithmeticError) as error:
            yield _no_throw(error)
            return
        yield from _speed_faults(train, expanded)
        yield from _motor_faults(train)
        yield from _friction_faults(train, expanded)
        rings = (*train.dampers, *train.pendulums, *_of_wheels(train)[0])
        yield from transient_faults(train, (*discs, *rings))


def _same_names(train: object) -> Iterator[InitErrorDetails]:
    cranks = [name for engine, throws in _engines(train) for name in crank_names(throws, engine)]
    for tables, taken in (
        (
            (
                *("shafts", "couplings", "dampers", "pendulums", "gears"),
                *("clutches", "brakes", "freewheels"),
            ),
            [*cranks, *_mesh_names(train), *_of_wheels(train)[1]],
        ),
        (
            ("discs", "dampers", "pendulums"),
            (*_throw_names(train), *_planet_names(train), *_of_wheels(train)[0]),
        ),
    ):
        seen = {name: _table_of(name) for name in taken}
        for table in tables:
            for name in keys(look(train, table)):
                if name in seen:
                    expected = f"another name than that of a part in [train.{seen[name]}]"
                    yield fault("train", table, name, found=name, expected=expected)
                seen.setdefault(name, table)


def _engines(train: object) -> list[tuple[str, int]]:
    installed = look(train, "engines")
    own = _throws(look(train, "engine"))
    if not keys(installed):
        return [("", own)]
    return [(name, _throws(look(look(installed, name), "engine")) or own) for name in keys(installed)]


def _throws(engine: object) -> int:
    """How many throws an engine has, whose angles may still be a text as it was read."""
    angles = look(engine, "throws")
    return len(_NUMBERS.findall(angles)) if isinstance(angles, str) else len(keys(angles))


def _throw_names(train: object) -> tuple[str, ...]:
    return tuple(name for engine, throws in _engines(train) for name in throw_names(throws, engine))


def _planet_names(train: object) -> tuple[str, ...]:
    stages = train.planetaries if isinstance(train, Train) else {}
    return tuple(planet for name, stage in stages.items() for planet in stage.planet_names(name))


def _mesh_names(train: object) -> tuple[str, ...]:
    stages = train.planetaries if isinstance(train, Train) else {}
    return tuple(mesh for name, stage in stages.items() for mesh in stage.meshes(name))


def _of_wheels(train: object) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Rings and springs of elastic freewheels."""
    wheels = train.freewheels.items() if isinstance(train, Train) else ()
    parts = [wheel.parts(name) for name, wheel in wheels if wheel.stiffness is not None]
    return tuple(ring for ring, _ in parts), tuple(spring for _, spring in parts)


def _table_of(name: str) -> str:
    """Table of the part that a name is made for."""
    if name.endswith(("_ring", "_spring")):
        return "freewheels"
    return "engine" if "throw" in name or "crank" in name else "planetaries"


def _engine_faults(train: object) -> Iterator[InitErrorDetails]:
    if not isinstance(train, Train):
        return
    for name, one in train.engines.items():
        engine = one.engine or train.engine
        if engine is None:
            remedy = "describe it as [train.engine], for all engines, or as [train.engines.NAME.engine]"
            yield fault("train", "engines", name, expected="the engine itself", remedy=remedy)
            continue
        for number in one.factors:
            if number not in map(str, range(1, engine.n_cylinders + 1)):
                expected = f"the number of a cylinder, 1 to {engine.n_cylinders}"
                yield fault("train", "engines", name, "factors", number, found=number, expected=expected)
    if train.engines and train.engine is not None and train.engine.factors:
        remedy = "give them to the engine whose cylinders they are, as train.engines.NAME.factors"
        factors = dict(train.engine.factors)
        yield fault(
            "train", "engine", "factors", found=factors, expected="none beside engines", remedy=remedy
        )


def _pairs(train: object, table: str) -> Iterator[tuple[str, Sequence[str]]]:
    node = look(train, table)
    for name in keys(node):
        ends = look(look(node, name), "between")
        if isinstance(ends, list | tuple) and len(ends) == 2 and all(isinstance(end, str) for end in ends):
            yield name, ends


def _name_faults(train: object, discs: Sequence[str]) -> Iterator[InitErrorDetails]:
    for table in _TABLES:
        for name, ends in _pairs(train, table):
            place = ("train", table, name, "between")
            on_carrier = look(look(look(train, table), name), "carrier") is not None
            held = table != "clutches" and (table != "gears" or on_carrier)
            known = (*discs, GROUND) if held else discs
            # A mesh is counted at its first disc, and a backstop holds its second.
            free_end = {"gears": 0, "freewheels": 1}.get(table)
            for n, end in enumerate(ends):
                if end == GROUND and (end not in known or n == free_end):
                    remedy = _HELD_BY.get(table, "hold a disc by a shaft to the ground")
                    yield fault(*place, n, found=end, expected="the name of a disc", remedy=remedy)
                elif end not in known:
                    remedy = close_match(end, known) or suggestion(end, discs)
                    yield fault(*place, n, found=end, expected="the name of a disc", remedy=remedy)
            if ends[0] == ends[1]:
                yield fault(*place, 1, found=ends[1], expected="another disc than the first")
    yield from _member_faults(train, discs)
    yield from _seat_faults(train, discs)


def _motor_faults(train: Train) -> Iterator[InitErrorDetails]:
    """Motors of the train and of its manoeuvre of one name."""
    for name in train.transient.motors if train.transient is not None else ():
        if name in train.motors:
            expected = "another name than that of a motor in [train.motors]"
            yield fault("train", "transient", "motors", name, found=name, expected=expected)


def _member_faults(train: object, discs: Sequence[str]) -> Iterator[InitErrorDetails]:
    """Members of planetary stages and carriers of gears that are no discs."""
    for table, members in (("planetaries", _MEMBERS), ("gears", ("carrier",))):
        for name in keys(look(train, table)):
            entry, taken = look(look(train, table), name), dict[str, str]()
            for member in members:
                disc = look(entry, member)
                if not isinstance(disc, str):
                    continue
                place = ("train", table, name, member)
                if disc not in discs and not (disc == GROUND and member != "carrier"):
                    remedy = close_match(disc, discs) or suggestion(disc, discs)
                    yield fault(*place, found=disc, expected="the name of a disc", remedy=remedy)
                elif disc in taken and disc != GROUND:
                    yield fault(*place, found=disc, expected=f"another disc than the {taken[disc]}")
                taken[disc] = member
            if table == "gears" and look(entry, "carrier") in (look(entry, "between") or ()):
                expected = "another disc than the two gears"
                yield fault("train", table, name, "carrier", found=look(entry, "carrier"), expected=expected)


def _seat_faults(train: object, discs: Sequence[str]) -> Iterator[InitErrorDetails]:
    driver = look(train, "driver")
    is_driven = isinstance(train, Train) and train.is_driven
    if isinstance(driver, str) and look(train, "engine") is not None and not is_driven:
        remedy = (
            "leave it out; a machine that drives beside the engine is one of [train.drivers], with a torque"
        )
        yield fault("train", "driver", found=driver, expected="none beside [train.engine]", remedy=remedy)
    elif isinstance(driver, str) and keys(look(train, "drivers")):
        remedy = "leave one of them out"
        yield fault("train", "driver", found=driver, expected="none beside [train.drivers]", remedy=remedy)
    elif isinstance(driver, str) and driver not in discs:
        remedy = close_match(driver, discs) or suggestion(driver, discs)
        yield fault("train", "driver", found=driver, expected="the name of a disc", remedy=remedy)
    yield from _driver_faults(train)
    for table in _ON:
        for name in keys(look(train, table)):
            on = look(look(look(train, table), name), "on")
            if isinstance(on, str) and on not in discs:
                remedy = close_match(on, discs) or suggestion(on, discs)
                yield fault(
                    "train", table, name, "on", found=on, expected="the name of a disc", remedy=remedy
                )


def _driver_faults(train: object) -> Iterator[InitErrorDetails]:
    if not isinstance(train, Train) or train.is_driven:
        return
    for name, driver in train.drivers.items():
        if driver.torque is None:
            expected = "the torque that it gives beside the engine"
            yield fault("train", "drivers", name, "torque", expected=expected)


def _parts_faults(train: object, discs: Sequence[str]) -> Iterator[InitErrorDetails]:
    pairs = [(a, b) for table in _TABLES for _, (a, b) in _pairs(train, table) if GROUND not in (a, b)]
    for engine, throws in _engines(train):
        pairs += pairwise(throw_names(throws, engine))
    for joined in _carried(train):
        pairs += pairwise(name for name in joined if name != GROUND)
    parts = parts_of(discs, pairs)
    if len(parts) > 1:
        found = "; ".join(_listed(part) for part in parts[:4]) + ("; …" if len(parts) > 4 else "")
        remedy = "join them by shafts, couplings or gears, or describe each as a train of its own file"
        expected = "one connected train"
        yield fault("train", found=f"{len(parts)} parts: {found}", expected=expected, remedy=remedy)


def _carried(train: object) -> Iterator[tuple[str, ...]]:
    """Discs that gears on a carrier join: all of a planetary stage, or gears and their carrier."""
    for name in keys(look(train, "planetaries")):
        stage = look(look(train, "planetaries"), name)
        members = [look(stage, member) for member in _MEMBERS]
        planets = stage.planet_names(name) if isinstance(stage, Planetary) else ()
        yield (*(member for member in members if isinstance(member, str)), *planets)
    for name, ends in _pairs(train, "gears"):
        carrier = look(look(look(train, "gears"), name), "carrier")
        if isinstance(carrier, str):
            yield (*ends, carrier)


def _speed_faults(train: Train, expanded: Train) -> Iterator[InitErrorDetails]:
    """Loops that cannot turn, discs whose speed is open, torques by the revolution on a disc at rest."""
    turning, wrong, undetermined = speeds(expanded)
    yield from map(_loop_fault, wrong)
    if undetermined:
        found = f"no speed of {_listed(undetermined)} relative to {next(iter(expanded.discs))}"
        remedy = "hold a member by a shaft to the ground, or give carrier_speed of the stage"
        yield fault("train", found=found, expected="one speed of every disc", remedy=remedy)
    for table in ("loads", "excitations", "drivers", "motors", "mechanisms"):
        for name, entry in getattr(train, table).items():
            if turning[entry.on] == 0:
                expected = "a disc that turns with the train"
                yield fault("train", table, name, "on", found=f"{entry.on}, at rest", expected=expected)
    bent = [name for name, shaft in expanded.shafts.items() if shaft.joint_angle is not None]
    for name in bent:
        if isinstance(expanded.shafts[name], RodShaft):
            expected = 'inertia = "ends" of a shaft with a joint'
            yield fault("train", "shafts", name, "inertia", found="distributed", expected=expected)
    heavy = [name for name, shaft in expanded.shafts.items() if isinstance(shaft, RodShaft)]
    if heavy and any(gear.carrier for gear in expanded.gears.values()):
        expected = 'inertia = "ends" in a train with gears on a carrier'
        yield fault("train", "shafts", heavy[0], "inertia", found="distributed", expected=expected)


def _friction_faults(train: Train, expanded: Train) -> Iterator[InitErrorDetails]:
    """Open clutches in forced vibration, friction beside gears on a carrier."""
    for name, clutch in train.clutches.items():
        if train.run is not None and not clutch.closed:
            remedy = "give its course in the manoeuvre by times and engagement, or leave [train.run] out"
            expected = "true in a train with [train.run], whose vibration a clutch has to carry"
            yield fault("train", "clutches", name, "closed", found=False, expected=expected, remedy=remedy)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")


def _short_rod(error: AssemblyError) -> InitErrorDetails:
    found, remedy = str(error).split(": ", 1)
    expected = "rods that reach their pistons at every crank angle"
    return fault("train", "engine", "rod", found=found, expected=expected, remedy=remedy)


def _no_throw(error: InputError | ArithmeticError) -> InitErrorDetails:
    why = str(error) if isinstance(error, InputError) else "check the units of its sizes"
    found = "sizes of which no throw can be made"
    expected = "a throw with inertia and stiffness above 0"
    return fault("train", "engine", "throw", found=found, expected=expected, remedy=why)


def _loop_fault(wrong: Contradiction) -> InitErrorDetails:
    remedy = "the other way around the loop must give the same ratio, with its sense"
    if wrong.table in ("clutches", "freewheels"):
        remedy = "clutches in parallel need equal ratios; describe one way of the gearbox at a time"
    return fault(
        "train",
        wrong.table,
        wrong.name,
        found=f"ratio {wrong.wanted:.6g}, where the rest of the loop gives {wrong.found:.6g}",
        expected="a loop that can turn",
        remedy=remedy,
    )
