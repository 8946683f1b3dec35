"""How small may the motor of a punching press be, and which flywheel does the work in between?

The load alone is known; a motor of nearly constant torque has to give its mean. Closed forms: the mean of the
steps, and the energy of the punch above it.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.turning.figures import diagram_figure

SHARES = np.linspace(0.05, 0.25, 9)


def study(machine: lw.Machine) -> dict[str, float]:
    """Power with and without the flywheel, and what it weighs."""
    found = lw.turning_moment(machine)
    return {
        "power": found.power_mean,
        "power_of_the_punch": 4000.0 * found.speed_mean,
        "energy_fluctuation": found.energy_fluctuation,
        "flywheel_inertia": found.flywheel_inertia,
        "flywheel_mass": found.flywheel_mass,
        "slowest_deg": float(np.degrees(found.speed_min_angle)),
        "fastest_deg": float(np.degrees(found.speed_max_angle)),
    }


def masses(machine: lw.Machine) -> list[float]:
    """Mass of the flywheel over the fluctuation of speed that is allowed."""
    variants = [lw.replace(machine, {"turning_moment.unevenness": float(share)}) for share in SHARES]
    return [lw.turning_moment(each).flywheel_mass for each in variants]


def figure(machine: lw.Machine):
    """The turning-moment diagram with its energy."""
    return diagram_figure(lw.turning_moment(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:22} {value:.8g}")
    for share, mass in zip(SHARES, masses(example), strict=True):
        print(f"speed fluctuation {share:5.1%}: {mass:6.0f} kg")
    figure(example).savefig(here / "figure.png", dpi=120)
