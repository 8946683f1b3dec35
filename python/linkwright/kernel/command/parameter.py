"""A command from a function: what its parameters are on the command line stands at their types.

    def check(words: Annotated[str, Argument("WORD", "A term.")], json: Json = False) -> None:

| type | on the command line |
| --- | --- |
| `bool` | a flag |
| `int`, `float`, `str`, `Path`, or one of them or None | a value |
| `Literal[...]`, an enumeration | one of these words |
| `list[...]`, or that or None | an option that may be given again, an argument that takes all words |

An option marked `Value` is a quantity with its unit, of which the function takes the value in SI. A `Group`
is one parameter of the function and several on the command line, such as a machine file with ``--set``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from enum import Enum
from inspect import Parameter, cleandoc, signature
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, get_args, get_origin, get_type_hints

import click

from linkwright.kernel.command.value import option_value
from linkwright.kernel.errors import cut

if TYPE_CHECKING:
    from linkwright.kernel.reader.out_units import OutUnits
    from linkwright.kernel.units.kinds import Kind
    from linkwright.kernel.units.marks import Quantity

# The largest whole number up to which every one is a float.
_WHOLE_MAX = 2**53

# Where the context of a command keeps the units and the digits that are asked for.
UNITS = "linkwright.units"

# How every command is asked for its help.
HELP = {"help_option_names": ["-h", "--help"]}


class Option(NamedTuple):
    """Mark of a parameter that is an option."""

    name: str  # as it is written, such as `"--json"`
    metavar: str | None = None  # what its value is called in the help
    help: str = ""  # what it does, in sentences
    min: int | None = None  # of a whole number, the smallest
    parser: Callable[[str], Any] | None = None  # makes the value of the word that is given


class Value(NamedTuple):
    """Mark of a parameter that is an option, written as a quantity with its unit; its value is in SI."""

    name: str
    of: Kind | Quantity  # the kind of quantity, and its bounds
    help: str
    default: str | None = None  # as it is written; with one, the parameter of the function has none
    metavar: str = ""  # the last word of the kind without it, such as ANGLE


class Argument(NamedTuple):
    """Mark of a parameter that is given by its place."""

    metavar: str  # what it is called in usage and help
    help: str  # what it is, in sentences
    takes_rest: bool = False  # whether it takes all words from here on, options too


class Group(NamedTuple):
    """Mark of a parameter that is made of several options and arguments."""

    make: Callable[..., Any]  # makes it of their values; their defaults are those of its parameters
    types: Mapping[str, Any] | None = None  # their names and marked types; without, those of `make`


def command(
    function: Callable[..., Any],
    name: str | None = None,
    *,
    shows_quantities: bool = False,
    around: Callable[[Callable[..., Any]], Callable[..., Any]] = lambda run: run,
) -> click.Command:
    """The command that a function is: its parameters are marked, its docstring is the help.

    `name`: that of the function without it; `shows_quantities`: whether there are ``--units`` and
    ``--digits``; `around`: wraps what is called with the values of all options. Options have the order of the
    parameters. A parameter without a mark is a `TypeError`.
    """
    params = [_param(*each) for each in _leaves(function)]

    def run(**given: Any) -> Any:
        return function(**_taken(function, given))

    if shows_quantities:
        params += [_units_option(), _digits_option()]
    about = cleandoc(function.__doc__ or "")
    words = name or function.__name__.replace("_", "-")
    rest = any(parameter.nargs == -1 and parameter.type is click.UNPROCESSED for parameter in params)
    settings: dict[str, Any] = {**HELP, "allow_interspersed_args": not rest}
    return click.Command(words, params=params, help=about, callback=around(run), context_settings=settings)


def _units_option() -> click.Option:
    """``--units``: in which units a command shows its numbers."""
    return click.Option(
        ["--units"],
        metavar="UNITS",
        help='Units of tables, figures and CSV, such as "mm, rpm, kN". Default: those of [units] in the '
        "file, or SI. JSON is always in SI.",
        expose_value=False,
        callback=_keep_units,
    )


def _keep_units(context: click.Context, option: click.Parameter, text: str | None) -> None:
    if text is None:
        return
    from linkwright.kernel.errors import InputError
    from linkwright.kernel.reader.out_units import OutUnits

    try:
        context.meta[UNITS] = replace(_asked(context), chosen=OutUnits.of(text).chosen)
    except InputError as error:
        raise click.UsageError(str(error), context) from None


def _digits_option() -> click.Option:
    """``--digits``: with how many significant digits a command shows its numbers."""
    from linkwright.kernel.reader.out_units import DIGITS, DIGITS_MAX

    return click.Option(
        ["--digits"],
        metavar="N",
        type=click.IntRange(1, DIGITS_MAX),
        help=f"Significant digits of tables and summary. Default: {DIGITS}. JSON and CSV have all.",
        expose_value=False,
        callback=_keep_digits,
    )


def _keep_digits(context: click.Context, option: click.Parameter, digits: int | None) -> None:
    if digits is not None:
        context.meta[UNITS] = replace(_asked(context), digits=digits)


def _asked(context: click.Context) -> OutUnits:
    from linkwright.kernel.reader.out_units import OutUnits

    known: OutUnits = context.meta.get(UNITS) or OutUnits()
    return known


def _marked(make: Callable[..., Any], types: Mapping[str, Any] | None = None) -> Iterator[tuple[Any, ...]]:
    """Parameters of a function or group: its mark, its type, and the parameter with name and default."""
    hints = get_type_hints(make, include_extras=True) if types is None else types
    known = signature(make).parameters
    for name in known if types is None else types:
        marks = getattr(hints[name], "__metadata__", ())
        mark = next((mark for mark in marks if isinstance(mark, Option | Value | Argument | Group)), None)
        if mark is None or get_origin(hints[name]) is not Annotated:
            raise TypeError(f"{name}: its type has no mark Option, Value, Argument or Group")
        yield mark, hints[name].__origin__, known[name]


def _leaves(make: Callable[..., Any], types: Mapping[str, Any] | None = None) -> Iterator[tuple[Any, ...]]:
    for mark, hint, parameter in _marked(make, types):
        if isinstance(mark, Group):
            yield from _leaves(*mark)
        else:
            yield mark, hint, parameter


def _taken(
    make: Callable[..., Any], given: Mapping[str, Any], types: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    taken = {}
    for mark, _, parameter in _marked(make, types):
        name = parameter.name
        if isinstance(mark, Group):
            taken[name] = mark.make(**_taken(mark.make, given, mark.types))
        else:
            is_text = isinstance(mark, Value) and given[name] is not None
            taken[name] = option_value(mark.name, given[name], mark.of) if is_text else given[name]
    return taken


def _param(mark: Option | Value | Argument, hint: Any, parameter: Parameter) -> click.Parameter:
    if isinstance(mark, Value):
        from linkwright.kernel.units.kinds import Kind

        kind = mark.of if isinstance(mark.of, Kind) else mark.of.kind
        metavar = mark.metavar or kind.noun.split()[-1].upper()
        return click.Option(
            [parameter.name, mark.name],
            metavar=metavar,
            help=mark.help,
            default=mark.default,
            show_default=mark.default is not None,
            required=parameter.default is Parameter.empty and mark.default is None,
        )
    kind, several = _kind(hint)
    optional = parameter.default is not Parameter.empty
    given: dict[str, Any] = {"callback": _list} if several else {}
    if optional and not several:
        given["default"] = parameter.default
    if isinstance(mark, Argument):
        given |= {"nargs": -1} if several else {}
        return click.Argument(
            [parameter.name],
            type=click.UNPROCESSED if mark.takes_rest else _converter(kind, None),
            metavar=mark.metavar,
            help=mark.help,
            required=not optional,
            **given,
        )
    given |= {"is_flag": True} if kind is bool else {"type": mark.parser or _converter(kind, mark.min)}
    return click.Option(
        [parameter.name, mark.name],
        metavar=mark.metavar,
        help=mark.help,
        show_default=parameter.default not in (None, ""),
        multiple=several,
        required=not optional,
        **given,
    )


def _kind(hint: Any) -> tuple[Any, bool]:
    if NoneType in get_args(hint):
        hint = next(arg for arg in get_args(hint) if arg is not NoneType)
    return (get_args(hint)[0], True) if get_origin(hint) is list else (hint, False)


def _converter(kind: Any, low: int | None) -> Any:
    if get_origin(kind) is Literal:
        return click.Choice(get_args(kind))
    if isinstance(kind, type) and issubclass(kind, Enum):
        return click.Choice(kind)
    if kind is Path:
        return click.Path(path_type=Path)
    if kind is float:
        return _Real()
    return _Whole(low) if kind is int else kind


class _Real(click.types.FloatParamType):
    # In the sentence of click on a word that is none.
    name = "number"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        number = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"found {cut(str(value))}, expected a finite number", param, ctx)
        return number


class _Whole(click.IntRange):
    """A whole number that is a float too: limits are compared with it, and no count is larger."""

    # In the sentence of click on a word that is none.
    name = "whole number"

    def __init__(self, low: int | None) -> None:
        super().__init__(min=low)

    def _describe_range(self) -> str:
        return "" if self.min is None else super()._describe_range()

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        number = super().convert(value, param, ctx)
        if abs(number) > _WHOLE_MAX:
            self.fail(
                f"found a whole number of {len(str(abs(number)))} digits, expected a smaller one", param, ctx
            )
        return number


def _list(context: click.Context, parameter: click.Parameter, values: tuple[Any, ...]) -> list[Any] | None:
    """What was given for several values; None where nothing was."""
    return list(values) or None
