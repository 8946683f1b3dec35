"""Quantities over a cycle do not depend on where the crank's angle is counted from, nor rows on each other.

A linkage with change points repeats after two revolutions, gears at a fraction of the speed after several, a
four-stroke load after two. The machine counted from another zero of the crank is the same machine: its crank
has another phase, its dyads the side on which they are there, its loads over the angle are shifted.
"""

import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke
from sizes import cases, generator

import linkwright as lw
from linkwright import Machine, SteadyStateError

FOUND = Path(__file__).parents[1] / "found"

# Extremes and integrals over a cycle are found to 1e-9 and better from any zero.
RTOL = 1e-8


def found(name: str) -> Machine:
    return lw.read(FOUND / f"{name}.toml")


def other_zero() -> Machine:
    """The tangent rod from 200°: what was ahead of its pin is then behind."""
    entries = ["mechanism.cranks.B.phase=200 deg", "mechanism.sliders.C.assembly=negative"]
    return lw.read(FOUND / "tangent_rod.toml", entries)


DRIVE = {
    "motor": {"kind": "dc", "speed_no_load": 40.0, "torque_stall": 900.0, "inertia": 0.3},
    "gearbox": {"ratio": 4.0},
    "flywheel": {"inertia": 12.0},
}


def square_rod(rng: np.random.Generator, zero: float) -> Machine:
    """A slider-crank whose rod is the sum of crank and offset: it passes one change point a revolution."""
    r, offset = rng.uniform(0.05, 0.2), rng.uniform(0.1, 0.3)
    angle = np.radians(90)
    # Just after the change point at 90° the slider goes on to the other side of its pin, for a revolution.
    side = "positive" if zero < angle else "negative"
    return Machine.model_validate(
        {
            "format": 1,
            "name": "square rod",
            "mechanism": {
                "points": {"G": {"y": -offset}},
                "cranks": {"B": {"radius": r, "phase": zero}},
                "sliders": {"C": {"crank": "B", "rod": r + offset, "through": "G", "assembly": side}},
            },
            "bodies": {"C": {"mass": rng.uniform(20, 60)}, "C.rod": {"mass": rng.uniform(2, 8)}},
            "loads": {
                "v": {"kind": "viscous", "on": "C", "damping": rng.uniform(300, 900)},
                "s": {
                    "kind": "spring",
                    "between": ["C", "O"],
                    "stiffness": rng.uniform(500, 3000),
                    "free_length": 0.15,
                },
                "g": {"kind": "gravity"},
            },
            "drive": DRIVE,
        }
    )


def slow_gear(rng: np.random.Generator, zero: float) -> Machine:
    """An eccentric mass with a formula's load on a gear at a fraction of the crank's speed."""
    size = float(rng.choice([30, 40, 50, 60]))
    return Machine.model_validate(
        {
            "format": 1,
            "name": "slow gear",
            "mechanism": {
                "points": {"P": {"x": 1.0}},
                "cranks": {"A": {"radius": 0.1, "phase": zero}},
                "gears": {"G": {"pivot": "P", "meshes": "A", "size": size, "size_other": 20.0}},
                "sliders": {"S": {"crank": "K", "rod": 0.9, "through": "P", "angle": 0.3}},
                "rigid_points": {"K": {"link": "G", "along": rng.uniform(0.1, 0.3)}},
            },
            "bodies": {"K": {"mass": rng.uniform(5, 20)}, "S": {"mass": rng.uniform(5, 30)}},
            "loads": {
                "w": {"kind": "gravity"},
                "f": {"kind": "formula", "on": "S", "force": f"-{rng.uniform(1, 20):.3f}*v*abs(v)"},
                "d": {"kind": "dry", "on": "S", "force": rng.uniform(1, 20)},
            },
            "drive": DRIVE,
        }
    )


def four_stroke(rng: np.random.Generator, zero: float) -> Machine:
    angles = np.radians([0, 40, 180, 360, 540, 700])
    forces = rng.uniform(-3000, 3000, len(angles))
    shifted = np.mod(angles - zero, 4 * np.pi)
    order = np.argsort(shifted)
    return Machine.model_validate(
        {
            "format": 1,
            "name": "four-stroke",
            "mechanism": {
                "cranks": {"A": {"radius": 0.05, "phase": zero}},
                "sliders": {"S": {"crank": "A", "rod": rng.uniform(0.15, 0.3)}},
            },
            "bodies": {"S": {"mass": rng.uniform(1, 5)}, "S.rod": {"mass": 1.0}},
            "loads": {
                "gas": {
                    "kind": "force_angle",
                    "on": "S",
                    "angle": shifted[order].tolist(),
                    "force": forces[order].tolist(),
                    "cycle": 4 * np.pi,
                },
                "v": {"kind": "viscous", "on": "S", "damping": 300.0},
            },
            "drive": DRIVE,
        }
    )


