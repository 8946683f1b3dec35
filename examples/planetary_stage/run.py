"""At which frequencies does the planetary stage of a helicopter vibrate, and what do its teeth carry?

Lin and Parker, J. Vib. Acoust. 121 (1999): with N planets there are N − 1 equal modes in which sun, ring and
carrier rest. Their first mode has 1536.6 Hz on elastic planet bearings; here the planets turn on stiff ones.
"""

from pathlib import Path

import numpy as np

import linkwright as lw

MEMBERS = ("sun", "ring", "carrier")


def study(machine: lw.Machine) -> dict[str, float]:
    """Modes of the members, those of the planets alone, and what the teeth of the sun carry."""
    free, forced = lw.free_vibration(machine), lw.forced_vibration(machine)
    members = np.abs(free.mode_shapes[:, [free.discs.index(name) for name in MEMBERS]]).max(axis=1)
    rotational, planets = (free.natural_frequencies[rows] for rows in (members > 1e-6, members <= 1e-6))
    mesh = forced.shafts.index("stage_sun_1")
    service = int(np.abs(forced.speeds - machine.train.run.service).argmin())
    return {
        "rigid_hz": float(rotational[0]),
        **{f"rotational_{n}_hz": float(f) for n, f in enumerate(rotational[1:], start=1)},
        "planets_hz": float(planets.mean()),
        "planet_modes": len(planets),
        "planets_apart_hz": float(np.ptp(planets)),
        "speed_ratio": float(1 / lw.scheme(machine).speed[free.discs.index("carrier")]),
        "mesh_torque_nm": float(forced.mean_torques[mesh, service]),
        "mesh_vibratory_nm": float(forced.shaft_torque_vibratory[mesh].max()),
    }


def figure(machine: lw.Machine):
    """The lowest modes: amplitudes of sun, carrier, ring and planets."""
    from linkwright.torsion.figures.modes import modes_figure

    return modes_figure(lw.free_vibration(machine), modes=5)


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:20} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")
