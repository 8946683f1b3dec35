"""At which angle between two cranks is the motion most even, whatever the length of the rods?

Speed fluctuation δ, dynamic factor H and combined non-uniformity index k_p = δ² + H over phase and rod
ratio λ = r/l. Their minima are kinks, where two extremes are equal; a finer grid finds them.
"""

from functools import cache
from pathlib import Path

import numpy as np

import linkwright as lw

HERE = Path(__file__).parent
PLAN = lw.read_study(HERE / "study.toml")
TITLES = {"delta": "speed fluctuation δ [–]", "H": "dynamic factor H [–]", "k_p": "index $k_p$ = δ² + H [–]"}


@cache
def maps():
    """The grid, (phases, rods), and by each measure the best phase [°] and the minimum for each rod."""
    grid = lw.evaluate(PLAN, PLAN.rows(0, 25 * 9)).columns
    found = {name: values.reshape(25, 9) for name, values in grid.items()}
    best, rods, steps = {}, range(9), np.radians(np.linspace(-2.5, 2.5, 101))[:, None]
    for name in TITLES:
        near = found["phase"][found[name].argmin(axis=0), rods] + steps
        rows = {"phase": near.ravel(), "rod": np.tile(found["rod"][0], 101)}
        fine = lw.evaluate(PLAN, rows).columns[name].reshape(near.shape)
        best[name] = np.degrees(near[fine.argmin(axis=0), rods]), fine.min(axis=0)
    return found, best


def study(machine: lw.Machine) -> dict[str, float]:
    """The best phase by each measure and the minimum there, with short and with long rods."""
    answers = {}
    for name, (phase, low) in maps()[1].items():
        answers |= {f"{name}_short": low[0], f"{name}_short_deg": phase[0]}
        answers |= {f"{name}_long": low[-1], f"{name}_long_deg": phase[-1]}
    return answers


def figure(machine: lw.Machine):
    """The three measures as maps, with the best phase by each and the usual right angle."""
    from matplotlib.figure import Figure

    (found, best), drawing = maps(), Figure(figsize=(11.5, 4), layout="constrained")
    for axes, name in zip(drawing.subplots(1, 3, sharey=True), TITLES, strict=True):
        phase, ratio = np.degrees(found["phase"]), found["rod_ratio"]
        drawing.colorbar(axes.contourf(phase, ratio, found[name], levels=16))
        axes.plot(best[name][0], ratio[0], ".-", color="#d55e00", label="minimum")
        axes.axvline(90, color="white", linestyle="--", label="90°")
        axes.set(xlabel="angle between the cranks [°]", ylabel="rod ratio λ = r/l [–]", title=TITLES[name])
        axes.label_outer()
    axes.legend(facecolor="0.6")
    return drawing


if __name__ == "__main__":
    print(*(f"{name:18} {value:.6g}" for name, value in study(PLAN.machine).items()), sep="\n")
    figure(PLAN.machine).savefig(HERE / "figure.png", dpi=120)
