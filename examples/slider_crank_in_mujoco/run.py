"""Does an engine that knows bodies and constraints instead of a crank angle move a slider-crank alike?

On the command line:
linkwright export slider_crank_in_mujoco --to mjcf --from-angle 0.3 --from-speed 20 --out crank.xml

MuJoCo is needed: pip install mujoco.
"""

from pathlib import Path

import numpy as np

import linkwright as lw

ANGLE, SPEED, STEP = 0.3, 20.0, 2.5e-4


def simulated(machine: lw.Machine) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, crank angle and place of the slider over one second, by MuJoCo."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(lw.mjcf(machine, angle=ANGLE, speed_start=SPEED, step=STEP).text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    rows = []
    for _ in range(101):
        mujoco.mj_kinematics(model, data)
        rows.append((data.time, ANGLE + data.joint("O").qpos[0], data.site("S").xpos[0]))
        mujoco.mj_step(model, data, 40)
    time, angle, place = np.array(rows).T
    return time, angle, place


def study(machine: lw.Machine) -> dict[str, float]:
    """Crank angle after one second by both, and the largest distance between both sliders."""
    time, angle, place = simulated(machine)
    motion = lw.transient(machine, angle=ANGLE, speed=SPEED, duration=1.01, accuracy=1e-12)
    own = lw.kinematics(machine, motion.at(time)[0]).points["S"].position[:, 0]
    return {
        "crank_angle": float(motion.at(time[-1])[0]),
        "crank_angle_in_mujoco": float(angle[-1]),
        "distance_max": float(np.abs(place - own).max()),
    }


def figure(machine: lw.Machine):
    """Crank angle of MuJoCo less that of Linkwright."""
    from matplotlib.figure import Figure

    time, angle, _ = simulated(machine)
    motion = lw.transient(machine, angle=ANGLE, speed=SPEED, duration=1.01, accuracy=1e-12)
    drawn = Figure(figsize=(6, 3), layout="constrained")
    axes = drawn.subplots()
    axes.set(xlabel="time [s]", ylabel="Δφ [rad]")
    axes.plot(time, angle - motion.at(time)[0])
    return drawn


if __name__ == "__main__":
    print(study(lw.read(Path(__file__).parent / "machine.toml")))
