"""How do two engines share one propeller, and does the line keep the limit of its class?

The engines give what their gas says: indicated mean pressure times swept volume over the angle of a cycle.
The permitted stress is that of IACS UR M68.
"""

from pathlib import Path

import numpy as np

import linkwright as lw

SERVICE = 750 * np.pi / 30


def study(machine: lw.Machine) -> dict[str, float]:
    """Mean torques of both branches and of the line in service; stress of the line there, and permitted."""
    forced = lw.forced_vibration(machine, np.array([SERVICE]))
    mean = dict(zip(forced.shafts, forced.mean_torques[:, 0], strict=True))
    stress = lw.shaft_stress(machine, forced)
    gears = lw.mesh_torques(machine, np.array([SERVICE]))
    line = stress.shafts.index("line")
    return {
        "port_coupling_torque": float(mean["port_coupling"]),
        "starboard_coupling_torque": float(mean["starboard_coupling"]),
        "line_torque": float(mean["line"]),
        "line_stress_permitted_mpa": float(stress.continuous[line, 0] / 1e6),
        "port_stage_application_factor": float(gears.application_factor[0, 0]),
        "line_stress_ratio": float(stress.vibratory[line, 0] / stress.continuous[line, 0]),
    }


def figure(machine: lw.Machine):
    """The vibratory torques of the couplings, the inputs and the line over the speed of the engines."""
    from linkwright.torsion.figures.forced import shaft_torques_figure

    return shaft_torques_figure(lw.forced_vibration(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
