"""How hard do the teeth of a reversing drive strike when they have crossed their backlash?

Between the flanks the motor runs ahead alone; what it has gained is stopped by the stiffness of the mesh.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.torsion.in_time.transient import TorsionTransient

# Backlash at the motor [rad]; None is that of the file.
GAPS = {"tight": 0.0, "given": None, "worn": np.radians(0.6)}
LEGEND = {"tight": "without backlash", "given": "0.2° at the motor", "worn": "0.6°, worn teeth"}


def moved(machine: lw.Machine, backlash: float | None) -> TorsionTransient:
    """The reversal with another backlash, or with that of the file."""
    if backlash is not None:
        machine = lw.replace(machine, {"train.gears.stage.backlash": backlash})
    return lw.torsion_transient(machine)


def study(machine: lw.Machine) -> dict[str, float]:
    """Extreme torques of the mesh at the motor and highest speed of the table, for each backlash."""
    numbers = {}
    for name, backlash in GAPS.items():
        motion = moved(machine, backlash)
        numbers |= {
            f"{name}_torque_max": float(motion.torque_max[0]),
            f"{name}_torque_min": float(motion.torque_min[0]),
            f"{name}_table_rpm": float(motion.speed_max[1]) * 30 / np.pi,
        }
    return numbers


def figure(machine: lw.Machine):
    """Torque of the mesh about the reversal."""
    import matplotlib.pyplot as plt

    fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
    for name, backlash in GAPS.items():
        motion = moved(machine, backlash)
        about = motion.time > 0.045
        ax.plot(1e3 * motion.time[about], motion.torque[0][about], label=LEGEND[name])
    ax.set(xlabel="time [ms]", ylabel="torque of the mesh at the motor [N m]", xlim=(45, 80))
    ax.legend()
    return fig


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:20} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
