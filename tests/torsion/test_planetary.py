"""Planetary stages and gears on an elastic seat: Willis, Lin and Parker, and Lagrange's equations."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

import linkwright as lw
from linkwright import MachineError, forced_vibration, free_vibration
from linkwright.torsion.study import torsion_study

SUN, RING = 24, 84
TEETH = {"teeth": [SUN, RING], "planet_inertia": 0.002, "sun_stiffness": 4e5, "ring_stiffness": 5e6}


def machine(**train: Any) -> lw.Machine:
    return lw.Machine.model_validate({"format": 1, "name": "planetary", "train": train})


def stage(sun: str = "sun", ring: str = "ring", carrier: str = "carrier", **entries: Any) -> dict[str, Any]:
    return {"stage": {"sun": sun, "ring": ring, "carrier": carrier, **TEETH, **entries}}


def discs(**inertia: float) -> dict[str, Any]:
    return {name: {"inertia": J} for name, J in inertia.items()}


def held(name: str, stiffness: float = 1e6) -> dict[str, Any]:
    return {"seat": {"between": [name, "ground"], "stiffness": stiffness}}


@pytest.mark.parametrize(
    ("first", "shaft", "entries", "other", "ratio"),
    [
        # Willis: (ω_s − ω_c)/(ω_r − ω_c) = −z_r/z_s.
        ("sun", held("ring"), {}, "carrier", 1 / (1 + RING / SUN)),
        ("sun", held("carrier"), {}, "ring", SUN / RING),
        ("ring", held("sun"), {}, "carrier", RING / (SUN + RING)),
        ("sun", {}, {"carrier_speed": 0.5}, "ring", 0.5 * (1 + SUN / RING) - SUN / RING),
        ("sun", {}, {"carrier_speed": -0.4}, "ring", 0.4 * (1 + SUN / RING) + SUN / RING),
    ],
)
def test_speeds_are_those_of_willis(
    first: str, shaft: dict[str, Any], entries: dict[str, Any], other: str, ratio: float
) -> None:
    """A held member, or the speed of the carrier of a stage with two inputs, sets all ratios."""
    names = [first, *(name for name in ("sun", "ring", "carrier") if name != first)]
    train = lw.scheme(
        machine(discs=discs(**dict.fromkeys(names, 1.0)), shafts=shaft, planetaries=stage(**entries))
    )
    turning = dict(zip(train.discs, train.speed.tolist(), strict=True))
    assert turning[other] == pytest.approx(ratio, rel=1e-14)
    assert turning[first] == 1


def test_members_held_without_a_disc() -> None:
    """A ring that is the ground itself is the limit of a ring on a stiff seat."""
    J = {"sun": 0.01, "carrier": 0.5}
    stiff = machine(discs=discs(**J, ring=1.0), shafts=held("ring", 1e14), planetaries=stage())
    ground = machine(discs=discs(**J), planetaries=stage(ring="ground"))
    found, limit = free_vibration(stiff), free_vibration(ground)
    n = len(limit.natural_frequencies)
    assert found.natural_frequencies[:n] == pytest.approx(limit.natural_frequencies, rel=1e-6, abs=1e-6)


def test_two_stages_that_set_their_speeds_together() -> None:
    """Stages that share ring with carrier and carrier with ring are solved as one system, with a held sun."""
    first = {"sun": "a", "ring": "r", "carrier": "c", **TEETH}
    second = {"sun": "b", "ring": "c", "carrier": "r", **TEETH, "teeth": [20, 70]}
    train = lw.scheme(
        machine(
            discs=discs(a=1.0, r=1.0, c=1.0, b=1.0),
            shafts=held("b"),
            planetaries={"one": first, "two": second},
        )
    )
    ratio, other = -RING / SUN, -70 / 20
    # ω_a − ω_c = i (ω_r − ω_c); ω_b − ω_r = j (ω_c − ω_r), with ω_a = 1 and ω_b = 0.
    speeds = np.linalg.solve([[ratio, 1 - ratio], [1 - other, other]], [1.0, 0.0])
    turning = dict(zip(train.discs, train.speed.tolist(), strict=True))
    assert [turning["r"], turning["c"]] == pytest.approx(np.abs(speeds).tolist(), rel=1e-12)


# Lin and Parker 1999, Table 1, the helicopter OH-58: J/r² and masses [kg], radii [mm], stiffnesses [N/m].
OH58 = {"sun": 0.39, "ring": 3.0, "carrier": 6.29, "planet": 0.61}
MASS, ANGLE, MESH, BEARING, RING_SEAT = 0.66, math.radians(24.6), 5e8, 1e8, 1e9
# Table 2, four planets: the distinct frequencies of rotational modes [Hz].
PUBLISHED = [0.0, 1536.6, 1970.6, 2625.7, 7773.6, 13071.1]


def rotational_frequencies(bearing: float, inertia: dict[str, float], arm: float, planets: int = 4) -> Any:
    """Rotational modes by Lin and Parker's equations: u of carrier, ring, sun, then ξ, η, u of planets.

    Frequencies [Hz]. `arm`: radius of the carrier over that of the circle on which η is counted.
    """
    N, (s, c) = planets, (math.sin(ANGLE), math.cos(ANGLE))
    masses = np.diag(
        [
            inertia["carrier"],
            inertia["ring"],
            inertia["sun"],
            *(N * m for m in (MASS, MASS, inertia["planet"])),
        ]
    )
    twists = [
        (N * MESH, [0, 0, 1, -s, -c, 1]),
        (N * MESH, [0, 1, 0, s, -c, -1]),
        (N * bearing, [0, 0, 0, 1, 0, 0]),
        (N * bearing, [arm, 0, 0, 0, -1, 0]),
        (RING_SEAT, [0, 1, 0, 0, 0, 0]),
    ]
    stiffness = sum(k * np.outer(w, w) for k, w in twists)
    return np.sqrt(np.maximum(eigh(stiffness, masses, eigvals_only=True), 0.0)) / (2 * math.pi)


def test_equations_of_lin_and_parker_give_their_printed_frequencies() -> None:
    """The equations by which the next test judges give the frequencies of the paper."""
    assert rotational_frequencies(BEARING, OH58, 1.0) == pytest.approx(PUBLISHED, abs=0.1)


def test_rotational_modes_are_those_of_lin_and_parker() -> None:
    """With stiff bearings the planets turn with the carrier: the frequencies of their equations are those."""
    sun, ring = 0.03871, 0.13871
    planet, arm = (ring - sun) / 2, (ring + sun) / 2
    stiff = rotational_frequencies(1e15, OH58, 1.0)[:4]
    # u_c = r_c θ_c, and η = u_c counts by cos α in the meshes, as the base circles of the train have it.
    base = {"sun": sun, "ring": ring}
    J = {name: OH58[name] * r**2 for name, r in base.items()}
    carrier = (OH58["carrier"] + 4 * MASS) * (arm / math.cos(ANGLE)) ** 2
    free = free_vibration(
        machine(
            discs=discs(sun=J["sun"], ring=J["ring"], carrier=carrier),
            shafts={"seat": {"between": ["ring", "ground"], "stiffness": RING_SEAT * ring**2}},
            planetaries=stage(
                teeth=[sun, ring],
                planets=4,
                planet_inertia=OH58["planet"] * planet**2,
                sun_stiffness=MESH * sun**2,
                ring_stiffness=MESH * ring**2,
            ),
        )
    )
    still = np.abs(free.mode_shapes[:, [free.discs.index(name) for name in ("sun", "ring", "carrier")]])
    rotational = free.natural_frequencies[still.max(axis=1) > 1e-6]
    assert rotational == pytest.approx(stiff, rel=1e-6, abs=0.02)
    # The others are N − 1 equal ones: planets against each other, all else at rest.
    others = free.natural_frequencies[still.max(axis=1) <= 1e-6]
    omega = math.sqrt(2 * MESH / OH58["planet"]) / (2 * math.pi)
    assert others == pytest.approx([omega] * 3, rel=1e-12)


def seated(seat: float = 3e4, **run: Any) -> lw.Machine:
    """A gear stage in a housing on an elastic seat, between a motor and a fan."""
    return machine(
        discs=discs(motor=0.4, pinion=0.01, wheel=0.09, fan=2.0, housing=0.8),
        shafts={
            "fast": {"between": ["motor", "pinion"], "stiffness": 3e4, "damping": 2.0},
            "slow": {"between": ["wheel", "fan"], "stiffness": 8e4, "damping": 5.0},
        },
        couplings={"seat": {"between": ["housing", "ground"], "stiffness": seat, "damping": 4.0}},
        gears={
            "mesh": {
                "between": ["pinion", "wheel"],
                "ratio": 3.0,
                "carrier": "housing",
                "stiffness": 5e4,
                "damping": 1.0,
            }
        },
        loads={"air": {"on": "fan", "torque": 600.0, "speed": 50.0}},
        excitations={"blades": {"on": "fan", "harmonics": [{"order": 6.0, "torque": 70.0, "phase": 0.4}]}},
        run={"speed_min": 60.0, "speed_max": 150.0, "points": 7, **run},
    )


def test_housing_takes_the_torque_reaction() -> None:
    """The seat of an external stage carries input and output torque together; all of it against Lagrange."""
    forced = forced_vibration(seated())
    J = np.diag([0.4, 0.01, 0.09, 2.0, 0.8])
    # The wheel turns against the pinion: signed angles, Δ = (a − h) + 3 (b − h).
    twists = [
        (3e4, 2.0, [1, -1, 0, 0, 0]),
        (8e4, 5.0, [0, 0, 1, -1, 0]),
        (5e4, 1.0, [0, 1, 3, 0, -4]),
        (3e4, 4.0, [0, 0, 0, 0, 1]),
    ]
    K, C = (sum(row[n] * np.outer(row[2], row[2]) for row in twists) for n in (0, 1))
    for n, speed in enumerate(forced.speeds.tolist()):
        omega, fan = 2.0 * speed, speed / 3
        slope = 2 * 600.0 * fan / 50.0**2
        damping = C + np.diag([0, 0, 0, slope, 0])
        torque = np.array([0, 0, 0, -70.0 * np.exp(0.4j), 0])
        theta = np.linalg.solve(K - omega**2 * J + 1j * omega * damping, torque)
        own = theta * np.array([1, 1, -1, -1, 1])
        assert forced.amplitudes[0, :, n] == pytest.approx(own, rel=1e-9)
        mean = 600.0 * (fan / 50.0) ** 2
        seat = forced.shafts.index("seat")
        assert forced.mean_torques[seat, n] == pytest.approx(mean + mean / 3, rel=1e-12)
        assert forced.shaft_torques[0, seat, n] == pytest.approx((3e4 + 4.0j * omega) * theta[4], rel=1e-9)
    heat = forced.shaft_heat.sum(axis=0) + forced.disc_heat.sum(axis=0)
    assert forced.power == pytest.approx(heat, rel=1e-9)


def test_stiff_seat_is_a_stage_on_fixed_bearings() -> None:
    """As the seat grows stiff, the frequencies become those of the same stage without a carrier."""
    entries = seated(1e13).model_dump(exclude_unset=True)
    fixed = {**entries["train"], "couplings": {}}
    fixed["gears"] = {"mesh": {k: v for k, v in entries["train"]["gears"]["mesh"].items() if k != "carrier"}}
    fixed["discs"] = {k: v for k, v in entries["train"]["discs"].items() if k != "housing"}
    limit = free_vibration(machine(**fixed)).natural_frequencies
    found = free_vibration(seated(1e13)).natural_frequencies[: len(limit)]
    assert found == pytest.approx(limit, rel=1e-7, abs=1e-6)


def test_torques_of_a_planetary_stage_balance() -> None:
    """Mean torques of sun, ring and carrier go as Willis has it, and the study with all tables is made."""
    study = torsion_study(
        machine(
            discs=discs(motor=1.0, sun=0.01, ring=0.3, carrier=0.5, mill=4.0),
            shafts={
                **held("ring"),
                "input": {"between": ["motor", "sun"], "stiffness": 4e4, "loss_factor": 0.02},
                "output": {"between": ["carrier", "mill"], "stiffness": 2e5},
            },
            planetaries=stage(loss_factor=0.01),
            loads={
                "mill": {
                    "on": "mill",
                    "torque": 450.0,
                    "speed": 30.0,
                    "exponent": 0.0,
                    "harmonics": [{"order": 3, "share": 0.1}],
                }
            },
            run={"speed_min": 50.0, "speed_max": 150.0, "points": 9},
        )
    )
    assert study.forced is not None
    mean = dict(zip(study.forced.shafts, study.forced.mean_torques[:, 0].tolist(), strict=True))
    assert mean["output"] == pytest.approx(450.0, rel=1e-12)
    assert mean["input"] == pytest.approx(450.0 * SUN / (SUN + RING), rel=1e-12)
    assert mean["seat"] == pytest.approx(-450.0 * RING / (SUN + RING), rel=1e-12)
    assert mean["stage_sun_2"] == pytest.approx(mean["input"] / 3, rel=1e-9)
    assert study.meshes is not None
    assert study.meshes.mean[0, 0] == pytest.approx(mean["stage_sun_1"], rel=1e-12)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"planetaries": stage()}, "no speed of ring, carrier"),
        ({"planetaries": stage(carrier="arm")}, "the name of a disc"),
        ({"planetaries": stage(ring="sun"), "shafts": held("ring")}, "another disc than the sun"),
        ({"planetaries": stage(sun="ground", ring="ground")}, "two held members"),
        ({"planetaries": stage(teeth=[84, 24]), "shafts": held("ring")}, "more teeth of the ring"),
        (
            {
                "planetaries": stage(),
                "shafts": held("ring"),
                "excitations": {"e": {"on": "ring", "harmonics": [{"order": 2.0, "torque": 1.0}]}},
            },
            "a disc that turns with the train",
        ),
        (
            {"gears": {"g": {"between": ["sun", "ring"], "ratio": 2.0, "carrier": "carrier"}}},
            "an elastic mesh",
        ),
        (
            {
                "gears": {
                    "g": {
                        "between": ["sun", "ring"],
                        "ratio": 2.0,
                        "carrier": "carrier",
                        "stiffness": 1e5,
                        "efficiency": 0.9,
                    }
                }
            },
            "none with a carrier",
        ),
    ],
)
def test_what_is_wrong_is_told(change: dict[str, Any], words: str) -> None:
    """Members without a disc, an open speed, torques on a disc at rest, losses on a carrier."""
    with pytest.raises((MachineError, lw.InputError), match=words):
        torsion_study(machine(discs=discs(sun=1.0, ring=1.0, carrier=1.0), **change))
