"""Which flywheel keeps the speed of a one-cart drive within 5 %?

Source: the one-cart drive of paper 1; the classical estimate is excess work over wanted δ ω_m².
"""

from pathlib import Path

import linkwright as lw

WANTED = 0.05


def study(machine: lw.Machine) -> dict[str, float]:
    """The flywheel, and the speed fluctuation that the machine with it has."""
    choice = lw.choose_flywheel(machine, WANTED)
    data = machine.model_dump(by_alias=True, exclude_unset=True)
    data["drive"]["flywheel"] = {"inertia": choice.inertia}
    return {
        "unevenness_without": lw.steady_state(machine).unevenness,
        "flywheel": choice.inertia,
        "unevenness_with": lw.steady_state(lw.Machine.model_validate(data)).unevenness,
    }


def figure(machine: lw.Machine):
    """Reduced inertia and load: what makes the drive uneven."""
    from linkwright.drive.figures import reduction_figure

    return reduction_figure(lw.reduction(machine))


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
