"""What do counterweights do to the shaking force of a four-bar, and what do they cost?"""

from pathlib import Path

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Root mean squares with two counterweights, or the crank's alone, over those without."""
    both = lw.balance(machine, ["A", "R.rocker"], radius=0.08).measures()
    one = lw.balance(machine, ["A"], radius=0.08).measures()
    return {
        "force_with_both": both["shaking_force"][1] / both["shaking_force"][0],
        "force_with_one": one["shaking_force"][1] / one["shaking_force"][0],
        "moment_with_both": both["shaking_moment"][1] / both["shaking_moment"][0],
        "torque_with_both": both["torque_drive"][1] / both["torque_drive"][0],
    }


def figure(machine: lw.Machine):
    """Shaking force without counterweights, and with one on the crank."""
    from linkwright.kinetostatics.figures import cases_figure

    found = lw.balance(machine, ["A"], radius=0.08)
    return cases_figure({"without": found.before, "counterweight on the crank": found.after})


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
