"""Does the motor start the machine, and when is it up to speed?

Source: the worked case of paper 1; the catalogue's starting torque against Kloss's formula alone.
"""

from pathlib import Path

import linkwright as lw


def study(machine: lw.Machine) -> dict[str, float]:
    """Run-up by the catalogue curve; and what Kloss alone would give at rest."""
    result = lw.run_up(machine)
    # Kloss at slip 1 with the motor's breakdown slip gives 39.8 N m: a third of the catalogue's torque.
    weak = lw.replace(machine, {"drive.motor.torque_start": 39.8})
    try:
        lw.run_up(weak)
        starts = 1.0
    except lw.StartError as reason:
        print(reason)
        starts = 0.0
    return {"turns": result.turns, "time": result.time, "starts_by_kloss_alone": starts}


def figure(machine: lw.Machine):
    """Speed over time and over turns."""
    from linkwright.drive.figures import run_up_figure

    steady = lw.steady_state(machine)
    return run_up_figure(lw.run_up(machine, steady=steady), steady)


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
