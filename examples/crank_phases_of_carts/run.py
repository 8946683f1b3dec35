"""Which angles between the cranks give two, three and four carts the minimum speed fluctuation?

A grid of machines over all phases, then smaller ones about the best. Usual are right angles and thirds.
"""

from functools import cache
from itertools import product
from pathlib import Path

import numpy as np

import linkwright as lw

HERE = Path(__file__).parent
CARTS = {2: "roller_two_carts", 3: "roller_three_carts", 4: "roller_four_carts"}


def delta(machine: lw.Machine, phases):
    """δ of machines with the phases of the second crank and those after it, (n, cranks - 1) [rad]."""
    names = [f"mechanism.cranks.A{i + 2}.phase" for i in range(phases.shape[1])]
    return lw.steady_states(machine, dict(zip(names, phases.T.copy(), strict=True))).unevenness


@cache
def best(carts: int):
    """The best phases [rad], δ there, and δ at the usual phases."""
    machine = lw.read(CARTS[carts])
    usual = np.array([[lw.get(machine, f"mechanism.cranks.A{i}.phase") for i in range(2, carts + 1)]])
    width = np.radians(45 if carts == 4 else 30)
    grid = np.array(list(product(np.arange(0, 2 * np.pi, width), repeat=carts - 1)))
    while width > np.radians((0.03, 0.06, 3.0)[carts - 2]):
        found = delta(machine, grid)
        steps = product((-width, -width / 2, 0.0, width / 2, width), repeat=carts - 1)
        middle, low = grid[np.nanargmin(found.round(8))], float(np.nanmin(found))  # of like ones the first
        grid, width = middle + np.array(list(steps)), width / 2
    return middle, low, float(delta(machine, usual)[0])


def study(machine: lw.Machine) -> dict[str, float]:
    """δ at the usual phases and at the best ones, for each number of carts; the best phases of three."""
    found = {carts: best(carts) for carts in CARTS}
    answers = {f"delta_usual_{carts}": usual for carts, (_, _, usual) in found.items()}
    answers |= {f"delta_best_{carts}": low for carts, (_, low, _) in found.items()}
    return answers | {f"phase_{i + 2}_of_3_deg": x for i, x in enumerate(np.degrees(found[3][0]))}


def figure(machine: lw.Machine):
    """δ of three carts over both phases, with the best and the usual ones."""
    from matplotlib.figure import Figure

    side = np.radians(np.linspace(0, 360, 25))
    table = delta(machine, np.array(list(product(side, side)))).reshape(25, 25).T
    drawing = Figure(figsize=(6.4, 5), layout="constrained")
    axes = drawing.subplots(subplot_kw={"title": "speed fluctuation of three carts", "aspect": "equal"})
    drawing.colorbar(axes.contourf(np.degrees(side), np.degrees(side), table, levels=20), label="δ [–]")
    axes.plot(*np.degrees(best(3)[0]), "o", color="#d55e00", label="best")
    axes.plot(120, 240, "x", color="white", label="thirds")
    axes.set(xlabel="phase of crank 2 [°]", ylabel="phase of crank 3 [°]")
    axes.legend()
    return drawing
