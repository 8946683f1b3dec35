"""Which crank hole keeps a pumping unit's gearbox within its rating, and what does it cost in stroke?"""

from pathlib import Path

import linkwright as lw

HOLES = (24, 20, 16)


def units(machine: lw.Machine) -> list[lw.Machine]:
    """The unit with its crank pin in each hole; radii in inches."""
    return [lw.replace(machine, {"pumping_unit.R": 0.0254 * radius}) for radius in HOLES]


def study(machine: lw.Machine) -> dict[str, float]:
    """Stroke and load of the gearbox for each hole, with the best counterbalance."""
    found = {}
    for hole, each in enumerate(units(machine), start=1):
        motion = lw.pumping_unit(each)
        found[f"stroke_{hole}"] = motion.stroke
        found[f"gear_load_{hole}"] = motion.gear.gear_load
    return found


def figure(machine: lw.Machine):
    """Torque of the gearbox over one revolution for each hole, and its rating."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(7, 4), layout="constrained")
    axes = drawing.subplots()
    for radius, each in zip(HOLES, units(machine), strict=True):
        gear = lw.pumping_unit(each).gear
        axes.plot(57.29578 * gear.crank_angle, gear.torque_net / 1e3, label=f"hole at {radius} in")
    axes.axhline(gear.torque_rated / 1e3, color="grey", linestyle="--", label="rating")
    axes.set(xlabel="crank angle θ [°]", ylabel="torque of the gearbox [kN m]", xlim=(0, 360))
    axes.legend()
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:16} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
