"""Which sizes of a valve train decide its pressure angle?

Exact derivatives of the maximum pressure angle by every size of the cam, its follower and its law.
"""

from pathlib import Path

import numpy as np

import linkwright as lw

RESPONSE = "cam.finger.pressure_angle_max"
LENGTHS = ("pivot.x", "pivot.y", "arm_length", "base_radius", "roller_radius")


def study(machine: lw.Machine) -> dict[str, float]:
    """The angle; its change for 1 % more of a length, for 1 mm of base radius, for a longer rise."""
    found = lw.gradient(machine, [RESPONSE])
    share = dict(zip(found.variables, found.elasticities[0], strict=True))
    slope = found.of(RESPONSE)
    sections = "mechanism.cams.finger.sections"
    longer = slope[f"{sections}.0.angle"] - slope[f"{sections}.2.angle"]
    lengths = [sum(value for name, value in share.items() if name.endswith(f".{key}")) for key in LENGTHS]
    return {
        "pressure_angle": float(np.degrees(found.values[0])),
        "arm": lengths[2],
        "base": lengths[3],
        "all_lengths": sum(lengths),
        "degrees_per_mm_of_base": float(np.degrees(slope["mechanism.cams.finger.base_radius"]) * 1e-3),
        "degrees_per_degree_of_rise": longer,
    }


def figure(machine: lw.Machine):
    """The sizes that matter most, as bars."""
    from linkwright.sensitivity.figures import influence_figure

    return influence_figure(lw.gradient(machine, [RESPONSE]), RESPONSE)


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
