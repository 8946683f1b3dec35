"""Does a geared five-bar linkage draw the same curve as a four-bar linkage?"""

from pathlib import Path

import numpy as np

import linkwright as lw

ANGLES = np.linspace(0, 2 * np.pi, 361)
FOUR_BAR = lw.read(Path(__file__).with_name("four_bar.toml"))


def curves(machine: lw.Machine) -> tuple[np.ndarray, np.ndarray]:
    """The curve of the four-bar linkage, and that of the five-bar linkage at the same coupler angles."""
    motion = lw.kinematics(FOUR_BAR, ANGLES)
    # The crank of the five-bar linkage is the side A-K of the coupler.
    side = motion.links["C.coupler"].angle + np.arctan2(0.06, 0.08)
    return motion.points["K"].position, lw.kinematics(machine, side).points["K"].position


def study(machine: lw.Machine) -> dict[str, float]:
    """Maximum distance of the two, and the extent of the curve."""
    four, five = curves(machine)
    return {"apart": float(np.abs(four - five).max()), "width": float(np.ptp(four[:, 0]))}


def figure(machine: lw.Machine):
    """Both curves."""
    from matplotlib.figure import Figure

    four, five = curves(machine)
    drawing = Figure(figsize=(6, 5), layout="constrained")
    axes = drawing.subplots()
    axes.plot(*1e3 * four.T, label="four-bar linkage")
    axes.plot(*1e3 * five[::15].T, "o", label="geared five-bar linkage")
    axes.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    axes.grid(alpha=0.3)
    axes.legend()
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
