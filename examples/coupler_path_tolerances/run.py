"""How far does a four-bar's coupler point stray from its path, and which length is to blame?"""

from functools import cache
from pathlib import Path

import numpy as np

import linkwright as lw

HERE, ANGLES = Path(__file__).parent, range(0, 360, 30)
# Standard deviations of the six lengths [m], a third of their tolerances, in the order of the file.
SIZES = np.array([0.1, 0.05, 0.1, 0.1, 0.2, 0.2]) * 1e-3 / 3


@cache
def scatter():
    """Tolerances of x and y at all angles, with what contributes."""
    one = 'study.responses.{0}{1}={{ curve = "motion.K.{0}", at = "{1} deg" }}'
    study = lw.read_study(HERE / "study.toml", [one.format(c, a) for a in ANGLES for c in "xy"])
    return lw.tolerance(study, 2000)


def spread(angle: int):
    """Covariance of x and y to first order [m²], (2, 2)."""
    slopes = np.array([list(scatter().slopes[f"{c}{angle}"].values()) for c in "xy"])
    return (slopes * SIZES**2) @ slopes.T


def study(machine: lw.Machine) -> dict[str, float]:
    """The largest standard deviation of the path, where it is, what contributes, first order over random."""
    size = {a: np.sqrt(np.linalg.eigvalsh(spread(a))[-1]) for a in ANGLES}
    worst = max(size, key=size.__getitem__)
    drawn = np.hypot(*(scatter().responses[f"{c}{worst}"]["deviation"] for c in "xy"))
    return {
        "worst_angle_deg": float(worst),
        "deviation_max_um": size[worst] * 1e6,
        "share_of_across_in_y": scatter().contributions[f"y{worst}"]["K_across"],
        "first_order_over_random": np.sqrt(np.trace(spread(worst))) / drawn,
    }


def figure(machine: lw.Machine):
    """The path, with the ellipses of three standard deviations, 30 times as large."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(6.4, 5), layout="constrained")
    axes = drawing.subplots()
    x, y = lw.motions(machine, np.radians(np.arange(361)), points=["K"])[0][:2] * 1e3
    axes.plot(x, y, color="#0072b2")
    turn = np.linspace(0, 2 * np.pi, 60)
    for angle in ANGLES:
        edge = 30 * 3e3 * np.linalg.cholesky(spread(angle)) @ [np.cos(turn), np.sin(turn)]
        axes.plot(x[angle] + edge[0], y[angle] + edge[1], color="#d55e00", linewidth=1)
        axes.annotate(f"{angle}°", (x[angle], y[angle]), fontsize=7)
    axes.set(xlabel="x [mm]", ylabel="y [mm]", title="path of K; 3 standard deviations × 30", aspect="equal")
    return drawing


if __name__ == "__main__":
    figure(lw.read(HERE / "machine.toml")).savefig(HERE / "figure.png", dpi=120)
