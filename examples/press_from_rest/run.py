"""How does a press start from rest at its top dead centre, and does it get through its first stroke?

On the command line: linkwright transient machine.toml --zero top --revolutions 3 --units mm,rpm,kN
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.drive.motion_events import MotionEvent
from linkwright.drive.transient import Transient


def force_sets_in(machine: lw.Machine, motion: Transient) -> MotionEvent:
    """When and where the ram first meets the work piece."""
    kinks = [event for event in lw.motion_events(machine, motion) if event.kind == "kink"]
    places = lw.kinematics(machine, [event.crank_angle for event in kinks]).slides["ram"].position
    return next(event for event, place in zip(kinks, places, strict=True) if place > 0.561)


def study(machine: lw.Machine) -> dict[str, float]:
    """The first stroke: when the force sets in, how hard it brakes; and a flywheel that is too small."""
    top = lw.zero_angle(machine, "top").angle
    motion = lw.transient(machine, angle=top, turns=3.0)
    force_begins = force_sets_in(machine, motion)
    # The press is its own mirror image, so that a motor connected the other way round starts it alike.
    clockwise = lw.transient(machine, angle=top, turns=3.0, clockwise=True)
    least = lw.motion_extremes(motion)[2]
    weak = lw.replace(machine, {"drive.flywheel.inertia": 2.0})
    stalled = lw.transient(weak, angle=top, turns=3.0)
    return {
        "time_to_the_force": force_begins.time,
        "angle_of_the_force": np.degrees(force_begins.crank_angle - top),
        "angle_of_the_force_clockwise": np.degrees(force_sets_in(machine, clockwise).crank_angle - top),
        "speed_clockwise": clockwise.speed[-1] / motion.speed[-1],
        "acceleration_min": least.value,
        "end_with_a_small_flywheel": float(stalled.end),
    }


def figure(machine: lw.Machine):
    """Speed and acceleration over time."""
    from linkwright.drive.figures import in_time_figure

    motion = lw.transient(machine, angle=lw.zero_angle(machine, "top").angle, turns=3.0)
    with lw.shown_in("rpm"):
        return in_time_figure(motion, lw.motion_extremes(motion))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
