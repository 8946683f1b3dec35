"""Inputs that make no sense, told by name, with what was found and what belongs there."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.errors import InputError, ShapeError

Floats = NDArray[np.float64]


def positive(**values: ArrayLike) -> None:
    """Raise unless every number is finite and greater than zero.

    Parameters
    ----------
    **values : array_like, shape (...)
        By the name that the message shall have.

    Raises
    ------
    InputError
        One is not.
    """
    _each(values.items(), "a finite number greater than 0", lambda x: np.isfinite(x) & (x > 0))


def not_negative(**values: ArrayLike) -> None:
    """Raise unless every number is finite and zero or more.

    Parameters
    ----------
    **values : array_like, shape (...)
        By the name that the message shall have.

    Raises
    ------
    InputError
        One is not.
    """
    _each(values.items(), "a finite number of 0 or more", lambda x: np.isfinite(x) & (x >= 0))


def finite(**values: ArrayLike) -> None:
    """Raise unless every number is finite.

    Parameters
    ----------
    **values : array_like, shape (...)
        By the name that the message shall have.

    Raises
    ------
    InputError
        One is not.
    """
    _each(values.items(), "a finite number", np.isfinite)


def _each(values: Iterable[tuple[str, ArrayLike]], expected: str, sound: object) -> None:
    """Raise for the first number that is not sound."""
    assert callable(sound)
    for name, value in values:
        numbers = np.asarray(value, dtype=float)
        wrong = np.flatnonzero(~sound(numbers))
        if len(wrong):
            place = f" at index {wrong[0]}" if numbers.ndim else ""
            raise InputError(f"{name}: found {numbers.flat[wrong[0]]:g}{place}, expected {expected}")


def alike(**values: ArrayLike) -> dict[str, Floats]:
    """Arrays of one length; a single number stands for all places.

    Parameters
    ----------
    **values : array_like, shape (n,) or ()
        By name.

    Returns
    -------
    dict of str to ndarray, shape (n,)
        By name.

    Raises
    ------
    ShapeError
        The lengths differ, or an array has more than one dimension.
    """
    arrays = {name: np.asarray(value, dtype=float) for name, value in values.items()}
    shapes = {name: array.shape for name, array in arrays.items() if array.shape != ()}
    if any(len(shape) > 1 for shape in shapes.values()) or len(set(shapes.values())) > 1:
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise ShapeError(f"found arrays of shapes {listed}; expected one length for all")
    shape = next(iter(shapes.values()), (1,))
    return {name: np.broadcast_to(array, shape).copy() for name, array in arrays.items()}
