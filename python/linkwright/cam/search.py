"""Thousands to millions of cams that differ in law, radii, offset or lift: which keep their limits.

Of two contacts the first counts. Each cam is examined at the same angles, in SIMD lanes; what is chosen in
the end is examined exactly.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from linkwright.cam.model.cam import Cam
from linkwright.cam.model.follower import Sizes
from linkwright.cam.model.motion_law import PlainLaw
from linkwright.cam.model.motion_section import MotionSection
from linkwright.cam.profile.contact import contacts
from linkwright.cam.profile.profile import the_cam
from linkwright.kernel.arrays import Bools, Floats, Indices
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, ShapeError
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import array
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine

# Entries of a cam that may vary, and the place of each among the dimensions; the factor on the lift comes
# last.
ENTRIES = ("base_radius", "roller_radius", "offset", "distance", "arm_length", "face_tilt", "lift_factor")

# What the core tells of each cam.
_SEARCHED = ("tan_pressure_angle", "soundness", "bend_max", "bend_min")

_POSITIVE = ("base_radius", "roller_radius", "distance", "arm_length")

# Angles per revolution at which cams are examined. An extreme between them is missed by up to (step)²/8 of
# its second derivative: some 1e-4 of pressure angles, up to 1e-3 of the size of the cam in radii of
# curvature.
PER_TURN = 360


@dataclass(frozen=True)
class Cams(Result):
    """Many cams; arrays (n,), NaN where the dimensions do not go together."""

    entries: Annotated[dict[str, Floats], About("Varied entries by name.")]
    laws: Annotated[tuple[str, ...], About("Names of the laws.")]
    law: Annotated[Indices, About("Number of the law of each cam.", "(n,)")]
    pressure_angle_max: Annotated[
        Floats, Label("maximum absolute pressure angle", "", "rad", over="pressure_angle_max")
    ]
    curvature_radius_min: Annotated[
        Floats,
        Label(
            "minimum radius of curvature of the convex parts of the profile",
            "",
            "m",
            "Negative where undercut.",
            over="curvature_radius_min",
        ),
    ]
    concave_radius_min: Annotated[
        Floats,
        Label(
            "minimum radius of the concave parts",
            "",
            "m",
            "Infinite without such parts; under a flat face the profile cannot have any.",
            over="concave_radius_min",
        ),
    ]
    is_sound: Annotated[Bools, About("Whether it is neither undercut nor locked.", "(n,)")]

    @public
    def keeps(self, pressure_angle: float, curvature_radius: float = 0.0) -> Bools:
        """Which cams are sound and keep limits.

        ``pressure_angle``: largest pressure angle allowed [rad]; ``curvature_radius``: minimum convex radius
        of curvature allowed [m] → one for each cam, (n,).
        """
        steep = self.pressure_angle_max <= pressure_angle
        keeps: Bools = self.is_sound & steep & (self.curvature_radius_min >= curvature_radius)
        return keeps

    @public
    def smallest(self, keeps: Bools, count: int = 1) -> Indices:
        """The cams of minimum base radius, then pressure angle, among those that ``keeps`` (n,) admits."""
        if keeps.shape != self.is_sound.shape:
            raise ShapeError(f"keeps: found {len(keeps)} truths for {len(self.is_sound)} cams")
        numbers = np.flatnonzero(keeps)
        base = self.entries.get("base_radius", np.zeros(len(keeps)))
        order = np.lexsort((self.pressure_angle_max[numbers], base[numbers]))
        return numbers[order[:count]]


@public
def search_cams(
    machine: Machine,
    name: str | None = None,
    *,
    entries: Mapping[str, ArrayLike],
    laws: Sequence[str] = (),
    law: ArrayLike | None = None,
    per_turn: int = PER_TURN,
) -> Cams:
    """Evaluate many variants of a cam.

    Parameters
    ----------
    machine : Machine
        A machine with the cam.
    name : str, optional
        The cam's name; may be left out if there is one.
    entries : mapping of str to array_like, shape (n,)
        What varies, by the names of `ENTRIES`; ``lift_factor`` multiplies the lift. All else is as in the
        file.
    laws : sequence of str
        Names of laws, one of which all moving sections of a cam follow; without them, the sections as they
        are.
    law : array_like of int, shape (n,), optional
        Number of the law of each cam; without it each variant is examined with every law, law after law.
    per_turn : int
        Cam angles per revolution, at least 16.

    Returns
    -------
    Cams
        One row for each cam.

    Raises
    ------
    InputError
        No such cam, entry or law; too few angles.
    ShapeError
        Arrays of different length.
    """
    name, cam = the_cam(machine, name)
    if per_turn < 16:
        raise InputError(f"per_turn = {per_turn}: expected 16 cam angles or more")
    useful_entries(cam, *entries)
    columns, n = _columns(entries)
    numbers, repeats = _numbers(law, len(laws) or 1, n)
    columns = {
        key: np.tile(column, repeats) if len(column) > 1 else column for key, column in columns.items()
    }
    results = {name: np.full(len(numbers), np.nan) for name in _SEARCHED}
    points = machine.mechanism.fixed_points()
    for i, candidate in enumerate(_variants(cam, laws)):
        rows = np.flatnonzero(numbers == i)
        if len(rows):
            contact = contacts(candidate, points, name)[0]
            part = {key: column[rows] if len(column) > 1 else column for key, column in columns.items()}
            sizes = Sizes(*(part.get(key, size) for key, size in zip(ENTRIES, contact.sizes, strict=False)))
            cams = contact.kernel.search(sizes, part.get("lift_factor", 1.0), per_turn)
            for quantity, column in results.items():
                column[rows] = getattr(cams, quantity)
    return _cams(cam, columns, tuple(laws), numbers, results)


def useful_entries(cam: Cam, *asked: str) -> tuple[str, ...]:
    """Entries that a cam of this kind depends on; an `InputError` for one that is asked for and is none."""
    own: tuple[str, ...]
    if cam.is_oscillating:
        own = ("distance", "arm_length") if cam.is_roller else ("distance", "offset")
    else:
        own = ("offset",) if cam.is_roller else ("face_tilt",)
    roller = ("roller_radius",) if cam.contact == "roller" else ()
    useful = ("base_radius", *roller, *own, "lift_factor")
    for entry in asked:
        if entry not in useful:
            remedy = suggestion(entry, useful)
            raise InputError(f'entries: found "{entry}", expected what such a cam depends on; {remedy}')
    return useful


def _columns(entries: Mapping[str, ArrayLike]) -> tuple[dict[str, Floats], int]:
    columns = {}
    for key, values in entries.items():
        columns[key] = np.atleast_1d(array(f"entries: {key}", values))
        if columns[key].ndim != 1 or not np.isfinite(columns[key]).all():
            raise InputError(f'entries: found no list of finite numbers for "{key}"')
        least = columns[key].min(initial=np.inf)
        if key in _POSITIVE and least <= 0:
            raise InputError(f"entries: found {key} {least:.6g}, expected more than 0")
    lengths = {len(column) for column in columns.values()} - {1}
    if len(lengths) > 1:
        found = ", ".join(f"{key} {len(column)}" for key, column in columns.items())
        raise ShapeError(f"entries: found lists of {found} numbers, expected the same length for all")
    return columns, lengths.pop() if lengths else 1


def _numbers(law: ArrayLike | None, n_laws: int, n: int) -> tuple[Indices, int]:
    if law is None:
        return np.repeat(np.arange(n_laws), n), n_laws
    given = array("law", law)
    if (given != np.floor(given)).any() or (np.abs(given) > n_laws).any():
        raise InputError("law: expected whole numbers, the place of a law among the laws")
    numbers = given.astype(np.intp)
    if numbers.ndim != 1 or (n > 1 and len(numbers) != n):
        raise ShapeError(f"law: found shape {numbers.shape}, expected one number for each of {n} cams")
    if ((numbers < 0) | (numbers >= n_laws)).any():
        raise InputError(f"law: expected numbers from 0 to {n_laws - 1}, the place of a law among the laws")
    return numbers, 1


def _variants(cam: Cam, laws: Sequence[str]) -> list[Cam]:
    if not laws:
        return [cam]
    return [
        cam.with_entries({"sections": tuple(_with(section, law) for section in cam.sections)}) for law in laws
    ]


def require_law(law: str) -> None:
    """Raise `InputError` unless a law has this name."""
    from linkwright.cam.laws.catalogue import LAWS

    if law not in LAWS:
        remedy = suggestion(law, LAWS) or "there is " + ", ".join(LAWS)
        raise InputError(f'laws: found "{law}", expected the name of a law; {remedy}')


def _with(section: MotionSection, law: str) -> MotionSection:
    """A section with another law; dwells and constant velocity stay."""
    require_law(law)
    if section.is_dwell or section.is_steady:
        return section
    entry: dict[str, Any] = {"kind": law}
    return section.with_entries({"law": PlainLaw.model_construct(**entry)})


def _cams(
    cam: Cam,
    columns: dict[str, Floats],
    laws: tuple[str, ...],
    numbers: Indices,
    results: dict[str, Floats],
) -> Cams:
    lead, sound, most, least = (results[name] for name in _SEARCHED)
    n = len(numbers)
    roller = np.broadcast_to(columns.get("roller_radius", np.array([cam.radius_of_roller])), n)
    with np.errstate(divide="ignore", invalid="ignore"):
        if cam.is_roller:
            convex = np.where(most > 0, 1.0 / most - roller, np.inf)
            concave = np.where(least < 0, -1.0 / least + roller, np.inf)
        else:
            convex, concave = least, np.full(n, np.inf)
        is_sound = (sound > 0) & np.isfinite(lead)
    full = {key: np.broadcast_to(column, n).copy() for key, column in columns.items()}
    return Cams(full, laws, numbers, np.arctan(lead), convex, concave, is_sound)
