"""Where does a motor that drives a pump through a gear resonate, and which part moves the resonance?

Three masses referred to the motor's speed have the closed form of Den Hartog, Mechanical Vibrations,
section 5.2.
"""

from pathlib import Path

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Frequencies, the node of the first mode, and what a thicker slow shaft does to it."""
    found = lw.free_vibration(machine)
    slow = found.shafts.index("slow")
    wider = lw.replace(machine, {"train.shafts.slow.sections.0.diameter": 0.1})
    return {
        "first_frequency_hz": float(found.natural_frequencies[1]),
        "second_frequency_hz": float(found.natural_frequencies[2]),
        "pump_amplitude_first": float(found.mode_shapes[1][-1]),
        "node_on_slow_shaft_mm": 1e3 * found.nodes[1][0].distance,
        "slow_shaft_share_first": float(found.potential_shares[1][slow]),
        "first_with_100_mm_hz": float(lw.free_vibration(wider).natural_frequencies[1]),
    }


def figure(machine: lw.Machine):
    """The shapes of both modes."""
    from linkwright.torsion.figures.modes import modes_figure

    return modes_figure(lw.free_vibration(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:24} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
