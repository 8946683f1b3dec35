"""Rows of a study as shares between 0 and 1, each a function of its number: any part can be drawn alone.

| method | row i of n |
| --- | --- |
| grid | digits of i in the numbers of levels, the last variable first |
| sobol | point i of the scrambled Sobol sequence [1]_ |
| latin_hypercube | in each variable, one row in each of n strata, at a random place in it [2]_ |
| random | independent |

Random numbers are those of the counter-based generator Philox [3]_: number i needs none before it.

References
----------
.. [1] Joe, Kuo, *Constructing Sobol sequences with better two-dimensional projections*, SIAM J. Sci. Comput.
   30 (2008) 2635; scrambled as Matoušek, J. Complexity 14 (1998) 527, by SciPy.
.. [2] McKay, Beckman, Conover, *A comparison of three methods for selecting values of input variables*,
   Technometrics 21 (1979) 239.
.. [3] Salmon et al., *Parallel random numbers: as easy as 1, 2, 3*, SC 2011.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from linkwright.kernel.arrays import Floats, Integers

# Numbers that Philox gives a step of its counter.
_BLOCK = 4


def grid(levels: Sequence[Floats], start: int, stop: int) -> Floats:
    """Rows of all combinations of some levels, the last variable fastest, (stop - start, variables)."""
    index = np.arange(start, stop)
    shares = np.empty((stop - start, len(levels)))
    for column in reversed(range(len(levels))):
        index, place = np.divmod(index, len(levels[column]))
        shares[:, column] = levels[column][place]
    return shares


def random(n_variables: int, seed: int, start: int, stop: int) -> Floats:
    """Independent rows, (stop - start, variables)."""
    columns = [_uniform(seed, column, start, stop) for column in range(n_variables)]
    return np.stack(columns, axis=1) if columns else np.empty((stop - start, 0))


def latin_hypercube(n_variables: int, rows: int, seed: int, start: int, stop: int) -> Floats:
    """Rows of which each of ``rows`` strata of every variable holds one, (stop - start, variables)."""
    within = random(n_variables, seed, start, stop)
    for column in range(n_variables):
        within[:, column] += _strata(rows, seed, column)[start:stop]
    return np.minimum(within / rows, _LAST)


def sobol(n_variables: int, seed: int, start: int, stop: int) -> Floats:
    """Points of the scrambled Sobol sequence, (stop - start, variables)."""
    from scipy.stats.qmc import Sobol

    # Of 30 bits, which are enough for all rows of the largest sweep.
    sequence = Sobol(n_variables, scramble=True, bits=30, rng=np.random.default_rng([seed, n_variables]))
    if start:
        sequence.fast_forward(start)
        return sequence.random(stop - start)
    # One first: rows that are no power of two are known to be less even, which is no cause for a warning.
    return np.vstack([sequence.random(1), sequence.random(max(stop - 1, 0))])[:stop]


# A share of 1 would be the next stratum.
_LAST = 1.0 - 2.0**-53


def _uniform(seed: int, column: int, start: int, stop: int) -> Floats:
    """Numbers ``start`` to ``stop`` of the stream of a column."""
    stream = np.random.Philox(key=[seed, column])
    stream.advance(start // _BLOCK)
    skipped = start % _BLOCK
    return np.random.Generator(stream).random(stop - start + skipped)[skipped:]


@lru_cache(maxsize=64)
def _strata(rows: int, seed: int, column: int) -> Integers:
    # The streams of the places in the strata have the numbers of the columns.
    stream = np.random.Generator(np.random.Philox(key=[seed, (1 << 32) + column]))
    return stream.permutation(rows).astype(np.int32)