FAMILIES = (square_rod, slow_gear, four_stroke)


def numbers(machine: Machine) -> dict[str, float]:
    reduced, limit, steady = lw.reduction(machine), lw.constant_energy(machine), lw.steady_state(machine)
    names = ("inertia_min", "inertia_max", "torque_load_mean", "torque_load_max", "viscous_mean")
    result = {f"reduction {name}": getattr(reduced, name) for name in names}
    result |= {f"limit {name}": getattr(limit, name) for name in ("unevenness", "dynamism")}
    names = ("speed_min", "speed_max", "acceleration_min", "acceleration_max", "period", "energy_motor")
    result |= {f"steady {name}": getattr(steady, name) for name in names}
    return result


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("seed", range(cases(3, 40)))
def test_another_zero_of_the_crank_gives_the_same_numbers(
    family: Callable[[np.random.Generator, float], Machine], seed: int
) -> None:
    zero = float(generator(seed + 1000).uniform(0.2, 6.0))
    first = numbers(family(generator(seed), 0.0))
    second = numbers(family(generator(seed), zero))
    size = max(abs(value) for name, value in first.items() if "torque" in name)
    for name, value in first.items():
        # A mean torque may vanish beside its peak.
        assert second[name] == pytest.approx(value, rel=RTOL, abs=1e-9 * size), name


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("seed", range(cases(2, 20)))
def test_forces_and_counterweights_do_not_depend_on_the_zero(
    family: Callable[[np.random.Generator, float], Machine], seed: int
) -> None:
    # Whole degrees, so that both are asked for at the same poses.
    zero = float(np.radians(generator(seed + 1000).integers(20, 340)))
    first, second = (family(generator(seed), at) for at in (0.0, zero))
    peaks = []
    for machine in (first, second):
        result = lw.forces(machine, speed=9.0)
        extents = lw.envelope(result)
        # Of two peaks of one size rounding chooses the sign.
        peaks.append({extent.name: (abs(extent.peak), extent.rms, extent.mean) for extent in extents})
        weights = lw.balance(machine, [next(iter(machine.mechanism.cranks))], speed=9.0).counterweights
        peaks[-1]["counterweight"] = (weights[0].moment, math.cos(weights[0].angle), 0.0)
    for name, values in peaks[0].items():
        # Beside a change point forces grow without limit, and rounding with them.
        assert peaks[1][name] == pytest.approx(values, rel=1e-7, abs=1e-9 * values[0]), name


def test_weight_on_a_wheel_at_half_the_speed_does_no_work() -> None:
    reduced = lw.reduction(found("half_speed_wheel"))
    assert reduced.torque_load_mean == 0
    assert reduced.crank_angle[-1] == pytest.approx(4 * np.pi)


def test_kite_repeats_after_two_revolutions() -> None:
    # Friction alone: 4 strokes of 6.9282 m less... the slider's way in a cycle times 100 N over 4π.
    reduced = lw.reduction(found("kite"))
    assert reduced.torque_load_mean == pytest.approx(2 * 6.9282032 * 100 / (4 * np.pi), rel=1e-6)


def test_constant_energy_without_inertia_at_dead_centres_says_so() -> None:
    with pytest.raises(SteadyStateError, match=r"reduced inertia falls to zero at a crank angle of 210°"):
        lw.constant_energy(found("kite"))


def test_tangent_rod_from_two_zeros() -> None:
    machine = found("tangent_rod")
    first, second = lw.reduction(machine), lw.reduction(other_zero())
    assert (first.torque_load_mean, second.torque_load_mean) == (0, 0)
    assert first.inertia_max == pytest.approx(21.577, abs=1e-3)
    assert second.inertia_max == pytest.approx(first.inertia_max, rel=RTOL)
    assert second.viscous_mean == pytest.approx(first.viscous_mean, rel=RTOL)
    assert first.viscous_mean == pytest.approx(14.864, abs=1e-3)
    weights = [
        lw.balance(each, ["B"], speed=9.0, radius=0.1).counterweights[0] for each in (machine, other_zero())
    ]
    # Of forces that are bounded at change points.
    assert weights[1].mass == pytest.approx(weights[0].mass, rel=1e-6)
    assert weights[1].angle == pytest.approx(weights[0].angle)


