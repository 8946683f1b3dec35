"""Which couples shake an in-line engine whose forces of inertia cancel?"""

from pathlib import Path

import linkwright as lw

# Distance of two cylinders [m].
SPACING = 0.09


def study(machine: lw.Machine) -> dict[str, float]:
    """Primary and secondary couples over F a and λ F a, F being the force m r ω² of one piston."""
    orders = lw.shaking_orders(machine)
    crank, rod = machine.mechanism.cranks["A1"].radius, machine.mechanism.sliders["piston1"].rod
    force = machine.bodies["piston1"].mass * crank * orders.speed**2
    return {
        "force_primary": orders.force_max[0] / force,
        "couple_primary": orders.couple_max[0] / (force * SPACING),
        "couple_secondary": orders.couple_max[1] / (force * SPACING * crank / rod),
    }


def figure(machine: lw.Machine):
    """The couple about both axes over a revolution, and its orders."""
    import matplotlib.pyplot as plt
    import numpy as np

    forces, orders = lw.forces(machine), lw.shaking_orders(machine)
    drawn, (left, right) = plt.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
    left.plot(np.degrees(forces.crank_angle), forces.shaking_couple[:, 0])
    left.set(xlabel="crank angle φ [°]", ylabel="couple about x [N m]", xticks=range(0, 361, 90))
    right.bar(orders.order[:6], orders.couple_max[:6])
    right.set(xlabel="order", ylabel="maximum couple [N m]")
    return drawn


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
