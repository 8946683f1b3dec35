"""How evenly does a crankshaft with two carts turn, and what would it do without motor and load?

Source: paper 1 (see docs/references.md), the worked case.
"""

from pathlib import Path

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Measures of steady motion beside those at constant kinetic energy."""
    motion, limit = lw.steady_state(machine), lw.constant_energy(machine)
    return {
        "unevenness": motion.unevenness,
        "dynamism": motion.dynamism,
        "unevenness_constant_energy": limit.unevenness,
        "dynamism_constant_energy": limit.dynamism,
    }


def figure(machine: lw.Machine):
    """Speed and acceleration over one revolution."""
    from linkwright.drive.figures import speed_figure

    return speed_figure(lw.steady_state(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