def test_forces_over_steady_motion_cover_the_cycle_of_the_forces() -> None:
    # A wheel at half the speed without masses: the crank feels the same every revolution.
    machine = slow_gear(np.random.default_rng(1), 0.0)
    entries = {"loads": {}, "bodies": {}}
    geared = lw.replace(machine.with_entries(entries), {"mechanism.gears.G.size": 40.0})
    sliders = geared.mechanism.model_copy(update={"sliders": {}})
    bare = geared.with_entries({"mechanism": sliders})
    assert lw.steady_state(bare).turns == 1
    assert lw.forces(bare).crank_angle[-1] == pytest.approx(4 * np.pi)
    assert lw.forces(bare).motion.time[-1] == pytest.approx(2 * lw.steady_state(bare).period)


def test_rows_of_a_batch_have_their_own_cycle() -> None:
    machine, teeth = found("batch_teeth"), np.array([20.0, 40, 30, 10, 25, 22, 41])
    address = "mechanism.gears.G.size_other"
    rows = lw.steady_states(machine, {address: teeth})
    assert (rows.status == 0).all()
    for k, z in enumerate(teeth):
        alone = lw.steady_state(lw.replace(machine, {address: z}))
        assert rows.turns[k] == alone.turns
        for name in ("speed_min", "speed_max", "period", "energy_motor", "unevenness", "speed_mean_time"):
            # A batch promises 1e-7.
            assert getattr(rows, name)[k] == pytest.approx(getattr(alone, name), rel=1e-7), (name, z)


def test_rows_that_never_repeat_have_no_numbers() -> None:
    rows = lw.steady_states(found("batch_teeth"), {"mechanism.gears.G.size_other": np.array([20.0, 19.3])})
    assert rows.status[0] == 0
    assert rows.status[1] != 0
    assert np.isnan(rows.speed_max[1])


def test_a_mass_that_is_zero_in_the_first_row_does_not_decide_the_cycle() -> None:
    machine = lw.replace(found("batch_teeth"), {"mechanism.gears.G.size_other": 30.0})
    masses = np.array([0.0, 40.0])
    rows = lw.steady_states(machine, {"bodies.K.mass": masses})
    alone = lw.steady_state(machine)
    assert rows.turns.tolist() == [1, 2]
    assert rows.speed_max[1] == pytest.approx(alone.speed_max, rel=1e-7)


# A nut that moves on from revolution to revolution, against a spring.
NEVER = """
format = 1
name = "nut against a spring"
mechanism.cranks.A = { radius = 0.1 }
mechanism.sliders.S = { crank = "A", rod = 0.4 }
mechanism.points.P = { y = 1.0 }
mechanism.linear_drivers.N = { per_turn = 0.01 }
bodies.S = { mass = 2.0 }
bodies.N = { mass = 1.0 }
loads.s = { kind = "spring", between = ["N", "P"], stiffness = 300.0, free_length = 0.2 }
"""


def test_masses_and_loads_that_never_repeat_are_told(tmp_path: Path) -> None:
    """Without a motor numbers are those of the first revolution, and it is said; with one, a finding."""
    machine = lw.loads(NEVER)
    words = "Masses and loads do not repeat within 24 revolutions of the crank, and never do"
    (told,) = [text for text in lw.study(machine).warnings if text.startswith(words)]
    assert "are those of the first revolution" in told
    assert "choose the slowest part as the crank" in told
    assert not lw.study(lw.replace(machine, {"loads.s.stiffness": 0.0})).findings
    path = tmp_path / "never.toml"
    path.write_text(NEVER, encoding="utf-8")
    result = invoke("forces", path, "--speed", "3 rad/s", "--json")
    assert told in json.loads(result.stdout)["warnings"]
    driven = lw.loads(NEVER + 'drive.motor = { kind = "dc", speed_no_load = 30, torque_stall = 60 }\n')
    (finding,) = [text for text in lw.study(driven).findings if text.startswith(words)]
    assert "never do" in finding
