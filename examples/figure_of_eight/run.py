"""Where does a coupler curve cross itself, and how hard is its point shaken from rest to rest?"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.linkages.law import RampLaw

# One revolution in two seconds by the polynomial 3-4-5.
LAW = RampLaw(duration=2.0, angle=2 * np.pi)
TIMES = np.linspace(0, 2, 401)


def study(machine: lw.Machine) -> dict[str, float]:
    """The double point, the quality of the linkage, and the extremes of the motion."""
    curve, rocker = lw.coupler_curve(machine, "K"), lw.linkage(machine).element("R")
    (point,) = curve.double_points
    path = lw.motion(machine, LAW, TIMES).points["K"]
    return {
        "double_x": point.x,
        "double_y": point.y,
        "first_angle_deg": float(np.degrees(point.first_angle)),
        "second_angle_deg": float(np.degrees(point.second_angle)),
        "length": curve.length,
        "transmission_angle_min_deg": float(np.degrees(rocker.transmission_angle_min)),
        "speed_at_the_ends": float(np.hypot(*path.velocity[[0, -1]].T).max()),
        "acceleration_max": float(np.hypot(*path.acceleration.T).max()),
    }


def figure(machine: lw.Machine):
    """The curve with its double point, and the acceleration over time."""
    from matplotlib.figure import Figure

    curve = lw.coupler_curve(machine, "K")
    path = lw.motion(machine, LAW, TIMES).points["K"]
    drawing = Figure(figsize=(9, 4.2), layout="constrained")
    left, right = drawing.subplots(1, 2)
    left.plot(1e3 * curve.x, 1e3 * curve.y)
    left.plot(
        [1e3 * each.x for each in curve.double_points], [1e3 * each.y for each in curve.double_points], "x"
    )
    left.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    right.plot(TIMES, np.hypot(*path.acceleration.T))
    right.set(xlabel="time [s]", ylabel="acceleration of K [m/s²]")
    for axes in (left, right):
        axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
