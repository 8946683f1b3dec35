"""Does the knife of a flying shear move with the strip, and do the three motors stand the cycle?

On the command line:
linkwright axes flying_shear
"""

from pathlib import Path

import numpy as np

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Slip and stroke of the knife while it cuts, peak force of each axis, verdicts, peak power."""
    axes = {name: lw.servo_axis(machine, name) for name in machine.axes}
    angle = np.radians(np.linspace(90.0, 180.0, 181))
    knife = lw.kinematics(machine, angle).points["K"]
    return {
        "slip": float(np.abs(2 * np.pi * knife.d1[:, 0] - 1.0).max()),
        "stroke": float(np.ptp(knife.position[:, 1])),
        **{f"force_{name}": abs(axis.torque_max) for name, axis in axes.items()},
        **{f"passes_{name}": float(bool(axis.passes)) for name, axis in axes.items()},
        "bus_power_peak": lw.dc_bus(machine).power_max,
    }


def figure(machine: lw.Machine):
    """The timing diagram of the strip and both carriages."""
    from linkwright.axes.figures import timing_figure

    return timing_figure(lw.timing(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
