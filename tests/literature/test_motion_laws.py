"""Published factors of motion laws, each with its tolerance and the reason for it."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest

from linkwright import cam_laws

CASES = tomllib.loads(Path(__file__).with_name("motion_laws.toml").read_text(encoding="utf-8"))["case"]


@pytest.mark.parametrize("case", CASES, ids=[f"{case['law']}-{'-'.join(case['expect'])}" for case in CASES])
def test_case(case: dict[str, Any]) -> None:
    found = cam_laws()[case["law"]].to_dict()
    half_digit = 0.5000001 * 10.0 ** -case["digits"] if "digits" in case else None
    for name, value in case["expect"].items():
        limits = {"rel": case.get("rtol"), "abs": half_digit or case.get("atol")}
        assert found[name] == pytest.approx(value, **limits), (name, case["why"])


def test_every_case_gives_its_reason() -> None:
    for case in CASES:
        assert case["why"]
        assert case["source"]
        assert {"rtol", "atol", "digits"} & set(case)
