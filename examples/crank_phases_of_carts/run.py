"""Do the best crank phases change which drive runs most evenly, that of one, two, three or four carts?"""

from functools import cache
from pathlib import Path

import numpy as np

import linkwright as lw

HERE, STARTS = Path(__file__).parent, {"two": 1, "three": 1, "four": 2}
MEASURES = {"delta": "unevenness", "H": "dynamism", "k_p": "motion_coefficient"}
PAPER = [[0.3765, 0.156, 0.11, 0.265], [0.51412, 0.1453, 0.169, 0.2792], [0.656, 0.1696, 0.181, 0.3497]]
LOOKS = {"paper": ("D:k", "paper 1"), "usual": ("s--C0", "usual phases"), "best": ("o-C1", "best phases")}


@cache
def best(carts: str, goal: str):
    """The minimum of a measure: derivatives lead down from the best of 16 places, or the two best of 32."""
    plan = lw.read_study(HERE / f"{carts}_carts.toml", [f"study.goals.{goal}=minimise"])
    return lw.optimise(plan, method="gradient", starts=STARTS[carts])


def study(machine: lw.Machine) -> dict[str, float]:
    """Measures of one to four carts; the drives in order, as digits; the smallest angle between cranks."""
    names, found = ["roller_one_cart", *(f"roller_{n}_carts" for n in STARTS)], {}
    drives = [lw.steady_state(lw.read(name)) for name in names]
    for published, (goal, name) in zip(PAPER, MEASURES.items(), strict=True):
        usual = [getattr(drive, name) for drive in drives]
        low = [usual[0], *(best(carts, goal).responses[goal] for carts in STARTS)]
        for by, values in zip(LOOKS, (published, usual, low), strict=True):
            found |= {f"{goal}_{by}_{n + 1}": value for n, value in enumerate(values)}
            found[f"{goal}_{by}_order"] = int("".join(str(n + 1) for n in np.argsort(values)))
        for carts in STARTS:
            at = np.degrees([0, *best(carts, goal).variables.values()]) % 360
            found[f"{goal}_{carts}_deg"] = np.diff(np.sort([*at, 360])).min()
    return found


def figure(machine: lw.Machine):
    """Each measure over the number of carts, and the order of the drives by it."""
    from matplotlib.figure import Figure

    drawing, found = Figure(figsize=(11.5, 4), layout="constrained"), study(machine)
    for axes, goal, title in zip(drawing.subplots(1, 3), MEASURES, ("δ", "H", "$k_p$"), strict=True):
        for by, (look, words) in LOOKS.items():
            order = " < ".join(str(found[f"{goal}_{by}_order"]))
            values = [found[f"{goal}_{by}_{n}"] for n in range(1, 5)]
            axes.semilogy(range(1, 5), values, look, label=f"{words}: {order}")
        axes.set(xlabel="number of carts", ylabel=f"{title} [–]", xticks=range(1, 5), ylim=(0.005, 4))
        axes.legend(title="most even drive first", fontsize="small")
    return drawing


if __name__ == "__main__":
    example = lw.read(HERE / "machine.toml")
    print(*(f"{name:18} {value:.6g}" for name, value in study(example).items()), sep="\n")
    paper, usual, low = (" < ".join(str(study(example)[f"k_p_{by}_order"])) for by in LOOKS)
    print(f"k_p ranks the drives {paper} in paper 1, {usual} at the usual and {low} at the best phases:")
    print("the ranking of paper 1", "survives." if paper == low else "does not survive.")
    figure(example).savefig(HERE / "figure.png", dpi=120)
