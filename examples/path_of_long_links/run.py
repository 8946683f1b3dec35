"""Do longer links still draw a more accurate path once their lengths have tolerances?

A coupler point shall pass ten points of an ellipse, 200 by 100 mm, in order. Longer links come nearer to it.
study.toml gives all lengths ± 0.1 mm; each linkage that is found takes the place of its machine.
"""

import tomllib
from functools import cache
from pathlib import Path

import linkwright as lw
from linkwright.synthesis import PathTask

HERE = Path(__file__).parent
STUDY = tomllib.loads((HERE / "study.toml").read_text(encoding="utf-8"))
RATIOS = (4, 6, 8, 12, 16, 20)


@cache
def scatter(ratio: float) -> dict[str, float]:
    """Path error [m] of the best linkage of a length ratio: as drawn, and as made with the tolerances."""
    path = {key: STUDY["paths"]["ellipse"][key] for key in "xy"}
    task = PathTask.model_validate({**path, "length_ratio_max": ratio, "population": 60, "generations": 300})
    tables = {name: table for name, table in STUDY.items() if name != "machine"}
    return lw.tolerance(lw.new_study(lw.path_generator(task).machine, tables), 4000).responses["error"]


def study(machine: lw.Machine) -> dict[str, float]:
    """Errors by the length ratio [µm], and those of the machine of the file, a linkage of 8 to 1."""
    plan = lw.read_study(HERE / "study.toml")
    path = plan.study.paths["ellipse"]
    numbers = {"error_of_file": lw.path_error(machine, path.point, path.x, path.y).error_rms * 1e6}
    for ratio in RATIOS:
        numbers[f"error_{ratio}"] = scatter(ratio)["middle"] * 1e6
        numbers[f"error_made_{ratio}"] = scatter(ratio)["band_high"] * 1e6
    return numbers


def figure(machine: lw.Machine):
    """Both errors over the length ratio."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(6.4, 4), layout="constrained")
    axes = drawing.subplots()
    for key, label in (("middle", "lengths exact"), ("band_high", "lengths ± 0.1 mm: 99.87 % are below")):
        axes.plot(RATIOS, [scatter(ratio)[key] * 1e3 for ratio in RATIOS], "o-", label=label)
    axes.set(xlabel="limit of longest over shortest link", ylabel="rms distance from the path [mm]")
    axes.set_ylim(bottom=0)
    axes.legend()
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    example = lw.read(HERE / "machine.toml")
    print(*(f"{name:20} {value:.6g}" for name, value in study(example).items()), sep="\n")
    figure(example).savefig(HERE / "figure.png", dpi=120)
