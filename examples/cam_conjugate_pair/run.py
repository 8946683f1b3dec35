"""Do two cams keep both rollers of a rocker without play?

Both profiles, as points, are turned under their rollers, which the mechanism places; gaps are measured.

Source: Norton, Cam Design and Manufacturing Handbook, 2nd ed., chapter 13.
"""

from pathlib import Path

import numpy as np

import linkwright as lw

TURN = np.linspace(0, 2 * np.pi, 14401)
ANGLES = TURN[:-1:200]


def gaps(machine: lw.Machine) -> np.ndarray:
    """Minimum distance of each roller from its cam over crank angles (2, n)."""
    profile, motion = lw.cam_profile(machine), lw.kinematics(machine, ANGLES)
    found = np.empty((2, len(ANGLES)))
    for row, flank in enumerate(profile.flanks):
        points = flank.curve().points(TURN) @ [1, 1j]
        for k, phi in enumerate(ANGLES):
            angle = motion.links["sley"].angle[k] + row * profile.cam.second.angle
            roller = 0.15 + 0.11 * np.exp(1j * angle)
            found[row, k] = np.abs(points * np.exp(1j * phi) - roller).min()
    return found - 0.03  # radius of the rollers


def study(machine: lw.Machine) -> dict[str, float]:
    """Largest gaps, size of the second cam, and the forces: negative where the second roller carries."""
    profile, gap = lw.cam_profile(machine), np.abs(gaps(machine)).max(axis=1)
    loaded = lw.loaded_cam(machine, profile, machine.drive.speed)
    return {
        "gap_first": gap[0],
        "gap_second": gap[1],
        "base_radius_second": profile.flanks[1].contact.sizes.base_radius,
        "pressure_angle_max": np.degrees(profile.pressure_angle_max),
        "force_size": loaded.force_size,
        "force_min": loaded.force_min,
    }


def figure(machine: lw.Machine):
    """Both cams on their shaft."""
    import matplotlib.pyplot as plt

    figure, ax = plt.subplots(figsize=(6, 5), layout="constrained")
    for flank, name in zip(lw.cam_profile(machine).flanks, ("first", "second"), strict=True):
        ax.plot(*1e3 * flank.curve().points(TURN).T, label=f"{name} cam")
    ax.set(aspect="equal", xlabel="x (mm)", ylabel="y (mm)")
    ax.legend()
    return figure


if __name__ == "__main__":
    here = Path(__file__).parent
    print(study(lw.read(here / "machine.toml")))
    figure(lw.read(here / "machine.toml")).savefig(here / "figure.png")
