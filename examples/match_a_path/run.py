"""Can the linkage be found from the curve that it draws?

Twelve points of a coupler curve, without their crank angles, are all that the search is given.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.synthesis.task import PathTask

ANGLES = np.linspace(0, 2 * np.pi, 12, endpoint=False)
TURN = np.linspace(0, 2 * np.pi, 721)


def found(machine: lw.Machine):
    """The linkage for the points that the machine draws."""
    path = lw.kinematics(machine, ANGLES).points["K"].position
    return lw.path_generator(PathTask(x=tuple(path[:, 0]), y=tuple(path[:, 1]), seed=1))


def study(machine: lw.Machine) -> dict[str, float]:
    """Error over the size of the path."""
    result = found(machine)
    return {"error_relative": result.error_relative, "crank_turns": float(result.type == "crank-rocker")}


def figure(machine: lw.Machine):
    """The points and the curve of the linkage that was found."""
    from matplotlib.figure import Figure

    points = lw.kinematics(machine, ANGLES).points["K"].position
    curve = lw.kinematics(found(machine).machine, TURN).points["P"].position
    drawing = Figure(figsize=(6, 5), layout="constrained")
    axes = drawing.subplots()
    axes.plot(1e3 * curve[:, 0], 1e3 * curve[:, 1])
    axes.plot(1e3 * points[:, 0], 1e3 * points[:, 1], "o")
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
