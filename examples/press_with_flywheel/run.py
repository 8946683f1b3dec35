"""How much does the speed of a press drop in its stroke, and what does the flywheel do about it?"""

from pathlib import Path

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Drop of the speed with the flywheel and with a third of it; work per stroke from the force's area."""
    motion = lw.steady_state(machine)
    light = lw.steady_state(lw.replace(machine, {"drive.flywheel.inertia": 40.0}))
    # Trapezia of the force table, 60 kN over 560…580 mm, and 250 N over twice the stroke of 160 mm.
    area = 0.5 * 60e3 * 0.002 + 60e3 * 0.016 + 0.5 * 60e3 * 0.002 + 250 * 0.32
    return {
        "unevenness": motion.unevenness,
        "ratio_with_a_third": light.unevenness / motion.unevenness,
        "work_over_area": motion.energy_load / area,
    }


def figure(machine: lw.Machine):
    """Torque and power over one revolution."""
    from linkwright.drive.figures import torque_figure

    return torque_figure(lw.steady_state(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
