"""At which angle between two cranks is the speed fluctuation at its minimum, whatever the length of the rods?

A grid of machines: δ over the phase and over the rod ratio λ = r/l, and the best phase for each λ.
"""

from pathlib import Path

import numpy as np

import linkwright as lw

HERE = Path(__file__).parent


def rows(machine: lw.Machine):
    """Phase [°], rod ratio and δ of all machines of the grid, (rods, phases)."""
    plan = lw.read_study(HERE / "study.toml")
    assert plan.machine == machine
    found = lw.evaluate(plan, plan.rows(0, plan.n_rows)).columns
    phase, ratio, delta = (found[name].reshape(25, 9).T for name in ("phase", "rod_ratio", "delta"))
    return np.degrees(phase), ratio, delta


def best(phase, delta):
    """Phase of the minimum of δ in each row [°], by a parabola through the three lowest values."""
    at = delta.argmin(axis=1)
    left, low, right = (np.take_along_axis(delta, (at + k)[:, None], 1)[:, 0] for k in (-1, 0, 1))
    step = phase[0, 1] - phase[0, 0]
    return phase[0, at] + 0.5 * step * (left - right) / (left - 2 * low + right)


def study(machine: lw.Machine) -> dict[str, float]:
    """The best phase with short and with long rods, and δ there."""
    phase, _, delta = rows(machine)
    short, *_, long = best(phase, delta)
    return {"best_short_deg": short, "best_long_deg": long, "delta_long": delta[-1].min()}


def figure(machine: lw.Machine):
    """δ as a map, with the best phase."""
    from matplotlib.figure import Figure

    phase, ratio, delta = rows(machine)
    drawing = Figure(figsize=(7, 4.4), layout="constrained")
    axes = drawing.subplots()
    lines = axes.contourf(phase, ratio, delta, levels=16)
    drawing.colorbar(lines, label="coefficient of speed fluctuation δ [–]")
    axes.plot(best(phase, delta), ratio[:, 0], ".-", color="#d55e00", label="minimum of δ")
    axes.set(xlabel="angle between the cranks [°]", ylabel="rod ratio λ = r/l [–]")
    axes.legend()
    return drawing


if __name__ == "__main__":
    example = lw.read(HERE / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(HERE / "figure.png", dpi=120)
    print(f"{HERE / 'figure.png'}")
