"""What public functions have in common: arguments checked by name, and results that stay as they are.

| module | |
| --- | --- |
| `arguments` | What the public functions take |
| `immutable` | Descriptions and results that stay as they are |
| `in_range` | Numbers that are given to a function |
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from itertools import zip_longest
from typing import Any, ParamSpec, TypeVar

from linkwright.kernel.public.arguments import checks_of
from linkwright.kernel.public.immutable import freeze, keep

P = ParamSpec("P")
R = TypeVar("R")


T = TypeVar("T")


def public_type(kind: type[T]) -> type[T]:
    """Check what a frozen dataclass, such as users make themselves, is made of by its annotations."""
    keep(kind)
    kind.__init__ = public(kind.__init__)  # type: ignore[method-assign]
    return kind


def public(function: Callable[P, R]) -> Callable[P, R]:
    """Check the arguments of a function by its annotations, and freeze what it returns."""
    code = function.__code__
    names = code.co_varnames[: code.co_argcount]
    checks = checks_of(function)

    @wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> R:
        # Arguments that are too many are the function's own business.
        given: list[Any] = [
            checks[name](name, value) if name in checks else value
            for name, value in zip_longest(names[: len(args)], args, fillvalue="")
        ]
        named: dict[str, Any] = {
            name: checks[name](name, value) if name in checks else value for name, value in kwargs.items()
        }
        result = function(*given, **named)
        freeze(result)
        return result

    return checked
