"""At which speed does the propeller shake two geared steam turbines most, and how much?

Frequencies and response as printed: Chen and Gunter, Introduction to Dynamics of Rotor-Bearing Systems,
example 8.1.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.torsion.response.forced import forced_vibration

RPM = np.pi / 30
# Newton metres of a pound-force inch.
LBF_IN = 4.4482216152605 * 0.0254


def study(machine: lw.Machine) -> dict[str, float]:
    """Natural frequencies as in the book, and the peak of the propeller shaft's vibratory torque."""
    free = lw.free_vibration(machine)
    speeds = np.linspace(34, 37, 601) * RPM
    forced = forced_vibration(machine, speeds)
    torque = forced.shaft_torque_vibratory[forced.shafts.index("propeller_shaft")]
    peak, turbine = int(torque.argmax()), forced.discs.index("high_turbine")
    return {
        **{f"frequency_{k}_cpm": float(60 * free.natural_frequencies[k]) for k in (1, 2, 3)},
        "peak_rpm": float(speeds[peak] / RPM),
        "peak_torque_lbf_in": float(torque[peak] / LBF_IN),
        "turbine_swing_deg": float(np.degrees(np.abs(forced.amplitudes[0, turbine, peak]))),
    }


def figure(machine: lw.Machine):
    """The vibratory torque of the shafts over the speed of the propeller."""
    from linkwright.torsion.figures.forced import shaft_torques_figure

    return shaft_torques_figure(forced_vibration(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:22} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
