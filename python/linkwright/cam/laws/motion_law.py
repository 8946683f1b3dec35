"""A motion law: lift over angle, or over time, in pieces that are polynomials and harmonics.

Every law of the textbooks has this form, and so have its derivatives, its sums with others, its stretched and
its mirrored image: all of them are exact.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Literal, NamedTuple

import numpy as np

from linkwright.cam.laws.piece import Harmonic, Piece, zeros
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.tangent import Tangent, lifted, numbers, plain, primal, total, variables_of
from linkwright.kernel.public.arguments import array, integer, number, shown

__all__ = ["Extreme", "Harmonic", "MotionLaw", "Piece", "combined", "joined"]

Side = Literal["after", "before"]

# Share of the whole domain below which two breaks are one.
_SAME = 1e-12

# Share of the domain by which a place may be beyond its ends by rounding.
_ROUNDING = 1e-9

# Beyond this angle, or time, the powers of a polynomial leave the range of numbers.
_FAR = 1e9

# Derivatives beyond are of no use, and beyond the range of numbers before long.
_ORDER_MAX = 100


class Extreme(NamedTuple):
    """A maximum or minimum value.

    Attributes
    ----------
    at : float
        Where.
    value : float
        How much.
    side : str
        Whether it is reached ``"after"`` that place or ``"before"`` it; only at a jump the two differ.
    """

    at: float
    value: float
    side: Side


def _places(x: Any) -> Floats:
    """Places of a law as an array; an `InputError` where a polynomial would pass the range of numbers."""
    places: Floats = array("x", x)
    farthest = np.abs(places).max(initial=0.0)
    if farthest > _FAR:
        raise InputError(f"x: found {farthest:.6g} in size, expected {_FAR:g} at most")
    return places


def _real(name: str, value: Any) -> Any:
    """A finite number, or one with derivatives; an `InputError` that names it for anything else."""
    return value if isinstance(value, Tangent) else number(name, value)


@dataclass(frozen=True)
class MotionLaw:
    """A law in pieces.

    Attributes
    ----------
    breaks : tuple of float, length n + 1
        Ends of the pieces, increasing [rad, s or –].
    pieces : tuple of Piece, length n
    """

    breaks: tuple[float, ...]
    pieces: tuple[Piece, ...]

    @classmethod
    def of(cls, start: float, *stretches: tuple[float, Piece]) -> MotionLaw:
        """A law from pairs of length and piece, one after the other, without those of no length."""
        least = _SAME * total(length for length, _ in stretches)
        kept = [(length, piece) for length, piece in stretches if length > least]
        ends = [total([start, *(length for length, _ in kept[:i])]) for i in range(len(kept) + 1)]
        return cls(tuple(ends), tuple(piece for _, piece in kept))

    @property
    def start(self) -> float:
        """Where it begins."""
        return self.breaks[0]

    @property
    def end(self) -> float:
        """Where it ends."""
        return self.breaks[-1]

    @property
    def length(self) -> float:
        """From start to end."""
        return self.end - self.start

    def _stretches(self) -> Iterable[tuple[float, float, Piece]]:
        for low, high, piece in zip(self.breaks, self.breaks[1:], self.pieces, strict=False):
            yield low, high - low, piece

    def at(self, x: Any, order: int = 0, side: Side = "after") -> Any:
        """Value, or derivative of an order, of the shape of ``x``; beyond the ends the outer pieces go on.

        `side`: which piece counts at a break, that ``"after"`` or ``"before"`` it. With derivatives where the
        law or x has some.
        """
        if not isinstance(side, str) or side not in ("after", "before"):
            raise InputError(f'side: found {shown(side)}, expected "after" or "before"')
        n = variables_of((x,)) or self.variables
        x = _places(x) if n is None else lifted(x, n)
        if n is not None and not x.ndim:
            return self.at(x.reshape(1), order, side)[0]
        law = self.derivative(order)
        inner = np.array(self.primal.breaks[1:-1])
        index = np.searchsorted(inner, primal(x), side="right" if side == "after" else "left")
        value: Any = np.zeros_like(x) if n is None else lifted(np.zeros(x.shape), n)
        for i, (low, length, piece) in enumerate(law._stretches()):
            here = index == i
            if here.any():
                value[here] = piece.at((x[here] - low) / length)
        return value

    def value(self, x: Any, order: int = 0, side: Side = "after") -> Any:
        """The value at one place, a number; with derivatives if it has some."""
        return plain(self.at(x, order, side))

    @cached_property
    def variables(self) -> int | None:
        """By how many variables it has derivatives; None without any."""
        numbers = (x for piece in self.pieces for x in piece.numbers)
        return variables_of((*self.breaks, *numbers))

    @cached_property
    def primal(self) -> MotionLaw:
        """The law without derivatives."""
        if self.variables is None:
            return self
        return MotionLaw(tuple(map(primal, self.breaks)), tuple(piece.primal for piece in self.pieces))

    def derivative(self, order: int = 1) -> MotionLaw:
        """The law's derivative of any order, piece by piece; jumps at breaks are left out."""
        if not 0 <= integer("derivative", order) <= _ORDER_MAX:
            raise InputError(f"derivative: found {shown(order)}, expected an order from 0 to {_ORDER_MAX}")
        law = self
        for _ in range(order):
            law = law._derivative
        return law

    @cached_property
    def _derivative(self) -> MotionLaw:
        pieces = tuple(piece.derivative(length) for _, length, piece in self._stretches())
        return MotionLaw(self.breaks, pieces)

    def integral(self, start: float = 0.0) -> MotionLaw:
        """The law whose derivative this is, continuous, beginning with the value `start`."""
        start, pieces = _real("start", start), list[Piece]()
        for _, length, piece in self._stretches():
            pieces.append(piece.integral(length, start))
            start = pieces[-1].value(1.0)
        return MotionLaw(self.breaks, tuple(pieces))

    # -- laws from laws ----------------------------------------------------------------------------------

    def scaled(self, factor: float, shift: float = 0.0) -> MotionLaw:
        """Factor times the law, plus a constant."""
        factor, shift = _real("factor", factor), _real("shift", shift)
        return MotionLaw(self.breaks, tuple(piece.scaled(factor, shift) for piece in self.pieces))

    def placed(self, start: float, length: float) -> MotionLaw:
        """The same course over another stretch: values stay, derivatives change."""
        start, length = _real("start", start), _real("length", length)
        if not length > 0:
            raise InputError(f"length: found {length:g}, expected more than 0")
        scale = length / self.length
        inner = tuple(start + (x - self.start) * scale for x in self.breaks[1:-1])
        return MotionLaw((start, *inner, start + length), self.pieces)

    def reversed(self) -> MotionLaw:
        """The law run through backwards, over the same stretch."""
        inner = tuple(self.start + (self.end - x) for x in self.breaks[-2:0:-1])
        pieces = tuple(piece.part(1.0, 0.0) for piece in self.pieces[::-1])
        return MotionLaw((self.start, *inner, self.end), pieces)

    def stretch(self, low: float, high: float) -> MotionLaw:
        """The part between two places inside the law."""
        low, high = _real("low", low), _real("high", high)
        slack = _ROUNDING * self.length
        if not self.start - slack <= low < high <= self.end + slack:
            found, own = (
                f"{primal(low):g} to {primal(high):g}",
                f"{primal(self.start):g} to {primal(self.end):g}",
            )
            raise InputError(f"low, high: found {found}, expected a part of {own}")
        return self._cut([low, *(x for x in self.breaks if low < x < high), high])

    def shifted(self, by: float) -> MotionLaw:
        """A periodic law over its whole stretch, starting ``by`` later and going on at its start."""
        by = np.remainder(_real("by", by), self.length)
        cut = self.end - by
        beside = min(self.primal.breaks, key=lambda place: abs(place - cut))
        if abs(beside - cut) <= _SAME * self.length:
            # Rounding makes no piece of its own.
            cut, by = beside, self.end - beside
        if not self.start < cut < self.end:
            return self
        tail, head = self.stretch(cut, self.end), self.stretch(self.start, cut)
        return joined([tail.placed(self.start, by), head.placed(self.start + by, self.length - by)])

    def _cut(self, breaks: Sequence[float]) -> MotionLaw:
        """The same law with other breaks, of which none lies inside a piece unseen."""
        own, pieces = np.array(self.primal.breaks), []
        for low, high in pairwise(breaks):
            i = int(np.clip(np.searchsorted(own, primal(0.5 * (low + high))) - 1, 0, len(self.pieces) - 1))
            start, length = self.breaks[i], self.breaks[i + 1] - self.breaks[i]
            ends = (low - start) / length, (high - start) / length
            # An end that moves otherwise than that of the piece makes another one of it.
            moves = any(isinstance(end, Tangent) and end.d.any() for end in ends)
            is_complete = not moves and abs(ends[0]) < _SAME and abs(ends[1] - 1) < _SAME
            pieces.append(self.pieces[i] if is_complete else self.pieces[i].part(*ends))
        return MotionLaw(tuple(breaks), tuple(pieces))

    # -- what is special about it ------------------------------------------------------------------------

    def jumps(self, order: int) -> Floats:
        """By how much a derivative jumps at each inner break, (n − 1,)."""
        inner = np.array(self.primal.breaks[1:-1])
        jumps: Floats = self.at(inner, order, "after") - self.at(inner, order, "before")
        return jumps

    def zeros(self, order: int = 0) -> list[float]:
        """Where a derivative is zero inside the pieces, increasing; a piece that is zero has none."""
        # They are asked for again and again: the extremes of a law, its speeds, where it turns.
        known, law = self.primal._zeros, self.primal.derivative(order)
        if order not in known:
            known[order] = tuple(law._find_zeros())
        return list(known[order])

    @cached_property
    def _zeros(self) -> dict[int, tuple[float, ...]]:
        """Order of a derivative → its zeros, as far as they were asked for."""
        return {}

    def _find_zeros(self) -> list[float]:
        scale = max((float(np.abs(p.at(np.linspace(0, 1, 9))).max()) for p in self.pieces), default=0.0)
        places: list[float] = []
        for low, length, piece in self._stretches():
            if not piece.vanishes(scale):
                degree = max(len(piece.polynomial) - 1, 0)
                places += [low + length * u for u in zeros(piece.at, degree, piece.waves)]
        return places

    def extremes(self, order: int = 0) -> tuple[Extreme, Extreme]:
        """Minimum and maximum of the law, or of its derivative of an order; of equal ones the first."""
        order = integer("order", order)
        ends = [(x, "after") for x in self.breaks[:-1]] + [(x, "before") for x in self.breaks[1:]]
        listed: list[Extreme] = []
        for side in ("after", "before"):
            places = [x for x, which in ends if which == side]
            places += self.zeros(order + 1) if side == "after" else []
            values = self._values(places, order, side)
            listed += [Extreme(primal(x), v, side) for x, v in zip(places, values, strict=True)]
        listed.sort(key=lambda extreme: extreme.at)
        return min(listed, key=lambda extreme: extreme.value), max(listed, key=lambda extreme: extreme.value)

    def _values(self, places: Sequence[Any], order: int, side: Side) -> list[Any]:
        """Values at places, which move if they are tangents; numbers."""
        if self.variables is None:
            return [float(v) for v in self.at(np.array(places), order, side)]
        return list(self.at(numbers(places), order, side))

    def peak(self, order: int = 0) -> Extreme:
        """The value of a derivative that is largest in magnitude."""
        return max(self.extremes(order)[::-1], key=lambda extreme: abs(extreme.value))

    def integral_of_square(self, order: int = 0) -> float:
        """∫ (dⁿs/dxⁿ)² dx over the law: Gauss–Legendre, exact for polynomials, to rounding for harmonics."""
        terms: list[float] = []
        for _, length, piece in self.derivative(order)._stretches():
            nodes = len(piece.polynomial) + 24 + int(2 * piece.waves)
            x, weight = np.polynomial.legendre.leggauss(nodes)
            terms += list(0.5 * length * weight * piece.at(0.5 * (x + 1)) ** 2)
        return float(total(terms))


def joined(laws: Sequence[MotionLaw]) -> MotionLaw:
    """Laws one after the other; each begins where the one before ends, with its values as they are."""
    breaks = [laws[0].start]
    for law in laws:
        breaks += law.breaks[1:]
    return MotionLaw(tuple(breaks), tuple(piece for law in laws for piece in law.pieces))


def combined(*terms: tuple[float, MotionLaw]) -> MotionLaw:
    """A sum of laws over the same stretch, each times a factor: pairs of factor and law."""
    first = terms[0][1]
    breaks: list[float] = []
    for x in sorted((x for _, law in terms for x in law.breaks), key=primal):
        if not breaks or x - breaks[-1] > _SAME * first.length:
            breaks.append(x)
    breaks[-1] = first.end
    cut = [law._cut(breaks).scaled(factor) for factor, law in terms]
    pieces = list(cut[0].pieces)
    for law in cut[1:]:
        pieces = [a.plus(b) for a, b in zip(pieces, law.pieces, strict=True)]
    return MotionLaw(tuple(breaks), tuple(pieces))
