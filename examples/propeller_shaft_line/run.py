"""Which speeds does a ship have to bar for its propeller shaft, and could it do without its damper?

Limits and bounds of the range: IACS, UR M68, 2021. The shaft is judged by all orders of the engine and of the
propeller, added up in phase.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.torsion.limits.verdict import verdict
from linkwright.torsion.study import torsion_study

RPM = np.pi / 30


def without_damper(machine: lw.Machine) -> lw.Machine:
    """The same line with the damper left away."""
    return machine.model_copy(update={"train": machine.train.model_copy(update={"dampers": {}})})


def study(machine: lw.Machine) -> dict[str, float]:
    """The barred range, what is reached in it, and the same line without its damper."""
    found = verdict(machine)
    stress, of_coupling, _, of_damper = found.judgements
    (barred,), (bare,) = found.barred, verdict(without_damper(machine)).barred
    return {
        "critical_rpm": barred.critical_speed / RPM,
        "stress_mpa": stress.found / 1e6,
        "permitted_mpa": stress.permitted / 1e6,
        "exceeded_from_rpm": barred.speed_min / RPM,
        "exceeded_to_rpm": barred.speed_max / RPM,
        "barred_from_rpm": barred.barred[0] / RPM,
        "barred_to_rpm": barred.barred[1] / RPM,
        "coupling_torque_nm": of_coupling.found,
        "damper_heat_w": of_damper.found,
        "stress_without_damper_mpa": bare.worst_stress / 1e6,
        "in_passing_mpa": bare.transient / 1e6,
    }


def figure(machine: lw.Machine):
    """The stress of the line over the speed, what it bears, and what has to be barred."""
    from linkwright.torsion.figures.forced import stress_figure

    found = torsion_study(machine)
    return stress_figure(found.stress, found.verdict.barred)


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:26} {value:.6g}")
    for sentence in verdict(example).words:
        print(sentence)
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
