"""Which ratio and law minimise a servo motor's torque, and which phase the peak power of the DC bus?

For a pure inertia J_L on a rotor J_M the best ratio is the root of J_L/J_M, whatever the law.
"""

from functools import cache
from math import pi, sqrt
from pathlib import Path

import linkwright as lw

HERE = Path(__file__).parent


@cache
def best(name: str):
    """The optimum of a study in this folder."""
    return lw.optimise(lw.read_study(HERE / f"{name}.toml"), method="gradient", starts=1)


def study(machine: lw.Machine) -> dict[str, float]:
    """Ratio and torque beside their closed forms, and the power of the bus before and after."""
    by_ratio, by_phase = best("ratio"), best("phase")
    rotor, table = machine.axes["left"].motor.inertia, machine.bodies["left"].inertia
    # The modified sine is best: peak 4π²/(4 + π) h/T², all of it in waves, which halve the square.
    rate = 4 * pi**2 / (4 + pi) / sqrt(2) * (pi / 2) * 9 * sqrt(2 / 3)
    return {
        "ratio": by_ratio.variables["ratio"],
        "ratio_beside_root": by_ratio.variables["ratio"] / sqrt(table / rotor) - 1,
        "rms_beside_closed_form": by_ratio.responses["rms"] / (2 * sqrt(table * rotor) * rate) - 1,
        "power_together": lw.dc_bus(machine).power_max,
        "power_in_turn": by_phase.responses["power"],
    }


def figure(machine: lw.Machine):
    """Power of the bus with both tables at once, and in turn."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(8, 3.2), layout="constrained")
    axes = drawing.subplots()
    axes.set(xlabel="master angle [deg]", ylabel="power of the DC bus [W]", xlim=(0, 360))
    for of, label in ((machine, "both at once"), (best("phase").machine, "phase of minimum peak")):
        bus = lw.dc_bus(of)
        axes.plot(bus.crank_angle * 180 / pi, bus.power, label=label)
    axes.legend()
    return drawing


if __name__ == "__main__":
    for name, value in study(lw.read(HERE / "machine.toml")).items():
        print(f"{name:28} {value:.6g}")
    figure(lw.read(HERE / "machine.toml")).savefig(HERE / "figure.png", dpi=120)
