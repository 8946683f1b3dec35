"""How evenly does a four-stroke engine run, with its cycle of two revolutions, and what do its masses change?

The gas force repeats after 720°, so that steady motion does too. The classical diagram takes the torque at
the mean speed and a constant moment of inertia: δ = ΔE/(J ω²). Steady motion knows the masses of piston and
rod.
"""

from pathlib import Path

import linkwright as lw
from linkwright.drive.figures import speed_figure


def study(machine: lw.Machine) -> dict[str, float]:
    """Steady motion of the engine, and of the same engine without masses, beside the classical diagram."""
    steady = lw.steady_state(machine)
    light = lw.steady_state(machine.with_entries({"bodies": {}}))
    turns = lw.turning_moment(diagram(machine, light.speed_mean_extremes))
    return {
        "cycle_deg": 360.0 * steady.turns,
        "speed": steady.speed_mean_time,
        "unevenness": steady.unevenness,
        "unevenness_without_masses": light.unevenness,
        "unevenness_of_diagram": turns.unevenness,
    }


def diagram(machine: lw.Machine, speed: float) -> lw.Machine:
    """The turning-moment diagram of the gas torque, by points; the load is its mean."""
    reduced = lw.reduction(machine.with_entries({"bodies": {}}), n=1440)
    angle, torque = reduced.crank_angle[:-1].tolist(), (-reduced.torque_load[:-1]).tolist()
    driver = {"kind": "table", "angle": angle, "torque": torque}
    table = {"speed": speed, "cycle": "720 deg", "inertia": 0.5, "driver": driver}
    return lw.Machine.model_validate({"format": 1, "name": "gas", "turning_moment": table})


def figure(machine: lw.Machine):
    """Speed and acceleration over the cycle."""
    return speed_figure(lw.steady_state(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.8g}")
    figure(example).savefig(here / "figure.png", dpi=120)
