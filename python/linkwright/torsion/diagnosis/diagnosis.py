r"""Which cylinder is weak: the share of each in a measured speed, by least squares on orders.

The speed of a disc has the harmonics

.. math:: y_\nu = b_\nu + \sum_c x_c H_{c\nu} + e_\nu

with :math:`H_{c\nu}` the response of the train to what the firing of cylinder c adds to its torque,
:math:`b_\nu` all the rest (inertia, compression, loads) and e noise. :math:`x_c = 1` is healthy, 0 a cylinder
that does not fire. Real and imaginary parts over their noise are the equations of a linear least-squares
problem with real x,

.. math:: \hat x = (A^T A)^{-1} A^T y, \qquad \mathrm{cov}\, \hat x = \sigma^2 (A^T A)^{-1}

where σ = 1 for noise that is known, else estimated from what is left over. Cylinders with parallel columns of
A act alike on this disc at these orders, and only their sum can be determined.

H is that of the elastic train. A train taken as rigid has
:math:`H = i\nu\Omega \sum M/(-(\nu\Omega)^2 \sum J)` in its place, the same at every disc, and gives other
x: by how much is what neglecting torsion costs.

References
----------
.. [1] Taraza, Henein and others, Determination of the gas-pressure torque of a multicylinder engine from
   measurements of the crankshaft's speed variation, SAE, 1998.
.. [2] Taraza, Henein and others, Diesel engine diagnosis based on analysis of the crankshaft's speed
   variation, SAE, 1998.
.. [3] Golub and Van Loan, Matrix Computations, 4th ed. 2013, section 5.5: least squares by singular values.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Bools, Complexes, Floats, Indices
from linkwright.kernel.errors import InputError, ShapeError
from linkwright.kernel.numerics.confidence import coverage_factor
from linkwright.kernel.numerics.least_squares import Fit, least_squares
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.torsion.diagnosis.engine_speed import cylinder_response, lines_of_orders
from linkwright.torsion.diagnosis.measured_speed import MeasuredSpeed
from linkwright.torsion.excitation.excited_train import ExcitedTrain


@dataclass(frozen=True)
class Diagnosis(Result):
    """How strongly each cylinder fires."""

    cylinders: Annotated[tuple[str, ...], About("Names of the cylinders.")]
    factor: Annotated[
        Floats,
        Label(
            "firing part over that of a healthy cylinder",
            "",
            "–",
            "1 where it cannot be determined.",
            shape="(cylinders,)",
        ),
    ]
    deviation: Annotated[
        Floats,
        Label(
            "standard deviation of the factor",
            "",
            "–",
            "Infinite where it cannot be determined.",
            shape="(cylinders,)",
        ),
    ]
    covariance: Annotated[
        Floats,
        Label(
            "covariance of the factors",
            "",
            "–",
            "As far as they can be determined.",
            shape="(cylinders, cylinders)",
            over="covariance",
        ),
    ]
    condition: Annotated[
        float,
        Label(
            "largest over smallest singular value",
            "",
            "–",
            "Infinite where cylinders cannot be distinguished.",
        ),
    ]
    misfit: Annotated[
        float,
        About(
            "Residual per degree of freedom, relative to the noise if known, otherwise in rad/s; NaN "
            "without a degree of freedom."
        ),
    ]
    freedom: Annotated[int, About("Number of equations minus number of determined factors.")]
    is_noise_known: Annotated[bool, About("Whether the noise was given, or estimated.")]
    warnings: Annotated[tuple[str, ...], About("Limitations of the diagnosis.")]
    delay: Annotated[
        Floats | None,
        Label(
            "crank angle by which the combustion is late",
            "",
            "rad",
            "None if the measured orders do not determine it.",
            shape="(cylinders,)",
        ),
    ] = None
    delay_deviation: Annotated[
        Floats | None,
        Label("standard deviation of the delay", "", "rad", "Likewise.", shape="(cylinders,)"),
    ] = None
    compression: Annotated[
        Floats | None,
        Label(
            "torque of compression and expansion over that of a tight cylinder",
            "",
            "–",
            "Likewise.",
            shape="(cylinders,)",
        ),
    ] = None
    compression_deviation: Annotated[
        Floats | None,
        Label("standard deviation of the compression", "", "–", "Likewise.", shape="(cylinders,)"),
    ] = None

    @public
    def half_width(self, level: float = 0.95) -> Floats:
        """Half width of the interval about each factor.

        Parameters
        ----------
        level : float
            Probability that it holds the truth, for each cylinder by itself.

        Returns
        -------
        ndarray, shape (cylinders,)
        """
        return self.coverage(level) * self.deviation

    @public
    def coverage(self, level: float) -> float:
        """Half width of an interval over the standard deviation.

        Parameters
        ----------
        level : float
            Probability that it holds the truth.
        """
        return self._coverage(level)

    def _coverage(self, level: float) -> float:
        return coverage_factor(level, None if self.is_noise_known else self.freedom)

    @public
    def weak(self, level: float = 0.95) -> tuple[str, ...]:
        """Cylinders that fire less than a healthy one, the weakest first.

        Parameters
        ----------
        level : float
            Probability that the intervals of all cylinders hold the truth together, in strength, delay and
            compression where these are estimated; shared out to them (Bonferroni). None is then named in a
            healthy engine, with this probability or a larger one.

        Returns
        -------
        tuple of str
            Those whose intervals lie below 1.
        """
        return self._below(self.factor - 1, self.deviation, level)

    @public
    def late(self, level: float = 0.95) -> tuple[str, ...]:
        """Cylinders that fire late, the latest first; none where the measurement says nothing of it.

        Parameters
        ----------
        level : float
            As of `weak`.

        Returns
        -------
        tuple of str
            Those whose intervals lie above 0.
        """
        if self.delay is None or self.delay_deviation is None:
            return ()
        return self._below(-self.delay, self.delay_deviation, level)

    @public
    def early(self, level: float = 0.95) -> tuple[str, ...]:
        """Cylinders that fire early, the earliest first; none where the measurement says nothing of it.

        Parameters
        ----------
        level : float
            As of `weak`.

        Returns
        -------
        tuple of str
            Those whose intervals lie below 0.
        """
        if self.delay is None or self.delay_deviation is None:
            return ()
        return self._below(self.delay, self.delay_deviation, level)

    @public
    def leaking(self, level: float = 0.95) -> tuple[str, ...]:
        """Cylinders that compress less than a tight one, the worst first; none where nothing is said of it.

        Parameters
        ----------
        level : float
            As of `weak`.

        Returns
        -------
        tuple of str
            Those whose intervals lie below 1.
        """
        if self.compression is None or self.compression_deviation is None:
            return ()
        return self._below(self.compression - 1, self.compression_deviation, level)

    def _below(self, value: Floats, deviation: Floats, level: float) -> tuple[str, ...]:
        intervals = len(self.cylinders) * (1 if self.delay is None else 3)
        single = 1 - (1 - level) / intervals
        below = value + self._coverage(single) * deviation < 0
        return tuple(self.cylinders[n] for n in np.argsort(value) if below[n])

    @property
    def is_refuted(self) -> bool:
        """Whether more is left over than the known noise explains."""
        # A misfit has the mean 1 and the deviation 1/√(2f); three of them are rare.
        return bool(self.is_noise_known and self.misfit > 1 + 3 / np.sqrt(2 * max(self.freedom, 1)))

    @property
    def relative(
        self,
    ) -> Annotated[Floats, Label("factor over the mean of the factors", "", "–", shape="(cylinders,)")]:
        """For an engine whose load is not known."""
        relative: Floats = self.factor / self.factor.mean()
        return relative


# Cosine between responses from which on two cylinders are called alike.
_ALIKE = 0.99
# Orders that differ by a smaller share are one.
_EQUAL = 1e-9


def diagnosis(
    at: ExcitedTrain,
    sources: Complexes,
    measured: MeasuredSpeed,
    cylinders: Sequence[str] | None = None,
    *,
    rigid: bool = False,
) -> Diagnosis:
    """Factors of the cylinders from a measured speed. `sources`: (cylinders, orders, discs) [N m]."""
    names = _names(at, sources, cylinders)
    sources, at = sources[:, at.torques.offsets == 0], lines_of_orders(at)
    rest = at.torques.harmonics[:, :, 0] - sources.sum(axis=0)
    every = cylinder_response(at, np.concatenate([sources, rest[None]]), measured.disc, rigid=rigid)
    columns = every[:, places(at.torques.orders, measured)]
    A = equations(columns[:-1], measured).T
    # What is sought is how far factors are from 1, so that what cannot be determined stays healthy.
    y = equations(measured.harmonics - columns.sum(axis=0), measured)
    return diagnosed(least_squares(A, y, is_known=measured.noise is not None), A, names, measured)


def equations(harmonics: Complexes, measured: MeasuredSpeed) -> Floats:
    """Real and imaginary parts over their noise, (..., 2 orders), of harmonics (..., orders) [rad/s]."""
    scaled = harmonics if measured.noise is None else harmonics / measured.noise
    rows: Floats = np.concatenate([scaled.real, scaled.imag], axis=-1)
    return rows


def diagnosed(fit: Fit, A: Floats, names: tuple[str, ...], measured: MeasuredSpeed) -> Diagnosis:
    """What a fit says of the cylinders. `A`: (equations, parameters) its equations."""
    is_known = measured.noise is not None
    if not is_known and fit.freedom < 1:
        remedy = f"measure more than {len(names) / 2:.4g} orders, or give the noise"
        raise InputError(
            f"{len(measured.orders)} orders for {len(names)} cylinders leave no residual to "
            f"estimate the noise from: {remedy}"
        )
    n, (delay, compression) = len(names), _delay_and_compression(fit, len(names))
    diagnosis = Diagnosis(
        cylinders=names,
        factor=np.where(fit.is_open[:n], 1.0, 1 + fit.values[:n]),
        deviation=fit.deviation[:n],
        covariance=fit.covariance[:n, :n],
        condition=fit.condition,
        misfit=fit.misfit,
        freedom=fit.freedom,
        is_noise_known=is_known,
        warnings=(),
        delay=delay[0],
        delay_deviation=delay[1],
        compression=None if compression[0] is None else 1 + compression[0],
        compression_deviation=compression[1],
    )
    return replace(diagnosis, warnings=tuple(_warnings(diagnosis, A[:, :n], fit.is_open[:n])))


def _delay_and_compression(fit: Fit, n: int) -> list[tuple[Floats, Floats] | tuple[None, None]]:
    if len(fit.values) == n:
        return [(None, None), (None, None)]
    return [(fit.values[at : at + n], fit.deviation[at : at + n]) for at in (n, 2 * n)]


def _warnings(diagnosis: Diagnosis, A: Floats, open_part: Bools) -> list[str]:
    names = np.array(diagnosis.cylinders)
    listed = []
    if open_part.any():
        listed.append(
            f"cylinders {', '.join(names[open_part])} cannot be distinguished by these orders at this disc"
        )
    size = np.linalg.norm(A, axis=0)
    product = np.outer(size, size)
    cosine = np.abs(A.T @ A) / np.where(product > 0, product, 1.0)
    for a, b in np.argwhere(np.triu(cosine > _ALIKE, k=1)):
        if not (open_part[a] and open_part[b]):
            listed.append(
                f"cylinders {names[a]} and {names[b]} have parallel responses (cosine {cosine[a, b]:.4f})"
            )
    blind = ~open_part & (diagnosis.half_width() > 1)
    if blind.any():
        listed.append(f"cylinders {', '.join(names[blind])}: even a misfire would be hidden by the noise")
    if diagnosis.is_refuted:
        listed.append(
            f"the residual is {diagnosis.misfit:.3g} times the noise: the train or its torques differ "
            "from the file"
        )
    return listed


def _names(at: ExcitedTrain, sources: Complexes, cylinders: Sequence[str] | None) -> tuple[str, ...]:
    if len(at.torques.speeds) != 1:
        speeds = len(at.torques.speeds)
        raise InputError(f"a diagnosis is made at one speed, and the train is at {speeds}")
    wanted = at.torques.harmonics.shape[:2]
    if sources.ndim != 3 or sources.shape[1:] != wanted or not len(sources):
        raise ShapeError(
            f"sources have the shape {sources.shape}, expected (cylinders, {wanted[0]}, {wanted[1]})"
        )
    names = tuple(cylinders) if cylinders is not None else tuple(str(n + 1) for n in range(len(sources)))
    if len(names) != len(sources):
        raise ShapeError(f"{len(names)} names for {len(sources)} cylinders")
    return names


def places(orders: Floats, measured: MeasuredSpeed) -> Indices:
    """Where the measured orders stand among others. One for each measured order. `orders`: (orders,)."""
    place = np.abs(orders[:, None] - measured.orders).argmin(axis=0)
    apart = np.abs(orders[place] - measured.orders) > _EQUAL * measured.orders
    if apart.any():
        order = measured.orders[apart][0]
        raise InputError(f"nothing in the train has the order {order:.6g}: leave it out of the measurement")
    at: Indices = place
    return at
