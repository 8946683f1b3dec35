"""Random machines from motor to load: cranks with sliders, rockers and levers, bodies, all kinds of loads.

The sizes spread over decades, the way careless files do: light and heavy cranks, motors with and without
inertia, springs from soft to nearly rigid, gearboxes that tell the directions apart. Every machine is valid;
whether it moves is for the analysis to find.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.random import Generator
from random_parts import log_uniform

import linkwright as lw

Table = dict[str, Any]


def random_drive(random: Generator) -> Table:
    """A machine that closes all round, with a motor that may or may not carry it.

    Inertia, load and steepness of the motor vary over some decades each, together over twelve. Of every other
    machine the loads and the motor are of the size that its inertia, its weight or neither calls for.
    """
    mechanism, carriers, slides = linkage(random)
    r = mechanism["cranks"]["A"]["radius"]
    ratio = float(random.choice([1.0, 3.0, 9.8, 40.0]))
    size, speed = log_uniform(random, 10.0, 3000.0), log_uniform(random, 5.0, 400.0)
    torque = log_uniform(random, 0.5, 3000.0)
    if random.random() < 0.5:
        speed = log_uniform(random, 1.0, 60.0) * ratio
        size = log_uniform(random, 1.0, 1e3) * (1.0 + r * speed / ratio)
        torque = size * r * log_uniform(random, 0.3, 30.0) / ratio
    return {
        "format": 1,
        "name": "Random machine",
        "drive": _drive(random, ratio, torque, speed),
        "mechanism": mechanism,
        "bodies": bodies(random, carriers),
        "loads": _loads(random, slides, r, size),
    }


def linkage(random: Generator) -> tuple[Table, list[str], list[str]]:
    """A crank and one to three elements on it; what can carry a mass, and what can be pushed."""
    r = log_uniform(random, 0.03, 0.6)
    points: Table = {}
    parts: dict[str, Table] = {"cranks": {"A": {"radius": r, "phase": random.uniform(-3.0, 3.0)}}}
    carriers, slides = ["A"], ["A"]
    pins = ["A"]
    if random.random() < 0.3:
        second = {"radius": r * random.uniform(0.5, 1.5), "phase": random.uniform(0.0, 2 * np.pi)}
        parts["cranks"]["A2"] = second
        pins.append("A2")
    for k in range(random.integers(1, 4)):
        kind = ("slider", "slider", "rocker", "lever")[random.integers(4)]
        if kind == "slider":
            name = f"S{k}"
            pin = pins[random.integers(len(pins))]
            reach = parts["cranks"][pin]["radius"]
            rod = reach * random.uniform(1.6, 6.0)
            offset = float(random.choice([0.0, random.uniform(-0.5, 0.5) * reach]))
            angle = float(random.choice([0.0, np.pi / 2, random.uniform(-3.0, 3.0)]))
            slider = {"crank": pin, "rod": rod, "offset": offset, "angle": angle}
            parts.setdefault("sliders", {})[name] = slider
            carriers += [name, f"{name}.rod"]
            slides.append(name)
        elif kind == "rocker":
            name = f"R{k}"
            frame, coupler, rocker = _crank_rocker(random, r)
            way = float(random.choice([0.0, random.uniform(0.0, 2 * np.pi)]))
            points[f"P{k}"] = {"x": frame * np.cos(way), "y": frame * np.sin(way)}
            side = str(random.choice(["left", "right"]))
            four_bar = {"crank": "A", "pivot": f"P{k}", "coupler": coupler, "rocker": rocker}
            parts.setdefault("rockers", {})[name] = {**four_bar, "assembly": side}
            carriers += [name, f"{name}.coupler", f"{name}.rocker"]
            slides.append(name)
        else:
            name = f"L{k}"
            points[f"P{k}"] = {"x": 0.0, "y": -r * random.uniform(1.3, 4.0)}
            lever = {"pin": "A", "pivot": f"P{k}", "length": r * random.uniform(1.0, 5.0)}
            parts.setdefault("slotted_levers", {})[name] = lever
            carriers.append(name)
    return {"points": points, **parts}, carriers, slides


def _crank_rocker(random: Generator, r: float) -> tuple[float, float, float]:
    """Frame, coupler and rocker of a four-bar whose crank rotates fully, by Grashof's condition."""
    while True:
        frame, coupler, rocker = (r * random.uniform(1.3, 6.0) for _ in range(3))
        longest = max(frame, coupler, rocker)
        if r + longest < 0.97 * (frame + coupler + rocker - longest):
            return frame, coupler, rocker


