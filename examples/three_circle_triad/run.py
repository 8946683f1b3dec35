"""Is a platform on three bars where it is, if the same linkage is driven from the other side?"""

from pathlib import Path

import numpy as np

import linkwright as lw

ANGLES = np.linspace(0, 2 * np.pi, 361)


def backwards(machine: lw.Machine) -> lw.Machine:
    """The same linkage driven by its left bar: a four-bar linkage, which is a dyad."""
    bars, corner = machine.mechanism.bars, machine.mechanism.rigid_points["E"]
    pivots = machine.mechanism.points
    links = {"crank": "C", "pivot": "Q", "coupler": bars["platform"].length, "rocker": bars["right"].length}
    mechanism = {
        "points": {name: {"x": point.x, "y": point.y} for name, point in pivots.items()},
        "cranks": {"C": {"radius": bars["left"].length, "pivot": "P"}},
        "rockers": {"D": {**links, "assembly": "left"}},
        "rigid_points": {"E": {"link": "D.coupler", "along": corner.along, "across": corner.across}},
    }
    return lw.Machine.model_validate({"format": 1, "name": "backwards", "mechanism": mechanism})


def study(machine: lw.Machine) -> dict[str, float]:
    """Distance of the platform's corners in both, at the same angles of the left bar; its swing."""
    ahead = lw.kinematics(machine, ANGLES)
    left = ahead.links["left"].angle
    back = lw.kinematics(backwards(machine), left)
    apart = [np.abs(ahead.points[name].position - back.points[name].position).max() for name in "CDE"]
    return {"apart": float(max(apart)), "swing_deg": float(np.degrees(np.ptp(left)))}


def figure(machine: lw.Machine):
    """Paths of the platform's corners."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(6, 4), layout="constrained")
    axes = drawing.subplots()
    for name in "ACDE":
        axes.plot(*1e3 * lw.kinematics(machine, ANGLES).points[name].position.T, label=name)
    axes.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    axes.grid(alpha=0.3)
    axes.legend()
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
