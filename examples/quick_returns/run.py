"""How much faster do a Whitworth mechanism and a crank-shaper come back than they go ahead?"""

from pathlib import Path

import numpy as np

import linkwright as lw

ANGLES = np.linspace(0, 2 * np.pi, 14401)


def time_ratio(place: np.ndarray) -> float:
    """Crank angle of the slow way over that of the fast one."""
    there = abs(ANGLES[place.argmax()] - ANGLES[place.argmin()])
    return float(max(there, 2 * np.pi - there) / min(there, 2 * np.pi - there))


def study(machine: lw.Machine) -> dict[str, float]:
    """Time ratios and the stroke of the ram, over their closed forms.

    Whitworth: the stroke ends when the lever lies along the ram, the pin then at the height of the lever's
    pivot: arccos(e/r) to both sides. Shaper: the lever is at its end when the crank stands across it.
    """
    slides = lw.kinematics(machine, ANGLES).slides
    half = np.arccos(40 / 80)
    swing = np.arcsin(90 / 240)
    ram = slides["ram"].position
    return {
        "whitworth": time_ratio(slides["press"].position) / ((np.pi - half) / half),
        "shaper": time_ratio(ram) / ((np.pi + 2 * swing) / (np.pi - 2 * swing)),
        "stroke": float(np.ptp(ram)) / (2 * 0.42 * np.sin(swing)),
    }


def figure(machine: lw.Machine):
    """Both rams over one revolution."""
    from matplotlib.figure import Figure

    motion = lw.kinematics(machine, ANGLES)
    drawing = Figure(figsize=(6, 4), layout="constrained")
    axes = drawing.subplots()
    for name, slide in motion.slides.items():
        if name in ("press", "ram"):
            axes.plot(np.degrees(ANGLES), 1e3 * slide.position, label=name)
    axes.set(xlabel="crank angle [°]", ylabel="place [mm]", xlim=(0, 360))
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
