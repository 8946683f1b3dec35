"""What rolls on what while a bar slides between two lines?"""

from pathlib import Path

import numpy as np

import linkwright as lw

# A revolution, and a quarter of it between two change points.
ANGLES = np.linspace(0, 2 * np.pi, 720, endpoint=False) + 0.003
QUARTER = np.linspace(0.01, 1.5, 4001)


def study(machine: lw.Machine) -> dict[str, float]:
    """Radii of both centrodes, the way that they roll on each other, the ellipse of a point of the bar.

    The perpendiculars to both lines at the bar's ends meet in the corner of a rectangle whose diagonal is the
    bar: on the frame a circle of its length about the corner, on the bar a circle of half of it.
    """
    radius, part = machine.mechanism.cranks["A"].radius, -0.4
    found, rolled = (lw.centrodes(machine, "S.rod", angles) for angles in (ANGLES, QUARTER))
    curves = (rolled.x, rolled.y), (rolled.along, rolled.across)
    ways = [np.hypot(*np.diff(curve)).sum() for curve in curves]
    points = lw.kinematics(machine, ANGLES).points
    x, y = points["E"].position.T / radius
    return {
        "fixed_off_its_circle": float(np.abs(np.hypot(found.x, found.y) / radius - 2).max()),
        "moving_off_its_circle": float(np.abs(np.hypot(found.along, found.across) / radius - 1).max()),
        "way_over_way": float(ways[1] / ways[0]),
        "other_end_off_its_line": float(np.abs(points["K"].position[:, 0]).max() / radius),
        "off_the_ellipse": float(np.abs((x / (1 + part)) ** 2 + (y / (1 - part)) ** 2 - 1).max()),
    }


def figure(machine: lw.Machine):
    """Both centrodes at 35°, the bar, and the ellipse of E."""
    from matplotlib.figure import Figure

    found, motion = lw.centrodes(machine, "S.rod", ANGLES), lw.kinematics(machine, ANGLES)
    now = int(np.argmin(np.abs(ANGLES - np.radians(35))))
    turn, start = motion.links["S.rod"].angle[now], motion.points["A"].position[now]
    moving = np.exp(1j * turn) * (found.along + 1j * found.across) + complex(*start)
    bar = np.array([motion.points[name].position[now] for name in "SK"])
    drawing = Figure(figsize=(6, 6), layout="constrained")
    axes = drawing.subplots()
    axes.plot(1e3 * found.x, 1e3 * found.y, label="fixed centrode")
    axes.plot(1e3 * moving.real, 1e3 * moving.imag, "--", label="moving centrode")
    axes.plot(*1e3 * bar.T, linewidth=4, label="bar")
    axes.plot(*1e3 * motion.points["E"].position.T, label="path of E")
    axes.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    axes.legend()
    return drawing


if __name__ == "__main__":
    here, example = Path(__file__).parent, lw.read(Path(__file__).with_name("machine.toml"))
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
