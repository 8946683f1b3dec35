"""Random machines from motor to load: cranks with sliders, rockers and levers, bodies, all kinds of loads."""

from __future__ import annotations

from typing import Any

from numpy.random import Generator
from random_parts import log_uniform

Table = dict[str, Any]


def random_drive(random: Generator) -> Table:
    """A machine that closes all round, with a motor that may or may not carry it.

    Inertia, load and steepness of the motor vary over some decades each, together over twelve.
    """
    mechanism, carriers, slides = _linkage(random)
    return {
        "format": 1,
        "name": "Random machine",
        "drive": _drive(random),
        "mechanism": mechanism,
        "bodies": _bodies(random, carriers),
        "loads": _loads(random, carriers, slides),
    }


def _linkage(random: Generator) -> tuple[Table, list[str], list[str]]:
    """A crank and one to three elements on it; what can carry a mass, and what can be pushed."""
    r = log_uniform(random, 0.03, 0.6)
    points: Table = {}
    parts: dict[str, Table] = {"cranks": {"A": {"radius": r, "phase": random.uniform(-3.0, 3.0)}}}
    carriers, slides = ["A"], ["A"]
    for k in range(random.integers(1, 4)):
        kind = ("slider", "slider", "rocker", "lever")[random.integers(4)]
        if kind == "slider":
            name = f"S{k}"
            rod = r * random.uniform(1.6, 6.0)
            offset = float(random.choice([0.0, random.uniform(-0.5, 0.5) * r]))
            angle = random.uniform(-3.0, 3.0)
            slider = {"crank": "A", "rod": rod, "offset": offset, "angle": angle}
            parts.setdefault("sliders", {})[name] = slider
            carriers += [name, f"{name}.rod"]
            slides.append(name)
        elif kind == "rocker":
            name = f"R{k}"
            frame, coupler, rocker = _crank_rocker(random, r)
            points[f"P{k}"] = {"x": frame, "y": 0.0}
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
    """Frame, coupler and rocker of a four-bar whose crank turns all round, by Grashof's condition."""
    while True:
        frame, coupler, rocker = (r * random.uniform(1.3, 6.0) for _ in range(3))
        longest = max(frame, coupler, rocker)
        if r + longest < 0.97 * (frame + coupler + rocker - longest):
            return frame, coupler, rocker


def _bodies(random: Generator, carriers: list[str]) -> Table:
    bodies: Table = {
        "A": {"mass": log_uniform(random, 0.1, 100.0), "inertia": log_uniform(random, 1e-3, 30.0)}
    }
    for name in carriers[1:]:
        if random.random() < 0.6:
            bodies[name] = {"mass": log_uniform(random, 0.1, 300.0)}
    return bodies


def _loads(random: Generator, carriers: list[str], slides: list[str]) -> Table:
    """Some loads on what moves; forces are of one size, stiffness and damping of many."""
    loads: Table = {"gravity": {"kind": "gravity"}} if random.random() < 0.5 else {}
    size = log_uniform(random, 10.0, 3000.0)
    for k in range(random.integers(0, 4)):
        on = slides[random.integers(len(slides))]
        kind = str(random.choice(["dry", "viscous", "force", "spring", "formula"]))
        if kind == "dry":
            loads[f"l{k}"] = {"kind": kind, "on": on, "force": size}
        elif kind == "viscous":
            loads[f"l{k}"] = {"kind": kind, "on": on, "damping": size / log_uniform(random, 0.1, 10.0)}
        elif kind == "force":
            loads[f"l{k}"] = {"kind": kind, "on": on, "force": size, "direction": random.uniform(-3.0, 3.0)}
        elif kind == "spring":
            spring = {"stiffness": log_uniform(random, 1e2, 1e6), "free_length": random.uniform(0.0, 0.5)}
            loads[f"l{k}"] = {"kind": kind, "between": [on, "O"], **spring}
        else:
            text = f"-{size!r}*(0.3 + sin(phi)^2)*tanh(omega)"
            loads[f"l{k}"] = {"kind": kind, "on": "A", "torque": text}
    return loads


def _drive(random: Generator) -> Table:
    ratio = float(random.choice([1.0, 3.0, 9.8, 40.0]))
    torque, speed = log_uniform(random, 0.5, 3000.0), log_uniform(random, 5.0, 400.0)
    motor: Table = {"kind": "dc", "speed_no_load": speed, "torque_stall": torque}
    if random.random() < 0.6:
        slip = log_uniform(random, 0.005, 0.08)
        motor = {
            "kind": "induction",
            "speed_synchronous": speed,
            "speed_rated": speed * (1.0 - slip),
            "torque_rated": torque,
            "torque_breakdown": torque * random.uniform(1.8, 3.2),
        }
    if random.random() < 0.8:
        motor["inertia"] = log_uniform(random, 1e-4, 3.0)
    gearbox = {"ratio": ratio, "efficiency": float(random.choice([1.0, 0.9, 0.7]))}
    drive: Table = {"motor": motor, "gearbox": gearbox}
    if random.random() < 0.3:
        drive["flywheel"] = {"inertia": log_uniform(random, 0.01, 300.0)}
    return drive
