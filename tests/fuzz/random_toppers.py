"""Random toppers of every motion of the knife."""

from __future__ import annotations

from typing import Any

import numpy as np

import linkwright as lw

MOTIONS = ("harmonic", "constant", "one_way", "slider", "cam")

CAM = {
    "base_radius": 0.05,
    "roller_radius": 0.01,
    "sections": [
        {"angle": 2.4, "lift": 0.05, "law": "cycloidal"},
        {"angle": 0.5},
        {"angle": 2.6, "lift": -0.05, "law": "polynomial_3_4_5"},
        {"angle": 2 * np.pi - 5.5},
    ],
}


def topper_table(rng: np.random.Generator, kind: str) -> dict[str, Any]:
    stroke = rng.uniform(0.04, 0.08)
    motion: dict[str, Any] = {"kind": kind, "stroke": stroke}
    if kind in ("slider", "cam"):
        motion = {"kind": "member", "of": "knife"}
    elif kind == "one_way":
        motion = {"kind": "constant"}
    if kind != "one_way" and rng.random() < 0.3:
        motion["phase"] = rng.uniform(0.1, 6.0)
    topper = {
        "root_diameter": rng.uniform(0.08, 0.13),
        "cut_height": rng.uniform(0.02, 0.035),
        "offset": rng.uniform(0.005, 0.03),
        "edge_angle": rng.uniform(-0.5, 0.5),
        "edge_length": rng.uniform(0.1, 0.25),
        "forward_speed": rng.uniform(1.5, 2.5),
        "motion": motion,
    }
    if motion["kind"] != "member":
        topper["knife_speed"] = rng.uniform(0.2, 0.8)
    return topper


def random_topper(rng: np.random.Generator, kind: str) -> lw.Machine:
    described: dict[str, Any] = {"format": 1, "name": "Topper", "topper": topper_table(rng, kind)}
    if kind == "slider":
        described["mechanism"] = {
            "cranks": {"crank": {"radius": rng.uniform(0.02, 0.04)}},
            "sliders": {
                "knife": {"crank": "crank", "rod": rng.uniform(0.12, 0.2), "offset": rng.uniform(0.004, 0.02)}
            },
        }
        described["bodies"] = {"knife": {"mass": 2.5}, "knife.rod": {"mass": 0.6}}
        described["drive"] = {"speed": rng.uniform(15.0, 30.0)}
        if rng.random() < 0.7:
            described["loads"] = {"cut": {"kind": "viscous", "on": "knife", "damping": 40.0}}
    if kind == "cam":
        described["mechanism"] = {"cams": {"knife": CAM}}
        described["drive"] = {"speed": rng.uniform(15.0, 25.0)}
        described["bodies"] = {"knife": {"mass": 2.0}}
    return lw.Machine.model_validate(described)
