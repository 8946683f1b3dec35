"""What every result can do: give its scalars and curves by name, and a table."""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import Field, fields, is_dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, get_args, get_type_hints

import numpy as np

from linkwright.kernel.public import public
from linkwright.kernel.quantities import Label, attributes_section, declared, quantities_of

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


# What a table in a result may hold to be written out.
_PLAIN = (bool, int, float, str, tuple, dict)


class _Docstring:
    """A docstring to which the declared attributes are added when it is asked for."""

    def __init__(self, text: str) -> None:
        self.text = text

    def __get__(self, instance: object, owner: type) -> str:
        """The text with its section ``Attributes``, before its other sections."""
        # The decorator `dataclass` asks whether there is a text, before the class is finished.
        if "__match_args__" not in vars(owner):
            return self.text
        section = attributes_section(owner)
        if not section:
            return self.text
        text = inspect.cleandoc(self.text)
        start = _SECTION.search(text)
        head, rest = (text[: start.start()], text[start.start() :]) if start else (text, "")
        return f"{head.rstrip()}\n\nAttributes\n----------\n{section}\n\n{rest}".rstrip() + "\n"


# The head of a section of a docstring.
_SECTION = re.compile(r"^\w[\w ]*\n-{3,}$", re.MULTILINE)


class PlainRecord:
    """Base of frozen dataclasses that are equal if all their entries are, arrays number by number.

    They show themselves by their entries, what is long by its size.
    """

    def __init_subclass__(cls, **options: Any) -> None:
        """Compare and show as all of them do: `dataclass` leaves what a class itself has."""
        super().__init_subclass__(**options)
        for name in ("__eq__", "__repr__"):
            if name not in vars(cls):
                setattr(cls, name, vars(PlainRecord)[name])

    def __eq__(self, other: object) -> bool:
        """Whether all entries are equal; numbers that are none equal each other."""
        if type(other) is not type(self):
            return NotImplemented
        return _equal_entries(self, other)

    def __repr__(self) -> str:
        """The class with its entries."""
        names = [entry.name for entry in _fields(self) if entry.repr]
        entries = (f"{name}={_in_short(getattr(self, name))}" for name in names)
        return f"{type(self).__name__}({', '.join(entries)})"


class Record(PlainRecord):
    """Base of dataclasses whose attributes are declared where they stand (`linkwright.kernel.quantities`)."""

    def __init_subclass__(cls, **options: Any) -> None:
        """Let the docstring tell the declared attributes."""
        super().__init_subclass__(**options)
        cls.__doc__ = _Docstring(vars(cls).get("__doc__") or "")  # type: ignore[assignment]

    @public
    def unit_of(self, name: str) -> str:
        """SI unit of an attribute or a curve by its name; empty if it has none."""
        _, mark = declared(type(self)).get(name, (None, None))
        return mark.unit if isinstance(mark, Label) else ""


def _fields(record: Any) -> tuple[Field[Any], ...]:
    return fields(record)


def _equal_entries(one: Any, other: Any) -> bool:
    """Whether two dataclasses of one type have equal entries."""
    names = [entry.name for entry in _fields(one) if entry.compare]
    return all(_equal(getattr(one, name), getattr(other, name)) for name in names)


