"""How does a parallelogram pass the positions where all its links are in line?"""

from pathlib import Path

import numpy as np

import linkwright as lw

# The change points at 0° and 180°, and angles ever closer to them.
NEAR = np.concatenate([[0.0], *([-d, d] for d in 10.0 ** -np.arange(1, 13))])
ANGLES = np.sort(np.concatenate([NEAR, np.pi + NEAR, np.linspace(0, 2 * np.pi, 721)]))


def study(machine: lw.Machine) -> dict[str, float]:
    """Departure from the laws of both linkages, at, near and far from the change points.

    Parallelogram: the coupler does not turn. Antiparallelogram: coupler and frame touch in the point where
    they cross, so dψ/dφ = −(l² − r²)/(l² + r² − 2 l r cos φ) with cranks r and long links l.
    """
    links = lw.kinematics(machine, ANGLES).links
    length, crank = 0.3, 0.1
    size = length**2 + crank**2 - 2 * length * crank * np.cos(ANGLES)
    rate = -(length**2 - crank**2) / size
    bend = -rate * 2 * length * crank * np.sin(ANGLES) / size
    return {
        "coupler_turns": float(np.abs(links["C.coupler"].d1).max()),
        "coupler_bends": float(np.abs(links["C.coupler"].d2).max()),
        "antiparallelogram": float(np.abs(links["E.rocker"].d1 - rate).max()),
        "antiparallelogram_bends": float(np.abs(links["E.rocker"].d2 - bend).max()),
        "third_crank": float(np.abs(links["third crank"].d1 - 1).max()),
    }


def figure(machine: lw.Machine):
    """Speed of the driven cranks."""
    from matplotlib.figure import Figure

    motion = lw.kinematics(machine, ANGLES)
    drawing = Figure(figsize=(6, 4), layout="constrained")
    axes = drawing.subplots()
    for name in ("C.rocker", "E.rocker"):
        axes.plot(np.degrees(ANGLES), motion.links[name].d1, label=name)
    axes.set(xlabel="crank angle [°]", ylabel="speed over that of the crank", xlim=(0, 360))
    axes.legend()
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
