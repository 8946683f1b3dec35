"""Does a servo motor drive a crank press whose ram slows down at the work?

On the command line:
linkwright axes servo_press
"""

from pathlib import Path

import numpy as np

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Largest velocity of the ram in the sheet; torque at the crank; what the motor stands."""
    axis = lw.servo_axis(machine)
    ram = lw.kinematics(machine, axis.crank_angle).slides["ram"]
    in_sheet = (ram.position > 0.56) & (ram.d1 > 0)
    return {
        "velocity_in_sheet": float(4 * np.pi / 3 * ram.d1[in_sheet].max()),
        "torque_crank": axis.torque_max,
        "torque_peak": axis.motor.torque_peak,
        "torque_rms": axis.motor.torque_rms,
        "speed_peak": axis.motor.speed_peak,
        "energy_regenerated": axis.motor.energy_regenerated,
        "passes": float(bool(axis.passes)),
    }


def figure(machine: lw.Machine):
    """Position, velocity, acceleration and torque of the crank."""
    from linkwright.axes.figures import timing_figure

    return timing_figure(lw.timing(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
