"""Random sound trains, cams and toppers, and the laws that each must keep."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np
from broken import PromiseError, watched
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.linalg import eigh

import linkwright as lw
from linkwright import FindingError, LinkwrightError
from linkwright.kernel.units.kinds import LENGTH
from linkwright.torsion import ForcedVibration, excited_train, responded

Floats = NDArray[np.float64]


def log_uniform(random: Generator, low: float, high: float) -> float:
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def random_train(random: Generator) -> dict[str, Any]:
    """A tree of discs and shafts, stiffness over six decades, some of them damped, with pulsating torques."""
    n = int(random.integers(2, 9))
    discs = {
        f"d{i}": {
            "inertia": log_uniform(random, 1e-2, 1e2),
            "damping": float(random.choice([0.0, log_uniform(random, 1e-2, 10.0)])),
        }
        for i in range(n)
    }
    shafts = {
        f"s{i}": {
            "between": [f"d{random.integers(i)}", f"d{i}"],
            "stiffness": log_uniform(random, 1e3, 1e9),
            "loss_factor": float(random.choice([0.0, log_uniform(random, 1e-3, 0.3)])),
        }
        for i in range(1, n)
    }
    harmonics = [
        {"order": float(order), "torque": log_uniform(random, 1.0, 1e4), "phase": random.uniform(-3.0, 3.0)}
        for order in random.choice([0.5, 1, 1.5, 2, 3, 4, 6], size=3, replace=False)
    ]
    run = {"speed_min": 5.0, "speed_max": log_uniform(random, 20.0, 600.0), "points": 7}
    excitations = {"e": {"on": f"d{random.integers(n)}", "harmonics": harmonics}}
    return {"run": run, "discs": discs, "shafts": shafts, "excitations": excitations}


def train(random: Generator) -> None:
    """Frequencies against a dense solver; equilibrium of every disc; power in is heat out."""
    description = random_train(random)
    inputs = {"train": repr(description)}
    with watched(inputs):
        machine = lw.Machine.model_validate({"format": 1, "name": "train", "train": description})
        _frequencies(lw.free_vibration(machine).natural_frequencies, description, inputs)
        _balance(machine, description, inputs)


def _stiffness_matrix(description: Mapping[str, Any]) -> Floats:
    place = {name: k for k, name in enumerate(description["discs"])}
    K = np.zeros((len(place), len(place)))
    for shaft in description["shafts"].values():
        a, b = (place[end] for end in shaft["between"])
        K[[a, b], [a, b]] += shaft["stiffness"]
        K[[a, b], [b, a]] -= shaft["stiffness"]
    return K


def _frequencies(found: Floats, description: Mapping[str, Any], inputs: Mapping[str, str]) -> None:
    J = np.array([disc["inertia"] for disc in description["discs"].values()])
    root = 1.0 / np.sqrt(J)
    squares = eigh(root[:, None] * _stiffness_matrix(description) * root, eigvals_only=True)
    # A dense solver errs by some rounding of the largest eigenvalue.
    worst = np.abs((2 * np.pi * found) ** 2 - squares).max() / squares[-1]
    if not worst < 1e-12:
        raise PromiseError(f"squares of natural frequencies differ by {worst:.2g} of the largest", inputs)


def _balance(machine: lw.Machine, description: Mapping[str, Any], inputs: Mapping[str, str]) -> None:
    at = excited_train(machine)
    found = responded(at)
    # Without any damping a speed on a resonance has no answer, which is said in words, not in numbers.
    if not any(part.get("damping") or part.get("loss_factor") for part in _parts(description)):
        return
    sums, sizes = _sums_at_discs(found, description, at.torques.harmonics)
    worst = (np.abs(sums) / sizes.max(axis=1, keepdims=True)).max()
    if not worst < 1e-8:
        raise PromiseError(f"torques on a disc add up to {worst:.2g} of the largest of them", inputs)
    omega = found.orders[:, None, None] * found.speeds
    apparent = 0.5 * np.abs(at.torques.harmonics * omega * found.amplitudes).sum(axis=(0, 1))
    rest = found.shaft_heat.sum(axis=0) + found.disc_heat.sum(axis=0) - found.power
    if not (np.abs(rest) <= 1e-9 * apparent).all():
        raise PromiseError(
            f"power less heat is {np.abs(rest / apparent).max():.2g} of the apparent power", inputs
        )


def _parts(description: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [*description["discs"].values(), *description["shafts"].values()]


def _sums_at_discs(
    found: ForcedVibration, description: Mapping[str, Any], applied: NDArray[np.complex128]
) -> tuple[NDArray[np.complex128], Floats]:
    """Sum of all torques on each disc, inertia included, and the largest of them, (orders, discs, speeds)."""
    place = {name: k for k, name in enumerate(found.discs)}
    J = np.array([description["discs"][name]["inertia"] for name in found.discs])[:, None]
    damping = np.array([description["discs"][name]["damping"] for name in found.discs])[:, None]
    omega = found.orders[:, None, None] * found.speeds
    own = (omega**2 * J - 1j * omega * damping) * found.amplitudes
    sums, sizes = own + applied, np.maximum(np.abs(own), np.abs(applied))
    for s, name in enumerate(found.shafts):
        a, b = (place[end] for end in description["shafts"][name]["between"])
        torque = found.shaft_torques[:, s]
        for end, sign in ((a, -1.0), (b, 1.0)):
            sums[:, end] += sign * torque
            sizes[:, end] = np.maximum(sizes[:, end], np.abs(torque))
    return sums, sizes


LAWS = ("cycloidal", "modified_sine", "modified_trapezoid", "polynomial_3_4_5", "harmonic", "minimum_jerk")


def random_cam(random: Generator) -> dict[str, Any]:
    """A cam with a translating or oscillating roller follower: rise, dwell, return, dwell."""
    shares = random.dirichlet([3.0, 1.0, 3.0, 1.0]) * 2 * np.pi
    oscillating = bool(random.integers(2))
    stroke = log_uniform(random, 0.1, 0.6) if oscillating else log_uniform(random, 2e-3, 60e-3)
    key = "swing" if oscillating else "lift"
    sections = [
        {"angle": float(shares[0]), key: stroke, "law": str(random.choice(LAWS))},
        {"angle": float(shares[1])},
        {"angle": float(shares[2]), key: -stroke, "law": str(random.choice(LAWS))},
        {"angle": float(2 * np.pi - shares[:3].sum())},
    ]
    cam: dict[str, Any] = {
        "follower": "oscillating" if oscillating else "translating",
        "base_radius": log_uniform(random, 10e-3, 80e-3),
        "roller_radius": log_uniform(random, 2e-3, 40e-3),
        "sections": sections,
    }
    if oscillating:
        cam |= {"pivot": "O", "arm_pivot": "P", "arm_length": 0.1, "side": "right"}
    return {
        "format": 1,
        "name": "cam",
        "drive": {"speed": 10.0},
        "mechanism": {"points": {"P": {"x": 0.13, "y": 0.02}}, "cams": {"c": cam}},
    }


def cam(random: Generator) -> None:
    """A roller never lies inside the profile that it rolls on, unless the cam is said to be impossible."""
    description = random_cam(random)
    inputs = {"machine": repr(description)}
    with suppress(LinkwrightError), watched(inputs):
        machine = lw.Machine.model_validate(description)
        profile = lw.cam_profile(machine, n=360)
        if lw.cam_faults(profile):
            return
        rows, flank = profile.flanks[0].shape.rows, profile.flanks[0]
        centres = np.column_stack((rows["pitch_x"], rows["pitch_y"]))
        distances = np.linalg.norm(centres[:, None] - flank.profile[None], axis=2)
        radius = flank.contact.sizes.roller_radius
        # A place of the profile inside the roller is no matter of sampling; rounding goes with the cam.
        inside = (radius - distances.min()) / np.abs(centres).max()
        if not inside < 1e-12:
            raise PromiseError(
                f"the profile lies inside the roller by {inside:.2g} of the cam, and no fault is reported",
                inputs,
            )


def random_topper(random: Generator) -> dict[str, Any]:
    kind = str(random.choice(["harmonic", "constant"]))
    diameter = random.uniform(0.06, 0.2)
    topper = {
        "root_diameter": diameter,
        "cut_height": diameter * random.uniform(0.1, 0.45),
        "offset": random.uniform(0.0, 0.04),
        "edge_angle": random.uniform(-0.7, 0.7),
        "edge_length": random.uniform(0.05, 0.5),
        "forward_speed": random.uniform(0.5, 3.0),
        "knife_speed": random.uniform(0.05, 1.5),
        "motion": {"kind": kind, "stroke": random.uniform(0.02, 0.12)},
    }
    return {"format": 1, "name": "topper", "topper": topper}


# No edge is longer [m]; what hardly advances may need more.
EDGE_MAX = 0.99 * LENGTH.most


def topper(random: Generator) -> None:
    """An edge of the exact length cuts every head whole, and a shorter one does not."""
    description = random_topper(random)
    inputs = {"topper": repr(description["topper"])}
    with suppress(FindingError), watched(inputs):
        whole = lw.topper(lw.Machine.model_validate(description))
        length = whole.length_exact
        if not np.isfinite(length):
            if not whole.obstacle:
                raise PromiseError(f"an exact length of {length} m, and no word why", inputs)
            return
        if length > EDGE_MAX:
            return
        for factor in (1.0 + 1e-6, 0.98):
            given = {**description, "topper": {**description["topper"], "edge_length": factor * length}}
            found = lw.topper(lw.Machine.model_validate(given))
            if found.edge_retreats:
                # Areas under edges that run backwards are good to 1e-5, so a sliver may be missed.
                return
            if (found.uncut_share == 0.0) != (factor > 1.0):
                raise PromiseError(
                    f"{factor} of the exact length leaves {found.uncut_share} of a head", inputs
                )
