"""How straight is the line of Peaucellier's inversor, and how far does it go?"""

from pathlib import Path

import numpy as np

import linkwright as lw

(LOW, HIGH) = np.radians((-51.0, 51.0))
ANGLES = np.linspace(LOW, HIGH, 361)


def study(machine: lw.Machine) -> dict[str, float]:
    """Place and straightness of the line; how far the crank swings.

    OA·OP = l² − a² for links l and sides a of the rhombus, and OA = 2 r cos of half the crank angle, so the
    line stands at (l² − a²)/2r. The rhombus is flat where OA = l − a.
    """
    x = lw.kinematics(machine, ANGLES).points["P"].position[:, 0]
    rhombus, crank = machine.mechanism.rockers["B"], machine.mechanism.cranks["A"].radius
    link, side = rhombus.rocker, rhombus.coupler
    limit = 2 * np.arccos((link - side) / (2 * crank))
    return {
        "off_line": float(np.abs(x - (link**2 - side**2) / (2 * crank)).max()),
        "range_over_closed_form": (lw.closure(machine).ranges[0][1] - 2 * np.pi) / limit,
    }


def figure(machine: lw.Machine):
    """The line, and the circle of A that it is the inverse of."""
    from matplotlib.figure import Figure

    motion = lw.kinematics(machine, ANGLES)
    drawing = Figure(figsize=(5, 6), layout="constrained")
    axes = drawing.subplots()
    for name in "ABDP":
        axes.plot(*1e3 * motion.points[name].position.T, label=name)
    axes.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    axes.legend()
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