def _equal(one: Any, other: Any) -> bool:
    """Whether two entries of records are equal, arrays inside of tables as well."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        kinds = np.asarray(one).dtype.kind + np.asarray(other).dtype.kind
        return bool(np.array_equal(one, other, equal_nan=set(kinds) <= set("fc")))
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(_equal(entry, other[key]) for key, entry in one.items())
    if isinstance(one, tuple | list) and type(one) is type(other):
        return len(one) == len(other) and all(map(_equal, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return one == other or (math.isnan(one) and math.isnan(other))
    if is_dataclass(one) and type(one) is type(other):
        return one is other or _equal_entries(one, other)
    return bool(one == other)


# Numbers of an array, entries of a table and letters that are shown.
_SHOWN_NUMBERS, _SHOWN_ENTRIES, _SHOWN_LETTERS = 12, 8, 300


def _in_short(entry: Any) -> str:
    """An entry of a record; of what is long its kind and size."""
    if isinstance(entry, np.ndarray):
        return repr(entry) if entry.size <= _SHOWN_NUMBERS else f"<{entry.dtype} {entry.shape}>"
    kind = type(entry).__name__
    if isinstance(entry, Mapping | tuple | list) and len(entry) > _SHOWN_ENTRIES:
        return f"<{kind} of {len(entry)}>"
    text = repr(entry)
    return text if len(text) <= _SHOWN_LETTERS else f"<{kind}>"


class Result(Record):
    """Base of the frozen results of analyses: dataclasses of SI scalars, tables (tuples) and arrays.

    Arrays whose length is that of the first array are the result's curves.
    """

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Scalars and tables by name, with ``curves`` also the arrays as lists.

        Parameters
        ----------
        curves : bool
            Whether arrays are included.

        Returns
        -------
        dict
            Plain numbers, texts and lists, ready for JSON.
        """
        tree: dict[str, Any] = {}
        for name, value in self._entries().items():
            if isinstance(value, np.ndarray):
                if curves:
                    tree[name] = value.tolist()
            elif isinstance(value, tuple):
                if all(x is None or isinstance(x, _PLAIN) for x in value):
                    tree[name] = list(value)
            elif isinstance(value, np.generic):
                tree[name] = value.item()
            elif value is None or isinstance(value, bool | int | float | str):
                tree[name] = value
        return tree

    def parts_by_name(self) -> dict[str, dict[str, float | None]]:
        """Numbers of named parts: those of shape ``"(shafts,)"`` by the names in the attribute ``shafts``."""
        tree: dict[str, dict[str, float | None]] = {}
        for name, (_, mark) in declared(type(self)).items():
            kind = mark.shape[1:-2] if isinstance(mark, Label) and mark.shape.endswith(",)") else ""
            names = getattr(self, kind, None) if kind else None
            if isinstance(names, tuple):
                values = getattr(self, name).tolist()
                tree[name] = {
                    part: value if np.isfinite(value) else None
                    for part, value in zip(names, values, strict=True)
                }
        return tree

    def to_frame(self) -> pd.DataFrame:
        """The curves as a table, one column each.

        Returns
        -------
        pandas.DataFrame
            Columns by name, SI.

        Raises
        ------
        InputError
            pandas is not installed, an extra; the message has the command that installs it.
        """
        from linkwright.kernel.extras import require

        require("pandas", "frame", "to_frame needs pandas")
        import pandas as pd

        return pd.DataFrame(self.curves())

    def plot(self, *names: str) -> Figure:
        """The curves as a figure, an axis for each unit.

        Parameters
        ----------
        *names : str
            Names of `curves`, such as ``"speed"``; without any, `usual_curves`.

        Returns
        -------
        matplotlib.figure.Figure
            A notebook shows it; ``figure.savefig(path)`` writes it.

        Raises
        ------
        InputError
            There is no such curve.
        """
        from linkwright.kernel.figure.plotted import plotted

        return plotted(self, names)

    def _repr_html_(self) -> str:
        """The scalars as a table, as a notebook shows them."""
        from linkwright.kernel.page.notebook import result_html

        return result_html(self)

    def curves(self) -> dict[str, np.ndarray]:
        """The arrays of common length by name."""
        arrays = {name: value for name, value in self._entries().items() if isinstance(value, np.ndarray)}
        length = len(next(iter(arrays.values()))) if arrays else 0
        return {name: value for name, value in arrays.items() if value.shape == (length,)}

    def usual_curves(self) -> list[str]:
        """Names of the curves that `plot` draws without names: attributes, or if there are none all."""
        curves = self.curves()
        own = [quantity.name for quantity in quantities_of(type(self)) if quantity.over]
        return [name for name in own if name in curves] or list(curves)[1:]

    def shown_rows(self) -> Iterator[tuple[str, str, float | tuple[float, float], str]]:
        """What a notebook shows beside the scalars: words, symbol, a number or a range of numbers, unit."""
        return iter(())

    def columns(self) -> dict[str, np.ndarray]:
        """Curves of the result's parts, named with their unit such as ``A_x [N]``; none for most."""
        return {}

    @public
    def word_of(self, name: str, word: str) -> str:
        """What a quantity is called in this result; `word`: as it is declared."""
        return word

    def _entries(self) -> dict[str, Any]:
        """Fields and properties in the order of their definition."""
        names = [field.name for field in fields(self)]  # type: ignore[arg-type]
        for kind in reversed(type(self).__mro__):
            names += [name for name, member in vars(kind).items() if isinstance(member, property)]
        return {name: getattr(self, name) for name in dict.fromkeys(names) if not name.startswith("_")}


@cache
def result_within(owner: type, name: str) -> type[Result] | None:
    """The kind of result that an attribute of a result is; None if it is none."""
    hint = get_type_hints(owner).get(name)
    kinds = (kind for kind in (hint, *get_args(hint)) if isinstance(kind, type) and issubclass(kind, Result))
    return next(kinds, None)


def finite(value: Any) -> Any:
    """The same tree, with lists for tuples and None in place of numbers that JSON does not know."""
    if isinstance(value, Mapping):
        return {key: finite(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [finite(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
