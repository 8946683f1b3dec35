"""How do the impacts of ice on a propeller load its shaft, gear and coupling?

Three cases of the rules for polar ships: one block of ice for 90° or 135° of a blade, or two for 45°.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.torsion.in_time.transient import TorsionTransient


def met(machine: lw.Machine, case: int) -> TorsionTransient:
    """The manoeuvre with another case of the ice."""
    manoeuvre = machine.train.transient
    (ice,) = manoeuvre.events
    events = (ice.model_copy(update={"case": case}),)
    return lw.torsion_transient(machine, manoeuvre.model_copy(update={"events": events}))


def study(machine: lw.Machine) -> dict[str, float]:
    """Ice torque, and of each case the maximum torques and the lowest speed of the propeller."""
    numbers = {}
    for case in (1, 2, 3):
        moved = met(machine, case)
        (ice,) = moved.ice
        shafts = dict(zip(moved.shafts, moved.torque_max, strict=True))
        numbers |= {
            f"line_torque_{case}": float(shafts["line"]),
            f"coupling_torque_{case}": float(shafts["coupling"]),
            f"stage_torque_{case}": float(moved.stage_torque[0].max()),
            f"stage_torque_min_{case}": float(moved.stage_torque[0].min()),
            f"propeller_rpm_{case}": ice.speed_min * 30 / np.pi,
        }
    return {"ice_torque": ice.torque_max, **numbers}


def figure(machine: lw.Machine):
    """Speeds and torques while the blades mill ice."""
    from linkwright.torsion.figures.transient import transient_figure

    moved = met(machine, 1)
    marks = [(moved.ice[0].start, "ice"), (moved.ice[0].end, "passed")]
    return transient_figure(moved, discs=["motor", "propeller"], shafts=["line", "coupling"], marks=marks)


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:20} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
