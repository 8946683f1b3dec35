"""Derivatives of motion and forces by the sections and laws of cams on the shaft, of which some jump in the
acceleration, against extrapolated differences of the same analyses.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError
from linkwright.drive import accurate_run_down, accurate_run_up
from linkwright.machine import exchanged

MACHINE = """
format = 1
name = "A follower on a line, against a spring"
[drive.motor]
kind = "dc"
speed_no_load = 12
torque_stall = 900
inertia = 4
[drive.gearbox]
efficiency = EFFICIENCY
[drive.brake]
torque = 60
[mechanism.cams.c]
base_radius = 0.1
roller_radius = 0.02
phase = 0.3
sections = [
  { angle = "100 deg", lift = "40 mm", law = RISE },
  { angle = "40 deg" },
  { angle = "150 deg", lift = "-40 mm", law = RETURN },
  { angle = "70 deg" },
]
[bodies]
c = { mass = 60 }
[loads]
spring = { kind = "spring", between = ["c", "O"], stiffness = 4000, free_length = 0.05 }
dry = { kind = "dry", on = "c", force = 100 }
gravity = { kind = "gravity" }
"""

# By name: laws of rise and return, and whether the acceleration jumps.
LAWS = {
    "constant acceleration": ('"parabolic"', '"parabolic"'),
    "harmonic and trapezoidal": ('"harmonic"', '{ kind = "trapezoidal_velocity", start = 0.25, stop = 0.3 }'),
    "smooth": ('"cycloidal"', '{ kind = "modified_sine", share = 0.17 }'),
    "ramps": ('{ kind = "combined", start = 0.2, ramp = "cycloidal" }', '"minimum_jerk"'),
    "searched limits": ('{ kind = "limited", velocity_max = 0.04, acceleration_max = 0.15 }', '"optimal"'),
}

# Of the largest derivative of a response, or of the response.
TOLERANCE = 1e-7

Measure = Callable[[lw.Machine], dict[str, float]]


def _machine(laws: str, efficiency: float = 0.9) -> lw.Machine:
    rise, back = LAWS[laws]
    text = MACHINE.replace("RISE", rise).replace("RETURN", back)
    return lw.loads(text.replace("EFFICIENCY", str(efficiency)))


def _steady(machine: lw.Machine) -> dict[str, float]:
    state = lw.steady_state(machine, accuracy=1e-13)
    names = ("speed_min", "speed_max", "acceleration_min", "acceleration_max", "period", "torque_motor_rms")
    return {f"steady_state.{name}": getattr(state, name) for name in (*names, "unevenness", "energy_load")}


def _run_up(machine: lw.Machine) -> dict[str, float]:
    up = accurate_run_up(machine, lw.steady_state(machine, accuracy=1e-13), 1e-12)
    return {f"run_up.{name}": getattr(up, name) for name in ("turns", "time", "speed_peak")}


def _run_down(machine: lw.Machine) -> dict[str, float]:
    start = lw.steady_state(machine, accuracy=1e-13, n=8)
    down = accurate_run_down(machine, float(start.speed[0]), 1e-12)
    return {f"run_down.{name}": getattr(down, name) for name in ("turns", "time")}


def _forces(machine: lw.Machine) -> dict[str, float]:
    found = lw.forces(machine, lw.steady_state(machine, accuracy=1e-13), contributions=False)
    reactions = {f"forces.reaction_max.{name}": force for name, force in found.reaction_max.items()}
    largest = {name: getattr(found, name) for name in ("torque_drive_max", "shaking_force_max")}
    return {f"forces.{name}": value for name, value in largest.items()} | reactions


def _ways(machine: lw.Machine, variables: Sequence[str]) -> list[dict[str, float]]:
    """Entries of cams and by how much each goes: sections in pairs, so that angles and lifts still close."""
    of_cams = [name for name in variables if name.startswith("mechanism.cams.") and lw.get(machine, name)]
    sections = [name for name in of_cams if ".sections." in name]
    paired = [[name for name in sections if name.endswith(key)] for key in (".angle", ".lift")]
    alone = [name for name in of_cams if not any(name in pair for pair in paired)]
    ways = [{name: abs(lw.get(machine, name))} for name in alone]
    for pair in paired:
        for one, other in pairwise(pair):
            size = min(abs(lw.get(machine, one)), abs(lw.get(machine, other)))
            ways.append({one: size, other: -size})
    return ways


def difference(machine: lw.Machine, way: dict[str, float], measure: Measure, step: float) -> dict[str, float]:
    """Central differences over h, 2h and 4h along a way, extrapolated to sixth order."""
    here = {name: lw.get(machine, name) for name in way}
    near = {
        n: measure(exchanged(machine, {name: here[name] + n * step * x for name, x in way.items()}))
        for n in (-4, -2, -1, 1, 2, 4)
    }
    once, twice, four = (
        {name: (near[n][name] - near[-n][name]) / (2 * n * step) for name in near[1]} for n in (1, 2, 4)
    )
    return {name: (64 * once[name] - 20 * twice[name] + four[name]) / 45 for name in once}


def errors(
    machine: lw.Machine, measure: Measure, ways: Sequence[dict[str, float]]
) -> dict[tuple[str, str], float]:
    """By response and way: how far its derivative is off a difference that agrees, or the nearer of two."""
    known = measure(machine)
    analysis = next(iter(known)).partition(".")[0]
    found = lw.gradient(machine, [analysis])
    scales = np.maximum(np.nanmax(np.abs(found.derivatives * found.at), axis=1), np.abs(found.values))
    off: dict[tuple[str, str], float] = {}
    rows = [
        (row, name) for row, name in enumerate(found.responses) if name in known and name not in found.ties
    ]
    for way in ways:
        exact = {name: sum(found.of(name)[entry] * x for entry, x in way.items()) for _, name in rows}
        least = dict.fromkeys(exact, np.inf)
        for step in (1e-3, 1e-4):
            rough = difference(machine, way, measure, step)
            least |= {
                name: min(least[name], abs(exact[name] - rough[name]) / scales[row]) for row, name in rows
            }
            if all(size <= TOLERANCE for size in least.values()):
                break
        off |= {(name, ", ".join(way)): size for name, size in least.items()}
    return off


@pytest.mark.parametrize("laws", LAWS)
def test_steady_motion_follows_sections_and_laws(laws: str) -> None:
    machine = _machine(laws)
    off = errors(machine, _steady, _ways(machine, lw.gradient(machine, ["steady_state"]).variables))
    assert len(off) > 60
    assert max(off.values()) <= TOLERANCE, {key: size for key, size in off.items() if size > TOLERANCE}


@pytest.mark.parametrize("laws", ["constant acceleration", "smooth"])
@pytest.mark.parametrize("measure", [_run_up, _run_down, _forces])
def test_motion_in_time_and_forces_follow_sections(laws: str, measure: Measure) -> None:
    machine = _machine(laws, 1.0)
    variables = lw.gradient(machine, [next(iter(measure(machine))).partition(".")[0]]).variables
    ways = [way for way in _ways(machine, variables) if any(".sections." in name for name in way)]
    off = errors(machine, measure, ways)
    assert len(off) >= 8
    assert max(off.values()) <= TOLERANCE, {key: size for key, size in off.items() if size > TOLERANCE}


def test_all_lifts_together_scale_the_work_of_friction() -> None:
    """Friction alone takes work over a revolution, in proportion to force and lift."""
    machine = _machine("constant acceleration", 1.0)
    entries = [f"mechanism.cams.c.sections.{i}.lift" for i in (0, 2)]
    found = lw.gradient(machine, ["steady_state.energy_load"], [*entries, "loads.dry.force"])
    by_lift = found.derivatives[0, 0] * 0.04 - found.derivatives[0, 1] * 0.04
    assert by_lift == pytest.approx(found.derivatives[0, 2] * 100.0, rel=1e-9)


TWO = """
[mechanism.cams.d]
base_radius = 0.1
roller_radius = 0.02
direction = 2.0
phase = 0.3
sections = [
  { angle = "100 deg", lift = "30 mm", law = RISE },
  { angle = "260 deg", lift = "-30 mm", law = RISE },
]
[bodies]
d = { mass = 20 }
"""


@pytest.mark.parametrize("law", ['"parabolic"', '"cycloidal"'])
def test_followers_that_jump_together(law: str) -> None:
    """Of two joints that jump at one angle neither can move alone; smooth ones can, and both together."""
    both = MACHINE.replace("[bodies]\n", TWO).replace("EFFICIENCY", "1.0")
    machine = lw.loads(both.replace("RISE", law).replace("RETURN", law))
    found = lw.gradient(machine, ["steady_state"])
    joints = {f"mechanism.cams.{cam}.sections.{i}.angle" for cam, n in (("c", 4), ("d", 2)) for i in range(n)}
    phases = {f"mechanism.cams.{cam}.phase" for cam in "cd"}
    if law == '"parabolic"':
        assert joints | phases >= set(found.refused) & (joints | phases) >= phases
        with pytest.raises(InputError, match="boundaries of two laws that coincide"):
            lw.gradient(machine, ["steady_state.period"], ["mechanism.cams.d.phase"])
    else:
        assert not found.refused
        way = {"mechanism.cams.c.sections.0.angle": 1.0, "mechanism.cams.c.sections.1.angle": -1.0}
        off = errors(machine, _steady, [way, {"mechanism.cams.d.phase": 0.3}])
        assert off
        assert max(off.values()) <= TOLERANCE
