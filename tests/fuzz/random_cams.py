"""Random cams of every kind of contact, closure and law, each alone in a machine."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from random_parts import log_uniform

import linkwright as lw

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


def random_cam(rng: np.random.Generator) -> lw.Machine:
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
    """Limits that a section keeps with some room."""
    yield from (("velocity", 1.7 * stroke / angle), ("acceleration", 9 * stroke / angle**2))
    yield ("jerk", 90 * stroke / angle**3)
