"""What are the lengths of a press that is given by its drawing, and what is the stroke of its ram?

On the command line:
linkwright run knuckle_press_drawing
"""

from pathlib import Path

import numpy as np

import linkwright as lw

# As the drawing has them [m], from the pivot of the crank.
DRAWN = {"A": (0.036, 0.048), "B": (0.330, -0.030), "ram": (0.400, -0.310)}


def study(machine: lw.Machine) -> dict[str, float]:
    """Lengths, the stroke, and how far the mechanism is from its drawing."""
    mechanism = machine.mechanism
    placed = lw.pose(machine, mechanism.assembled_at).points
    ram = next(each for each in lw.linkage(machine).elements if each.output == "ram")
    return {
        "crank": mechanism.cranks["A"].radius,
        "coupler": mechanism.rockers["B"].coupler,
        "rod": mechanism.sliders["ram"].rod,
        "stroke": ram.stroke,
        "distance_from_drawing": max(
            np.hypot(*(placed[name].position - np.array(at))) for name, at in DRAWN.items()
        ),
    }


def figure(machine: lw.Machine):
    """Position, velocity and acceleration of knee and ram over the crank angle."""
    from linkwright.drive.figures_of_cycle import cycle_figures

    with lw.shown_in("mm"):
        return next(cycle_figures(lw.cycle_motion(machine), lw.linkage(machine))).figure


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:24} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
