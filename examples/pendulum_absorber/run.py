"""How much vibration do centrifugal pendulums take off a crank, at which speeds, and how far do they swing?

Den Hartog, Mechanical Vibrations, 4th ed. 1956, chapter 5: a pendulum with R/l = n² holds its disc at rest
under the order n at every speed, unlike a tuned damper, whose spring does not follow the speed.
"""

from pathlib import Path

import numpy as np

import linkwright as lw


def without(machine: lw.Machine) -> lw.Machine:
    """The crank with the pendulums fixed to it."""
    train = machine.train
    fixed = train.discs["crank"].inertia + sum(one.ring_inertia for one in train.pendulums.values())
    bare = machine.with_entries({"train": train.with_entries({"pendulums": {}})})
    return lw.replace(bare, {"train.discs.crank.inertia": fixed})


def study(machine: lw.Machine) -> dict[str, float]:
    """Amplitudes of the crank by order, torque of the shaft, and the swing of the pendulums."""
    found, fixed = lw.forced_vibration(machine), lw.forced_vibration(without(machine))
    pendulum = machine.train.pendulums["weights"]
    angle = np.degrees(np.abs(found.amplitudes))
    crank, ring = found.discs.index("crank"), found.discs.index("weights")
    lead = np.abs(found.amplitudes[0, ring] - found.amplitudes[0, crank])
    return {
        "order_2_crank_deg": float(angle[0, crank].max()),
        "order_4_crank_deg": float(angle[1, crank].max()),
        "order_2_fixed_deg": float(np.degrees(np.abs(fixed.amplitudes[0, 0])).max()),
        "shaft_nm": float(found.shaft_torque_vibratory[0].max()),
        "shaft_fixed_nm": float(fixed.shaft_torque_vibratory[0].max()),
        "swing_deg": float(np.degrees(pendulum.swing_per_twist * lead).max()),
    }


def figure(machine: lw.Machine):
    """Vibratory torque of the shaft over the speed, with the pendulums free and fixed."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(7.5, 4.2), layout="constrained")
    words = {"xlabel": "speed [rpm]", "ylabel": "vibratory torque of the shaft [N m]", "yscale": "log"}
    axes = drawing.subplots(subplot_kw=words)
    for name, one in (("pendulums fixed", without(machine)), ("pendulums free", machine)):
        found = lw.forced_vibration(one)
        axes.plot(found.speeds * 30 / np.pi, found.shaft_torque_vibratory[0], label=name)
    axes.legend()
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:20} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
