"""Programmes as mathematics: what rounding leaves is shared out; what does not close is refused."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest

from linkwright import InputError
from linkwright.cam import LAWS, Boundary, MotionLaw, Programme
from linkwright.cam.laws.programme import Section, programme

THIRD = 2 * math.pi / 3


def sections(lifts: tuple[float, ...], angles: tuple[float, ...], law: str = "cycloidal") -> Programme:
    shape = partial(lambda task, entry: entry.section(task), entry=LAWS[law])
    return programme([Section(angle, lift, shape) for lift, angle in zip(lifts, angles, strict=True)])


def test_what_rounding_leaves_of_the_lift_is_taken_from_the_largest() -> None:
    found = sections((0.1, 0.2, -0.3 * (1 + 5e-10)), (THIRD, THIRD, THIRD))
    assert abs(float(found.law.at(2 * math.pi))) < 1e-16
    assert float(found.law.at(THIRD)) == pytest.approx(0.1, rel=1e-15)
    assert all(each.order == 2 for each in found.joints)


def test_what_rounding_leaves_of_the_turn_is_shared() -> None:
    found = sections((0.1, 0.2, -0.3), (THIRD, THIRD, THIRD * (1 - 2e-9)))
    assert found.law.end == 2 * math.pi
    np.testing.assert_allclose(np.diff(found.law.breaks), THIRD, rtol=3e-9)


def test_what_does_not_close_is_refused() -> None:
    with pytest.raises(InputError, match=r"lifts of a programme add to 0\.01"):
        sections((0.1, 0.2, -0.29), (THIRD, THIRD, THIRD))
    with pytest.raises(InputError, match="add to 240°"):
        sections((0.1, -0.1), (THIRD, THIRD))


def test_one_section_is_its_own_neighbour() -> None:
    def wave(task: Boundary) -> MotionLaw:
        return LAWS["cycloidal"].normalised().scaled(0.0)

    found = programme([Section(2 * math.pi, 0.0, wave)])
    assert found.joints[0].jumps == (0.0,) * 5
    assert found.joints[0].words() == "continuous up to the fourth derivative"


def test_a_jump_of_the_lift_is_told() -> None:
    """By a law that goes elsewhere than its section says."""
    late = LAWS["cycloidal"].normalised().scaled(0.05)
    back = partial(lambda task, entry: entry.section(task), entry=LAWS["cycloidal"])
    found = programme([Section(math.pi, 0.1, lambda task: late), Section(math.pi, -0.1, back)])
    assert found.joints[1].order == -1
    assert found.joints[1].words() == "the lift jumps by 0.05 m"
