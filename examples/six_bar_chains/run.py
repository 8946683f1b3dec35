"""Do the five six-bar linkages of Watt and Stephenson close, and do their rates fit their positions?"""

from pathlib import Path

import numpy as np

import linkwright as lw

ANGLES = np.linspace(0, 2 * np.pi, 721)
OTHERS = ("watt_1", "watt_2", "stephenson_1", "stephenson_3")
CHAINS = {name: lw.read(Path(__file__).with_name(f"{name}.toml")) for name in OTHERS}


def gap(machine: lw.Machine) -> float:
    """Maximum error of a link's length all round [m]."""
    motion = lw.kinematics(machine, ANGLES)
    place = {name: point.position for name, point in motion.points.items()}
    links = machine.mechanism.links().values()
    return max(np.abs(np.hypot(*(place[k.end] - place[k.start]).T) - k.length).max() for k in links)


def slip(machine: lw.Machine) -> float:
    """Maximum difference of the rates of a point from those of its Fourier series [m]."""
    points, n = lw.kinematics(machine, ANGLES[:-1]).points.values(), len(ANGLES) - 1
    order = 1j * np.arange(n // 2 + 1)[:, None]
    pairs = [pair for each in points for pair in ((each.position, each.d1), (each.d1, each.d2))]
    apart = [np.fft.irfft(np.fft.rfft(x, axis=0) * order, n, axis=0) - rate for x, rate in pairs]
    return float(np.abs(apart).max())


def study(machine: lw.Machine) -> dict[str, float]:
    """Closure of each chain; freedom by Gruebler: six links and seven hinges have 3·5 − 2·7 = 1."""
    chains = {**CHAINS, "stephenson_2": machine}
    found = {f"{check.__name__}_{name}": check(chains[name]) for name in chains for check in (gap, slip)}
    kinds = [step.kind for each in chains.values() for step in each.mechanism.steps()]
    return found | {"groups": kinds.count("group")}


def figure(machine: lw.Machine):
    """Paths of the moving points."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(11, 3), layout="constrained")
    chains = {**CHAINS, "stephenson_2": machine}
    for axes, (name, each) in zip(drawing.subplots(1, 5), chains.items(), strict=True):
        for point in lw.kinematics(each, ANGLES).points.values():
            axes.plot(*point.position.T, "." if np.ptp(point.position) == 0 else "-")
        axes.set(title=name.replace("_", " "), aspect="equal", xticks=[], yticks=[])
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
