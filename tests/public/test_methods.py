"""Methods of results that users call: wrong numbers end in errors of Linkwright, at once."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import pytest
from tests.public.test_misuse import WRONG

import linkwright as lw
from linkwright.kernel.errors import InputError, LinkwrightError

LAW = lw.read("machines/roller_cam.toml").mechanism.cams["cart"].motion.lift
CART = lw.read("machines/roller_one_cart.toml")
MOTION = lw.transient(CART, duration=0.1)
WAVES = lw.waterfall(
    [0.01 * k for k in range(3000)], [0.3 * k for k in range(3000)], [1.0] * 3000, highest=4.0
)

CALLS: dict[str, Callable[[Any], Any]] = {
    "law.at x": LAW.at,
    "law.at order": lambda value: LAW.at(0.5, value),
    "law.at side": lambda value: LAW.at(0.5, 0, value),
    "law.derivative": LAW.derivative,
    "law.peak": LAW.peak,
    "law.extremes": LAW.extremes,
    "law.zeros": LAW.zeros,
    "transient.at": MOTION.at,
    "transient.slope": MOTION.slope,
    "waterfall.order": WAVES.order,
}


@pytest.mark.parametrize("name", CALLS)
def test_misuse(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for word, value in WRONG.items():
            try:
                CALLS[name](value)
            except LinkwrightError:
                continue
            except Exception as error:
                raise AssertionError(f"{name}({word}): {type(error).__name__}: {error}") from error


def test_counterweights_beyond_all_masses_are_refused() -> None:
    with pytest.raises(InputError, match=r"^mass of the counterweight on A1: found "):
        lw.partial_balance(CART, "cart1", share=1e9, speed=1.0)
