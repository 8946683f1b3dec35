"""Functions that are named by their place, ``"cam.tables:law_table"``, and imported when they are called."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any


def at_place(place: str) -> Any:
    """What a module below `linkwright` has under a name, ``"module:name"``, imported now."""
    module, _, name = place.partition(":")
    return getattr(import_module(f"linkwright.{module}"), name)


def later(place: str, *args: Any, **options: Any) -> Callable[[], Any]:
    """A call of the function at a place with these arguments; it is imported when the call is made."""
    return lambda: at_place(place)(*args, **options)
