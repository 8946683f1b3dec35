"""How evenly does a cart roll that a cam moves at "constant speed", once a motor drives the cam?

The law of the cart holds over the angle of the cam, and the cam turns unevenly: cart and friction load it,
the motor gives way along its characteristic. The cart's speed is s′ω: not constant over time.

Source: paper 2 (see docs/references.md) for the cam of constant diameter; the machine is made for this.
"""

from pathlib import Path

import numpy as np

import linkwright as lw


def cart_speed(machine: lw.Machine, n: int = 720):
    """Steady motion, and the cart's speed along it (n,) [m/s]."""
    steady = lw.steady_state(machine, accuracy=1e-11, n=n)
    slide = lw.kinematics(machine, steady.crank_angle).slides["cart"]
    return steady, slide.d1 * steady.speed


def study(machine: lw.Machine) -> dict[str, float]:
    """Steady motion, and how much the cart's speed varies where it should be constant."""
    steady, speed = cart_speed(machine)
    inside = np.abs(steady.crank_angle - np.pi / 2) < np.pi / 3 + 1e-9
    return {
        "speed_min": steady.speed_min,
        "speed_max": steady.speed_max,
        "period": steady.period,
        "unevenness": steady.unevenness,
        "energy_load": steady.energy_load,
        "cart_speed_varies": np.ptp(speed[inside]) / speed[inside].mean(),
    }


def figure(machine: lw.Machine):
    """Speed of the cam, and of the cart, over the crank angle."""
    import matplotlib.pyplot as plt

    steady, speed = cart_speed(machine)
    figure, axes = plt.subplots(2, 1, figsize=(8, 5), layout="constrained", sharex=True)
    axes[0].plot(np.degrees(steady.crank_angle), steady.speed)
    axes[0].set(ylabel="speed of the cam (rad/s)")
    axes[1].plot(np.degrees(steady.crank_angle), speed)
    axes[1].set(xlabel="crank angle (°)", ylabel="speed of the cart (m/s)", xlim=(0, 360))
    return figure


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:24} {value:.8g}")
    figure(example).savefig(here / "figure.png", dpi=120)
