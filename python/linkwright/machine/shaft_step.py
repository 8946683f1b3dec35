r"""What a step of a shaft adds to the thinner side: the thicker one does not turn as a whole at the step.

The torque comes out of the thinner side into the middle of the thicker one, which yields there. The step
counts as a further length of the thinner side, a share λ of its diameter, by the ratio of the diameters:

| D/d | 1 | 1.25 | 1.5 | 2 | 3 | ∞ |
| --- | --- | --- | --- | --- | --- | --- |
| λ | 0 | 0.055 | 0.085 | 0.100 | 0.107 | 0.125 |

References
----------
.. [1] Nestorides, A Handbook on Torsional Vibration, 1958, part 2: junction effects.
"""

from __future__ import annotations

import numpy as np

# Over d/D, so that a step to a body without end is a point of the table too.
_RATIO = (0.0, 1 / 3, 1 / 2, 1 / 1.5, 1 / 1.25, 1.0)
_SHARE = (0.125, 0.107, 0.100, 0.085, 0.055, 0.0)


def step_length(thin: float, thick: float, fillet: float = 0.0) -> float:
    """Length of the thinner side that a step adds [m].

    Parameters
    ----------
    thin, thick : float
        Diameters on its two sides [m].
    fillet : float
        Radius in the corner [m].
    """
    return thin * float(np.interp(thin / thick, _RATIO, _SHARE))