def bodies(random: Generator, carriers: list[str]) -> Table:
    bodies: Table = {
        "A": {
            "mass": log_uniform(random, 0.1, 100.0),
            "inertia": float(random.choice([0.0, log_uniform(random, 1e-3, 30.0)])),
        }
    }
    for name in carriers[1:]:
        if random.random() < 0.6:
            bodies[name] = {"mass": log_uniform(random, 0.1, 300.0)}
    return bodies


def _loads(random: Generator, slides: list[str], r: float, size: float) -> Table:
    """Some loads on what moves; forces are of one size, stiffness and damping of many."""
    loads: Table = {"gravity": {"kind": "gravity"}} if random.random() < 0.5 else {}
    for k in range(random.integers(0, 4)):
        on = slides[random.integers(len(slides))]
        loads[f"l{k}"] = load(random, on, r, size)
    return loads


def load(random: Generator, on: str, r: float, size: float) -> Table:
    kind = str(random.choice(["dry", "viscous", "force", "spring", "formula", "member formula", "fan"]))
    if kind == "dry":
        return {"kind": kind, "on": on, "force": size}
    if kind == "viscous":
        return {"kind": kind, "on": on, "damping": size / log_uniform(random, 0.1, 10.0)}
    if kind == "force":
        return {"kind": kind, "on": on, "force": size, "direction": random.uniform(-3.0, 3.0)}
    if kind == "spring":
        by_size = log_uniform(random, 0.01, 30.0) * size / r
        stiffness = float(random.choice([by_size, log_uniform(random, 1e2, 1e6)]))
        free = float(random.choice([r * random.uniform(0.5, 2.0), random.uniform(0.0, 0.5)]))
        return {"kind": kind, "between": [on, "O"], "stiffness": stiffness, "free_length": free}
    if kind == "formula":
        return {"kind": kind, "on": "A", "torque": f"-{size!r}*(0.3 + sin(phi)^2)*tanh(omega)"}
    if kind == "fan":
        return {"kind": "torque_speed", "speed": [0.0, 20.0, 60.0], "torque": [0.0, 0.2 * size * r, size]}
    constants = {"constants": {"c": 0.3 * size}}
    if on.startswith("S"):
        return {"kind": "formula", "on": on, "force": "-c*tanh(20*v)", **constants}
    return {"kind": "formula", "on": on, "force": "-c*vx", "direction": 0.0, **constants}


def _drive(random: Generator, ratio: float, torque: float, speed: float) -> Table:
    """A motor of any kind, with or without inertia, behind a gearbox."""
    motor = _motor(random, torque, speed)
    inertia = log_uniform(random, 1e-4, 3.0), log_uniform(random, 1e-5, 10.0) * torque / speed
    if random.random() < 0.8:
        motor["inertia"] = inertia[random.integers(2)]
    gearbox: Table = {"ratio": ratio, "efficiency": float(random.choice([1.0, 0.9, 0.7]))}
    if random.random() < 0.3:
        gearbox["reverse"] = ("same", 1.2)[random.integers(2)]
    drive: Table = {"motor": motor, "gearbox": gearbox}
    if random.random() < 0.3:
        drive["flywheel"] = {"inertia": log_uniform(random, 0.01, 300.0)}
    return drive


def _motor(random: Generator, torque: float, speed: float) -> Table:
    kind = str(random.choice(["dc", "induction", "induction", "started", "table"]))
    if kind == "dc":
        return {"kind": "dc", "speed_no_load": speed, "torque_stall": torque}
    if kind == "table":
        speeds, torques = [0.0, 0.4 * speed, 0.8 * speed, 1.2 * speed], [0.8, 1.0, 0.4, -0.8]
        return {"kind": "table", "speed": speeds, "torque": [torque * share for share in torques]}
    motor: Table = {
        "kind": "induction",
        "speed_synchronous": speed,
        "speed_rated": speed * (1.0 - log_uniform(random, 0.005, 0.08)),
        "torque_rated": torque,
        "torque_breakdown": torque * random.uniform(1.8, 3.5),
    }
    return motor | ({"torque_start": torque * random.uniform(1.2, 1.7)} if kind == "started" else {})


