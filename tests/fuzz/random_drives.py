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
    """One load on a member."""
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
