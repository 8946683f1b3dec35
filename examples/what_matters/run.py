"""Which entries of a machine decide how evenly it turns?

Exact derivatives of δ by every number of the file, as shares: what 1 % more of an entry changes.
"""

from pathlib import Path

import linkwright as lw

RESPONSE = "steady_state.unevenness"


def study(machine: lw.Machine) -> dict[str, float]:
    """Shares by which δ changes for 1 % more of the rods' and cranks' lengths, of a mass and of the ratio."""
    found = lw.gradient(machine, [RESPONSE])
    share = dict(zip(found.variables, found.elasticities[0], strict=True))
    return {
        "crank": share["mechanism.cranks.A1.radius"] + share["mechanism.cranks.A2.radius"],
        "rod": share["mechanism.sliders.cart1.rod"] + share["mechanism.sliders.cart2.rod"],
        "mass": share["bodies.cart1.mass"] + share["bodies.cart2.mass"],
        "ratio": share["drive.gearbox.ratio"],
    }


def figure(machine: lw.Machine):
    """The entries that matter most, as bars."""
    from linkwright.sensitivity.figures import influence_figure

    return influence_figure(lw.gradient(machine, [RESPONSE]), RESPONSE)


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