def torque_size(state: lw.SteadyState) -> float:
    """Largest torque of a drive and its loads [N m]."""
    return float(np.abs([state.torque_load, state.torque_drive]).max())


def with_jump(random: Generator, drive: Table, speeds: tuple[float, float], size: float) -> Table:
    """A drive with one load more, which jumps at one of its speeds; its torques are of the given size."""
    level = float(random.uniform(*speeds))
    jump = float(size * 10 ** random.uniform(-2.0, 0.3) * random.choice([-1, 1]))
    switch = random.choice(["omega", "omega*(1+0.1*cos(phi))"]) if random.random() < 0.3 else "omega"
    torque = f"-({0.05 * size!r}*cos(phi) + where({switch} > {level!r}, {jump!r}, 0))"
    return drive | {"loads": drive["loads"] | {"jump": {"kind": "formula", "on": "A", "torque": torque}}}


# Loads that jump or have kinks at crank angles, of a place p, a width w and a size c.
BLOWS = (
    "where(abs(phi - p) < w, c, 0)",
    "where(phi < p - w, 0, where(phi < p + w, c, 0))",
    "c*step(phi - p)*step(p + w - phi)",
    "c*max(0, 1 - abs(phi - p)/w)",
    "where(exp(-((phi - p)/w)^2) > 0.5, c, 0)",
    "c*sign(sin(2*phi - p) - 0.3*w)",
    "c*min(1, abs(sin(phi - p))/w)",
    "where(cos(phi - p) > 1 - 0.5*w^2, c*omega/10, 0)",
)


def with_blow(random: Generator, drive: Table, size: float) -> Table:
    """A drive with one load more, which jumps or has kinks at some angles; torques are of the given size."""
    constants = {
        "p": float(random.uniform(1.0, 5.0)),
        "w": float(10 ** random.uniform(-3.0, -0.2)),
        "c": float(size * 10 ** random.uniform(-1.5, 0.0) * random.choice([-1, 1])),
    }
    load = {"kind": "formula", "on": "A", "torque": str(random.choice(BLOWS)), "constants": constants}
    return drive | {"loads": drive["loads"] | {"blow": load}}


def with_tables(random: Generator, drive: Table, speeds: tuple[float, float], size: float) -> Table:
    """A drive with tables over angle, position, distance and both speeds; torques are of the given size."""
    sliders = drive["mechanism"].get("sliders", {})
    r = drive["mechanism"]["cranks"]["A"]["radius"]

    def heights(n: int, by: float = 1.0) -> list[float]:
        return (by * size * random.uniform(-0.3, 1.0, n)).tolist()

    loads: Table = {
        "turning": {
            "kind": "torque_angle",
            "angle": _increasing(random, (0.0, 6.2), 5),
            "torque": heights(5, 0.3),
        },
        "fan": {
            "kind": "torque_speed",
            "speed": _around(random, *speeds),
            "torque": np.sort(heights(4, 0.3)),
        },
    }
    for name, slider in sliders.items():
        rod, reach = slider["rod"], (slider["rod"] - r, slider["rod"] + r)
        loads |= {
            f"{name} pressed": {
                "kind": "force_position",
                "on": name,
                "position": _increasing(random, reach, 3),
                "forward": np.abs(heights(3, 0.3 / r)),
                "return": np.abs(heights(3, 0.3 / r)),
            },
            f"{name} held": {
                "kind": "spring",
                "between": [name, "O"],
                "length": _increasing(random, (rod - 0.5 * r, rod + r), 3),
                "force": heights(3, 0.3 / r),
            },
            f"{name} damped": {
                "kind": "damper",
                "between": [name, "O"],
                "velocity": [-r * speeds[0], -0.1 * r * speeds[0], 0.4 * r * speeds[0]],
                "force": np.sort(heights(3, 0.1 / r)),
            },
        }
    plain = {name: {key: _listed(value) for key, value in load.items()} for name, load in loads.items()}
    some = {name: plain[name] for name in plain if random.random() < 0.6}
    return drive | {"loads": drive["loads"] | some}


