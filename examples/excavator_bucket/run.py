"""Which forces and pressures do the two cylinders of an excavator's stick and bucket need?"""

from pathlib import Path

import numpy as np

import linkwright as lw

ANGLES = np.radians([40.0, 100.0, 200.0, 290.0])
STEP = 1e-5


def potential(machine: lw.Machine) -> np.ndarray:
    """Energy of weights and of the constant digging force at the teeth, at some positions [J]."""
    motion = lw.kinematics(machine, ANGLES)
    energy = np.zeros(len(ANGLES))
    for name, start in {"stick": "S", "bucket": "G", "bucket_cylinder": "T", "rod": "P"}.items():
        body, angle = machine.bodies[name], motion.links[machine.bodies[name].on or name].angle
        height = motion.points[start].position[:, 1] + body.along * np.sin(angle)
        height = height + body.across * np.cos(angle)
        energy += body.mass * machine.loads["weight"].acceleration * height
    soil = machine.loads["soil"]
    along = np.array([np.cos(soil.direction), np.sin(soil.direction)])
    return energy - soil.force * motion.points["K"].position @ along


def study(machine: lw.Machine) -> dict[str, float]:
    """Deviation of both holding forces from virtual work, F = dU/dL; largest pressures in motion."""
    held, deviation = lw.forces(machine, speed=0.0, angles=ANGLES), 0.0
    for name, cylinder in machine.mechanism.cylinders.items():
        address = f"mechanism.cylinders.{name}.start_length"
        at = [lw.replace(machine, {address: cylinder.start_length + step}) for step in (-STEP, STEP)]
        work = (potential(at[1]) - potential(at[0])) / (2 * STEP)
        deviation = max(deviation, float(np.abs(held.drives[name] / work - 1).max()))
    moving = {name: lw.cylinder_force(machine, name) for name in machine.mechanism.cylinders}
    return {"deviation": deviation} | {name: one.pressure_max or 0.0 for name, one in moving.items()}


def figure(machine: lw.Machine):
    """Forces of both cylinders over the cycle."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(6, 4), layout="constrained")
    axes = drawing.subplots()
    for name in machine.mechanism.cylinders:
        one = lw.cylinder_force(machine, name)
        axes.plot(one.time, 1e-3 * one.force, label=name.replace("_", " "))
    axes.set(xlabel="time [s]", ylabel="force on the rod [kN]")
    axes.grid(alpha=0.3)
    axes.legend()
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
