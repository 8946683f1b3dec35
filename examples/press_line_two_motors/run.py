"""What do the shafts of a press line carry between two motors, and which phase of the presses is best?

Presses that stamp together draw on all flywheels at once: the speed dips most. Half a revolution apart they
take turns, and the coupling between them carries the energy from one side to the other.
"""

from pathlib import Path

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Torques and speeds with the presses half a revolution apart, and together."""
    apart = lw.elastic_motion(machine)
    together = lw.elastic_motion(lw.replace(machine, {"train.mechanisms.press_2.phase": 0.0}))
    middle = apart.shafts.index("middle")
    return {
        "period": apart.period,
        "middle_min": float(apart.torque_min[middle]),
        "middle_max": float(apart.torque_max[middle]),
        "middle_max_together": float(together.torque_max[middle]),
        "left_max": float(apart.torque_max[0]),
        "left_max_together": float(together.torque_max[0]),
        "power_left": float(apart.power_motor[0]),
        "power_right": float(apart.power_motor[1]),
        "fluctuation": float(apart.unevenness[1]),
        "fluctuation_together": float(together.unevenness[1]),
        "multiplier": apart.multiplier_max,
    }


def figure(machine: lw.Machine):
    """Torques of the shafts and speeds of the discs."""
    from linkwright.driveline.figures import elastic_figure

    return elastic_figure(lw.elastic_motion(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:24} {value:.10g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
