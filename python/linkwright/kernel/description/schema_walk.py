"""What belongs at an address, read from the annotations of the models."""

from __future__ import annotations

import types
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel

from linkwright.kernel.description.deferred_model import DeferredModel
from linkwright.kernel.description.place import field_names, former_keys, look
from linkwright.kernel.units.marks import Quantity, QuantityList

Mark = Quantity | QuantityList


def annotation_at(model: type[BaseModel], place: Sequence[str], data: object = None) -> Any:
    """The annotation of the entry at a place, keys from the top down; None if no such entry exists.

    `data`: the description, checked or raw; its ``kind`` entries choose among motors and among loads.
    """
    annotation: Any = model
    for key in place:
        annotation = _below(annotation, key, data)
        data = look(data, key)
    return annotation


@cache
def mark_of(annotation: Any) -> Mark | None:
    """The quantity that an entry holds; None if it holds something else."""
    marked = [branch for branch in (annotation, *_branches(annotation)) if get_origin(branch) is Annotated]
    marks = (mark for branch in marked for mark in branch.__metadata__)
    return next((mark for mark in marks if isinstance(mark, Mark)), None)


def quantity_of(model: type[BaseModel], field: str) -> Quantity:
    """The quantity that a field of a model declares, for whoever asks for it elsewhere, as a command does."""
    mark = mark_of(annotation_at(model, (field,)))
    assert isinstance(mark, Quantity)
    return mark


def model_of(annotation: Any, data: object = None) -> type[BaseModel] | None:
    """The model of a table; of several, the one whose ``kind`` the table has."""
    models = _tables(annotation)
    if len(models) == 1:
        return models[0]
    return next((model for model in models if look(data, "kind") in kinds_of(model)), None)


def models_in(annotation: Any) -> list[type[BaseModel]]:
    """All models that an entry may hold, in tables and lists too."""
    models: list[type[BaseModel]] = []
    for branch in map(_bare, _branches(annotation)):
        if _is_model(branch):
            models.append(branch)
        elif get_origin(branch) in (dict, tuple):
            models += [model for inner in get_args(branch) if inner is not ... for model in models_in(inner)]
    return models


@cache
def kinds_of(model: type[BaseModel]) -> tuple[str, ...]:
    """The words for ``kind`` that choose a model."""
    field = model.model_fields.get("kind")
    return get_args(field.annotation) if field else ()


def words_of(annotation: Any) -> str:
    """What belongs into an entry, in words."""
    mark = mark_of(annotation)
    if mark is not None:
        return mark.expected
    bare = [_bare(branch) for branch in _branches(annotation)]
    if any(get_origin(branch) is Literal for branch in bare):
        choices = [choice for branch in bare if get_origin(branch) is Literal for choice in get_args(branch)]
        quoted = [f'"{choice}"' if isinstance(choice, str) else str(choice) for choice in choices]
        return quoted[0] if len(quoted) == 1 else "one of " + ", ".join(quoted)
    if any(_is_model(branch) or get_origin(branch) is dict for branch in bare):
        return "a table"
    lists = [branch for branch in bare if get_origin(branch) is tuple]
    if lists:
        inner = get_args(lists[0])[0]
        if any(_is_model(_bare(branch)) for branch in _branches(inner)):
            return "a list of tables"
        entry = mark_of(inner)
        if entry is not None:
            entries = get_args(lists[0])
            count = "" if entries[-1] is Ellipsis else f"{len(entries)} "
            return f"a list of {count}{entry.kind.plural}"
        if _bare(inner) is int:
            return "a list of whole numbers"
        count = "" if get_args(lists[0])[-1] is Ellipsis else "two "
        is_names = {_bare(branch) for branch in _branches(inner)} == {str}
        return f"a list of {count}{'names' if is_names else 'values'}"
    if bool in bare:
        return "true or false"
    if int in bare:
        return "a whole number"
    if str in bare:
        return "a text"
    return "a number" if float in bare else "another value"


def _below(annotation: Any, key: str, data: object) -> Any:
    mark = mark_of(annotation)
    if isinstance(mark, QuantityList):
        return Annotated[float, Quantity(mark.kind)]
    for branch in map(_bare, _branches(annotation)):
        if get_origin(branch) in (dict, tuple):
            return get_args(branch)[0 if get_origin(branch) is tuple else 1]
    model = model_of(annotation, data)
    name = field_names(model).get(former_keys(model).get(key, key)) if model else None
    if model is None or name is None:
        return None
    return _of_field(model, name)


def key_as_written(place: tuple[str, ...], data: object, model: type[BaseModel]) -> tuple[str, ...]:
    """The place of an entry in tables that `model` describes, by the key that they have, also a former."""
    *above, key = place or ("",)
    table = data
    for part in above:
        table = look(table, part)
    if not isinstance(table, Mapping) or key in table:
        return place
    owner = model_of(annotation_at(model, above, data), table)
    same = former_keys(owner).items() if owner else ()
    other = next((b for pair in same for a, b in (pair, pair[::-1]) if a == key and b in table), None)
    return place if other is None else (*above, other)


@cache
def _of_field(model: type[BaseModel], name: str) -> Any:
    field = model.model_fields[name]
    return Annotated[field.annotation, *field.metadata] if field.metadata else field.annotation


@cache
def _tables(annotation: Any) -> list[type[BaseModel]]:
    """The models of the tables that an entry may be. Shared: read only."""
    return [branch for branch in map(_bare, _branches(annotation)) if _is_model(branch)]


@cache
def _branches(annotation: Any) -> tuple[Any, ...]:
    """The alternatives of a union but for None; the annotation itself if it is none."""
    bare = _bare(annotation)
    if get_origin(bare) in (Union, types.UnionType):
        return tuple(branch for arg in get_args(bare) for branch in _branches(arg))
    return () if bare is types.NoneType else (annotation,)


@cache
def _bare(annotation: Any) -> Any:
    """The annotation without its marks; the model of a table that is described elsewhere."""
    if get_origin(annotation) is not Annotated:
        return annotation
    marks = (mark for mark in annotation.__metadata__ if isinstance(mark, DeferredModel))
    mark = next(marks, None)
    return get_args(annotation)[0] if mark is None else mark.model()


def _is_model(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def kinds_at(annotation: Any) -> list[str]:
    """All words for ``kind`` that a table may have."""
    return [word for model in _tables(annotation) for word in kinds_of(model)]
