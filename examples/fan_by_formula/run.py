"""How fast does a shaft run whose load is given by formulas, and how much of the work is the fan's?"""

from pathlib import Path

import numpy as np

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Speed fluctuation; work of the revolution over what the formulas say; mean speed without the fan."""
    motion = lw.steady_state(machine)
    alone = lw.steady_state(lw.replace(machine, {"loads.fan.constants.c": 0.0}))
    fan = np.trapezoid(0.12 * motion.speed**2, motion.crank_angle)
    plunger = (4e5 * 20e-4 + 2 * 40) * 2 * 0.06
    return {
        "unevenness": motion.unevenness,
        "work_over_formula": motion.energy_load / (fan + plunger),
        "speed_without_fan": alone.speed_mean_time,
    }


def figure(machine: lw.Machine):
    """Torque and power over one revolution."""
    from linkwright.drive.figures import torque_figure

    return torque_figure(lw.steady_state(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
