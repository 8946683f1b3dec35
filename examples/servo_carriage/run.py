"""Does a servo motor of 750 W with i = 10 stand the motion of a carriage on a crank?

On the command line:
linkwright axes servo_carriage
"""

from pathlib import Path

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Torque, speed and inertia ratio of the motor, and whether it passes all checks."""
    axis = lw.servo_axis(machine)
    names = ("torque_peak", "torque_rms", "speed_peak", "inertia_ratio", "energy_regenerated")
    return {name: getattr(axis.motor, name) for name in names} | {"passes": float(bool(axis.passes))}


def figure(machine: lw.Machine):
    """Torque over speed of the motor in four quadrants, with its limits."""
    from linkwright.axes.figures import loop_figure

    return loop_figure(lw.servo_axis(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
