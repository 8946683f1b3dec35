"""Where should the crankshaft of a pumping unit stand, so that its peak torque factor is at its minimum?

The stroke is kept at 1.41 m: at each place the crank has the radius that gives it.
"""

from functools import cache
from pathlib import Path

import numpy as np

import linkwright as lw

HERE, STROKE = Path(__file__).parent, 1.41


@cache
def places():
    """Place of the crankshaft, radius, torque factors up and down at that stroke [m], (5,) each."""
    plan = lw.read_study(HERE / "study.toml")
    columns = lw.evaluate(plan, plan.rows(0, plan.n_rows)).columns
    front, stroke, *rest = (columns[x].reshape(5, 4) for x in ("front", "stroke", "crank", "up", "down"))
    # All are smooth over the stroke: cubics through the four radii.
    at = [[np.polyfit(s - STROKE, y, 3)[-1] for s, y in zip(stroke, table, strict=True)] for table in rest]
    return front[:, 0], np.array(at[0]), np.array(at[1]), -np.array(at[2])


def best(machine: lw.Machine):
    """The unit whose upstroke and downstroke need the same."""
    front, radius, up, down = places()
    place = np.polyfit(down - up, front, 4)[-1]
    crank = np.polyval(np.polyfit(front, radius, 4), place)
    return lw.replace(machine, {"pumping_unit.I": place, "pumping_unit.R": crank})


def study(machine: lw.Machine) -> dict[str, float]:
    """The best place; the unit there by its own analysis; and that of the catalogue."""
    unit, changed = lw.pumping_unit(machine), lw.pumping_unit(best(machine))
    return {
        "front_in": lw.get(best(machine), "pumping_unit.I") / 0.0254,
        "stroke": changed.stroke,
        "up_less_down": changed.torque_factor_max + changed.torque_factor_min,
        "peak": changed.torque_factor_max,
        "saved": 1 - changed.torque_factor_max / unit.torque_factor_max,
    }


def figure(machine: lw.Machine):
    """Both torque factors over the place of the crankshaft."""
    from matplotlib.figure import Figure

    front, _, up, down = places()
    drawing = Figure(figsize=(7, 4), layout="constrained")
    axes = drawing.subplots()
    axes.plot(front / 0.0254, up, label="upstroke, maximum")
    axes.plot(front / 0.0254, down, label="downstroke, peak absolute")
    axes.axvline(64, color="#6b7480", linestyle="--", label="catalogue")
    axes.set(xlabel="saddle bearing in front of the crankshaft I [in]", ylabel="torque factor at 1.41 m [m]")
    axes.legend()
    return drawing
