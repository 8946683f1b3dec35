"""A quantity of a result is declared once, at its attribute: its words, its symbol, its unit.

    speed_min: Annotated[float, Label("minimum speed", "ω_min", "rad/s", "Exact, not that of the curve.")]

From this follow the docs of the class, the rows of tables, the heads of columns, the table in
`docs/notation.md`, and what `linkwright.quantities` lists. Whether it is a scalar or a curve is said by its
type; a curve runs over the first array of its result unless it says otherwise.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, NamedTuple, Union, get_args, get_origin, get_type_hints

import numpy as np


class Label(NamedTuple):
    """Mark of an attribute that is a quantity.

    Attributes
    ----------
    word : str
        What it is called.
    symbol : str
        As the field writes it, an index after ``_``; empty if it has none.
    unit : str
        SI unit as it is printed; empty for a number without one.
    about : str
        What else is to be known, in sentences. A property says it in its docstring.
    shape : str
        Of an array that is no list of numbers over another one, such as ``"(n, 2)"``; ``"(shafts,)"`` for one
        with a number for each of the names in the attribute ``shafts``.
    over : str
        Attribute that a curve runs over, if that is not the first array of its result; its own name for an
        array that runs over no quantity, such as over variants: where the first array does so, all others of
        the result do. Numbers of named parts run over none.
    table : str
        Name of the table that has a row for it; empty for none.
    before : str
        Attribute of that table that it stands before; without it, rows have the order of the declarations.
    scale : float
        Size beside which a value is rounding and shows as zero, where it has no others of its unit to compare
        with; 0 if every digit counts.
    usual : str
        Unit in which people read it where they want no other; empty for `unit`.
    """

    word: str
    symbol: str
    unit: str
    about: str = ""
    shape: str = ""
    over: str = ""
    table: str = ""
    before: str = ""
    scale: float = 0.0
    usual: str = ""


class About(NamedTuple):
    """Mark of an attribute that is no quantity of one unit: a text, a table, another result; its shape."""

    about: str
    shape: str = ""


class DeclaredQuantity(NamedTuple):
    """A quantity of a result, as it is declared.

    Attributes
    ----------
    name : str
        Of the attribute; of a study, with the analysis before it: ``"steady_state.speed_min"``.
    kind : str
        ``"scalar"`` or ``"curve"``.
    word, symbol, unit : str
        What it is called, its symbol, its SI unit; the last two may be empty.
    about : str
        What else is to be known, in sentences.
    over : str
        Of a curve, name of the attribute that it runs over; empty for that one itself and for scalars.
    scale : float
        Size beside which a value is rounding; 0 if every digit counts.
    """

    name: str
    kind: str
    word: str
    symbol: str
    unit: str
    about: str
    over: str
    scale: float


def quantities_of(owner: type) -> Iterator[DeclaredQuantity]:
    """The quantities that a class declares, fields before properties."""
    for name, (_, mark) in declared(owner).items():
        if isinstance(mark, Label):
            kind = "curve" if is_array(owner, name) else "scalar"
            yield DeclaredQuantity(
                name,
                kind,
                mark.word,
                mark.symbol,
                mark.unit,
                _about(owner, name),
                over(owner, name),
                mark.scale,
            )


def shown(owner: type, name: str) -> Label:
    """How an attribute of a result is shown; a `KeyError` if it is not declared as a quantity."""
    mark = declared(owner)[name][1]
    if not isinstance(mark, Label):
        raise KeyError(name)
    return mark


def in_table(owner: type, table: str) -> list[str]:
    """Names of the attributes that have a row in a table, in the order of its rows."""
    names: list[str] = []
    for name, (_, mark) in declared(owner).items():
        if isinstance(mark, Label) and mark.table == table:
            names.insert(names.index(mark.before) if mark.before else len(names), name)
    return names


def over(owner: type, name: str) -> str:
    """The attribute that a curve runs over; empty for that one itself, and for what is no curve."""
    mark = shown(owner, name)
    if not is_array(owner, name):
        return ""
    if not mark.over and mark.shape.strip("(,)") in declared(owner):
        return ""
    first = next(attribute for attribute in declared(owner) if is_array(owner, attribute))
    abscissa = mark.over or first
    is_free = not mark.over and getattr(declared(owner)[first][1], "over", "") == first
    return "" if is_free or abscissa == name else abscissa


def is_array(owner: type, name: str) -> bool:
    """Whether an attribute is an array, where it is not None."""
    return any(get_origin(kind) is np.ndarray for kind in _alternatives(declared(owner)[name][0]))


def declared(owner: type) -> dict[str, tuple[Any, Label | About]]:
    """Type and mark of the declared attributes of a class by name, fields before properties."""
    return _declared(owner)


@cache
def _declared(owner: type) -> dict[str, tuple[Any, Label | About]]:
    hints = get_type_hints(owner, include_extras=True)
    for kind in reversed(owner.__mro__):
        for name, member in vars(kind).items():
            if isinstance(member, property) and member.fget is not None:
                hints[name] = get_type_hints(member.fget, include_extras=True).get("return")
    marks = {}
    for name, hint in hints.items():
        if get_origin(hint) is Annotated:
            mark = next((mark for mark in hint.__metadata__ if isinstance(mark, Label | About)), None)
            if mark is not None:
                marks[name] = (_bound(owner).get(hint.__origin__, hint.__origin__), mark)
    return marks


def _bound(owner: type) -> dict[Any, Any]:
    """What the type variables of a class's generic bases stand for."""
    pairs: dict[Any, Any] = {}
    for base in getattr(owner, "__orig_bases__", ()):
        pairs |= dict(zip(getattr(get_origin(base), "__parameters__", ()), get_args(base), strict=False))
    return pairs


