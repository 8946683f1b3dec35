"""Which curve does a point on the coupler of a crank-rocker draw, and how far does the rocker swing?"""

from pathlib import Path

import numpy as np

import linkwright as lw

ANGLES = np.linspace(0, 2 * np.pi, 721)


def study(machine: lw.Machine) -> dict[str, float]:
    """Extent of the curve, and the rocker's swing against its closed form from the two dead centres."""
    motion = lw.kinematics(machine, ANGLES)
    curve, rocker = motion.points["K"].position, motion.links["C.rocker"].angle
    # Dead centres: crank and coupler in line, 120 ± 50 mm; cosine theorem with 160 and 110 mm.
    ends = [np.arccos((0.16**2 + 0.11**2 - d**2) / (2 * 0.16 * 0.11)) for d in (0.17, 0.07)]
    return {
        "width": float(np.ptp(curve[:, 0])),
        "height": float(np.ptp(curve[:, 1])),
        "swing_over_closed_form": float(np.ptp(rocker)) / (ends[0] - ends[1]),
    }


def figure(machine: lw.Machine):
    """The curve."""
    from matplotlib.figure import Figure

    curve = lw.kinematics(machine, ANGLES).points["K"].position
    drawing = Figure(figsize=(6, 5), layout="constrained")
    axes = drawing.subplots()
    axes.plot(1e3 * curve[:, 0], 1e3 * curve[:, 1])
    axes.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
