"""What does a quicker return cost a six-bar quick return: how well can its rocker still transmit?

A crank-rocker drives a slide. For each time ratio the study seeks the lengths with which the worst
transmission angle of the rocker is best, for a stroke of 200 mm and a transmission angle of the slide of 75°.
"""

import tomllib
from functools import cache
from math import degrees
from pathlib import Path

import linkwright as lw

HERE = Path(__file__).parent
RATIOS = (1.1, 1.2, 1.3, 1.4)


@cache
def best(ratio: float):
    """The best machine for a time ratio."""
    tables = tomllib.loads((HERE / "study.toml").read_text(encoding="utf-8"))
    del tables["machine"]
    tables["constraints"]["time_ratio"] = {"min": ratio}
    return lw.optimise(lw.new_study(lw.read(HERE / "machine.toml"), tables), 300, seed=1)


def study(machine: lw.Machine) -> dict[str, float]:
    """Worst transmission angles, and what 0.01 of the time ratio costs [°]."""
    rocker = lw.linkage(machine).element("R")
    numbers = {"of_file": degrees(rocker.transmission_angle_worst), "ratio_of_file": rocker.time_ratio}
    for ratio in RATIOS:
        numbers[f"best_{ratio}"] = degrees(best(ratio).responses["rocker_transmission"])
        numbers[f"cost_{ratio}"] = degrees(0.01 * best(ratio).multipliers["minimum of time_ratio"])
    return numbers


def figure(machine: lw.Machine):
    """The best transmission angle over the time ratio, with the slopes that the multipliers tell."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(6.4, 4), layout="constrained")
    axes = drawing.subplots()
    numbers = study(machine)
    axes.plot(RATIOS, [numbers[f"best_{ratio}"] for ratio in RATIOS], "o-", label="best lengths")
    for ratio in RATIOS:
        ends, slope = (ratio - 0.04, ratio + 0.04), 100 * numbers[f"cost_{ratio}"]
        axes.plot(ends, [numbers[f"best_{ratio}"] - slope * (end - ratio) for end in ends], "C1", lw=3)
    axes.plot([], [], "C1", lw=3, label="slope by the multiplier of the time ratio")
    axes.plot(numbers["ratio_of_file"], numbers["of_file"], "ks", label="machine of the file")
    axes.set(xlabel="time ratio", ylabel="worst transmission angle of the rocker [°]", ylim=(0, None))
    axes.legend()
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    example = lw.read(HERE / "machine.toml")
    print(*(f"{name:20} {value:.6g}" for name, value in study(example).items()), sep="\n")
    figure(example).savefig(HERE / "figure.png", dpi=120)
