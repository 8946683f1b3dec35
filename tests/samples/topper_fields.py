"""Machine files of toppers with a field, for several tests."""

from __future__ import annotations

from typing import Any

import linkwright as lw

TOPPER = """
format = 1
name = "Topper"
[topper]
root_diameter = "110 mm"
cut_height = "30 mm"
offset = "20 mm"
edge_angle = "20 deg"
edge_length = "0.18 m"
forward_speed = "1.9 m/s"
knife_speed = "0.55 m/s"
[topper.motion]
kind = "harmonic"
stroke = "60 mm"
"""

CRANK = """
format = 1
name = "Crank"
[drive]
speed = "275 rpm"
[mechanism.cranks.crank]
radius = "30 mm"
[mechanism.sliders.knife]
crank = "crank"
rod = "150 mm"
[topper]
root_diameter = "110 mm"
cut_height = "30 mm"
offset = "20 mm"
edge_angle = "20 deg"
edge_length = "0.18 m"
forward_speed = "1.9 m/s"
[topper.motion]
kind = "member"
of = "knife"
"""

FIELD = """
[topper.field]
kind = "random"
roots = 500
rows = 10
cut_height = { kind = "normal", mean = "28 mm", deviation = "12 mm" }
root_density = "1050 kg/m^3"
"""


def machine(text: str = "", **entries: Any) -> lw.Machine:
    """The topper with tables added, and entries of [topper] exchanged; two underscores go down a table."""
    changes = {"topper." + key.replace("__", "."): value for key, value in entries.items()}
    return lw.loads(TOPPER + text, changes)
