"""Cases of texts: machine files, overrides, tables and formulas as somebody might write them by mistake."""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path

import numpy as np
from broken import PromiseError, watched
from commands import asked, call, finite, questions
from mutations import FORMULA, MACHINE_FILE, TABLE, VALUES, mutated
from numpy.random import Generator
from numpy.typing import NDArray

import linkwright as lw
from linkwright import LinkwrightError
from linkwright.kernel.description import formula
from linkwright.kernel.files.library import template, templates
from linkwright.kernel.numerics.formula_value import value
from linkwright.machine import compile_machine

Floats = NDArray[np.float64]

ROOT = Path(__file__).parents[2]


@lru_cache(maxsize=1)
def machine_files() -> dict[str, str]:
    """Machine files to start from: shipped machines, examples and templates, by name."""
    paths = [*sorted((ROOT / "machines").glob("*.toml")), *sorted((ROOT / "examples").glob("*/machine.toml"))]
    texts = {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in paths}
    return texts | {f"template {name}": template(name) for name in templates()}


# What lies beside machine files that refer to it: tables and drawings.
BESIDE = [
    path
    for kind in ("csv", "dxf")
    for path in (*ROOT.glob(f"machines/*.{kind}"), *ROOT.glob(f"examples/*/*.{kind}"))
]


@contextmanager
def folder() -> Iterator[Path]:
    with tempfile.TemporaryDirectory(prefix="linkwright_fuzz_") as name:
        for path in BESIDE:
            shutil.copy(path, name)
        yield Path(name)


def some_file(random: Generator) -> str:
    names = list(machine_files())
    return machine_files()[names[random.integers(len(names))]]


def file_of_a_machine(random: Generator) -> None:
    """A machine file with mistakes: every command answers, or says what is wrong."""
    text = mutated(some_file(random), random, MACHINE_FILE)
    with folder() as here:
        path = here / "machine.toml"
        path.write_text(text, encoding="utf-8", newline="")
        inputs = {"machine.toml": text}
        if call(["check", str(path)], inputs) == 2:
            return
        possible = questions(text)
        for k in random.permutation(len(possible))[:2]:
            call(asked(possible[k], path), inputs)


def override(random: Generator) -> None:
    text = some_file(random)
    entries = list(lw.addresses(_machine_of(text)))
    values = [value.strip('"') for value in VALUES]
    with folder() as here:
        path = here / "machine.toml"
        path.write_text(text, encoding="utf-8")
        possible = questions(text)
        arguments = asked(possible[random.integers(len(possible))], path)
        for _ in range(random.integers(1, 3)):
            entry, given = entries[random.integers(len(entries))], values[random.integers(len(values))]
            arguments += ["--set", f"{entry}={given}"]
        call(arguments, {"machine.toml": text})


@lru_cache(maxsize=64)
def _machine_of(text: str) -> lw.Machine:
    with folder() as here:
        path = here / "machine.toml"
        path.write_text(text, encoding="utf-8")
        return lw.read(path)


def bytes_of_a_file(random: Generator) -> None:
    """A machine file of which some bytes are others: no encoding is a reason to fail without a word."""
    data = bytearray(some_file(random).encode())
    for _ in range(random.integers(1, 8)):
        data[random.integers(len(data))] = random.integers(256)
    if random.random() < 0.1:
        data = bytearray(bytes(data).decode("latin-1").encode("utf-16"))
    with folder() as here:
        path = here / "machine.toml"
        path.write_bytes(bytes(data))
        call(["check", str(path)], {"machine.toml": bytes(data)})


def table(random: Generator) -> None:
    """A table of measured values with mistakes, in an engine's indicator diagram or a field of roots."""
    name, machine = (
        ("v_diesel_indicator.csv", "machines/v_diesel.toml"),
        ("roots.csv", "examples/topper_field/machine.toml"),
    )[random.integers(2)]
    with folder() as here:
        path, place = here / "machine.toml", here / name
        rows = place.read_text(encoding="utf-8").split("\n")
        # Some tens of rows hold every mistake that thousands could.
        text = mutated("\n".join(rows[:40]), random, TABLE)
        place.write_text(text, encoding="utf-8", newline="")
        path.write_text(machine_files()[machine], encoding="utf-8")
        call(["check", str(path)], {"machine.toml": machine_files()[machine], name: text})


LOAD = """
format = 1
name = "Crank"
[drive]
speed = 5.0
[mechanism.cranks.A]
radius = 0.3
[bodies]
A = {{ mass = 2.0 }}
[loads]
load = {{ kind = "formula", on = "A", torque = "{formula}" }}
"""

# Places and speed of the crank at which formulas are compared, away from where functions jump.
ANGLES, SPEED = np.linspace(0.1, 6.1, 7), 5.3

