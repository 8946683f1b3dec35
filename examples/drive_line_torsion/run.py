"""What does an elastic crankshaft do to the speed fluctuation that the rigid driveline promises?

The yoke is r cos φ from the shaft, so that all of its torque has two cycles per revolution, and the two discs
that the crankshaft joins have the closed form of Den Hartog, Mechanical Vibrations, section 5.2.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.torsion.response.forced import forced_vibration


def unevenness(machine: lw.Machine, disc: str) -> float:
    """δ of a disc at the design speed, by forced vibration of the driveline."""
    motor_speed = machine.drive.gearbox.ratio * machine.drive.speed
    found = forced_vibration(machine, np.array([motor_speed]))
    return float(found.unevenness[found.discs.index(disc), 0])


def study(machine: lw.Machine) -> dict[str, float]:
    """Frequency, speed at which the yoke meets it, and δ with the crankshaft as it is and far stiffer."""
    frequency = float(lw.free_vibration(machine).natural_frequencies[1])
    stiff = lw.replace(machine, {"drive.crankshaft.sections.0.diameter": 1.0})
    return {
        "mean_inertia_crank": lw.drive_line(machine).discs["crank"].inertia,
        "first_frequency_hz": frequency,
        "critical_speed_rpm": 60 * frequency / 2,
        "harmonic_2_nm": float(abs(lw.mechanism_harmonics(machine, machine.drive.speed, [2])[0])),
        "unevenness_crank": unevenness(machine, "crank"),
        "unevenness_flywheel": unevenness(machine, "gearbox"),
        "unevenness_stiff": unevenness(stiff, "crank"),
        "unevenness_rigid_steady": lw.steady_state(machine).unevenness,
    }


def figure(machine: lw.Machine):
    """The equivalent scheme."""
    from linkwright.torsion.figures.scheme import scheme_figure

    return scheme_figure(lw.scheme(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:24} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
