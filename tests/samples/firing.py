"""An engine for tests: cylinders in a row on an elastic crankshaft, firing one after the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

import linkwright as lw

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

# A four-stroke engine of six cylinders: half orders up to 6.
ORDERS = np.arange(1, 13) / 2
FIRING = (1, 5, 3, 6, 2, 4)
TURNS = 2


def firing_angles(order: Sequence[int] = FIRING, turns: int = TURNS) -> dict[str, float]:
    step = 2 * np.pi * turns / len(order)
    return {str(cylinder): n * step for n, cylinder in enumerate(order)}


def gas(order: float) -> complex:
    """Harmonic of what firing adds to the torque of a cylinder that fires at angle 0: a pulse that fades."""
    return 900 * np.exp(-0.28 * order - 0.5j * order)


def sources(orders: Floats = ORDERS, order: Sequence[int] = FIRING, discs: int = 8) -> Complexes:
    """Harmonics of the firing part of each cylinder at its disc, (cylinders, orders, discs)."""
    found = np.zeros((len(order), len(orders), discs), complex)
    for name, angle in firing_angles(order).items():
        c = int(name) - 1
        found[c, :, c] = [gas(nu) * np.exp(-1j * nu * angle) for nu in orders]
    return found


def engine(
    factors: Sequence[float] | None = None,
    stiffness: float = 4e5,
    order: Sequence[int] = FIRING,
    orders: Floats = ORDERS,
    inertia: float = 900.0,
    damping: float = 3.0,
    coupling: float = 2e4,
) -> lw.Machine:
    """Crank throws 1…z, a flywheel and a brake; inertia torques of order 2 on every throw."""
    z = len(order)
    factors = [1.0] * z if factors is None else factors
    lines = ["format = 1", 'name = "Engine"', "[train.discs]"]
    lines += [f"throw_{n + 1} = {{ inertia = 0.06, damping = {damping} }}" for n in range(z)]
    lines += [
        "flywheel = { inertia = 2.5 }",
        f"brake = {{ inertia = 0.8, damping = {damping / 3} }}",
        "[train.shafts]",
    ]
    lines += [
        f'crank_{n} = {{ between = ["throw_{n}", "throw_{n + 1}"], stiffness = {stiffness} }}'
        for n in range(1, z)
    ]
    lines += [f'last = {{ between = ["throw_{z}", "flywheel"], stiffness = {stiffness} }}']
    lines += [
        'coupling = { between = ["flywheel", "brake"], stiffness = ' + f"{coupling}, loss_factor = 0.1 }}"
    ]
    waves = sources(orders, order, z + 2)
    for c in range(z):
        total = {nu: factors[c] * waves[c, n, c] for n, nu in enumerate(orders)}
        angle = firing_angles(order)[str(c + 1)]
        total[2.0] = total.get(2.0, 0) + inertia * np.exp(-2j * angle)
        rows = ", ".join(
            f"{{ order = {nu}, torque = {float(abs(t))!r}, phase = {float(np.angle(t))!r} }}"
            for nu, t in total.items()
        )
        lines += [f"[train.excitations.cylinder_{c + 1}]", f'on = "throw_{c + 1}"', f"harmonics = [{rows}]"]
    return lw.loads("\n".join(lines) + "\n")
