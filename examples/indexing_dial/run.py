"""What do dial, pusher and jaw of a packaging machine do over one cycle, and does the dial's motor stand it?

On the command line:
linkwright axes indexing_dial
"""

from pathlib import Path

import numpy as np

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Index, torque of the dial and of its motor; accelerations of pusher and jaw; mean power of the bus."""
    dial, bus = lw.servo_axis(machine, "dial"), lw.dc_bus(machine)
    tracks = {track.driver: track for track in lw.timing(machine)}
    x, y = lw.kinematics(machine, [6 * np.pi]).points["dial"].position[0]
    return {
        "angle_after_three_cycles": float(np.degrees(np.arctan2(y, x))),
        "dial_torque": dial.torque_max,
        "dial_motor_torque": dial.motor.torque_peak,
        "dial_motor_rms": dial.motor.torque_rms,
        "dial_passes": float(bool(dial.passes)),
        "pusher_acceleration": float(np.abs(tracks["pusher"].acceleration).max()),
        "jaw_acceleration": float(np.abs(tracks["jaw"].acceleration).max()),
        "bus_power_mean": bus.power_mean,
    }


def figure(machine: lw.Machine):
    """The timing diagram of dial, pusher and jaw."""
    from linkwright.axes.figures import timing_figure

    return timing_figure(lw.timing(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
