"""How many independent motions a mechanism has by the count of its links and pairs.

.. math:: W = 3 n - 2 p_1 - p_2

with n moving links, p₁ pairs of one freedom (pins and guides) and p₂ pairs of two (slots, teeth, cables): the
formula of Chebyshev and Grübler (Artobolevsky, *Theory of Mechanisms and Machines*, structure of plane
mechanisms; Norton, *Design of Machinery*, chapter 2).
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.kernel.public import public
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.linkages.model.structure import Structure, structure


@dataclass(frozen=True, slots=True)
class Mobility:
    """The count of a mechanism.

    Attributes
    ----------
    links : int
        n, moving links; cranks on one pivot are one link.
    lower, higher : int
        p₁, pins and guides; p₂, slots, teeth and cables, and drivers that the drive holds to the first.
    redundant : tuple of str
        Bars that take a freedom without need.
    """

    links: int
    lower: int
    higher: int
    redundant: tuple[str, ...]

    @property
    def freedom(self) -> int:
        """W, the degree of freedom by the count."""
        return 3 * self.links - 2 * self.lower - self.higher

    def __str__(self) -> str:
        """One line in words."""
        counted = (
            (self.links, "moving link", "moving links"),
            (self.lower, "pin or guide", "pins and guides"),
            (self.higher, "slot, tooth contact or coupling", "slots, teeth or couplings"),
        )
        count = ", ".join(f"{n} {one if n == 1 else many}" for n, one, many in counted if n)
        formula = f"W = 3·{self.links} − 2·{self.lower}" + (f" − {self.higher}" if self.higher else "")
        text = f"{count}: {formula} = {self.freedom}".replace("-", "−")
        if self.redundant:
            text += f"; it moves only because of the lengths of the redundant {', '.join(self.redundant)}"
        return text


@public
def mobility(mechanism: Mechanism) -> Mobility:
    """Count links and pairs.

    Parameters
    ----------
    mechanism : Mechanism

    Returns
    -------
    Mobility
        W is 1, less one for each redundant bar: all cranks and drivers turn together.

    Notes
    -----
    A pin that two guides cross at counts as two blocks with a pin. A driver on another pivot than the first
    is held to it by the drive, which counts as a pair of two freedoms.
    """
    members = structure(mechanism)
    pairs = [pair.kind for pair in members.pairs.values()]
    bars = len(members.redundant)
    pins = sum(not member.turns for member in members.members.values())
    apart, together = _drivers(members)
    lower = sum(kind in ("pin", "guide") for kind in pairs) + pins + bars - together
    higher = sum(kind not in ("pin", "guide") for kind in pairs) - bars + apart
    return Mobility(len(members.members) + pins - together, lower, higher, members.redundant)


def _drivers(members: Structure) -> tuple[int, int]:
    """Drivers beside the first that need a coupling, and cranks that are one link with another."""
    turned = [members.members[drive.member].point for drive in members.drives if drive.guide is None]
    moved = len(members.drives) - len(turned)
    together = len(turned) - len(set(turned))
    return max(0, len(set(turned)) + moved - 1), together
