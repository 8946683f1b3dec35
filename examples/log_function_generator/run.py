"""How well does a four-bar linkage compute the logarithm?

y = log₁₀ x from 1 to 2 over 60° of the crank and 90° of the rocker, met at three points by Freudenstein's
equation.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.synthesis.expression import chebyshev_points
from linkwright.synthesis.task import FunctionTask

X = np.linspace(1, 2, 361)
SCALE = np.radians(90) / np.log10(2)


def error(machine: lw.Machine, x: np.ndarray) -> np.ndarray:
    """Rocker angle less the wanted one [rad], counted from the first point of Chebyshev."""
    first = chebyshev_points(1, 2, 3)[0]
    both = np.concatenate([[first], x])
    psi = lw.kinematics(machine, np.radians(60) * (both - 1)).links["B.rocker"].angle
    return psi[1:] - psi[0] - SCALE * np.log10(x / first)


def study(machine: lw.Machine) -> dict[str, float]:
    """The maximum error of three points, and what five points with free start angles would give."""
    ranges = {"crank_range": np.radians(60), "rocker_range": np.radians(90)}
    five = lw.function_generator(FunctionTask(function="log10(x)", range=(1, 2), points=5, **ranges))
    return {
        "error_at_points_deg": float(np.degrees(abs(error(machine, chebyshev_points(1, 2, 3))).max())),
        "error_three_points_deg": float(np.degrees(abs(error(machine, X)).max())),
        "error_five_points_deg": float(np.degrees(five.angle_error_max)),
    }


def figure(machine: lw.Machine):
    """The structural error."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(6, 4), layout="constrained")
    axes = drawing.subplots()
    axes.plot(X, np.degrees(error(machine, X)))
    axes.set(xlabel="x", ylabel="error of the rocker [°]")
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
