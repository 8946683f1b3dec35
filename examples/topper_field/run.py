"""How long must the edge of a topper be for 95 % of the heads of a field, and which edge slices as well?

The roots are made up, but come as measured ones do: a row of the file for each.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.topping.best.best_knife import best_knife
from linkwright.topping.field import topper_field
from linkwright.topping.model.field import RandomField


def bell(values: tuple[float, ...], least: float) -> dict[str, object]:
    """The normal distribution of measured lengths."""
    spread = float(np.std(values, ddof=1))
    return {"kind": "normal", "mean": float(np.mean(values)), "deviation": spread, "min": least}


def by_normal_distributions(machine: lw.Machine) -> lw.Machine:
    """The machine over random roots that scatter as the measured ones do, each size by itself."""
    measured = machine.topper.field
    field = {"kind": "random", "offset": bell(measured.offset, -0.1)}
    field["root_diameter"] = bell(measured.root_diameter, 0.03)
    field["cut_height"] = bell(measured.cut_height, -0.1)
    return lw.replace(machine, {"topper.field": RandomField.model_validate(field)})


def study(machine: lw.Machine) -> dict[str, float]:
    """What the edge of the file does, the length for 95 %, and the shortest edge that slices as asked."""
    measured, random = topper_field(machine), topper_field(by_normal_distributions(machine))
    best = best_knife(machine).best
    return {
        "share_complete": measured.share_complete,
        "haulm_mean": measured.haulm_mean,
        "loss_mass_mean": measured.loss_mass_mean,
        "length_for_95": measured.length_for_95,
        "length_for_95_normal": random.length_for_95,
        "edge_angle_best": best.edge_angle,
        "edge_length_best": best.edge_length,
    }


def figure(machine: lw.Machine):
    """Share of heads against the length of the edge."""
    from linkwright.topping.figures.field import field_share_figure

    return field_share_figure(topper_field(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:22} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
