"""How large may the roller of a cam be, and how small the base circle?

The profile lies the roller's radius r inside the pitch curve, the path of the roller's centre. Where the
pitch curve is bent more than 1/r, the profile turns back: the roller cuts away what it should ride on.

Source: Norton, Cam Design and Manufacturing Handbook, 2nd ed., section 7.4.
"""

from pathlib import Path

import numpy as np

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Whether the cam is undercut, and the sizes that mend it."""
    profile = lw.cam_profile(machine)
    least = lw.least_sizes(profile)
    return {
        "faults": len(lw.cam_faults(profile)),
        "pressure_angle_max": np.degrees(profile.pressure_angle_max),
        "roller_radius_max": least.roller_radius_max,
        "base_radius_sound": least.base_radius_sound,
        "base_radius_for_30_deg": least.base_radius_pressure_angle,
    }


def figure(machine: lw.Machine):
    """Pitch curve and undercut profile, and the profile on the base circle that keeps 30°."""
    import matplotlib.pyplot as plt

    found, phi = study(machine), np.linspace(0, 2 * np.pi, 2001)
    figure, axes = plt.subplots(1, 2, figsize=(9, 4.5), layout="constrained")
    for ax, radius in zip(axes, (0.008, found["base_radius_for_30_deg"]), strict=True):
        one = lw.replace(machine, {"mechanism.cams.follower.base_radius": radius})
        flank = lw.cam_profile(one).flanks[0]
        ax.plot(*1e3 * flank.curve(0.0).points(phi).T, "--", lw=1, label="pitch curve")
        ax.plot(*1e3 * flank.curve().points(phi).T, label="profile")
        ax.set(aspect="equal", xlabel="x (mm)", ylabel="y (mm)", title=f"base radius {1e3 * radius:.3g} mm")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:24} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
