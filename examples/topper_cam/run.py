"""What does a cam gain that moves the knife of a topper at constant speed in the middle of its stroke?

A sine of the same stroke and frequency lingers at its ends, where an edge leaves most of a head, and is
faster at mid-stroke, where the edge slices most. The cam does less of both, for more acceleration.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.topping.edge import edges_of
from linkwright.topping.model.topper import HarmonicKnife


def by_a_sine(machine: lw.Machine) -> lw.Machine:
    """The topper with a sine of the same stroke and frequency."""
    cam = lw.topper(machine)
    motion = HarmonicKnife(kind="harmonic", stroke=cam.stroke)
    return lw.replace(machine, {"topper.motion": motion, "topper.knife_speed": cam.knife_speed})


def study(machine: lw.Machine) -> dict[str, float]:
    """Length for all phases, and by both laws what is left, how it slices, what the knife bears."""
    cam, sine = (lw.topper(each) for each in (machine, by_a_sine(machine)))
    names = ("uncut_share_mean", "slicing_ratio_max", "knife_speed_max", "knife_acceleration_max")
    return {
        "length_exact": cam.length_exact,
        **{f"{name}_cam": getattr(cam, name) for name in names},
        **{f"{name}_sine": getattr(sine, name) for name in names},
        "inertia_force_max": cam.inertia_force_max,
    }


def figure(machine: lw.Machine):
    """Speed of the knife, and the length that heads need, over the phase."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, 1, figsize=(8, 5.5), layout="constrained", sharex=True)
    angle = np.linspace(0, 2 * np.pi, 721)
    # The sine begins at mid-stroke, a quarter revolution after the lift of the cam.
    for each, lag in ((machine, 0.0), (by_a_sine(machine), np.pi / 2)):
        found = lw.topper(each)
        knife = edges_of(each, each.topper)[0].knife
        axes[0].plot(np.degrees(angle), knife.at(0.0, angle - lag, 1))
        needed = np.interp(angle - lag, found.phase, 1e3 * found.length_by_phase, period=2 * np.pi)
        axes[1].plot(np.degrees(angle), needed)
    axes[1].axhline(1e3 * machine.topper.edge_length, color="0.4", ls="--")
    axes[0].set(ylabel="speed across the row (m/s)", xlim=(0, 360), xticks=range(0, 361, 45))
    axes[1].set(xlabel="phase at the head (°)", ylabel="length needed (mm)")
    axes[1].legend(axes[1].lines, ["cam", "sine", "edge of the file"], loc="lower left", fontsize=8)
    return figure


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.8g}")
    figure(example).savefig(here / "figure.png", dpi=120)
