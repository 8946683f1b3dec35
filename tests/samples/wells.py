"""Wells: rod strings of round numbers, that of API RP 11L's worked example, and random ones."""

from __future__ import annotations

from typing import Any

import numpy as np

import linkwright as lw

INCH, FOOT, POUND, PSI = 0.0254, 0.3048, 4.4482216152605, 6894.757293168361


# A conventional unit of 54 in stroke.
UNIT = """
[pumping_unit]
A = "72 in"
C = "64 in"
I = "64 in"
P = "74.5 in"
H = "116 in"
G = "41 in"
R = "23.4 in"
"""

# The string of the worked example of API RP 11L.
API_STRING = """
[rod_string]
specific_gravity = 0.9
[[rod_string.sections]]
rod = "7/8"
length = "1585 ft"
grade = "C"
[[rod_string.sections]]
rod = "3/4"
length = "3415 ft"
grade = "C"
[rod_string.pump]
plunger = "1.5 in"
fluid_level = "4500 ft"
"""


def well(pump: dict[str, Any] | None = None, **entries: Any) -> lw.Machine:
    """The string of the worked example of API RP 11L on a harmonic polished rod; entries of it exchanged."""
    sections = [
        {"rod": "7/8", "length": "1585 ft", "grade": "C"},
        {"rod": "3/4", "length": "3415 ft", "grade": "C"},
    ]
    string = {
        "specific_gravity": 0.9,
        "stroke": "54 in",
        "speed": "16 rpm",
        "sections": sections,
        "pump": _given({"plunger": "1.5 in", "fluid_level": "4500 ft"} | (pump or {})),
    }
    return lw.Machine.model_validate({"format": 1, "name": "well", "rod_string": _given(string | entries)})


def _given(entries: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in entries.items() if value is not None}


def random_well(generator: np.random.Generator) -> lw.Machine:
    """One to three tapers, any pump: full, partly filled, with gas, tubing anchored or not."""
    length = generator.uniform(600, 2700)
    n = int(generator.integers(1, 4))
    shares = generator.dirichlet(np.full(n, 5.0))
    rods = ("1", "7/8", "3/4")[-n:]
    pump: dict[str, Any] = {
        "plunger": generator.uniform(1.06, 2.25) * INCH,
        "fluid_level": length * generator.uniform(0.5, 1.0),
    }
    if generator.random() < 0.5:
        pump["fillage"] = generator.uniform(0.3, 0.95)
        if generator.random() < 0.5:
            pump["gas_exponent"] = 1.2
    if generator.random() < 0.5:
        pump |= {"tubing_diameter": "2.875 in", "tubing_bore": "2.441 in"}
    return well(
        pump,
        specific_gravity=generator.uniform(0.8, 1.05),
        stroke=generator.uniform(1.0, 4.2),
        speed=generator.uniform(3, 16 * min(1, 1500 / length)) * 2 * np.pi / 60,
        damping_factor=generator.uniform(0.05, 0.3),
        sections=[
            {"rod": rod, "length": share * length, "grade": "D"}
            for rod, share in zip(rods, shares, strict=True)
        ],
    )
