"""What are the joint reactions of a press, and what power does their friction take?"""

from pathlib import Path

import numpy as np

import linkwright as lw

# Bronze bushings on the crankshaft, the crank's pin and the ram's pin; the ram's guide.
FRICTION = {
    "O": lw.Friction(0.1, radius=0.05),
    "A": lw.Friction(0.1, radius=0.06),
    "ram": lw.Friction(0.1, radius=0.03),
    "ram.guide": lw.Friction(0.1),
}


def study(machine: lw.Machine) -> dict[str, float]:
    """Peaks along the steady motion, and work of friction over work of the loads per revolution."""
    smooth, rough = lw.forces(machine, n=1440), lw.forces(machine, n=1440, friction=FRICTION)
    lost = np.trapezoid(rough.power_friction, rough.time)
    work = np.trapezoid(rough.power_load, rough.time)
    return {
        "force_of_the_rod": smooth.reaction_max["A"],
        "force_of_the_guide": smooth.reaction_max["ram.guide"],
        "torque_with_friction": rough.torque_drive_max / smooth.torque_drive_max,
        "friction_over_work": float(lost / work),
        "balance_of_powers": float(np.abs(rough.power_residual).max() / np.abs(rough.power_drive).max()),
    }


def figure(machine: lw.Machine):
    """Hodographs of the reactions and of the shaking force."""
    from linkwright.kinetostatics.figures import hodograph_figure

    return hodograph_figure(lw.forces(machine, n=1440, friction=FRICTION))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
