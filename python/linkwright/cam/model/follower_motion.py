"""How the follower of a cam moves: its programme over one revolution, from the base circle, and its peaks.

The same sections give the same motion, which is worked out once.
"""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

from linkwright.cam.model.follower_train import FollowerTrain
from linkwright.cam.model.motion_section import Family, MotionSection, programme
from linkwright.kernel.description.plain import arrays
from linkwright.kernel.description.text import join
from linkwright.kernel.errors import ShapeError

if TYPE_CHECKING:
    from linkwright.cam.laws.motion_law import MotionLaw
    from linkwright.cam.laws.programme import Joint, Programme


class FollowerMotion:
    """The motion that some sections describe.

    Parameters
    ----------
    sections : tuple of MotionSection
        Without faults.
    family : {"lift", "swing"}
        What the follower does.
    train : FollowerTrain or None
        What vibrates behind the cam, which may ask for a lift of its own.

    Attributes
    ----------
    programme : Programme
        As the sections say: it begins with zero.
    lift : MotionLaw
        Counted from the base circle: its minimum value is zero [m or rad].
    stroke : float
        Maximum lift [m or rad].

    Raises
    ------
    ShapeError
        An entry of a section or of the train is an array over many machines.
    """

    def __init__(
        self, sections: tuple[MotionSection, ...], family: Family, train: FollowerTrain | None
    ) -> None:
        for what, part in (("sections", sections), ("train", train)):
            for place, _ in arrays(part):
                raise ShapeError(
                    f"{join((what, *place))}: the {what} of a cam cannot vary from machine to machine in a "
                    "batch; compute machines with others one by one"
                )
        self.programme: Programme = programme(sections, family)
        law = self.programme.law if train is None else train.lift_for(self.programme.law)
        least, greatest = law.extremes()
        self.lift: MotionLaw = law.scaled(1.0, -least.value)
        self.stroke = greatest.value - least.value

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """How smooth the lift is at segment boundaries, and where a law inside a section has a break."""
        from linkwright.cam.laws.programme import joints

        return joints(self.lift, self.lift.breaks[:-1])

    @cached_property
    def peaks(self) -> tuple[float | None, ...]:
        """Largest first, second and third derivative by the cam angle, in size; None where it is infinite."""
        smooth = min(joint.order for joint in self.joints)
        orders = range(1, 4)
        return tuple(abs(self.lift.peak(n).value) if n <= smooth + 1 else None for n in orders)

    @cached_property
    def steady_velocity(self) -> float | None:
        """Largest velocity that is kept over a piece, by the cam angle; None if there is none."""
        slopes = [
            abs(float(piece.derivative(high - low).at(0.5)))
            for piece, (low, high) in zip(self.lift.pieces, pairwise(self.lift.breaks), strict=True)
            if not piece.harmonics and not any(piece.polynomial[2:])
        ]
        return max(slopes, default=0.0) or None


def follower_motion(
    sections: tuple[MotionSection, ...], family: Family, train: FollowerTrain | None = None
) -> FollowerMotion:
    """The motion of some sections; the same as before for the same tuple.

    Parameters
    ----------
    sections : tuple of MotionSection
        Without faults.
    family : {"lift", "swing"}
        What the follower does.
    train : FollowerTrain or None
        What vibrates behind the cam.

    Returns
    -------
    FollowerMotion
        Programme, lift and peaks.
    """
    key = (id(sections), family, id(train))
    if key not in _known:
        if len(_known) >= _KNOWN_MAX:
            _known.pop(next(iter(_known)), None)
        # The parts are kept with their motion, so that nothing else can take their identity.
        _known[key] = ((sections, train), FollowerMotion(sections, family, train))
    return _known[key][1]


_known: dict[tuple[int, Family, int], tuple[object, FollowerMotion]] = {}
_KNOWN_MAX = 64
