"""Paper 2 computed anew: a cart moved by a cam of constant diameter with a combined motion law.

Stroke and time of the worked case are printed, the distance b of the followers is not: it is that of the
machine in the library, ``roller_cam``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.cam.profile.profile import CamProfile, cam_profile
from linkwright.papers.paper2.alternatives import Alternative, alternatives
from linkwright.papers.paper2.conclusions import conclusions
from linkwright.papers.paper2.course import Course, course
from linkwright.papers.paper2.formulas import Formulas
from linkwright.papers.paper2.pair import Pair, pair
from linkwright.papers.paper2.roller import Rollers, rollers
from linkwright.papers.paper2.rows import rows_of
from linkwright.papers.paper2.start import Starts, starts
from linkwright.papers.published import printed_values
from linkwright.papers.row import Row

# Cam angles a turn of the curves.
_ANGLES = 1440


@dataclass(frozen=True)
class Paper2:
    """Paper 2, published against computed.

    Attributes
    ----------
    published : dict
        What is printed.
    formulas : Formulas
        The printed formulas.
    profile : CamProfile
        The cam by the general synthesis.
    starts : Starts
        The start section, and those of least ∫ jerk².
    rollers : Rollers
        Rollers on the printed profile.
    pair : Pair
        One cam against two.
    alternatives : tuple of Alternative
        The printed law, the crank drive, other laws.
    course : Course
        The cart in steady motion.
    rows : tuple of Row
        Every printed number and formula with its verdict.
    """

    published: dict[str, Any]
    formulas: Formulas
    profile: CamProfile
    starts: Starts
    rollers: Rollers
    pair: Pair
    alternatives: tuple[Alternative, ...]
    course: Course
    rows: tuple[Row, ...]

    @property
    def number(self) -> int:
        """Of the paper."""
        return int(self.published["number"])

    @property
    def title(self) -> str:
        """Of the paper, in English."""
        return str(self.published["title"])

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        rolled = {name: value for name, value in vars(self.rollers).items() if name != "offset"}
        return {
            "cam": self.profile.to_dict(),
            "start_section": self.starts.to_dict(),
            "rollers": rolled | {"cam": self.rollers.offset.to_dict()},
            "two_cams": vars(self.pair),
            "alternatives": [each.to_dict() for each in self.alternatives],
            "steady_motion": self.course.to_dict(),
            "rows": [vars(row) for row in self.rows],
            "conclusions": conclusions(self),
        }


def paper2() -> Paper2:
    """Compute paper 2 anew.

    Returns
    -------
    Paper2
        Published and computed values with verdicts.

    References
    ----------
    .. [1] Paper 2, whole.
    """
    data = printed_values(2)
    formulas = Formulas(data)
    drives = alternatives(formulas)
    profile = cam_profile(drives[0].machine, n=_ANGLES)
    sections = starts(formulas)
    return Paper2(
        published=data,
        formulas=formulas,
        profile=profile,
        starts=sections,
        rollers=rollers(profile, data["given"]["machine"], data["chosen"]["roller_radius"]),
        pair=pair(data["given"]["machine"], profile.name),
        alternatives=drives,
        course=course(drives[0], formulas),
        rows=rows_of(formulas, profile, sections),
    )
