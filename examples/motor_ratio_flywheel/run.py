"""Which motor, gear ratio and flywheel are cheapest for a required speed fluctuation, start and speed?

Two active limits determine ratio and flywheel: two equations, solved on their own.
"""

from functools import cache
from pathlib import Path

from scipy.optimize import root

import linkwright as lw

HERE = Path(__file__).parent


@cache
def best():
    """The optimum, and the best of each motor."""
    return lw.optimise(lw.read_study(HERE / "study.toml"), method="gradient", starts=1)


def beyond(x, machine: lw.Machine) -> list[float]:
    """How far mean speed and peak torque pass their limits at a ratio and a flywheel."""
    variant = lw.replace(machine, {"drive.gearbox.ratio": x[0], "drive.flywheel.inertia": x[1]})
    motion = lw.steady_state(variant)
    limit = 0.8 * machine.drive.motor.torque_breakdown
    return [motion.speed_mean_time / 10 - 1, motion.torque_motor_max / limit - 1]


def study(machine: lw.Machine) -> dict[str, float]:
    """The cheapest machine, and its distance from the root of the two equations."""
    found = best()
    ratio, flywheel = root(beyond, [10.0, 50.0], args=(found.machine,), tol=1e-10).x
    return {
        "power_kw": found.responses["power"] / 1e3,
        "cost": found.responses["cost"],
        "ratio_beside_equations": found.variables["ratio"] / ratio - 1,
        "flywheel_beside_equations": found.variables["flywheel"] / flywheel - 1,
        "motors_refused": float(sum(one["refused"] is not None for one in found.tried)),
    }


def figure(machine: lw.Machine):
    """The cost of each motor with its flywheel, or what stands against it."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(8, 3.2), layout="constrained")
    axes = drawing.subplots()
    axes.set(xlabel="cost of motor and flywheel [€]", xlim=(0, 4500))
    for one in best().tried:
        axes.barh(one["motor"], one["cost"] or 0.0, color="#0072b2")
        text = one["refused"] or f"{one['cost']:.0f} €"
        axes.text(one["cost"] or 0.0, one["motor"], f"  {text}", va="center", fontsize=8)
    return drawing


if __name__ == "__main__":
    for name, value in study(lw.read(HERE / "machine.toml")).items():
        print(f"{name:28} {value:.6g}")
    figure(lw.read(HERE / "machine.toml")).savefig(HERE / "figure.png", dpi=120)
