"""How unevenly does an engine with a weak cylinder turn, and can one tell which it is from the flywheel?

The speed of the flywheel, with noise, stands for a measurement; the diagnosis knows the sound engine.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.torsion.diagnosis.engine_diagnosis import engine_diagnosis
from linkwright.torsion.diagnosis.measured_speed import MeasuredSpeed, measured_speed
from linkwright.torsion.response.forced import ForcedVibration, forced_vibration

SPEED = 1500 * np.pi / 30
NOISE = 0.02


def measurement(found: ForcedVibration, samples: int = 720) -> MeasuredSpeed:
    """Speed of the flywheel over the two revolutions of a cycle, with noise, as harmonics."""
    waves = 1j * found.orders * SPEED * found.amplitudes[:, found.discs.index("flywheel"), 0]
    angle = 4 * np.pi * np.arange(samples) / samples
    speed = SPEED + (np.exp(1j * np.outer(angle, found.orders)) @ waves).real
    speed += np.random.default_rng(1).normal(0, NOISE, samples)
    return measured_speed("flywheel", speed, turns=2, orders=found.orders, noise=NOISE)


def study(machine: lw.Machine) -> dict[str, float]:
    """Speed fluctuation at three discs, of the sound and of the weak engine, and what the diagnosis says."""
    sound = lw.replace(machine, {"train.engine.factors": {}})
    weak, well = (forced_vibration(each, np.array([SPEED])) for each in (machine, sound))
    told = engine_diagnosis(machine, measurement(weak), SPEED)
    rigid = engine_diagnosis(machine, measurement(weak), SPEED, rigid=True)
    at = {name: weak.discs.index(name) for name in ("front", "flywheel", "generator")}
    return {
        **{f"unevenness_{name}": float(weak.unevenness[d, 0]) for name, d in at.items()},
        **{f"unevenness_{name}_sound": float(well.unevenness[d, 0]) for name, d in at.items()},
        "unevenness_rigid": float(weak.unevenness_rigid[0, 0]),
        "unevenness_rigid_sound": float(well.unevenness_rigid[0, 0]),
        "weak_cylinder": float("".join(told.weak())),
        "factor": float(told.factor[told.cylinders.index("3")]),
        "factor_by_a_rigid_train": float(rigid.factor[rigid.cylinders.index("3")]),
    }


def figure(machine: lw.Machine):
    """Speed fluctuation along the train."""
    from linkwright.torsion.figures.forced import torsion_unevenness_figure
    from linkwright.torsion.figures.modes import in_a_row

    found = forced_vibration(machine)
    return torsion_unevenness_figure(found, in_a_row(found.discs, lw.free_vibration(machine).joined), SPEED)


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:26} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
