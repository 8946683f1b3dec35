"""How fast does a rocking lever turn the rod string, and what does its swing cost the link?"""

from pathlib import Path

import numpy as np

import linkwright as lw

SWINGS = np.radians([30, 45, 60, 75, 90, 105, 120, 135, 150])


def rotators(machine: lw.Machine) -> list:
    """The rotator for each swing; lengths follow from it."""
    return [lw.rod_rotator(lw.replace(machine, {"rod_rotator.swing": float(swing)})) for swing in SWINGS]


def study(machine: lw.Machine) -> dict[str, float]:
    """Turns in a day with the swing of the file, against the swing in revolutions; force in the link."""
    found = lw.rod_rotator(machine)
    strokes = machine.drive.speed / (2 * np.pi) * 86400
    by_swing = found.lever_swing / (2 * np.pi) / machine.rod_rotator.worm_ratio * strokes
    return {
        "turns_per_day_over_closed_form": found.string_turns_per_day / by_swing,
        "turns_per_day": found.string_turns_per_day,
        "lever_length": found.lever_length,
        "link_force_max": found.link_force_max,
    }


def figure(machine: lw.Machine):
    """Force in the link, and revolutions of the string in a day, over the swing."""
    from matplotlib.figure import Figure

    found = rotators(machine)
    drawing = Figure(figsize=(7, 4.5), layout="constrained")
    turns, force = drawing.subplots(2, sharex=True)
    turns.plot(np.degrees(SWINGS), [each.string_turns_per_day for each in found], "o-")
    turns.set(ylabel="revolutions of the string in a day")
    force.plot(np.degrees(SWINGS), [each.link_force_max for each in found], "o-")
    force.set(xlabel="swing of the lever [°]", ylabel="force in the link [N]", ylim=(0, None))
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:32} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
