"""How long must the edge of a topper be, what does its stroke cost, and what does a shorter one leave?

Paper 5 (see docs/references.md) asks for a length that keeps the knife busy while a head passes. A head is
cut through if the edge crosses each of its points, in whatever phase it meets the knife.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.topping.topper import TopperStudy

STROKES = np.linspace(0.01, 0.1, 10)


def with_stroke(machine: lw.Machine, stroke: float) -> TopperStudy:
    """The study of the knife with another stroke at the same mean speed."""
    return lw.topper(lw.replace(machine, {"topper.motion.stroke": float(stroke)}))


def study(machine: lw.Machine) -> dict[str, float]:
    """Lengths by all ways, what a longer stroke adds, what an edge of the published length leaves."""
    found, longer = lw.topper(machine), with_stroke(machine, 0.1)
    names = ("length_published", "length_consistent", "length_at_rest", "length_exact_constant_speed")
    short = lw.topper(lw.replace(machine, {"topper.edge_length": found.length_published}))
    return {
        **{name: getattr(found, name) for name in (*names, "length_exact")},
        "uncut_share": found.uncut_share,
        "length_for_each_metre_of_stroke": (longer.length_exact - found.length_exact) / 0.04,
        "uncut_share_of_the_published_length": short.uncut_share,
    }


def figure(machine: lw.Machine):
    """Lengths over the stroke."""
    import matplotlib.pyplot as plt

    found = [with_stroke(machine, stroke) for stroke in STROKES]
    figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
    named = {"length_exact": "heads in all phases", "length_best_phase": "heads in the best phase alone"}
    named["length_exact_constant_speed"] = "knife at constant speed"
    named |= {"length_at_rest": "knife at rest", "length_consistent": "paper 5, from (4)"}
    for name, words in (named | {"length_published": "paper 5, (10)"}).items():
        axes.plot(1e3 * STROKES, [1e3 * getattr(each, name) for each in found], label=words)
    axes.axhline(1e3 * machine.topper.edge_length, color="0.4", ls="--", label="edge of the file")
    axes.set(xlabel="stroke (mm)", ylabel="length of the edge (mm)", ylim=(0, None), xlim=(10, 100))
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
    return figure


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:36} {value:.8g}")
    figure(example).savefig(here / "figure.png", dpi=120)
