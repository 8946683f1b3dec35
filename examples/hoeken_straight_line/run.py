"""How straight is the line of Hoeken's linkage, and how evenly is it run through?

The machine is that of `linkwright synthesise line --kind hoeken --length "0.2 m"`: 1 : 2 : 2.5 : 2.5 : 5.
"""

from pathlib import Path

import numpy as np

import linkwright as lw

ANGLES = np.radians(np.linspace(-90, 90, 361))


def study(machine: lw.Machine) -> dict[str, float]:
    """Length and straightness of the line over half a revolution, and how much its speed fluctuates."""
    point = lw.kinematics(machine, ANGLES).points["P"]
    speed = np.hypot(*point.d1.T)
    return {
        "length": float(np.ptp(point.position[:, 0])),
        "height_over_crank": float(np.ptp(point.position[:, 1]) / machine.mechanism.cranks["A"].radius),
        "speed_ratio": float(speed.max() / speed.min()),
        "deviation_in_catalogue": lw.straight_line("hoeken", 0.2).deviation,
    }


def figure(machine: lw.Machine):
    """The whole curve, and the line in it."""
    from matplotlib.figure import Figure

    whole = lw.kinematics(machine).points["P"].position
    line = lw.kinematics(machine, ANGLES).points["P"].position
    drawing = Figure(figsize=(6, 4), layout="constrained")
    axes = drawing.subplots()
    axes.plot(1e3 * whole[:, 0], 1e3 * whole[:, 1], lw=1)
    axes.plot(1e3 * line[:, 0], 1e3 * line[:, 1], lw=2.5)
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
