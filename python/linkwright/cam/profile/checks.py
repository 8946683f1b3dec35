"""Arrays that belong together, brought to one length."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.kernel.errors import ShapeError

Floats = NDArray[np.float64]


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
        The lengths differ, or an array is empty or has more than one dimension.
    """
    arrays = {name: np.asarray(value, dtype=float) for name, value in values.items()}
    shapes = {name: array.shape for name, array in arrays.items() if array.shape != ()}
    if any(len(shape) > 1 or not shape[0] for shape in shapes.values()) or len(set(shapes.values())) > 1:
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise ShapeError(f"found arrays of shapes {listed}; expected lists of one length, not empty")
    shape = next(iter(shapes.values()), (1,))
    return {name: np.broadcast_to(array, shape).copy() for name, array in arrays.items()}
