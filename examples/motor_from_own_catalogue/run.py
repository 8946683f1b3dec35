"""Which motor of the store drives a shaper: induction, DC or servo?

On the command line, in the folder of the example:
linkwright size machine.toml --catalogue motors.csv
"""

from pathlib import Path

import linkwright as lw

HERE = Path(__file__).parent


def choice(machine: lw.Machine):
    """The motors of the file, judged each by the checks of its kind."""
    return lw.choose_motor(machine, catalogue=lw.read_motors(HERE / "motors.csv"))


def study(machine: lw.Machine) -> dict[str, float]:
    """Required power, rated power of the chosen motor, and its highest torque over what it may give."""
    chosen = choice(machine)
    (peak,) = (check for check in chosen.chosen.checks if check.name == "torque_peak")
    return {
        "power_required": chosen.required.power,
        "power_of_the_chosen": chosen.chosen.known.power_rated,
        "motors_that_pass": float(sum(candidate.passes for candidate in chosen.candidates)),
        "limit_of_the_peak": peak.limit,
    }


def figure(machine: lw.Machine):
    """Torque and power with the chosen motor."""
    from linkwright.drive.figures import torque_figure

    return torque_figure(choice(machine).chosen.steady)


if __name__ == "__main__":
    example = lw.read(HERE / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(HERE / "figure.png", dpi=120)
    print(f"{HERE / 'figure.png'}")
