"""Derivatives of random cams of every kind of contact, closure and law against extrapolated differences."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
from differences import sixth_order
from random_parts import log_uniform
from sizes import cases, random_cases

import linkwright as lw
from linkwright import LinkwrightError
from linkwright.cam.gradient import cam_tangents
from linkwright.machine import exchanged

# Share of an entry by which it is varied: rounding leaves 1e-13 of a result over it, the extrapolated
# differences h⁶ of a seventh derivative, which small radii of curvature make large.
_STEP = 5e-5

# What differences are good for, as a share of the largest derivative of a response.
_TOLERANCE = 1e-7

_LAWS: tuple[Any, ...] = (
    *("parabolic", "harmonic", "cycloidal", "gutman_1_3", "freudenstein_1_3_5", "polynomial_3_4_5"),
    *("polynomial_4_5_6_7", "minimum_acceleration", "minimum_jerk"),
    {"kind": "modified_sine", "share": 0.17},
    {"kind": "modified_trapezoid", "share": 0.11},
    {"kind": "combined", "start": 0.3, "stop": 0.22},
    {"kind": "combined", "start": 0.2, "stop": 0.35, "ramp": "cycloidal"},
    {"kind": "trapezoidal_velocity", "start": 0.25, "stop": 0.3},
    {"kind": "s_curve", "start": 0.3, "stop": 0.35, "rounding": 0.2},
    {"kind": "optimal", "order": 4},
    {"kind": "polynomial", "continuity_start": 3},
)


def _machine(rng: np.random.Generator) -> lw.Machine:
    """Rise, dwell, return and dwell of different lengths, so that few extremes tie."""
    follower = str(rng.choice(["translating", "oscillating"]))
    contact = str(rng.choice(["roller", "point", "flat"]))
    swings = follower == "oscillating"
    stroke = log_uniform(rng, 0.1, 0.5) if swings else log_uniform(rng, 4e-3, 40e-3)
    key, shares = "swing" if swings else "lift", rng.dirichlet([6.0, 2.0, 6.0, 2.0]) * 2 * np.pi
    laws = [_LAWS[rng.integers(len(_LAWS))] for _ in range(2)]
    if rng.random() < 0.15:
        most = {
            f"{'swing_' if swings else ''}{name}_max": limit for name, limit in _limits(stroke, shares[0])
        }
        laws[0] = {"kind": "limited", **most}
    cam: dict[str, Any] = {
        "follower": follower,
        "contact": contact,
        "base_radius": log_uniform(rng, 0.03, 0.06),
        "rotation": str(rng.choice(["same", "opposite"])),
        "sections": [
            {"angle": shares[0], key: stroke, "law": laws[0]},
            {"angle": shares[1]},
            {"angle": shares[2], key: -stroke, "law": laws[1]},
            {"angle": 2 * np.pi - shares[:3].sum()},
        ],
    }
    if contact == "roller":
        cam["roller_radius"] = log_uniform(rng, 5e-3, 20e-3)
    if swings:
        cam |= {"arm_pivot": "P", "side": str(rng.choice(["left", "right"]))}
        cam |= {"offset": rng.uniform(-5e-3, 5e-3)} if contact == "flat" else {"arm_length": 0.1}
    elif contact == "flat":
        cam["face_tilt"] = float(rng.choice([0.0, rng.uniform(-0.3, 0.3)]))
    else:
        cam["offset"] = rng.uniform(-0.01, 0.01)
    if contact == "roller" and rng.random() < 0.3:
        second = {"angle": 1.9, "arm_length": 0.09} if swings else {"distance": 0.16, "roller_radius": 0.012}
        cam |= {"closure": "conjugate", "second": second}
    return lw.Machine.model_validate(
        {
            "format": 1,
            "name": "cam",
            "drive": {"speed": 12.0},
            "mechanism": {"points": {"P": {"x": 0.13, "y": 0.02}}, "cams": {"c": cam}},
        }
    )


def _limits(stroke: float, angle: float) -> Iterator[tuple[str, float]]:
    yield from (("velocity", 1.7 * stroke / angle), ("acceleration", 9 * stroke / angle**2))
    yield ("jerk", 90 * stroke / angle**3)


def _ways(machine: lw.Machine, names: tuple[str, ...]) -> Iterator[dict[str, float]]:
    """Entries and by how much each goes: sections in pairs, so that angles and lifts still close."""
    paired = [
        [name for name in names if ".sections." in name and name.endswith(f".{key}")]
        for key in ("angle", "lift", "swing")
    ]
    alone = set(names) - {name for pair in paired for name in pair}
    for name in sorted(alone):
        if value := lw.get(machine, name):
            yield {name: abs(value)}
    for names_of in paired:
        for one, other in pairwise(names_of):
            size = min(abs(lw.get(machine, one)), abs(lw.get(machine, other)))
            yield {one: size, other: -size}


def _numbers(machine: lw.Machine, names: list[str]) -> np.ndarray:
    profile = lw.cam_profile(machine, "c", n=180)
    return np.array([getattr(profile, name) for name in names], dtype=float)


def _difference(machine: lw.Machine, names: list[str], way: dict[str, float], step: float) -> np.ndarray:
    """Central differences over h, 2h and 4h, extrapolated to sixth order."""
    here = {name: lw.get(machine, name) for name in way}
    return sixth_order(
        lambda by: _numbers(
            exchanged(machine, {name: here[name] + by * x for name, x in way.items()}), names
        ),
        step,
    )


def _check(machine: lw.Machine, what: object) -> tuple[int, int]:
    """Compare derivatives with differences: how many were compared, and how many tie."""
    names = [name for name in lw.addresses(machine) if name.startswith(("mechanism.", "drive."))]
    found = cam_tangents(machine, "c", names)
    listed = [name for name in found.tangents if name not in found.ties]
    d = np.array([found.tangents[name].d for name in listed])
    at = np.array([abs(lw.get(machine, name)) or 1e-3 for name in found.variables])
    scales = np.abs(d * at).max(axis=1)
    compared = 0
    for way in _ways(machine, found.variables):
        exact = sum(d[:, found.variables.index(name)] * x for name, x in way.items())
        sizes = np.maximum(scales, [abs(found.tangents[name].value) for name in listed])
        try:
            errors = np.abs(exact - _difference(machine, listed, way, _STEP)) / sizes
            # Where curvatures nearly go through zero differences need smaller steps: they come nearer then.
            finer = (
                errors
                if (errors <= _TOLERANCE).all()
                else (np.abs(exact - _difference(machine, listed, way, _STEP / 8)) / sizes)
            )
        except (LinkwrightError, TypeError):
            continue
        for row, name in enumerate(listed):
            is_nearer = finer[row] <= 1e-2 * errors[row]
            assert min(errors[row], finer[row]) <= _TOLERANCE or is_nearer, (what, name, way, errors[row])
            compared += 1
    return compared, len(found.ties)


# The smallest radius lies a third of a thousandth of a radian behind a joint.
_BESIDE_JOINTS = (5025,)


def test_derivatives_are_those_of_the_cam() -> None:
    compared = 0
    for case, random in random_cases(7, 12, 1000, also=_BESIDE_JOINTS):
        try:
            machine = _machine(random)
            faults = lw.cam_faults(lw.cam_profile(machine, "c"))
        except (LinkwrightError, ValueError):
            # A follower that does not reach its cam, a law that cannot do what is asked.
            continue
        # Curves of a cam that cannot be made go through infinite curvature.
        compared += 0 if faults else _check(machine, case)[0]
    assert compared > cases(250, 500)
