r"""The roots of a field, one by one, and in which phases of the knife they stand.

The head of a root is cut off a sphere of diameter D at the height h_p below its top. The plane of the cut
meets the sphere in a disc of diameter d, above which lies a cap of volume V:

.. math:: d = 2\sqrt{h_p (D - h_p)}, \qquad V = \frac{\pi h_p^2}{3}\left(\frac{3D}{2} - h_p\right).

Random numbers depend on the seed alone: the i-th root has the same share of each distribution whatever else
is changed, so that variants of a knife are compared over the same roots.

With the distance a of neighbours, the phase of the next root follows from the rate ω of the knife's phase and
the speed v along the row:

.. math:: \theta_{i+1} = \theta_i + \frac{\omega a}{v}.

Equal distances may so lock to the stroke: with :math:`a f/v` a whole number, all roots of a row meet the
knife in one phase.

References
----------
.. [1] Paper 5, d from D and h_p; phases are derived here.
.. [2] Bronshtein, Semendyayev, *Handbook of Mathematics*: spherical segment.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Bools, Floats, Indices
from linkwright.kernel.errors import InputError
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.topping.model.field import MeasuredField, RandomField, even_offset
from linkwright.topping.model.scatter import ConstantScatter
from linkwright.topping.model.topper import Topper


def head_diameter(root_diameter: Any, cut_height: Any) -> Any:
    """Diameter d of the disc cut of D at h_p, (...) [m]; zero where the cut passes above or below."""
    return 2 * np.sqrt(np.maximum(cut_height * (root_diameter - cut_height), 0.0))


def cap_volume(root_diameter: Any, cut_height: Any) -> Any:
    """Volume of the root above the cut at h_p, (...) [m³]; zero above the root, all of it below."""
    h = np.minimum(np.maximum(cut_height, 0.0), root_diameter)
    return np.pi * h**2 * (1.5 * root_diameter - h) / 3


@dataclass(frozen=True)
class Roots(Result):
    """Roots that the knife meets; arrays (n,), a meeting each."""

    root_diameter: Annotated[Floats, Label("diameter of the root", "D", "m", over="root_diameter")]
    cut_height: Annotated[Floats, Label("height of the cut", "h_p", "m")]
    offset: Annotated[Floats, Label("axis of the root to the left of the row", "", "m")]
    distance: Annotated[
        Floats,
        Label(
            "distance from the first root of the row",
            "",
            "m",
            "Zero where phases are independent and uniform.",
        ),
    ]
    start: Annotated[
        Floats,
        Label(
            "share of a revolution of the knife's phase at the first root of the row", "", "–", over="start"
        ),
    ]
    cluster: Annotated[Indices, About("Row of a random root, number of a measured one.", "(n,)")]
    n_clusters: Annotated[int, About("How many there are.")]
    are_free: Annotated[bool, About("Whether roots of a cluster are independent.")]

    @property
    def diameter(
        self,
    ) -> Annotated[Floats, Label("diameter of the disc that is cut", "d", "m")]:
        """Of the head at the height of the cut."""
        return np.asarray(head_diameter(self.root_diameter, self.cut_height))

    @property
    def cap(self) -> Annotated[Floats, Label("volume above the cut", "", "m³")]:
        """A cap of the sphere."""
        return np.asarray(cap_volume(self.root_diameter, self.cut_height))

    @property
    def volume(self) -> Annotated[Floats, Label("volume of the root", "", "m³")]:
        """Of the whole sphere."""
        return np.asarray(np.pi / 6 * self.root_diameter**3)

    @property
    def is_missed(
        self,
    ) -> Annotated[Bools, About("Whether the knife passes above the root.", "(n,)")]:
        """Whether the knife passes above the root."""
        return np.asarray(self.cut_height <= 0)

    @property
    def is_lost(
        self,
    ) -> Annotated[Bools, About("Whether the knife passes below the root.", "(n,)")]:
        """Whether it passes below the root."""
        return np.asarray(self.cut_height >= self.root_diameter)

    def phase(self, rate: float, forward_speed: float) -> Floats:
        """Phase, 0 to 2π, when the edge's middle is abreast of each root, (n,); `rate` [rad/s]; v [m/s]."""
        turns = self.start + self.distance * (rate / (2 * np.pi * forward_speed))
        return np.asarray(2 * np.pi * (turns - np.floor(turns)))


def field_of(topper: Topper) -> RandomField | MeasuredField:
    """The field of a topper; without one, roots that differ in their offset alone."""
    return topper.field or RandomField(kind="random")


def draw_roots(topper: Topper, seed: int | None = None) -> Roots:
    """Draw the roots of a field, the same for the same seed, in place of the field's own if one is given.

    The topper's own sizes count where the field has none. Raises `InputError` for a negative seed.
    """
    if seed is not None and seed < 0:
        raise InputError(f"seed: found {seed}, expected a whole number of 0 or more")
    field = field_of(topper)
    rng = np.random.default_rng(field.seed if seed is None else seed)
    fixed = topper.motion.phase
    if isinstance(field, MeasuredField):
        return _measured(field, rng, fixed)
    return _random(field, topper, rng, fixed)


def _random(field: RandomField, topper: Topper, rng: np.random.Generator, fixed: float | None) -> Roots:
    n = field.roots
    row = np.arange(n) * field.rows // n
    first = np.searchsorted(row, np.arange(field.rows))
    diameter = field.root_diameter or _constant(topper.root_diameter)
    height = field.cut_height or _constant(topper.cut_height)
    offset = field.offset or even_offset(topper.offset)
    shares = rng.random((5, n))
    distance, start = np.zeros(n), shares[4]
    if field.spacing is not None:
        along = np.cumsum(field.spacing.values(shares[3]))
        distance, start = along - along[first][row], start[first][row]
    return Roots(
        root_diameter=diameter.values(shares[0]),
        cut_height=height.values(shares[1]) + field.cut_height_shift,
        offset=offset.values(shares[2]),
        distance=distance,
        start=start if fixed is None else np.full(n, fixed / (2 * np.pi)),
        cluster=row,
        n_clusters=field.rows,
        are_free=field.spacing is None,
    )


def _constant(value: float) -> ConstantScatter:
    return ConstantScatter(kind="constant", value=value)


def _measured(field: MeasuredField, rng: np.random.Generator, fixed: float | None) -> Roots:
    """Each root in evenly spread phases, of which the first is random."""
    n, m = len(field.root_diameter), field.phases if fixed is None else 1
    number = np.repeat(np.arange(n), m)
    first = rng.random(n)
    along = np.zeros(n)
    if field.spacing is not None:
        first = np.full(n, first[0])
        along[1:] = np.cumsum(field.spacing[1:])
    start = ((first[:, None] + np.arange(m)) / m).ravel()
    return Roots(
        root_diameter=np.array(field.root_diameter)[number],
        cut_height=np.array(field.cut_height)[number] + field.cut_height_shift,
        offset=np.array(field.offset)[number],
        distance=along[number],
        start=start if fixed is None else np.full(n, fixed / (2 * np.pi)),
        cluster=number,
        n_clusters=n,
        are_free=False,
    )
