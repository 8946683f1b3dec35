"""Four-bar loops of a mechanism and their class after Grashof.

With the shortest link s, the longest l and the others p, q: only if s + l ≤ p + q can a link turn fully
against the others, and which one depends on where the shortest is (Grashof 1883; Norton, *Design of
Machinery*, section 2.12).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.linkages.dyads import dyads_of
from linkwright.machine.program.compiled import CompiledMachine
from linkwright.machine.program.core import Element

# Share of s + l by which p + q may differ and still be the same: lengths given to all digits are.
_SAME = 1e-9

# Angles at which arms are compared, a prime number so that no symmetry hides a difference, and by how far
# directions that are the same differ, by rounding that change points make larger [rad].
_LOOKS = 97
_PARALLEL = 1e-6


@dataclass(frozen=True)
class FourBar:
    """A loop of four links.

    Attributes
    ----------
    element : str
        Name of the dyad that closes it.
    driver, coupler, follower, ground : float
        Lengths [m].
    is_parallel : bool or None
        Whether driver and follower stay parallel; None where that is not known.
    """

    element: str
    driver: float
    coupler: float
    follower: float
    ground: float
    is_parallel: bool | None = None

    @property
    def sum_extremes(self) -> float:
        """s + l, the shortest and the longest link [m]."""
        lengths = self._lengths()
        return lengths[0] + lengths[3]

    @property
    def sum_others(self) -> float:
        """p + q, the other two [m]."""
        lengths = self._lengths()
        return lengths[1] + lengths[2]

    @property
    def grashof(self) -> str:
        """The class in words.

        ``crank-rocker``, ``rocker-crank`` (the follower turns), ``double-crank (drag link)``,
        ``double-rocker`` (the coupler turns), ``triple-rocker`` (nothing turns), or ``change-point`` with its
        kind.
        """
        spare = self.sum_others - self.sum_extremes
        if abs(spare) <= _SAME * self.sum_others:
            return f"change-point: {self._change_point()}"
        if spare < 0:
            return "triple-rocker"
        return ("crank-rocker", "double-rocker", "rocker-crank", "double-crank (drag link)")[
            int(np.argmin((self.driver, self.coupler, self.follower, self.ground)))
        ]

    def _lengths(self) -> list[float]:
        return sorted((self.driver, self.coupler, self.follower, self.ground))

    def _change_point(self) -> str:
        opposite = _same(self.driver, self.follower) and _same(self.coupler, self.ground)
        if opposite:
            words = {
                True: "parallelogram",
                False: "antiparallelogram",
                None: "parallelogram or antiparallelogram",
            }
            return words[self.is_parallel]
        beside_driver = _same(self.driver, self.coupler) and _same(self.follower, self.ground)
        beside_follower = _same(self.coupler, self.follower) and _same(self.driver, self.ground)
        return "kite" if beside_driver or beside_follower else "links in line once per revolution"


def _same(a: float, b: float) -> bool:
    return abs(a - b) <= _SAME * max(a, b)


def four_bars(compiled: CompiledMachine) -> list[FourBar]:
    """The four-bar loops of a machine: an arm on a fixed point, a coupler, and a link on another fixed point.
    Returns: in build order, from cranks and rockers as well as from joints and bars.
    """
    grounds = {fixed.point: compiled.parameters[[fixed.x, fixed.y]] for fixed in compiled.ground}
    arms = _arms(compiled, grounds)
    bars = []
    for dyad in dyads_of(compiled):
        if isinstance(dyad.element, Element.Rocker):
            bars += _loops(compiled, dyad.name, dyad.element, grounds, arms)
    return bars


def _loops(
    compiled: CompiledMachine,
    name: str,
    dyad: Element.Rocker,
    grounds: dict[int, Floats],
    arms: dict[int, tuple[int, float]],
) -> list[FourBar]:
    """Loops that a dyad closes: one, or none if neither of its ends is at rest."""
    pin, pivot = dyad.pin, dyad.pivot
    lengths = compiled.parameters[[dyad.coupler, dyad.rocker]]
    loops = []
    for moving, fixed, order in ((pin, pivot, (0, 1)), (pivot, pin, (1, 0))):
        if fixed in grounds and moving in arms:
            centre, driver = arms[moving]
            ground = float(np.hypot(*(grounds[fixed] - grounds[centre])))
            if ground > 0:
                coupler, follower = (float(lengths[k]) for k in order)
                is_parallel = _stays_parallel(compiled, (centre, moving), (fixed, dyad.joint))
                loops.append(FourBar(name, driver, coupler, follower, ground, is_parallel))
    return loops


def _stays_parallel(compiled: CompiledMachine, driver: tuple[int, int], follower: tuple[int, int]) -> bool:
    """Whether two arms, each from its centre to its end, have one direction wherever the mechanism closes."""
    angles = np.linspace(0.0, 2 * np.pi * compiled.turns, _LOOKS)
    one, other = (
        compiled.point_motion(end, angles).place - compiled.point_motion(centre, angles).place
        for centre, end in (driver, follower)
    )
    apart = np.hypot(*(one / np.hypot(*one) - other / np.hypot(*other)))
    known = np.isfinite(apart)
    return bool(known.any() and apart[known].max() < _PARALLEL)


def _arms(compiled: CompiledMachine, grounds: dict[int, Floats]) -> dict[int, tuple[int, float]]:
    centres = dict(_centred(compiled.elements, grounds))
    arms: dict[int, tuple[int, float]] = {}
    for element in compiled.elements:
        for point, centre in _carried(element, centres, grounds):
            if point != centre:
                arms.setdefault(point, (centre, _distance(compiled, point, grounds[centre])))
    return {point: arm for point, arm in arms.items() if arm[1] > 0}


def _centred(elements: tuple[Element, ...], grounds: dict[int, Floats]) -> list[tuple[int, int]]:
    ends = []
    for element in elements:
        match element:
            case Element.Crank(link=link, pivot=pivot) | Element.SlottedLever(link=link, pivot=pivot):
                ends.append((link, pivot))
            case Element.Rocker():
                ends += [(element.coupler_link, element.pin), (element.rocker_link, element.pivot)]
            case Element.Link(bar=bar):
                ends += [(bar.link, bar.start), (bar.link, bar.end)]
    return [(link, point) for link, point in ends if point in grounds]


def _carried(element: Element, centres: dict[int, int], grounds: dict[int, Floats]) -> list[tuple[int, int]]:
    match element:
        case Element.Crank(pin=pin, pivot=pivot):
            return [(pin, pivot)]
        case Element.Rocker(joint=joint, pin=pin, pivot=pivot):
            return [(joint, end) for end in (pin, pivot) if end in grounds]
        case Element.RigidPoint(point=point, origin=origin) if origin in grounds:
            return [(point, origin)]
        case Element.RigidPoint(point=point, link=link) if link in centres:
            return [(point, centres[link])]
        case Element.Group(bar_points=fixed):
            return [(point.point, point.start) for point in fixed if point.start in grounds]
    return []


def _distance(compiled: CompiledMachine, point: int, centre: Floats) -> float:
    """Distance of a point from a fixed one that it turns about, at an angle where the mechanism closes."""
    places = compiled.point_motion(point, np.linspace(0.1, 6.2, 24)).place
    distances = np.hypot(*(places - centre[:, None]))
    known = distances[np.isfinite(distances)]
    return float(known[0]) if len(known) else 0.0
