"""NumPy's arrays by what they hold, as signatures and fields name them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Bools = NDArray[np.bool_]
# Positions in other arrays.
Indices = NDArray[np.intp]
# What crosses the border to the core: slots, discs, rows.
Integers = NDArray[np.int32]
