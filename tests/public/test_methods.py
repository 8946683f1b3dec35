"""Methods of results that users call: wrong numbers end in errors of Linkwright, at once."""

from __future__ import annotations

import dataclasses
import inspect
import math
import warnings
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from tests.public.test_misuse import WRONG, right_calls

import linkwright as lw
from linkwright import InputError, LinkwrightError
from linkwright.kernel.result import PlainRecord
from linkwright.torsion import record_diagnosis
from linkwright.torsion.diagnosis.record_diagnosis import RecordDiagnosis

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
    "law.integral": LAW.integral,
    "law.scaled": LAW.scaled,
    "law.scaled shift": lambda value: LAW.scaled(1.0, value),
    "law.placed": lambda value: LAW.placed(value, 1.0),
    "law.placed length": lambda value: LAW.placed(0.0, value),
    "law.stretch low": lambda value: LAW.stretch(value, 1.0),
    "law.stretch high": lambda value: LAW.stretch(0.0, value),
    "law.shifted": LAW.shifted,
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


@cache
def results() -> dict[type, Any]:
    """One object of each class that public functions give, and of those that users make."""
    found: dict[type, Any] = {}
    for name, (function, call) in right_calls().items():
        if name not in ("read", "loads", "get", "replace"):
            _keep(function(**call), found)
    beam = lw.read("machines/roller_two_carts.toml")
    for made in (lw.linkage(beam), lw.study(CART), lw.gradient(CART, ["steady_state.unevenness"])):
        _keep(made, found)
    _keep(lw.topper_field(lw.read("examples/topper_field/machine.toml")), found)
    _keep(lw.pumping_units(), found)
    engine = lw.read("machines/v8_diesel.toml")
    angle = [math.radians(5 * k) for k in range(144)]
    speed = [150 + 2 * math.cos(4 * x) for x in angle]
    _keep(record_diagnosis(engine, "flywheel", angle, speed), found)
    _keep(lw.free_vibration(engine), found)
    return found


def _keep(value: Any, found: dict[type, Any]) -> None:
    """Keep an object, and those that it consists of, by their classes."""
    if isinstance(value, dict | list | tuple):
        for part in value.values() if isinstance(value, dict) else value:
            _keep(part, found)
    elif dataclasses.is_dataclass(value) and type(value) not in found:
        found[type(value)] = value
        for field in dataclasses.fields(value):
            _keep(getattr(value, field.name), found)


def methods() -> Iterator[tuple[Any, str]]:
    for kind, each in results().items():
        # Results, and the small classes that users make.
        if issubclass(kind, PlainRecord | RecordDiagnosis) or kind.__name__ in dir(lw):
            for name, method in inspect.getmembers(kind, inspect.isfunction):
                # What `to_dict` takes is a truth, as any object is.
                is_asked = not name.startswith("_") and name != "to_dict"
                if is_asked and len(inspect.signature(method).parameters) > 1:
                    yield each, name


def test_methods_of_all_results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever they are given, for one argument or for all, they answer or refuse it as an error of ours."""
    asked, count = list(methods()), 0
    # Some write a file.
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for each, name in asked:
            every = list(inspect.signature(getattr(type(each), name)).parameters.values())[1:]
            parameters = [p for p in every if p.kind is not p.VAR_POSITIONAL]
            for chosen in parameters:
                needed = {p.name for p in parameters if p.default is p.empty}
                for word, value in WRONG.items():
                    count += 1
                    given = dict.fromkeys({*needed, chosen.name}, value)
                    try:
                        getattr(each, name)(**given)
                    except LinkwrightError:
                        continue
                    except Exception as error:
                        place = f"{type(each).__name__}.{name}({chosen.name}={word})"
                        raise AssertionError(f"{place}: {type(error).__name__}: {error}") from error
    assert count > 1500


def test_methods_name_what_they_do_not_know() -> None:
    cams = lw.search_cams(lw.read("machines/roller_cam.toml"), entries={"base_radius": [0.3, 0.4]})
    with pytest.raises(InputError, match="keeps: found 3 truths for 2 cams"):
        cams.smallest([True, True, False])
    with pytest.raises(InputError, match="count: found -1"):
        cams.smallest([True, True], -1)
    with pytest.raises(InputError, match=r"^course: found 3, expected a cam's course"):
        lw.StemGuide(0.1, 0.05).held(3, 3)
    with pytest.raises(InputError, match=r"^share: found 2, expected a share"):
        results()[next(kind for kind in results() if kind.__name__ == "TopperField")].length_at(2)


def test_shares_beyond_all_masses_are_refused() -> None:
    with pytest.raises(InputError, match=r"^share: found 1e\+09, expected a ratio from 0 to 1"):
        lw.partial_balance(CART, "cart1", share=1e9, speed=1.0)
