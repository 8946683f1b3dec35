"""Does a cam with dwells fill a yoke of two flat faces at every angle?

It does if the second half revolution mirrors the first, s(φ + π) = h − s(φ): the support function r₀ + s is
then one of constant breadth. By Barbier's theorem the perimeter of such a cam is π times its breadth.

Source: E. Barbier, Journal de mathématiques pures et appliquées 5 (1860) 273–286.
"""

from pathlib import Path

import numpy as np

import linkwright as lw

TURN = np.linspace(0, 2 * np.pi, 36001)


def study(machine: lw.Machine) -> dict[str, float]:
    """Breadth by the law and by points of the profile, perimeter over breadth, the face that is needed."""
    profile = lw.cam_profile(machine)
    points = profile.flanks[0].curve().points(TURN)
    ways = np.stack((np.cos(TURN[:18000:100]), np.sin(TURN[:18000:100])))
    breadths = np.ptp(points @ ways, axis=0)
    return {
        "breadth": profile.opposite.breadth,
        "breadth_spread": profile.diameter_max - profile.diameter_min,
        "breadth_of_points_min": breadths.min(),
        "breadth_of_points_max": breadths.max(),
        "perimeter_over_breadth": np.linalg.norm(np.diff(points, axis=0), axis=1).sum() / 0.1,
        "face_max": profile.face_max,
        "curvature_radius_min": profile.curvature_radius_min,
    }


def figure(machine: lw.Machine):
    """The cam in its yoke at four angles."""
    import matplotlib.pyplot as plt

    flank = lw.cam_profile(machine).flanks[0]
    points = flank.curve().points(TURN)
    figure, axes = plt.subplots(1, 4, figsize=(11, 3.4), layout="constrained", sharey=True)
    for ax, angle in zip(axes, (0.0, 90.0, 120.0, 200.0), strict=True):
        cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        ax.fill(*(1e3 * points @ np.array([[cos, sin], [-sin, cos]])).T, color="0.85", ec="C0")
        right = 1e3 * (flank.contact.start + float(flank.contact.law.at(np.radians(angle))))
        ax.vlines([right, right - 100], -45, 45, color="C1")
        ax.plot(0, 0, "k+")
        ax.set(aspect="equal", xlabel="x (mm)", title=f"{angle:.0f}°")
    return figure


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:24} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
