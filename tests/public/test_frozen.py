"""Errors are names of `linkwright`; attributes that are set are refused in words that tell what to do."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Callable
from typing import Any

import pytest

import linkwright as lw
from linkwright.kernel import errors


def _machine() -> lw.Machine:
    return lw.read("roller_two_carts")


FROZEN: dict[str, tuple[Callable[[], Any], str, str]] = {
    "a result": (lambda: lw.steady_state(_machine()), "speed", "dataclasses.replace"),
    "a part of a result": (lambda: lw.linkage(_machine()).elements[0], "swing", "dataclasses.replace"),
    "an entry made when asked for": (
        lambda: lw.kinematics(_machine()).slides["cart1"],
        "d1",
        "dataclasses.replace",
    ),
    "a record with slots or without a base": (
        lambda: lw.pose(_machine(), 1.0),
        "points",
        "dataclasses.replace",
    ),
    "a result that a study makes when asked for": (
        lambda: lw.study(_machine()).motion,
        "speed",
        "dataclasses.replace",
    ),
    "what a user makes": (lambda: lw.Friction(0.1), "radius", "dataclasses.replace"),
    "a machine": (_machine, "name", ".with_entries"),
    "a part of a machine": (lambda: _machine().mechanism.cranks["A2"], "phase", ".with_entries"),
}


@pytest.mark.parametrize(("made", "name", "remedy"), FROZEN.values(), ids=FROZEN)
def test_an_attribute_that_is_set_is_refused_with_what_to_do(
    made: Callable[[], Any], name: str, remedy: str
) -> None:
    """The message has class, attribute and both ways to a changed copy; it is an `AttributeError` as well."""
    frozen = made()
    before = getattr(frozen, name)
    for change in (lambda: setattr(frozen, name, 1.0), lambda: delattr(frozen, name)):
        with pytest.raises(lw.FrozenError) as caught:
            change()
        assert isinstance(caught.value, AttributeError)
        assert isinstance(caught.value, lw.InputError)
        text = str(caught.value)
        assert text.startswith(f"{type(frozen).__name__}.{name}: descriptions and results do not change")
        assert remedy in text
        assert "lw.replace(machine, {address: value})" in text
    assert getattr(frozen, name) is before


def test_a_misspelt_attribute_has_no_copy_with_it() -> None:
    """Of a name that is no entry, a copy with that entry is not proposed."""
    for frozen in (lw.steady_state(_machine()), _machine().drive):
        with pytest.raises(lw.FrozenError) as caught:
            frozen.sped = 3.0  # type: ignore[union-attr]
        assert "copy" not in str(caught.value)


def test_what_the_messages_propose_works() -> None:
    steady, machine = lw.steady_state(_machine()), _machine()
    assert dataclasses.replace(steady, speed_min=1.0).speed_min == 1.0
    assert machine.mechanism.cranks["A2"].with_entries({"phase": 1.0}).phase == 1.0
    assert lw.replace(machine, {"mechanism.cranks.A2.phase": 1.0}).mechanism.cranks["A2"].phase == 1.0


def test_every_error_is_a_name_of_linkwright() -> None:
    """Whatever is raised on purpose can be caught by a name of `lw`."""
    own = {
        name
        for name, kind in inspect.getmembers(errors, inspect.isclass)
        if issubclass(kind, errors.LinkwrightError)
    }
    assert len(own) >= 18
    assert own <= set(lw.__all__)
    assert all(getattr(lw, name) is getattr(errors, name) for name in own)
