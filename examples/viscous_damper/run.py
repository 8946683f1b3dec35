"""Which oil does a viscous damper need, how much of a resonance does it leave, and how warm does it get?

Closed form of one mass with Lanchester's damper: Den Hartog, Mechanical Vibrations, section 3.3, by the mode
of the train.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.torsion.response.forced import forced_vibration

RING = 0.8


def study(machine: lw.Machine) -> dict[str, float]:
    """The best damping, and what the damper of the file does in the run."""
    design = lw.design_damper(machine, "engine", RING)
    run = machine.train.run
    speeds = np.linspace(run.speed_min, run.speed_max, 2001)
    forced = forced_vibration(machine, speeds)
    row, ring = forced.shafts.index("shaft"), forced.shafts.index("damper")
    return {
        "mode_hz": design.natural_frequency,
        "mass_ratio": design.mass_ratio,
        "damping_by_the_mode": design.damping,
        "magnification_promised": design.magnification,
        "damping_best": design.damping_best,
        "magnification_best": design.magnification_best,
        "shaft_torque_nm": float(forced.shaft_torque_vibratory[row].max()),
        "heat_w": float(forced.shaft_heat[ring].max()),
    }


def figure(machine: lw.Machine):
    """The resonance without and with the damper."""
    from linkwright.torsion.figures.forced import damper_figure

    return damper_figure(lw.design_damper(machine, "engine", RING))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:24} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
