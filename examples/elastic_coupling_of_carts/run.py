"""What load does an elastic coupling carry between a drive and carts that shake it?

A rigid driveline promises a mean torque with peaks of about twice as much. With a coupling the motor side
and the crank side swing against each other: the inertia of the carts changes by a third over the revolution.
"""

from pathlib import Path

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Torque of the coupling and speeds beside those of the rigid driveline, and what a flywheel does."""
    motion, rigid = lw.elastic_motion(machine), lw.steady_state(machine)
    crank, gearbox = motion.stations.index("crank"), motion.stations.index("gearbox")
    even = lw.elastic_motion(lw.replace(machine, {"drive.flywheel": {"inertia": 100.0}}))
    return {
        "period": motion.period,
        "torque_min": float(motion.torque_min[0]),
        "torque_max": float(motion.torque_max[0]),
        "peak_over_mean": float(motion.torque_ratio[0]),
        "dissipated_watts": float(motion.power_dissipated[0]),
        "speed_min_crank": float(motion.speed_min[crank]),
        "speed_max_crank": float(motion.speed_max[crank]),
        "speed_min_gearbox": float(motion.speed_min[gearbox]),
        "speed_max_gearbox": float(motion.speed_max[gearbox]),
        "unevenness_crank": float(motion.unevenness[crank]),
        "unevenness_rigid": rigid.unevenness_time,
        "multiplier": motion.multiplier_max,
        "torque_max_with_flywheel": float(even.torque_max[0]),
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
