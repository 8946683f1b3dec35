"""Does Klann's leg make the step of its patent?"""

from pathlib import Path

import numpy as np

import linkwright as lw

ANGLES = np.linspace(0, 2 * np.pi, 721)


def study(machine: lw.Machine) -> dict[str, float]:
    """Stride from full extension (180°) to retraction (0°), and how far the foot leaves the level between."""
    foot = lw.kinematics(machine, ANGLES).points["33"].position
    stride = foot[0] - foot[360]
    on_ground = foot[:361, 1]
    return {
        "stride": float(stride[0]),
        "rise": float(stride[1]),
        "deviation": float(np.ptp(on_ground)),
        "lift": float(np.ptp(foot[:, 1])),
    }


def figure(machine: lw.Machine):
    """The path of the foot under the leg, fully extended."""
    from matplotlib.figure import Figure

    motion = lw.kinematics(machine, ANGLES)
    drawing = Figure(figsize=(6, 6), layout="constrained")
    axes = drawing.subplots()
    ends = [(link.start, link.end) for link in machine.mechanism.links().values()]
    for start, end in [*ends, ("29", "35"), ("35", "33")]:
        axes.plot(*np.array([motion.points[name].position[360] for name in (start, end)]).T, "C0")
    axes.plot(*motion.points["33"].position.T, "C1")
    axes.set(xlabel="x [strides]", ylabel="y [strides]", aspect="equal")
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
