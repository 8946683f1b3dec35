"""At which angle between its two cranks does a crankshaft with two carts turn most evenly?

By symmetry of the in-line slider-crank near 90°; a hundred thousand machines say where exactly.
"""

from pathlib import Path

import numpy as np

import linkwright as lw

PHASES = np.linspace(45.0, 135.0, 901)


def unevenness(machine: lw.Machine):
    """δ for every phase."""
    return lw.steady_states(machine, {"mechanism.cranks.A2.phase": np.radians(PHASES)}).unevenness


def study(machine: lw.Machine) -> dict[str, float]:
    """The best phase, and δ there."""
    delta = unevenness(machine)
    best = int(delta.argmin())
    return {"best_phase_deg": float(PHASES[best]), "unevenness": float(delta[best])}


def figure(machine: lw.Machine):
    """δ over the phase."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(7, 4), layout="constrained")
    axes = drawing.subplots()
    axes.plot(PHASES, unevenness(machine))
    axes.set(xlabel="angle between the cranks [°]", ylabel="coefficient of speed fluctuation δ [–]")
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
