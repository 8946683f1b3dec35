"""At which speed of the drive does a drill bit stick for good, stick and slip, or turn steadily?

Under the weight of 55 kN the bit starts from rest at three no-load speeds of the drive.
"""

from pathlib import Path

import linkwright as lw
from linkwright.torsion.in_time.transient import TorsionTransient

SPEEDS = (12.0, 14.0, 16.0)


def drilled(machine: lw.Machine, speed: float) -> TorsionTransient:
    """The motion with another no-load speed of the drive [rad/s]."""
    course = "train.transient.events.0.speed"
    return lw.torsion_transient(lw.replace(machine, {f"{course}.0": speed, f"{course}.1": speed}))


def study(machine: lw.Machine) -> dict[str, float]:
    """How often and how long the bit sticks, how fast it gets, and the heat at the rock."""
    numbers = {}
    for speed in SPEEDS:
        moved = drilled(machine, speed)
        bit = moved.discs.index("bit")
        numbers |= {
            f"engagements_{speed:g}": float(moved.engagements[0]),
            f"stuck_time_{speed:g}": float(moved.stuck_time[0]),
            f"bit_speed_max_{speed:g}": float(moved.speed_max[bit]),
            f"pipe_torque_max_{speed:g}": float(moved.torque_max[0]),
            f"heat_mj_{speed:g}": 1e-6 * float(moved.friction_heat[0]),
            f"bit_speed_at_the_end_{speed:g}": float(moved.speed[bit, -1]),
        }
    return numbers


def figure(machine: lw.Machine):
    """The bit sticks and slips at 14 rad/s."""
    from linkwright.torsion.figures.friction import friction_figure

    return friction_figure(drilled(machine, SPEEDS[1]))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:26} {value:.8g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
