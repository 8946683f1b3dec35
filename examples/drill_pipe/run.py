"""How does a drill pipe of 1.5 km swing, heavier than the collar that hangs on it?

Fixed above, with a disc below, β tan β = J_pipe/J_collar with β = ω L √(ρ/G): Thomson, Theory of Vibration
with Applications, section 9.3.
"""

from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """The first two frequencies; the first against its closed form, and against the inertia at the ends."""
    found = lw.free_vibration(machine)
    pipe = machine.train.shafts["pipe"]
    (section,) = pipe.sections
    ratio = section.inertia(pipe.density) / machine.train.discs["collar"].inertia
    beta = brentq(lambda x: x * np.tan(x) - ratio, 0.1, 1.57, xtol=1e-15)
    wave = np.sqrt(pipe.shear_modulus / pipe.density) / section.length
    lumped = lw.free_vibration(lw.replace(machine, {"train.inertia": "ends"})).natural_frequencies[0]
    first = float(found.natural_frequencies[0])
    return {
        "first_frequency_hz": first,
        "second_frequency_hz": float(found.natural_frequencies[1]),
        "first_over_closed_form": first / float(beta * wave / (2 * np.pi)),
        "lumped_first_error": float(lumped / first - 1),
    }


def figure(machine: lw.Machine):
    """The shapes along the pipe."""
    from linkwright.torsion.figures.modes import modes_figure

    return modes_figure(lw.free_vibration(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:24} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
