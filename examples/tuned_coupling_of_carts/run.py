"""Which coupling and flywheel leave the minimum peak torque between a drive and carts that shake it?

A stiff coupling follows the changing inertia of the carts, a soft one lets them swing: a minimum is between.
"""

from functools import cache
from pathlib import Path

import numpy as np
from scipy.optimize import minimize

import linkwright as lw

HERE = Path(__file__).parent
COUPLING = ("drive.crankshaft.stiffness", "drive.crankshaft.damping")


@cache
def best():
    """The optimum by exact derivatives of the elastic motion."""
    return lw.optimise(lw.read_study(HERE / "study.toml"), method="gradient", starts=1)


def peak(machine: lw.Machine, coupling) -> float:
    """Peak torque with a stiffness and a damping."""
    variant = lw.replace(machine, dict(zip(COUPLING, map(float, coupling), strict=True)))
    return float(lw.elastic_motion(variant, n=4).torque_max[0])


def study(machine: lw.Machine) -> dict[str, float]:
    """The optimum, and how far below it a search without derivatives comes."""
    found = best()
    start = np.array([lw.get(found.machine, name) for name in COUPLING])
    simplex = {"initial_simplex": start * [[1, 1], [1.03, 1], [1, 1.03]], "maxfev": 60}
    other = minimize(lambda x: peak(found.machine, x), start, method="Nelder-Mead", options=simplex)
    return {
        **found.variables,
        "peak_torque": found.responses["peak"],
        "peak_before": peak(machine, [lw.get(machine, name) for name in COUPLING]),
        "search_without_derivatives_beside": float(other.fun) / found.responses["peak"] - 1,
    }


def figure(machine: lw.Machine):
    """Peak torque over the stiffness for three dampings, with the flywheel of the optimum."""
    from matplotlib.figure import Figure

    axes = (drawing := Figure(figsize=(7, 3.6), layout="constrained")).subplots()
    axes.set(xlabel="stiffness of the coupling [kN m/rad]", ylabel="peak torque [N m]")
    k = np.linspace(10e3, 60e3, 51)
    for c in (50, 150, 250):
        axes.plot(k / 1e3, [peak(best().machine, (one, c)) for one in k], label=f"damping {c} N m s/rad")
    axes.legend()
    return drawing


if __name__ == "__main__":
    for name, value in study(example := lw.read(HERE / "machine.toml")).items():
        print(f"{name:36} {value:.8g}")
    figure(example).savefig(HERE / "figure.png", dpi=120)
