"""Where does a press stop that a controller in another tool switches off and brakes before the top?

On the command line: linkwright fmu machine.toml --out press.fmu. The other tool is fmpy (pip install fmpy).
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy
import numpy as np

import linkwright as lw

STEP = 1e-3  # the controller looks once a millisecond
OFF = np.radians(300)  # crank angle after the top from which on it brakes


def course(machine: lw.Machine, top: float) -> np.ndarray:
    """Time, crank angle and speed from the start at the top until the press stands again, a row each."""
    unit = lw.fmu(machine, angle=top)
    number = {variable.name: [variable.reference] for variable in unit.variables}
    with TemporaryDirectory() as folder:
        unit.write(Path(folder) / "press.fmu")
        fmpy.extract(Path(folder) / "press.fmu", folder)
        press = fmpy.instantiate_fmu(folder, fmpy.read_model_description(folder), "CoSimulation")
        press.setupExperiment(tolerance=1e-10)
        press.enterInitializationMode()
        press.exitInitializationMode()
        rows = [(0.0, top, 0.0)]
        while rows[-1][2] > 0 or len(rows) == 1:
            if rows[-1][1] - top > OFF:
                press.setBoolean(number["motor_on"], [False])
                press.setReal(number["brake_torque"], [machine.drive.brake.torque])
            press.doStep(rows[-1][0], STEP)
            rows.append((len(rows) * STEP, *press.getReal(number["crank_angle"] + number["crank_speed"])))
        press.freeInstance()
    return np.array(rows)


def study(machine: lw.Machine) -> dict[str, float]:
    """Angle at rest after the top, and its difference to `transient` from the instant of the switch on."""
    top = lw.zero_angle(machine, "top").angle
    rows = course(machine, top)
    _, angle, speed = next(row for row in rows if row[1] - top > OFF)
    rest = lw.transient(machine, angle=angle, speed=speed, motor=False, brake=True, turns=2.0, accuracy=1e-10)
    stands = np.degrees(rows[-1, 1] - top)
    return {"angle_at_rest": stands, "difference": stands - np.degrees(rest.crank_angle[-1] - top)}


def figure(machine: lw.Machine):
    """Crank angle and speed over time."""
    return lw.transient(machine, angle=lw.zero_angle(machine, "top").angle, turns=1.0).plot()


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
