"""What does a damper gain that is tuned to all speeds and orders of an engine, beside the rule for one mode?

The rule lowers one resonance. The engine runs through a part of it, and orders far from resonance count too.
"""

from functools import cache
from pathlib import Path

import linkwright as lw

HERE, RING, MODE = Path(__file__).parent, 0.12, 2  # the first mode that twists the crankshaft


@cache
def tuned():
    """Spring and oil of the smallest peak over all speeds."""
    return lw.optimise(lw.read_study(HERE / "study.toml"), evaluations=150)


def responses(machine: lw.Machine):
    """Forced vibration with each damper."""
    oil = lw.design_damper(machine, "front", RING, mode=MODE)
    spring = lw.design_damper(machine, "front", RING, mode=MODE, kind="tuned")
    sprung = {"damping": spring.damping_best, "stiffness": spring.stiffness_best}
    rules = {
        "without damper": {},
        "oil, by the mode": {"kind": "viscous", "damping": oil.damping_best},
        "spring and oil, by the mode": {"kind": "tuned", **sprung},
    }
    found = {}
    for name, entries in rules.items():
        dampers = {"damper": {"on": "front", "ring_inertia": RING} | entries} if entries else {}
        found[name] = lw.forced_vibration(lw.replace(machine, {"train.dampers": dampers}))
    return found | {"spring and oil, over all speeds": lw.forced_vibration(tuned().machine)}


def study(machine: lw.Machine) -> dict[str, float]:
    """The peak over all speeds with each damper [N m], and spring and oil of the last."""
    peaks = [float(one.shaft_torque_vibratory.max()) for one in responses(machine).values()]
    return dict(zip(("bare", "oil", "rule", "tuned"), peaks, strict=True)) | tuned().variables


def figure(machine: lw.Machine):
    """The largest vibratory torque of all shafts over the speed with each damper."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(7.5, 4.2), layout="constrained")
    axes = drawing.subplots(subplot_kw={"xlabel": "speed [rpm]", "ylabel": "largest vibratory torque [N m]"})
    for name, one in responses(machine).items():
        row = one.shaft_torque_vibratory.max(axis=0)
        axes.plot(one.speeds * 9.5493, row, label=f"{name}: {row.max():.0f} N m")
    axes.set_ylim(bottom=0)
    axes.legend()
    return drawing


if __name__ == "__main__":
    example = lw.read(HERE / "machine.toml")
    print(*(f"{name:12} {value:.6g}" for name, value in study(example).items()), sep="\n")
    figure(example).savefig(HERE / "figure.png", dpi=120)
