"""Which motion law asks least of the follower: of its force, of its jerk, of the torque of the shaft?

Factors after VDI 2143; the bounds 4 and 32 hold for every law between two dwells.
"""

from pathlib import Path

import linkwright as lw
from linkwright.cam.laws.catalogue import LAWS
from linkwright.cam.model.motion_section import programme

# Laws without a jump of the acceleration, which a quick cam needs.
SOFT = [name for name, law in lw.cam_laws().items() if law.C_j is not None]


def study(machine: lw.Machine) -> dict[str, float]:
    """Peaks of the file's law in newtons, and how much less the best laws ask."""
    cam = machine.mechanism.cams["slide"]
    rise, speed = cam.sections[0], machine.drive.speed
    factors = lw.cam_laws()
    own, best = factors[rise.law.kind], {}
    for name in ("C_a", "C_j", "C_M"):
        best[name] = min(SOFT, key=lambda law: getattr(factors[law], name))
    peak = programme(cam.sections).law.peak(2).value * speed**2
    mass = machine.bodies["slide"].mass
    return {
        "force_max": mass * abs(peak),
        "force_by_factor": mass * own.C_a * rise.lift / rise.angle**2 * speed**2,
        "force_of_the_best_over_this": factors[best["C_a"]].C_a / own.C_a,
        "jerk_of_the_best_over_this": factors[best["C_j"]].C_j / own.C_j,
        "torque_of_the_best_over_this": factors[best["C_M"]].C_M / own.C_M,
        "jerk_above_the_bound": factors[best["C_j"]].C_j - 32.0,
    }


def figure(machine: lw.Machine):
    """The law of the file beside the three that are best in something."""
    from linkwright.cam.figures.cam import motion_laws_figure

    names = [machine.mechanism.cams["slide"].sections[0].law.kind, "modified_trapezoid", "minimum_jerk"]
    return motion_laws_figure({name: LAWS[name].normalised() for name in names})


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:32} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
