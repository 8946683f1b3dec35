"""Cases of what stands beside a machine file: own motors, lifts as formulas, reports and pictures."""

from __future__ import annotations

import re
from contextlib import chdir

from commands import call
from mutations import FORMULA, MACHINE_FILE, TABLE, mutated
from numpy.random import Generator
from texts import folder, machine_files, some_file

MOTORS = """type, power_rated [kW], speed_rated [rpm], torque_breakdown_ratio, inertia [kg m^2]
A,5.5,970,2.5,0.04
B,7.5,970,2.5,0.14
C,30,970,2.4,0.5
"""

# Laws of a rise, and some that are none.
LIFTS = (
    "h*(z - sin(2*pi*z)/(2*pi))",
    "h*z^3*(10-15*z+6*z^2)",
    "h*(1-cos(pi*z))/2",
    "h*where(z<0.5,2*z^2,1-2*(1-z)^2)",
    "h*z^0.5",
    "h/(1-z)",
    "h*tanh(1e9*z)",
    "h*sin(1e6*z)",
    "z^z*h",
)

# Commands whose answer is written, for any machine.
WRITTEN = (
    ("report", "--to", "r.html", "--lang", "uk", "run", "machine.toml"),
    ("report", "--to", "r.html", "torsion", "machine.toml"),
    ("draw", "machine.toml", "--out", "d.svg"),
    ("plot", "machine.toml"),
)


def motors(random: Generator) -> None:
    """A catalogue of one's own with mistakes: a motor is chosen, or the line is named."""
    text = mutated(MOTORS, random, TABLE)
    with folder() as here:
        (here / "motors.csv").write_text(text, encoding="utf-8", newline="")
        (here / "machine.toml").write_text(machine_files()["machines/roller_one_cart.toml"], encoding="utf-8")
        words = ["size", str(here / "machine.toml"), "--catalogue", str(here / "motors.csv"), "--by", "power"]
        call(words, {"motors.csv": text})


def lift(random: Generator) -> None:
    """The lift of a cam as a formula with mistakes: it is analysed, or refused."""
    lift = LIFTS[random.integers(len(LIFTS))]
    if random.random() < 0.5:
        lift = mutated(lift, random, FORMULA)
    law = f'law = {{ kind = "formula", lift = {_quoted(lift)} }}'
    cam = machine_files()["machines/roller_cam.toml"]
    text = re.sub(r"law = .*", lambda _: law, cam, count=int(random.integers(2)))
    with folder() as here:
        (here / "machine.toml").write_text(text, encoding="utf-8", newline="")
        call(["cam", str(here / "machine.toml"), "--json"], {"machine.toml": text})


def written(random: Generator) -> None:
    """A machine file with mistakes, and what is written of it: a page in another language, a picture."""
    text = mutated(some_file(random), random, MACHINE_FILE)
    with folder() as here, chdir(here):
        (here / "machine.toml").write_text(text, encoding="utf-8", newline="")
        call(WRITTEN[random.integers(len(WRITTEN))], {"machine.toml": text})


def _quoted(text: str) -> str:
    signs = {'"': '\\"', "\\": "\\\\"}
    return '"' + "".join(signs.get(sign, sign if sign.isprintable() else " ") for sign in text) + '"'
