"""What does one degree of backlash do to a drive whose torque reverses?

The slider drives the crank twice a revolution. Without backlash the torque passes through zero; with it the
flanks part, the coupling carries nothing, and meets the other flank with an impact.
"""

from pathlib import Path

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Torque of the coupling, speed of the crank, heat of the coupling, and the stability."""
    motion = lw.elastic_motion(machine)
    crank = motion.stations.index("crank")
    return {
        "period": motion.period,
        "torque_min": float(motion.torque_min[0]),
        "torque_max": float(motion.torque_max[0]),
        "speed_min_crank": float(motion.speed_min[crank]),
        "speed_max_crank": float(motion.speed_max[crank]),
        "dissipated_watts": float(motion.power_dissipated[0]),
        "multiplier": motion.multiplier_max,
    }


def figure(machine: lw.Machine):
    """The torque of the coupling, and the speeds on both of its sides."""
    from linkwright.driveline.figures import elastic_figure

    return elastic_figure(lw.elastic_motion(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:24} {value:.10g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
