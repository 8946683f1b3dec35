"""Up to which speed does the spring keep a finger follower on its cam, and how hard does the cam push?

The arm turns about its pivot as the sections say. Its inertia asks for a torque J ψ″ω², the spring gives one
that depends on the angle alone; where they meet the roller leaves the cam.

Source: Norton, Cam Design and Manufacturing Handbook, 2nd ed., chapters 7 and 8.
"""

from pathlib import Path

import numpy as np

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Pressure angle, curvature, force on the cam, and the speed at which the roller leaves it."""
    profile = lw.cam_profile(machine)
    loaded = lw.loaded_cam(machine, profile, machine.drive.speed)
    return {
        "pressure_angle_max": np.degrees(profile.pressure_angle_max),
        "curvature_radius_min": profile.curvature_radius_min,
        "force_max": loaded.force_max,
        "force_min": loaded.force_min,
        "speed_lost": loaded.speed_lost,
    }


def figure(machine: lw.Machine):
    """Force on the cam over the crank angle, standing still nearly and at two speeds."""
    import matplotlib.pyplot as plt

    fastest = study(machine)["speed_lost"]
    figure, ax = plt.subplots(figsize=(8, 4), layout="constrained")
    for speed in (1.0, machine.drive.speed, fastest):
        found = lw.forces(machine, speed=speed)
        ax.plot(np.degrees(found.crank_angle), found.drives["finger"], label=f"{speed:.4g} rad/s")
    ax.axhline(0, color="0.6", lw=0.8)
    ax.set(xlabel="crank angle (°)", ylabel="force of the cam (N)", xlim=(0, 360))
    ax.legend()
    return figure


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:24} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
