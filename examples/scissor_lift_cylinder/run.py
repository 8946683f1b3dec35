"""Which force and pressure of its cylinder hold a scissor lift at each height?"""

from pathlib import Path

import numpy as np

import linkwright as lw

# Weight [N], length of the arms, trunnion and eye from the fixed foot [m].
W, ARM, TRUNNION, EYE = 10e3, 2.0, 0.6, 1.3


def slope(length: np.ndarray) -> np.ndarray:
    """Angle of the arms by the law of cosines [rad]."""
    return np.arccos((TRUNNION**2 + EYE**2 - length**2) / (2 * TRUNNION * EYE))


def study(machine: lw.Machine) -> dict[str, float]:
    """Deviation from F dL = W dh, F = W l L/(t k tan θ); largest force and pressure."""
    cylinder = lw.cylinder_force(machine)
    closed = W * ARM * cylinder.length / (TRUNNION * EYE * np.tan(slope(cylinder.length)))
    return {
        "deviation": float(np.abs(cylinder.force / closed - 1).max()),
        "force_max": cylinder.force_max,
        "pressure_max": cylinder.pressure_max or 0.0,
    }


def figure(machine: lw.Machine):
    """Force over the height of the table."""
    from matplotlib.figure import Figure

    cylinder = lw.cylinder_force(machine)
    drawing = Figure(figsize=(6, 4), layout="constrained")
    axes = drawing.subplots()
    axes.plot(1e3 * ARM * np.sin(slope(cylinder.length)), 1e-3 * cylinder.force)
    axes.set(xlabel="height of the table [mm]", ylabel="force of the cylinder [kN]")
    axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
