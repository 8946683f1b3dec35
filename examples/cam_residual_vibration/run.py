"""At which speeds does a cam leave its elastic follower quiet in the dwell?

After a cycloidal rise the amplitude over the lift is |sin πτ|/(πτ|1 − τ²|), τ rise time over natural period
(the transform of its acceleration; Koster, Vibrations of Cam Mechanisms, 1974).
"""

from pathlib import Path

import numpy as np

import linkwright as lw

# The follower has 1.2 kg on a train of 800 N/mm.
FOLLOWER = lw.OneMass(mass=1.2, stiffness=8e5)
SPEEDS = np.radians(6.0) * np.array([250.0, 3200.0])


def study(machine: lw.Machine) -> dict[str, float]:
    """Speeds that leave nothing, what is left at another, and the motion over a revolution with damping."""
    lift = machine.mechanism.cams["valve"].lift
    rise = lift.stretch(0.0, np.pi / 2)
    found = lw.residual_over_speed(rise, FOLLOWER, SPEEDS)
    quiet = [rise.length * FOLLOWER.natural_frequency / (2 * np.pi * each.ratio) for each in found.quiet]
    damped = lw.OneMass(1.2, 8e5, damping_ratio=0.02)
    turn = lw.follower_vibration(lift, damped, quiet[0])
    return {
        "fastest_quiet_speed_rpm": quiet[0] * 30 / np.pi,
        "second_quiet_speed_rpm": quiet[1] * 30 / np.pi,
        "left_at_fastest": found.quiet[0].residual,
        "left_at_3000_rpm": float(lw.residual_over_speed(rise, FOLLOWER, 100 * np.pi).residual[0]),
        "departure_with_damping_mm": 1e3 * turn.departure_max,
    }


def figure(machine: lw.Machine):
    """What the rise leaves over τ, of the cam's law and of two others."""
    from linkwright.cam.figures.cam import residual_figure
    from linkwright.cam.laws.catalogue import LAWS

    laws = {name: LAWS[name].normalised() for name in ("parabolic", "cycloidal", "polynomial_4_5_6_7")}
    ratios = np.linspace(0.5, 10.0, 160)
    return residual_figure({name: lw.residual_spectrum(law, ratios) for name, law in laws.items()})


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
