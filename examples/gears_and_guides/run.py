"""Do gears, rack, belt, cable and Scotch yoke keep their laws?"""

from pathlib import Path

import numpy as np

import linkwright as lw

# The pulley turns half as fast as the crank, the planet 7/3 as fast: all is as before after six revolutions.
ANGLES = np.linspace(0, 12 * np.pi, 2161)


def study(machine: lw.Machine) -> dict[str, float]:
    """Maximum departure from each law."""
    motion = lw.kinematics(machine, ANGLES)
    line = np.stack([0.1 * np.cos(ANGLES), 0 * ANGLES], axis=-1)
    rocker = motion.links["C.rocker"]
    laws = {
        # Cardan: a point of a circle that rolls in one of twice its size runs on the diameter, 2r cos φ.
        "cardan": motion.points["K"].position - line,
        # Willis: (ω_sun − ω_arm)/(0 − ω_arm) = −z_ring/z_sun, so the sun turns 1 + 60/24 times as fast.
        "planetary_train": motion.links["sun"].d1 - (1 + 60 / 24),
        "scotch_yoke": motion.slides["yoke"].position - 0.05 * np.cos(ANGLES),
        "belt": motion.links["pulley"].angle - ANGLES / 2,
        "rack": motion.slides["rack"].position - 0.06 * rocker.angle,
        # A rope that runs down, its arc to the left of it, is drawn in as the arc turns to the left.
        "cable": motion.slides["rope"].d1 + 0.08 * rocker.d1,
    }
    return {name: float(np.abs(off).max()) for name, off in laws.items()} | {
        "turns": lw.closure(machine).turns
    }


def figure(machine: lw.Machine):
    """What moves along a guide."""
    from matplotlib.figure import Figure

    motion = lw.kinematics(machine, ANGLES)
    drawing = Figure(figsize=(6, 4), layout="constrained")
    axes = drawing.subplots()
    for name in ("yoke", "rack", "rope"):
        axes.plot(np.degrees(ANGLES), 1e3 * motion.slides[name].position, label=name)
    axes.set(xlabel="crank angle [°]", ylabel="place [mm]", xlim=(0, 2160))
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
