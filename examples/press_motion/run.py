"""How fast does the ram of a press move, and how hard is it accelerated, counted from its top dead centre?

On the command line:
linkwright plot press_motion ram.place ram.velocity ram.acceleration --zero top --units mm,rpm
"""

from pathlib import Path

import numpy as np

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Extremes of velocity and acceleration of the ram, and where they are."""
    top = lw.zero_angle(machine, "top").angle
    extremes = lw.cycle_motion(machine).extremes
    velocity, acceleration = extremes["ram.place.velocity"], extremes["ram.place.acceleration"]
    return {
        "velocity_max": velocity.maximum,
        "angle_of_velocity_max": np.degrees((velocity.maximum_angle - top) % (2 * np.pi)),
        "acceleration_at_the_top": acceleration.maximum,
        "acceleration_at_the_bottom": acceleration.minimum,
    }


def figure(machine: lw.Machine):
    """Position, velocity and acceleration over the crank angle."""
    from linkwright.drive.figures_of_cycle import cycle_figures

    return next(cycle_figures(lw.cycle_motion(machine), lw.linkage(machine))).figure


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
