"""Which flywheel does a four-stroke engine need, and how much of it do two cylinders save?

The torque is a half sine wave for each stroke, so that all results have a closed form: a half wave of height
a has the area 2a, and the shaft is fastest and slowest where the torque of the expansion passes the mean.
A rim of cast iron may have a hoop stress of 4 MPa: that gives its radius, and with the inertia its mass.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.turning.figures import diagram_figure


def two_cylinders(machine: lw.Machine) -> lw.Machine:
    """The same engine with a second cylinder that fires a revolution later."""
    one = machine.turning_moment.driver.torque
    other = "where(phi < pi, suction, where(phi < 2*pi, compression, where(phi < 3*pi, expansion, exhaust)))"
    other += "*abs(sin(phi))"
    return lw.replace(machine, {"turning_moment.driver.torque": f"{one} + {other}"})


def study(machine: lw.Machine) -> dict[str, float]:
    """The flywheel of one cylinder and of two."""
    one, two = lw.turning_moment(machine), lw.turning_moment(two_cylinders(machine))
    return {
        "power": one.power_mean,
        "energy_fluctuation": one.energy_fluctuation,
        "flywheel_inertia": one.flywheel_inertia,
        "flywheel_mass": one.flywheel_mass,
        "energy_coefficient": one.energy_coefficient,
        "energy_coefficient_of_two": two.energy_coefficient,
        "flywheel_inertia_of_two": two.flywheel_inertia,
        "rim_radius": one.rim_radius,
        "rim_mass": one.rim_mass,
        "rim_thickness": one.rim_thickness,
        "fastest_deg": float(np.degrees(one.speed_max_angle)),
        "share_of_the_expansion": _share(machine, "turning_moment.driver.constants.expansion"),
        "share_of_the_speed": _share(machine, "turning_moment.speed"),
    }


def _share(machine: lw.Machine, address: str) -> float:
    """By how many per cent the flywheel grows for 1 % more of an entry."""
    return float(lw.gradient(machine, ["turning_moment.flywheel_inertia"], [address]).elasticities[0, 0])


def figure(machine: lw.Machine):
    """The turning-moment diagram with its energy."""
    return diagram_figure(lw.turning_moment(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.8g}")
    figure(example).savefig(here / "figure.png", dpi=120)