def _listed(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value


def _increasing(random: Generator, ends: tuple[float, float], n: int) -> list[float]:
    shares = np.cumsum(random.uniform(0.3, 1.0, n + 1))[:-1]
    return (ends[0] + (ends[1] - ends[0]) * shares / (shares[-1] + 0.3)).tolist()


def _around(random: Generator, low: float, high: float) -> list[float]:
    inner = low + (high - low) * np.array([random.uniform(0.2, 0.4), random.uniform(0.6, 0.8)])
    return [0.0, *(inner * [1.0, 1.001]).tolist(), 1.5 * high]


# Laws of a follower, of which some jump in the acceleration.
FOLLOWER_LAWS: tuple[Any, ...] = (
    *("parabolic", "parabolic", "harmonic", "cycloidal", "polynomial_3_4_5", "minimum_jerk"),
    {"kind": "modified_sine", "share": 0.17},
    {"kind": "modified_trapezoid", "share": 0.11},
    {"kind": "combined", "start": 0.3, "stop": 0.22},
    {"kind": "s_curve", "start": 0.3, "stop": 0.35, "rounding": 0.2},
    {"kind": "trapezoidal_velocity", "start": 0.25, "stop": 0.3},
)


def random_camshaft(random: Generator) -> Table:
    """One or two cams on a shaft that a motor drives, whose followers have mass, friction and springs."""
    height, mass = log_uniform(random, 5e-3, 80e-3), log_uniform(random, 1.0, 300.0)
    speed, ratio = log_uniform(random, 3.0, 40.0), float(random.choice([1.0, 9.8]))
    force = mass * 9.81 + log_uniform(random, 10.0, 3000.0)
    torque = force * height * log_uniform(random, 0.7, 20.0) / ratio
    drive = _drive(random, ratio, torque, speed * ratio)
    inertia = mass * height**2 * log_uniform(random, 0.3, 100.0)
    drive["flywheel"] = {"on": "crank", "inertia": inertia}
    loads: Table = {"gravity": {"kind": "gravity"}} if random.random() < 0.5 else {}
    cams: Table = {}
    for name in ("c", "d")[: random.integers(1, 3)]:
        cams[name] = _follower(random, height)
        swings = cams[name]["follower"] == "oscillating"
        if not swings:
            loads[f"{name} rubs"] = {"kind": "dry", "on": name, "force": 0.2 * force}
        if random.random() < 0.7:
            stiffness = force / height * random.uniform(0.1, 1.0)
            between = [name, "O"]
            loads[f"{name} closes"] = {
                "kind": "spring", "between": between, "stiffness": stiffness, "free_length": 0.05
            }  # fmt: skip
    return {
        "format": 1,
        "name": "Random camshaft",
        "drive": drive,
        "mechanism": {"points": {"P": {"x": 0.13, "y": 0.02}}, "cams": cams},
        "bodies": {name: {"mass": mass} for name in cams},
        "loads": loads,
    }


def _follower(random: Generator, height: float) -> Table:
    swings = bool(random.random() < 0.3)
    key, stroke = ("swing", height / 0.1) if swings else ("lift", height)
    laws = [FOLLOWER_LAWS[random.integers(len(FOLLOWER_LAWS))] for _ in range(2)]
    shares = random.dirichlet([6.0, 2.0, 6.0, 2.0])[: random.choice([3, 4])]
    angles = (shares / shares.sum() * 2 * np.pi).tolist()
    sections: list[Table] = [{"angle": angle} for angle in angles]
    sections[0] |= {key: stroke, "law": laws[0]}
    sections[2] |= {key: -stroke, "law": laws[1]}
    cam: Table = {
        "follower": "oscillating" if swings else "translating",
        "base_radius": 0.05,
        "roller_radius": 0.01,
        "phase": random.uniform(0.0, 6.0),
        "rotation": str(random.choice(["same", "opposite"])),
        "sections": sections,
    }
    arm = {"arm_pivot": "P", "arm_length": 0.1}
    return cam | (arm if swings else {"direction": random.uniform(0.0, 3.0)})
