"""What does a connecting rod weigh by its drawing, and which loads does its stress analysis need?"""

import math
from pathlib import Path

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Mass and inertia of the drawing; peaks of the rod's loads, and the whip of its mass alone."""
    body = machine.bodies["piston.rod"]
    loads = lw.link_loads(machine, "piston.rod", n=1440)
    idle = lw.link_loads(machine.with_entries({"loads": {}}), "piston.rod", n=1440)
    # Whip of a uniform rod that moves with r ω² at the crank, square to it.
    crank, rod = (machine.mechanism.cranks["A"].radius, machine.mechanism.sliders["piston"].rod)
    whip = body.mass * crank * machine.design_speed**2 * rod / (9 * math.sqrt(3))
    return {
        "mass": body.mass,
        "inertia": body.inertia,
        "force_at_the_crank": loads.force_max["A"],
        "force_at_the_piston": loads.force_max["piston"],
        "whip_over_that_of_a_uniform_rod": float(abs(idle.bending).max()) / whip,
        "residual_of_the_balance": loads.residual,
    }


def figure(machine: lw.Machine):
    """Forces at both ends of the rod, and its bending moment."""
    from linkwright.finite_elements.figures import loads_figure

    return loads_figure(lw.link_loads(machine, "piston.rod", n=720))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:32} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
