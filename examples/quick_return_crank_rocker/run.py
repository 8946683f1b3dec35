"""Which crank-rocker swings 60° and returns 1.2 times as fast, with the best transmission angle?

The machine is that of `linkwright synthesise dead-centre --swing "60 deg" --time-ratio 1.2 --frame "0.2 m"`.
"""

from pathlib import Path

import numpy as np

import linkwright as lw

ANGLES = np.linspace(0, 2 * np.pi, 7201)


def study(machine: lw.Machine) -> dict[str, float]:
    """Swing and time ratio of the machine in the file, from its extremes; the design done again."""
    rocker = lw.kinematics(machine, ANGLES).links["B.rocker"].angle
    forward = (ANGLES[rocker.argmax()] - ANGLES[rocker.argmin()]) % (2 * np.pi)
    forward = max(forward, 2 * np.pi - forward)
    found = lw.crank_rocker(np.radians(60), 1.2, frame=0.2)
    return {
        "swing_deg": float(np.degrees(np.ptp(rocker))),
        "time_ratio": float(forward / (2 * np.pi - forward)),
        "crank": found.crank,
        "transmission_angle_min_deg": float(np.degrees(found.transmission_angle_min)),
    }


def figure(machine: lw.Machine):
    """The rocker's angle over the crank angle."""
    from matplotlib.figure import Figure

    rocker = lw.kinematics(machine, ANGLES).links["B.rocker"].angle
    drawing = Figure(figsize=(6, 4), layout="constrained")
    axes = drawing.subplots()
    axes.plot(np.degrees(ANGLES), np.degrees(rocker))
    axes.set(xlabel="crank angle [°]", ylabel="rocker angle [°]", xlim=(0, 360))
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