def _about(owner: type, name: str) -> str:
    """What a declaration says beside the words, or the docstring of a property."""
    member = getattr(owner, name, None)
    if isinstance(member, property):
        return " ".join((member.__doc__ or "").split("\n\n")[0].split())
    return declared(owner)[name][1].about


def attributes_section(owner: type) -> str:
    """The docstring's section on the declared attributes, without its head; empty if there are none."""
    return "\n".join(_entry(owner, name) for name in declared(owner))


def _entry(owner: type, name: str) -> str:
    """Name, type and text of one attribute."""
    hint, mark = declared(owner)[name]
    text = _about(owner, name)
    if isinstance(mark, Label):
        words = ", ".join(part for part in (mark.word[0].upper() + mark.word[1:], mark.symbol) if part)
        text = f"{words} [{mark.unit or '–'}]. {text}".rstrip()
    return f"{name} : {_type_words(hint)}{_shape(owner, name)}\n    {text}"


def _shape(owner: type, name: str) -> str:
    """How a docstring says the shape of an array."""
    mark = declared(owner)[name][1]
    if isinstance(mark, About):
        return f", shape {mark.shape}" if mark.shape else ""
    if not is_array(owner, name):
        return ""
    along = over(owner, name)
    if mark.shape or not along:
        return f", shape {mark.shape or '(n,)'}"
    return f", shape as {along}"


def _type_words(hint: Any) -> str:
    """A type as docstrings write it: ``float or None``, ``tuple of str``, ``dict of str to PairForce``."""
    kinds = _alternatives(hint)
    if len(kinds) > 1 or NoneType in get_args(hint):
        optional = " or None" if NoneType in get_args(hint) else ""
        return " or ".join(_type_words(kind) for kind in kinds) + optional
    origin, parts = get_origin(hint), [arg for arg in get_args(hint) if arg is not Ellipsis]
    if origin is np.ndarray:
        return "ndarray"
    if origin is dict:
        return f"dict of {_type_words(parts[0])} to {_type_words(parts[1])}"
    if origin in (tuple, list):
        return f"{origin.__name__} of {' and '.join(dict.fromkeys(_type_words(part) for part in parts))}"
    return str(getattr(hint, "__name__", hint))


def _alternatives(hint: Any) -> tuple[Any, ...]:
    """The types of a union but for None, or the type itself."""
    if get_origin(hint) in (Union, UnionType):
        return tuple(kind for kind in get_args(hint) if kind is not NoneType)
    return (hint,)
