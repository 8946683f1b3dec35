"""Paper 1: every case of its file of data, each with its tolerance and the reason for it."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest

from linkwright import Machine, constant_energy, read, reduction, required_power, steady_state
from linkwright.kernel.files.library import library_path
from linkwright.papers.paper1.paper import load_by_steps
from linkwright.papers.paper1.scheme import published_scheme, turns_to_steady

CASES = tomllib.loads((Path(__file__).parent / "paper1.toml").read_text(encoding="utf-8"))["case"]


def scheme(machine: Machine) -> dict[str, float]:
    motion = published_scheme(machine)
    return {
        "speed_min": motion.speed_min,
        "speed_max": motion.speed_max,
        "speed_mean": motion.speed_mean_extremes,
        "unevenness": motion.unevenness,
        "turns": turns_to_steady(motion),
    }


METHODS = {
    "load": lambda machine: reduction(machine).to_dict(),
    "load at degrees": lambda machine: {"torque_load_mean": load_by_steps(reduction(machine, n=360), 1.0)},
    "power": lambda machine: required_power(machine).to_dict(),
    "solution": lambda machine: steady_state(machine).to_dict(),
    "limit": lambda machine: constant_energy(machine).to_dict(),
    "scheme": scheme,
}


@pytest.mark.parametrize("case", CASES, ids=[case["name"] for case in CASES])
def test_case(case: dict[str, Any]) -> None:
    machine = read(library_path(case["given"]["machine"]))
    found = METHODS[case["given"]["method"]](machine)
    for name, value in case["expect"].items():
        # A hair more than half a digit, for rounding of the binary numbers.
        half_digit = 0.500001 * 10.0 ** -case["digits"][name] if "digits" in case else None
        limits = {"rel": case.get("rtol"), "abs": half_digit or case.get("atol")}
        assert found[name] == pytest.approx(value, **limits), (name, case["why"])


def test_every_case_gives_its_reason() -> None:
    for case in CASES:
        assert case["why"]
        assert case["source"]
        assert {"rtol", "atol", "digits"} & set(case)
