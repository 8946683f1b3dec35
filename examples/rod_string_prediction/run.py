"""How close does the wave equation come to the worked example of API RP 11L?"""

from pathlib import Path

import linkwright as lw

INCH, POUND = 0.0254, 4.4482216

# What API RP 11L prints: loads [lbf], torque [lbf in], stroke of the plunger [in].
API = {"load_max": 14_355, "load_min": 5248, "torque": 133_793, "plunger_stroke": 41.7}


def study(machine: lw.Machine) -> dict[str, float]:
    """Loads, torque with the best counterbalance and plunger stroke over those of API; the stroke of both."""
    # Curves of API are those of anchored tubing; the stretch of another one is subtracted from the stroke.
    tubing = {"rod_string.pump.tubing_diameter": None, "rod_string.pump.tubing_bore": None}
    motion = lw.rod_string(lw.replace(machine, tubing), accuracy=3e-3)
    moving = lw.rod_string(machine, accuracy=3e-3)
    string = machine.rod_string
    stretch = string.fluid_load * string.pump.tubing_compliance(string.length)
    torque = max(motion.gear_best.torque_net_up, motion.gear_best.torque_net_down)
    return {
        "strokes_per_minute": 60 / motion.period,
        "load_max_over_api": motion.load_max / (API["load_max"] * POUND),
        "load_min_over_api": motion.load_min / (API["load_min"] * POUND),
        "torque_over_api": torque / (API["torque"] * POUND * INCH),
        "plunger_stroke_over_api": (motion.plunger_stroke - stretch) / (API["plunger_stroke"] * INCH),
        "moving_over_anchored": moving.plunger_stroke / (motion.plunger_stroke - stretch),
        "goodman_loading": motion.stress.loading_max,
    }


def figure(machine: lw.Machine):
    """Cards of the polished rod, of the taper and of the pump, the load with the rods' weight below."""
    from matplotlib.figure import Figure

    motion = lw.rod_string(machine)
    drawing = Figure(figsize=(7, 4), layout="constrained")
    axes = drawing.subplots()
    for name, position, load in zip(motion.stations, motion.position, motion.load, strict=True):
        weight = motion.weight_fluid if name == "polished rod" else 0.0
        axes.plot(position - position.min(), (load + weight) / 1e3, label=name)
    axes.set(xlabel="position above the bottom of the stroke [m]", ylabel="load [kN]")
    axes.legend()
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:26} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
