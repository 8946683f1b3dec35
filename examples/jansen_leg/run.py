"""How level does the foot of Jansen's leg walk, and how far?"""

from pathlib import Path

import numpy as np

import linkwright as lw

ANGLES = np.linspace(0, 2 * np.pi, 1441)


def study(machine: lw.Machine) -> dict[str, float]:
    """Step and lift of the foot, share of the revolution near the ground, and closure of the bars."""
    motion = lw.kinematics(machine, ANGLES)
    x, y = motion.points["F"].position.T
    low = y < y.min() + 0.1 * np.ptp(y)
    bars = machine.mechanism.bars.values()
    ends = [motion.points[bar.end].position - motion.points[bar.start].position for bar in bars]
    gaps = [np.abs(np.hypot(*u.T) - bar.length).max() for u, bar in zip(ends, bars, strict=True)]
    return {
        "step": float(np.ptp(x)),
        "lift": float(np.ptp(y)),
        "share_on_ground": float(low.mean()),
        "step_on_ground": float(np.ptp(x[low])),
        "gap": float(max(gaps)),
    }


def figure(machine: lw.Machine):
    """The path of the foot under the leg."""
    from matplotlib.figure import Figure

    motion = lw.kinematics(machine, ANGLES)
    drawing = Figure(figsize=(6, 6), layout="constrained")
    axes = drawing.subplots()
    for bar in machine.mechanism.bars.values():
        axes.plot(*100 * np.array([motion.points[end].position[0] for end in (bar.start, bar.end)]).T, "C0")
    axes.plot(*100 * motion.points["F"].position.T, "C1")
    axes.set(xlabel="x [cm]", ylabel="y [cm]", aspect="equal")
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
