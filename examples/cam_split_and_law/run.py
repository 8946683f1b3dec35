"""How should a cam divide its stroke into start, constant speed and braking, and by which law?

For the minimum peak force: longer ramps ask for less acceleration, but for a higher speed between them and so
for a larger pressure angle.
"""

from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar

import linkwright as lw

HERE = Path(__file__).parent
PLAN = lw.read_study(HERE / "study.toml")
LAWS, SHARES = PLAN.axes[0].choices, np.linspace(0.05, 0.5, 10)


def forces(law: int, shares) -> np.ndarray:
    """Peak force of a law with ramps of some shares of the stroke [N]."""
    return lw.evaluate(PLAN, {"law": np.full(len(shares), law, float), "share": shares}).columns["force"]


def by_hand(speed: float, share: float) -> float:
    """Peak of (m a + F)/cos γ of the harmonic law by its formulas, with tan γ = s′/r."""
    breadth, stroke, mass, load = 1.0, 0.4, 1000.0, 3562.0
    top, wave = 1.0 / (1.0 - share * (2.0 - 4.0 / np.pi)), 0.5 * np.pi / share
    turn = wave * np.linspace(0.0, share, 20_001)
    lift, slope, bend = (top * f for f in ((1 - np.cos(turn)) / wave, np.sin(turn), wave * np.cos(turn)))
    radius = 0.5 * (breadth - stroke) + stroke * lift
    force = mass * stroke * bend * (speed / np.pi) ** 2 + load
    return float((force * np.hypot(1.0, stroke * slope / np.pi / radius)).max())


def study(machine: lw.Machine) -> dict[str, float]:
    """The best law and the share of its ramps, the force; that of the published law; and by formulas."""
    law = int(np.argmin([forces(law, SHARES).min() for law in range(len(LAWS))]))
    best = minimize_scalar(lambda x: forces(law, [x])[0], bounds=(0.05, 0.5), options={"xatol": 1e-6})
    hand = by_hand(machine.drive.speed, best.x)
    named = {"law": float(law), "share": best.x, "force": best.fun, "over_formulas": best.fun / hand}
    return named | {"force_published_law": forces(0, [1 / 6])[0]}


def figure(machine: lw.Machine):
    """Peak force over the share, for each law."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(7, 4), layout="constrained")
    axes = drawing.subplots()
    for law, name in enumerate(LAWS):
        axes.plot(SHARES, forces(law, SHARES) * 1e-3, label=name.replace("_", " "))
    axes.set(xlabel="share of the start, and of the braking", ylabel="peak force [kN]", ylim=(3.9, 5.5))
    axes.legend(frameon=False)
    return drawing


if __name__ == "__main__":
    for name, value in study(lw.read(HERE / "machine.toml")).items():
        print(f"{name:28} {value:.6g}")
    figure(lw.read(HERE / "machine.toml")).savefig(HERE / "figure.png", dpi=120)
