"""Which masses and lengths of a four-bar linkage decide what its foundation bears?

Exact derivatives of the maximum shaking force and of a joint reaction by every number of the file.
"""

from pathlib import Path

import linkwright as lw

RESPONSE = "forces.shaking_force_max"


def study(machine: lw.Machine) -> dict[str, float]:
    """Shares by which the largest forces change for 1 % more of the masses, and of the speed."""
    found = lw.gradient(machine, ["forces"])
    shares = {
        name: dict(zip(found.variables, row, strict=True))
        for name, row in zip(found.responses, found.elasticities, strict=True)
    }
    shaking = shares[RESPONSE]
    masses = {name: x for name, x in shaking.items() if name.startswith("bodies.")}
    return {
        "shaking_force": float(found.values[found.responses.index(RESPONSE)]),
        "all_masses": sum(x for name, x in masses.items() if "mass" in name or "inertia" in name),
        "speed": shaking["drive.speed"],
        "crank": shaking["mechanism.cranks.A.radius"],
        "largest_mass": max(masses.values()),
    }


def figure(machine: lw.Machine):
    """The entries that matter most, as bars."""
    from linkwright.sensitivity.figures import influence_figure

    return influence_figure(lw.gradient(machine, [RESPONSE]), RESPONSE)


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
