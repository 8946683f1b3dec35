"""How high does a scissor lift stand, and how does the screw lift it?"""

from pathlib import Path

import numpy as np

import linkwright as lw

TURNS = np.linspace(0, 55, 221)


def study(machine: lw.Machine) -> dict[str, float]:
    """Height and lift per revolution over their closed forms, h = √(l² − x²); the travel of the nut."""
    motion = lw.kinematics(machine, 2 * np.pi * TURNS)
    nut, table = motion.slides["nut"], motion.slides["post"]
    height = np.sqrt(0.6**2 - nut.position**2)
    rate = 0.004 / (2 * np.pi) * nut.position / height
    low, high = lw.closure(machine).ranges[0]
    return {
        "height": float(np.abs(table.position / height - 1).max()),
        "rate": float(np.abs(table.d1 / rate - 1).max()),
        "travel": 0.004 * (high - low) / (2 * np.pi),
    }


def figure(machine: lw.Machine):
    """Height over the revolutions of the screw."""
    from matplotlib.figure import Figure

    motion = lw.kinematics(machine, 2 * np.pi * TURNS)
    drawing = Figure(figsize=(6, 4), layout="constrained")
    axes = drawing.subplots()
    axes.plot(TURNS, 1e3 * motion.slides["post"].position)
    axes.set(xlabel="revolutions of the screw", ylabel="height [mm]")
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
