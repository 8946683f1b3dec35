"""Errors of pydantic, in the words of the file: which key, what is there, what belongs there."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Self

from pydantic import BaseModel, ModelWrapValidatorHandler, ValidationError, model_validator
from pydantic_core import ErrorDetails

from linkwright.kernel.description.base import Description, close_match
from linkwright.kernel.description.place import field_names, join, look
from linkwright.kernel.description.schema_walk import (
    annotation_at,
    key_as_written,
    kinds_at,
    model_of,
    words_of,
)
from linkwright.kernel.errors import MachineError, Problem, show


def problems(
    error: ValidationError, model: type[BaseModel], data: object, at: tuple[str, ...] = ()
) -> list[Problem]:
    """All problems that an error of pydantic and our own checks holds, each once, without file and line.

    `model`, `data`: what was to be made, and of what; `at`: keys down to the part that was checked.
    """
    details = error.errors(include_url=False)
    for detail in details:
        detail["loc"] = (*at, *detail["loc"])
    return list(dict.fromkeys(_problem(detail, model, data) for detail in details))


def _problem(error: ErrorDetails, model: type[BaseModel], data: object) -> Problem:
    place = key_as_written(_place(error["loc"], model, data), data, model)
    context: dict[str, Any] = error.get("ctx") or {}
    match error["type"]:
        case "problem":
            key, remedy = join(place), context["remedy"]
            return Problem(key, _as_written(place, data, context["found"]), context["expected"], remedy)
        case "extra_forbidden":
            return _unknown_key(place, model, data)
        case "union_tag_invalid" | "union_tag_not_found":
            return _wrong_kind((*place, "kind"), model, data)
        case "missing":
            return Problem(join(place), "nothing", words_of(annotation_at(model, place, data)))
    expected = words_of(annotation_at(model, place, data)) + _bound(error["type"], context)
    return Problem(join(place), show(error["input"]), expected)


def _bound(kind: str, context: dict[str, Any]) -> str:
    match kind:
        case "greater_than":
            return f" greater than {context['gt']:g}"
        case "less_than":
            return f" less than {context['lt']:g}"
        case "greater_than_equal":
            return f", at least {context['ge']}"
        case "less_than_equal":
            return f", at most {context['le']}"
    return ""


def _place(location: Iterable[str | int], model: type[BaseModel], data: object) -> tuple[str, ...]:
    place: list[str] = []
    node, tagged = data, False
    for part in (str(part) for part in location if part != "[key]"):
        kinds = kinds_at(annotation_at(model, place, data)) if place and not tagged else []
        tagged = len(kinds) > 1 and (part in kinds or part == look(node, "kind"))
        if not tagged:
            place.append(part)
            node = look(node, part)
    return tuple(place)


def _as_written(place: Sequence[str], data: object, short: str) -> str:
    """The value at a place as the user wrote it; else what the check found."""
    for key in place:
        data = look(data, key)
    written = isinstance(data, str | int | float)
    return show(data) if written else short


def _unknown_key(place: tuple[str, ...], model: type[BaseModel], data: object) -> Problem:
    table = data
    for key in place[:-1]:
        table = look(table, key)
    owner = model_of(annotation_at(model, place[:-1], data), table)
    known = list(field_names(owner)) if owner else []
    expected = "one of " + ", ".join(known)
    return Problem(join(place), "an unknown key", expected, close_match(place[-1], known) or "remove it")


def _wrong_kind(place: tuple[str, ...], model: type[BaseModel], data: object) -> Problem:
    known = kinds_at(annotation_at(model, place[:-1], data))
    entry = data
    for n, key in enumerate(place):
        if isinstance(entry, str):
            # A name in place of a table.
            place = place[:n]
            break
        entry = look(entry, key)
    expected = "one of " + ", ".join(f'"{kind}"' for kind in known)
    if entry is None:
        return Problem(join(place), "nothing", expected)
    return Problem(join(place), show(entry), expected, close_match(str(entry), known))


class WholeDescription(Description):
    """A description that stands for itself, as a file: what is wrong in it is a `MachineError`."""

    @model_validator(mode="wrap")
    @classmethod
    def _all_problems(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        try:
            return cls._checked(data, handler)
        except ValidationError as error:
            raise MachineError(problems(error, cls, data)) from None

    @classmethod
    def _checked(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        return handler(data)
