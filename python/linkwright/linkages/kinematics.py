"""Motion of points, links and slides over the crank angle, with first and second transfer functions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, MachineError, Problem, ShapeError
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import array, shown
from linkwright.kernel.public.immutable import LazyTable
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record, Result
from linkwright.linkages.closure import has_levers, require_closed, require_finite_rates
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import Channel
from linkwright.machine.program.motion import WIDTHS

if TYPE_CHECKING:
    import pandas as pd

# What the core takes for a point, a link and a slide, and how many numbers it gives at each angle.
_CHANNELS = {"points": Channel.Point, "links": Channel.Link, "slides": Channel.Slide}
_WIDTHS = {part: WIDTHS[channel] for part, channel in _CHANNELS.items()}


@dataclass(frozen=True)
class PointMotion(Record):
    """A point over the crank angle; arrays (n, 2) for one machine, (rows, n, 2) for a batch."""

    position: Annotated[Floats, About("Place [m].")]
    d1: Annotated[Floats, About("First derivative by the crank angle [m/rad].")]
    d2: Annotated[Floats, About("Second derivative [m/rad²].")]
    d3: Annotated[Floats | None, About("Third derivative [m/rad³], where it was asked for.")] = None


@dataclass(frozen=True)
class LinkMotion(Record):
    """A link over the crank angle; arrays (n,) for one machine, (rows, n) for a batch."""

    angle: Annotated[Floats, About("Direction of the link, continuous over the angles [rad].")]
    d1: Annotated[Floats, About("First derivative by the crank angle [–].")]
    d2: Annotated[Floats, About("Second derivative [–].")]
    d3: Annotated[Floats | None, About("Third derivative [–], where it was asked for.")] = None


@dataclass(frozen=True)
class SlideMotion(Record):
    """A slider along its guide; arrays (n,) for one machine, (rows, n) for a batch."""

    position: Annotated[Floats, About("Along the guide from the foot of its through point [m].")]
    d1: Annotated[Floats, About("First derivative by the crank angle [m/rad].")]
    d2: Annotated[Floats, About("Second derivative [m/rad²].")]
    d3: Annotated[Floats | None, About("Third derivative [m/rad³], where it was asked for.")] = None


@dataclass(frozen=True)
class Kinematics(Result):
    """Motion of a mechanism over given crank angles; its curves are those of one machine, not of a batch."""

    angles: Annotated[Floats, Label("crank angles", "φ", "rad")]
    points: Annotated[Mapping[str, PointMotion], About("Motion of each point.")]
    links: Annotated[Mapping[str, LinkMotion], About("Motion of each link.")]
    slides: Annotated[Mapping[str, SlideMotion], About("Motion of each slide.")]

    def curves(self) -> dict[str, np.ndarray]:
        """The angles and all columns: ``K.x``, ``K.x.d1``, ``R.rocker.angle``, ``ram.place.d2``, …."""
        curves = {"angles": self.angles}
        for name, point in self.points.items():
            for k, axis in enumerate("xy"):
                curves |= columns_of(f"{name}.{axis}", point.position[..., k], _derivatives(point, k))
        for name, link in self.links.items():
            curves |= columns_of(f"{name}.angle", link.angle, _derivatives(link))
        for name, slide in self.slides.items():
            curves |= columns_of(f"{name}.place", slide.position, _derivatives(slide))
        return {name: curve for name, curve in curves.items() if curve.shape == self.angles.shape}

    def usual_curves(self) -> list[str]:
        """Positions of slides and links; of a mechanism without such, of points."""
        names = [name for name in self.curves() if name.endswith((".place", ".angle"))]
        return names or super().usual_curves()

    def shown_rows(self) -> Iterator[tuple[str, str, float | tuple[float, float], str]]:
        """Numbers of angles and machines; of one machine the range of each slide and link."""
        yield "crank angles", "", len(self.angles), ""
        if machines := _machines(self):
            yield "machines", "", machines, ""
        curves = self.curves()
        for name in self.usual_curves():
            yield name, "", (float(curves[name].min()), float(curves[name].max())), self.unit_of(name)

    def to_frame(self) -> pd.DataFrame:
        """The angles and all columns of one machine as a table, SI.

        Raises `ShapeError` of a batch, of which an entry is an array over machines, and `InputError` without
        pandas.
        """
        if machines := _machines(self):
            raise ShapeError(
                f"to_frame: found a batch of {machines} machines, expected one; take the arrays of "
                "points, links and slides"
            )
        return super().to_frame()

    @public
    def unit_of(self, name: str) -> str:
        """SI unit of an attribute or a column by its name."""
        of, _, last = name.rpartition(".")
        if not of:
            return super().unit_of(name)
        if last in _DERIVATIVES:
            return _DERIVATIVES[last] if self.unit_of(of) == "m" else ""
        return unit_of_coordinate(name, self.links)


def _machines(motion: Kinematics) -> int:
    """How many machines a batch has; 0 of one machine."""
    place = next(iter(motion.points.values())).position
    return len(place) if place.ndim > 2 else 0


# Units of coordinates by the last word of their name, and of their derivatives by the crank angle.
_COORDINATES = {"x": "m", "y": "m", "place": "m", "angle": "rad"}
_DERIVATIVES = {"d1": "m/rad", "d2": "m/rad²", "d3": "m/rad³"}


def unit_of_coordinate(name: str, links: Mapping[str, Any]) -> str:
    """SI unit of a coordinate by its name; the lift of a cam whose follower is a link is an angle."""
    follower = name.removesuffix(".lift.place")
    return "rad" if follower != name and follower in links else _COORDINATES.get(name.rpartition(".")[2], "")


def columns_of(head: str, position: Floats, rates: Mapping[str, Floats]) -> dict[str, Floats]:
    """A coordinate and its derivatives by name."""
    return {head: position} | {f"{head}.{rate}": values for rate, values in rates.items()}


def _derivatives(part: Any, at: Any = slice(None)) -> dict[str, Floats]:
    """The derivatives of a part by the crank angle, as far as they are known."""
    known = {name: getattr(part, name) for name in _DERIVATIVES}
    return {name: values[..., at] for name, values in known.items() if values is not None}


@public
def kinematics(machine: Machine, angles: ArrayLike | None = None, *, third: bool = False) -> Kinematics:
    r"""Motion of every point, link and slide over the crank angle.

    Parameters
    ----------
    machine : Machine
        The machine. Entries may be arrays over many machines; results then have a row for each.
    angles : array_like, shape (n,), optional
        Crank angles [rad]; without them a revolution by single degrees.
    third : bool
        Whether third derivatives are wanted too; of one machine only.

    Returns
    -------
    Kinematics
        Positions and derivatives by the crank angle φ. Velocity is :math:`p' \omega`, acceleration
        :math:`p'' \omega^2 + p' \varepsilon`, jerk
        :math:`p''' \omega^3 + 3 p'' \omega \varepsilon + p' \dot\varepsilon`.

    Raises
    ------
    AssemblyError
        The mechanism does not close at one of the angles, or its motion is not determined between them.
    ShapeError
        Third derivatives of many machines at once.

    Notes
    -----
    Derivatives are exact. Angles count counter-clockwise from x; signs in ``docs/signs.md``.
    """
    compiled = compile_machine(machine)
    phi = np.linspace(0, 2 * np.pi, 361) if angles is None else crank_angles(angles)
    what = everything(compiled)
    out = motion_arrays(compiled, phi, what)
    is_finite = bool(np.isfinite(out).all())
    if not is_finite or has_levers(compiled):
        require_closed(compiled, machine, phi)
    if not is_finite:
        require_finite_rates(out, compiled, machine, phi)
    single = compiled.n_rows == 1 and not len(compiled.slots)
    collect = _collect(phi, out[0] if single else out, what)
    return with_third(compiled, collect, what) if third else collect


def kinematics_of(
    compiled: CompiledMachine, angles: Floats, what: list[tuple[str, str]], *, third: bool = False
) -> Kinematics:
    """`kinematics` of one compiled machine where it closes; ``what`` holds pairs of part and name."""
    collect = _collect(angles, motion_arrays(compiled, angles, what)[0], what)
    return with_third(compiled, collect, what) if third else collect


def everything(compiled: CompiledMachine) -> list[tuple[str, str]]:
    """Pairs of part and name of all that has a name in the machine: not what the core keeps for itself."""
    names = {"points": compiled.points, "links": compiled.links, "slides": compiled.slides}
    hidden = (".angle", ".law", ".length", " reversed")
    return [(part, name) for part, known in names.items() for name in known if not name.endswith(hidden)]


def with_third(compiled: CompiledMachine, kinematics: Kinematics, what: list[tuple[str, str]]) -> Kinematics:
    """The same motion with third derivatives. Raises ShapeError: entries vary from machine to machine."""
    if len(compiled.slots):
        raise ShapeError("third derivatives are for one machine, and entries vary from machine to machine")
    known = {"points": compiled.points, "links": compiled.links, "slides": compiled.slides}
    asked = {part: [name for kind, name in what if kind == part] for part in known}
    indices = {part: [known[part][name] for name in names] for part, names in asked.items()}
    third = compiled.third(kinematics.angles, **indices)
    rows = {"points": third.points.swapaxes(1, 2), "links": third.links, "slides": third.slides}
    parts: dict[str, dict[str, Any]] = {part: {} for part in known}
    for part, names in asked.items():
        for name, d3 in zip(names, rows[part], strict=True):
            parts[part][name] = replace(getattr(kinematics, part)[name], d3=d3)
    return Kinematics(kinematics.angles, **parts)


def kinematics_along(machine: Machine, angles: Floats, directions: Floats) -> Kinematics:
    """The motion of a machine with its derivatives by directions of the program's numbers (parameters, k).

    The attributes of points, links and slides are arrays of tangents, at fixed crank angles.
    """
    compiled = compile_machine(machine)
    what = everything(compiled)
    table = motion_arrays(compiled, angles, what)[0]
    return _collect(angles, Tangent(table, rows_along(compiled, angles, what, directions)), what)


def rows_along(
    compiled: CompiledMachine, angles: Floats, what: list[tuple[str, str]], directions: Floats
) -> Floats:
    """Derivatives of the rows of `motion_arrays` by directions (parameters, k), (numbers, n, k)."""
    known = {"points": compiled.points, "links": compiled.links, "slides": compiled.slides}
    channels = [_CHANNELS[part](known[part][name]) for part, name in what]
    return compiled.motions_along(directions, angles, channels)


def checked_angles(angles: ArrayLike) -> Floats:
    """Crank angles as a contiguous list. Raises ShapeError: they are no list of finite numbers."""
    # Those that a public function has checked are an array of their own.
    is_own = isinstance(angles, np.ndarray) and angles.dtype == np.float64 and not angles.flags.writeable
    phi: Floats = np.asarray(angles) if is_own else array("crank angles", angles)
    if is_own and not (phi.flags.c_contiguous and np.isfinite(phi).all()):
        phi = array("crank angles", phi)
    if phi.ndim != 1:
        raise ShapeError(f"crank angles: found an array of shape {phi.shape}, expected a list")
    return phi


# Crank angles to this are known to 1e-11 rad, and the core has their sines to rounding [rad].
_FARTHEST = 1e5


def crank_angles(angles: ArrayLike) -> Floats:
    """The same of crank angles, which beyond some thousand revolutions have no digits left."""
    phi = checked_angles(angles)
    far = np.flatnonzero(np.abs(phi) > _FARTHEST)
    if len(far):
        at = int(far[0])
        raise InputError(
            f"crank angles: found {phi[at]:g} rad at index {at}, expected at most {_FARTHEST:g} rad in size"
        )
    return phi


def _collect(phi: Floats, table: Any, what: list[tuple[str, str]]) -> Kinematics:
    makers: dict[str, dict[str, Any]] = {part: {} for part in _WIDTHS}
    if isinstance(table, np.ndarray):
        table.flags.writeable = False
    at = 0
    for part, name in what:
        makers[part][name] = partial(_MOTIONS[part], table, at)
        at += _WIDTHS[part]
    return Kinematics(phi, **{part: LazyTable(maker) for part, maker in makers.items()})


def _point(table: Any, at: int) -> PointMotion:
    # Views, not copies: x and y of a point lie one after the other.
    return PointMotion(*(np.swapaxes(table[..., i : i + 2, :], -1, -2) for i in (at, at + 2, at + 4)))


def _link(table: Any, at: int) -> LinkMotion:
    angle = _continuous(np.arctan2(table[..., at + 1, :], table[..., at, :]))
    return LinkMotion(angle, table[..., at + 2, :], table[..., at + 3, :])


def _slide(table: Any, at: int) -> SlideMotion:
    return SlideMotion(*(table[..., i, :] for i in (at, at + 1, at + 2)))


_MOTIONS = {"points": _point, "links": _link, "slides": _slide}


def _continuous(angles: Floats) -> Floats:
    """Angles without jumps; most have none."""
    has_jumps = (np.abs(angles[..., 1:] - angles[..., :-1]) > np.pi).any()
    return np.unwrap(angles) if has_jumps else angles


@public
def motions(
    machine: Machine,
    angles: ArrayLike,
    *,
    points: Iterable[str] = (),
    links: Iterable[str] = (),
    slides: Iterable[str] = (),
    # Not `Floats`, which an argument of a public function is one list of.
    out: NDArray[np.float64] | None = None,
) -> Floats:
    """Motions of one or many machines as one array, at the speed of the core.

    Parameters
    ----------
    machine : Machine
        The machine; entries may be arrays over many machines (`linkwright.replace`).
    angles : array_like, shape (n,)
        Crank angles [rad].
    points, links, slides : iterable of str
        What is wanted. A point gives six numbers: x, y, x′, y′, x″, y″. A link gives four: cos ψ, sin ψ,
        ψ′, ψ″. A slide gives three: s, s′, s″.
    out : ndarray, optional
        Array of the result's shape to write into; saves making a new one each time.

    Returns
    -------
    ndarray, shape (rows, numbers, n)
        In the order asked for, points first; NaN where a machine does not close, and rates where they grow
        without limit, at a limit of crank rotation.

    Raises
    ------
    MachineError
        A name that does not exist.
    ShapeError
        ``out`` does not fit.
    """
    compiled = compile_machine(machine)
    asked: Mapping[str, Iterable[str]] = {"points": points, "links": links, "slides": slides}
    what = [(part, name) for part, names in asked.items() for name in names]
    result, is_finite = _filled(compiled, crank_angles(angles), what, out)
    if not is_finite:
        result[np.isinf(result)] = np.nan
    return result


def motion_arrays(
    compiled: CompiledMachine, angles: Floats, what: list[tuple[str, str]], out: Floats | None = None
) -> Floats:
    """`motions` of a compiled machine, also where rates are infinite; ``what`` has pairs (part, name)."""
    return _filled(compiled, angles, what, out)[0]


def _filled(
    compiled: CompiledMachine, angles: Floats, what: list[tuple[str, str]], out: Floats | None
) -> tuple[Floats, bool]:
    """The array, and whether all of it is finite."""
    known = {"points": compiled.points, "links": compiled.links, "slides": compiled.slides}
    for part, name in what:
        if name not in known[part]:
            expected = f"one of {', '.join(known[part])}"
            raise MachineError([Problem(part, name, expected)])
    shape = (compiled.n_rows, sum(_WIDTHS[part] for part, _ in what), len(angles))
    if out is None:
        out = _room(shape)
    if (
        not isinstance(out, np.ndarray)
        or out.shape != shape
        or out.dtype != np.float64
        or not out.flags.carray
    ):
        expected = f"a contiguous array of floats of shape {shape} that may be written to"
        raise ShapeError(f"out: found {shown(out)}, expected {expected}")
    channels = [_CHANNELS[part](known[part][name]) for part, name in what]
    return out, compiled.motions(angles, channels, out)


def _room(shape: tuple[int, ...]) -> Floats:
    try:
        return np.empty(shape)
    except (MemoryError, ValueError):
        raise ShapeError(f"motions: {shape} numbers do not fit into memory; ask for fewer at once") from None
