r"""What a record tells of numbers: the singular directions of its derivatives.

With derivatives J over the noise, each column times the scale of its number,

.. math:: J = U S V^T, \qquad \sigma_k = 1 / S_k

is the standard deviation, as a share of the scales, of the combination of numbers along column k of V [1]_.

References
----------
.. [1] Golub and Van Loan, Matrix Computations, 4th ed. 2013, section 5.5; Bates and Watts, Nonlinear
   Regression Analysis, 1988, section 2.2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.studies.fit_parameters import Number

# A combination that the record knows no better than to its own size is not determined.
_WEAK = 1.0

# Parts of a direction, as a share of its largest, that a message lists.
_PART = 0.02


@dataclass(frozen=True)
class Direction:
    """A combination of numbers that a record determines by itself.

    Attributes
    ----------
    parts : dict of str to float
        Change of each number along it, as a share of its scale; the largest is 1.
    deviation : float
        Standard deviation along it, as a share of the scales; infinite where the record says nothing.
    effect : float
        Root mean square change of the record, over its noise, for one hundredth along it.
    words : str
        The same in words.
    """

    parts: dict[str, float]
    deviation: float
    effect: float
    words: str

    @property
    def is_determined(self) -> bool:
        """Whether the record knows it better than to its own size."""
        return self.deviation < _WEAK


def covariance(J: Floats, rounding: float) -> Floats:
    """Covariance (numbers, numbers) by derivatives over the noise (n, numbers); infinite on the diagonal
    for what the record does not tell, up to `rounding`, a share of the largest singular value.
    """
    _, S, V = np.linalg.svd(J, full_matrices=False)
    kept = rounding * S[0] < S
    matrix: Floats = (V[kept].T / S[kept] ** 2) @ V[kept]
    is_open = (V[~kept] ** 2).sum(axis=0) > _OPEN
    matrix[np.diag_indices(len(matrix))] = np.where(is_open, np.inf, np.diag(matrix))
    return matrix


# Part of a number in what the record does not tell from which on it is open itself.
_OPEN = 1e-8


def singular_directions(J: Floats, numbers: Sequence[Number], rounding: float) -> tuple[Direction, ...]:
    """Combinations of numbers from the one known worst to the one known best, by the same derivatives."""
    _, S, V = np.linalg.svd(J, full_matrices=False)
    directions = []
    for size, way in zip(S[::-1], V[::-1], strict=True):
        unit = way / way[int(np.abs(way).argmax())]
        parts = {n.name: float(x) for n, x in zip(numbers, unit, strict=True) if abs(x) > _PART}
        length = float(np.linalg.norm(unit))
        is_open = size <= rounding * S[0]
        deviation = np.inf if is_open else float(1 / (size * length))
        effect = 0.01 * float(size) * length / float(np.sqrt(len(J)))
        directions.append(Direction(parts, deviation, effect, _words(numbers, parts, deviation, effect)))
    return tuple(directions)


def _words(numbers: Sequence[Number], parts: dict[str, float], deviation: float, effect: float) -> str:
    scales = {number.name: number for number in numbers}
    listed = " and ".join(
        f"{_change(scales[name], share)} {'more' if share > 0 else 'less'} {name}"
        for name, share in parts.items()
    )
    if deviation < _WEAK:
        known = "is" if len(parts) == 1 else "together are"
        return f"{listed} {known} known to ±{100 * deviation:.2g} % (standard deviation)"
    together = " together" if len(parts) > 1 else ""
    return (
        f"{listed}{together} would change the record by {effect:.2g} of its noise: the record does not "
        f"determine {'them' if len(parts) > 1 else 'it'}"
    )


def _change(number: Number, share: float) -> str:
    """One hundredth of the scale of a number times a share: per cent of its value, or in its unit."""
    if number.scale == abs(number.start):
        return f"{abs(share):.3g} %"
    return f"{0.01 * abs(share) * number.scale:.3g} {number.unit}".rstrip()
