"""Which torque does each of the two motors of a five-bar linkage give?

On the command line:
linkwright axes five_bar_two_motors
"""

from pathlib import Path

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Peak torque of each motor, and of their sum, which exists in the computation alone."""
    found = {f"torque_{name}": lw.servo_axis(machine, name).torque_max for name in machine.axes}
    found["torque_referred_to_the_master"] = lw.forces(machine).torque_drive_max
    return found | {"power_residual": lw.dc_bus(machine).power_residual}


def figure(machine: lw.Machine):
    """Position, velocity, acceleration and torque of both motors."""
    from linkwright.axes.figures import timing_figure

    return timing_figure(lw.timing(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
