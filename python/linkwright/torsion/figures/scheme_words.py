"""What is written beside the parts of a train's scheme, and how much room it takes."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.torsion.modes.scheme import Connection, Scheme

# Size of the letters [points], and what a letter and a line of it take [inch]: DejaVu Sans is 0.6 em wide in
# the mean of names and numbers.
SIZE = 7.0
_LETTER, LINE = 0.6 * SIZE / 72, 1.25 * SIZE / 72

# Ratios of speed nearer to one than this are those of the first disc: what is referred is then what is.
_SAME = 1e-9

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""))


@dataclass(frozen=True)
class Words:
    """Lines above and below a part."""

    # `above`, `below`: from top to bottom.
    above: tuple[str, ...]
    below: tuple[str, ...]

    @property
    def width(self) -> float:
        """Room of the longest line [inch]."""
        return max((wide(line) for line in (*self.above, *self.below)), default=0.0)


def wide(line: str) -> float:
    """Room of a line [inch]."""
    return _LETTER * len(line)


def disc_words(found: Scheme, n: int) -> Words:
    """Name, inertia, and where the speed is another one, the referred inertia in brackets."""
    own = f"{found.inertia[n]:.4g} kg m²"
    referred = () if _same(found.speed[n]) else (f"({found.inertia_referred[n]:.4g})",)
    return Words((found.discs[n],), (own, *referred))


def connection_words(each: Connection) -> Words:
    """Name and stiffness; the referred stiffness in brackets, and the equivalent length."""
    if each.kind == "gears":
        return Words((), (f"{each.name} i = {each.ratio:.4g}",))
    if each.stiffness is None or each.stiffness_referred is None:
        return Words((each.name,), ())
    own = stiffness(each.stiffness)
    below = (
        [] if _same(each.stiffness_referred / each.stiffness) else [f"({stiffness(each.stiffness_referred)})"]
    )
    if each.kind == "mesh":
        return Words((), (f"{each.name} i = {each.ratio:.4g}", own, *below))
    return Words((each.name, own), (*below, metres(each.equivalent_length or 0.0)))


def stiffness(value: float) -> str:
    """A stiffness with the prefix of its size."""
    factor, prefix = next(((f, p) for f, p in _PREFIXES if abs(value) >= f), _PREFIXES[-1])
    return f"{value / factor:.4g} {prefix}N m/rad"


def metres(length: float) -> str:
    """A length with three digits, without powers of ten where it is long."""
    return f"{length:.0f} m" if length >= 1000 else f"{length:.3g} m"


def _same(factor: float) -> bool:
    return abs(factor - 1) < _SAME