# All numbers of a formula are varied by a few units of the last digit; what rounding of its operations makes
# of the value is no more than some of these changes.
_BESIDE, _LOST = 1e-15, 10.0


def formula_text(random: Generator) -> None:
    """A formula with mistakes: it is read, or refused with the character at which it is wrong."""
    text = mutated(_formula(random, 3), random, FORMULA)
    with watched({"formula": text}):
        try:
            formula.parse(text)
        except formula.FormulaError as error:
            if not str(error):
                raise PromiseError("refused without a word", {"formula": text}) from None


def formula_value(random: Generator) -> None:
    """A random formula has the value in the core that plain arithmetic gives it, and in Python's tree too."""
    text = _formula(random, int(random.integers(1, 5)))
    inputs = {"formula": text}
    with watched(inputs), np.errstate(all="ignore"):
        # Numbers of numpy divide by zero as the core does.
        python = re.sub(r"(?<![\w.])(\d[\d.e]*)", r"number(\1)", text.replace("^", "**"))
        by_hand, beside = (
            np.broadcast_to(eval(python, {"__builtins__": {}}, _names(scale)), ANGLES.shape)
            for scale in (1.0, 1.0 + _BESIDE)
        )
        # Of a cosine of 1e9, seven digits are left: as much as numbers beside make of it, rounding may.
        lost = _LOST * np.nan_to_num(np.abs(beside - by_hand), posinf=0.0)
        _same(value(formula.parse(text), _names()), by_hand, lost, inputs)
    with suppress(LinkwrightError), watched(inputs):
        # Refused: too long for the stack, or nothing in it depends on the motion as the core needs it.
        compiled = compile_machine(lw.loads(LOAD.format(formula=text)))
        at = compiled.reductions(ANGLES)
        resisting = at.load + at.dry + at.viscous * SPEED
        if compiled.has_laws:
            resisting = resisting + compiled.law_torques(ANGLES, np.array([SPEED]))[0]
        _same(-resisting, by_hand, lost, inputs)


def _names(scale: float = 1.0) -> dict[str, object]:
    """What formulas may name, all numbers times `scale`."""
    functions = {name: getattr(np, name) for name in ("sin", "cos", "tanh", "exp", "sqrt", "abs", "sign")}
    choices = {"min": np.minimum, "max": np.maximum, "atan2": np.arctan2, "where": np.where}
    return {
        **functions,
        **choices,
        "number": lambda x: np.float64(x) * scale,
        "phi": ANGLES * scale,
        "omega": SPEED * scale,
        "pi": np.pi * scale,
        "g": 9.81 * scale,
    }


def _same(found: object, expected: Floats, lost: Floats, inputs: dict[str, str]) -> None:
    # Differences of large terms lose digits against the terms, none of which passes 1e3^6 here.
    size = np.abs(expected[np.isfinite(expected)]).max(initial=1.0)
    if not np.allclose(found, expected, rtol=1e-9, atol=1e-9 * size + lost, equal_nan=True):
        raise PromiseError(f"found {found}, plain arithmetic gives {expected}", inputs)


def _formula(random: Generator, depth: int) -> str:
    if depth == 0 or random.random() < 0.15:
        leaves = ("phi", "omega", "pi", "g", "2", "0.5", "1e3", "7.25", "1")
        return leaves[random.integers(len(leaves))]

    def part() -> str:
        return _formula(random, depth - 1)

    kind = random.integers(10)
    if kind < 5:
        return f"({part()} {'+-*/+'[kind]} {part()})"
    if kind == 5:
        return f"(-{part()})"
    if kind == 6:
        return f"abs({part()})^{random.integers(1, 4)}"
    if kind == 7:
        return f"{('min', 'max', 'atan2')[random.integers(3)]}({part()}, {part()})"
    if kind == 8:
        return f"where({part()} < {part()}, {part()}, {part()})"
    return f"{('sin', 'cos', 'tanh', 'abs', 'sign')[random.integers(5)]}({part()})"


def results(random: Generator) -> None:
    """Entries of a sound machine change up to threefold: all results are finite, or it says why."""
    text = some_file(random)
    machine = _machine_of(text)
    entries = [(address, number) for address, number in lw.addresses(machine).items() if number]
    picked = [entries[k] for k in random.permutation(len(entries))[: random.integers(1, 4)]]
    changes = {address: float(number * 3.0 ** random.uniform(-1, 1)) for address, number in picked}
    inputs = {"machine.toml": text, "changes": repr(changes)}
    try:
        with watched(inputs):
            machine = lw.loads(text, changes)
            found = lw.study(machine) if machine.mechanism else lw.torsion_study(machine)
            finite(found.to_dict(), inputs)
    except LinkwrightError:
        return
