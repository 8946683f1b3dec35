"""What a start leaves out changes no class: dataclasses behave as those of the library."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from collections.abc import Callable
from dataclasses import FrozenInstanceError, field
from typing import Any

import pytest

from linkwright.app.lean_start import _dataclass

OPTIONS: tuple[dict[str, Any], ...] = (
    {},
    {"frozen": True},
    {"frozen": True, "slots": True},
    {"frozen": True, "kw_only": True},
    {"eq": False},
    {"repr": False},
    {"order": True},
    {"unsafe_hash": True},
)


class Parts:
    """Entries: one that is compared and shown, one that is neither, one with a default."""

    x: int
    hidden: int = field(default=0, compare=False, repr=False)
    rest: Any = None


class OwnMethods(Parts):
    """With a comparison and a text of its own."""

    x: int
    rest: Any = None

    def __eq__(self, other: object) -> bool:
        return True

    def __repr__(self) -> str:
        return "own"


class OwnHash(Parts):
    """With a hash of its own."""

    x: int
    rest: Any = None

    def __hash__(self) -> int:
        return 7


def made(decorate: Callable[..., Any], parts: type, options: dict[str, Any]) -> Any:
    """The dataclass of some entries."""
    body = {name: value for name, value in vars(parts).items() if name not in ("__dict__", "__weakref__")}
    return decorate(**options)(type("Made", (), body))


def told(value: Callable[[], Any]) -> Any:
    """A value, or the kind of its error."""
    try:
        return value()
    except (TypeError, FrozenInstanceError, AttributeError) as error:
        return type(error)


def answers(kind: Any) -> list[Any]:
    """What a dataclass says of some of its objects."""
    first, same, other = kind(x=1), kind(x=1), kind(x=2, rest=(3,))
    first_of_itself = kind(x=1, rest=[])
    first_of_itself.rest.append(first_of_itself)
    return [
        first == same,
        first == kind(x=1, hidden=2),
        told(lambda: hash(first) == hash(kind(x=1, hidden=2))),
        first == other,
        first != other,
        first == 1,
        told(lambda: hash(first) == hash(same)),
        told(lambda: hash(kind(x=1, rest=[])) is None),
        told(lambda: first < other),
        repr(other) if "object at" not in repr(other) else "",
        repr(first_of_itself) if "object at" not in repr(first_of_itself) else "",
        told(lambda: setattr(first, "x", 4)),
        dataclasses.asdict(other),
        dataclasses.replace(other, x=5) == kind(x=5, rest=(3,)),
        kind.__match_args__,
    ]


@pytest.mark.parametrize("parts", [Parts, OwnMethods, OwnHash])
@pytest.mark.parametrize("options", OPTIONS, ids=str)
def test_dataclasses_behave_as_those_of_the_library(parts: type, options: dict[str, Any]) -> None:
    theirs, ours = (
        told(lambda decorate=decorate: answers(made(decorate, parts, options)))
        for decorate in (dataclasses.dataclass, _dataclass)
    )
    assert ours == theirs


def test_of_two_classes_none_is_equal() -> None:
    assert made(_dataclass, Parts, {})(x=1) != made(_dataclass, Parts, {})(x=1)


def test_schemas_are_imported_once_and_typed_dictionaries_stay() -> None:
    code = """
import typing, typing_extensions
kept = typing.TypedDict, typing_extensions.TypedDict
from linkwright.app.lean_start import import_schemas
import_schemas()
assert kept == (typing.TypedDict, typing_extensions.TypedDict)
import pydantic_core.core_schema as schemas
assert isinstance(schemas.int_schema(), dict)
first = schemas
import_schemas()
assert first is schemas
import linkwright as lw
assert lw.read('roller_two_carts').name
"""
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, timeout=120)
