"""Motion generation: the body passes its poses, as a rigid body; what cannot be is reported."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sizes import cases

import linkwright as lw
from linkwright import MachineError, SynthesisError, loads
from linkwright.machine import dumps
from linkwright.synthesis.four_bar import FourBar
from linkwright.synthesis.slider_pose import circle_of_sliders
from linkwright.synthesis.task import MovingPoint, Poses, PoseTask
from linkwright.synthesis.verification import least_transmission, travel

POSES = Poses(x=(0, 0.04, 0.06), y=(0, 0.02, 0.06), angle=(0, np.radians(20), np.radians(50)))
A, B = MovingPoint(x=-0.02, y=-0.05), MovingPoint(x=0.06, y=-0.04)


def places(guide: object, task: PoseTask) -> np.ndarray:
    """The body's own places of two of its points, from the analysis of the machine alone."""
    link = "B.coupler" if guide.linkage == "four-bar" else "B.rod"
    motion = lw.motions(guide.machine, guide.crank_angles, points=["P", "A"], links=[link])[0]
    turned = (motion[12] + 1j * motion[13]) / (motion[12, 0] + 1j * motion[13, 0])
    body = np.exp(1j * task.poses.angle[0]) * turned
    origin = motion[0] + 1j * motion[1]
    pin = (motion[6] + 1j * motion[7] - origin) / body
    return np.stack([origin, body, pin])


@pytest.mark.parametrize("linkage", ["four-bar", "slider-crank"])
def test_three_poses_are_met(linkage: str) -> None:
    second = {"rocker_point": B} if linkage == "four-bar" else {"slider_point": B}
    task = PoseTask(linkage=linkage, poses=POSES, crank_point=A, **second)
    guide = lw.pose_guide(task)
    origin, body, pin = places(guide, task)
    wanted = np.array(POSES.x) + 1j * np.array(POSES.y)
    assert np.abs(origin - wanted).max() < 1e-15
    assert np.abs(body - np.exp(1j * np.array(POSES.angle))).max() < 1e-14
    # A rigid body: the crank pin is at its place in the body's axes in every pose.
    assert np.abs(pin - complex(A.x, A.y)).max() < 1e-14
    assert guide.pose_error < 1e-15
    assert loads(dumps(guide.machine)) == guide.machine


@settings(max_examples=cases(60, 600), deadline=None, derandomize=True)
@given(turn=st.floats(0.3, 2.5), other=st.floats(-2.5, -0.3), sign=st.sampled_from([1, -1]))
def test_two_poses_and_the_turns_of_the_links(turn: float, other: float, sign: int) -> None:
    poses = Poses(x=(0, 0.1), y=(0, 0.03), angle=(0.1, 0.5))
    crank = MovingPoint(x=0, y=0, turn=sign * turn)
    rocker = MovingPoint(x=0.08, y=0.02, turn=sign * other)
    task = PoseTask(poses=poses, crank_point=crank, rocker_point=rocker)
    finding = ""
    try:
        guide = lw.pose_guide(task)
    except SynthesisError as error:
        finding = str(error)
    if finding:
        assert "branches" in finding or "neither direction" in finding
        return
    assert guide.crank_angles[1] == pytest.approx(sign * turn)
    assert guide.pose_error < 1e-13
    motion = lw.motions(guide.machine, guide.crank_angles, links=["B.rocker"])[0]
    rocked = np.angle((motion[0, 1] + 1j * motion[1, 1]) / (motion[0, 0] + 1j * motion[1, 0]))
    assert rocked == pytest.approx(sign * other, abs=1e-9)


def test_a_known_linkage_is_found_again() -> None:
    bar = FourBar(0.01 + 0.02j, 0.16 + 0.03j, 0.05, 0.12, 0.11, "left", 0.4)
    angles = np.array([0.0, 0.7, 1.9])
    motion = lw.kinematics(bar.machine("known", points={"P": 0.06 + 0.04j}), angles)
    p, angle = motion.points["P"].position, motion.links["B.coupler"].angle
    found = lw.pose_guide(
        PoseTask(
            poses=Poses(x=tuple(p[:, 0]), y=tuple(p[:, 1]), angle=tuple(angle)),
            crank_point=MovingPoint(x=-0.06, y=-0.04),
            rocker_point=MovingPoint(x=0.06, y=-0.04),
        )
    )
    sizes = (found.frame, found.crank, found.coupler, found.rocker)
    assert sizes == pytest.approx((bar.frame, 0.05, 0.12, 0.11), rel=1e-11)
    assert found.crank_angles == pytest.approx(angles, rel=1e-10)
    assert found.type == "crank-rocker"


@settings(max_examples=cases(60, 600), deadline=None, derandomize=True)
@given(
    st.tuples(*4 * [st.floats(-1, 1)]),
    st.tuples(*2 * [st.floats(-3, 3)]),
    st.tuples(*2 * [st.floats(-1, 1)]),
)
def test_points_on_the_circle_of_sliders_stay_in_line(
    p: tuple[float, ...], turned: tuple[float, ...], wanted: tuple[float, ...]
) -> None:
    origins = np.array([0, p[0] + 1j * p[1], p[2] + 1j * p[3]])
    angles = np.array([0.0, *turned])
    if min(abs(np.sin((angles[i] - angles[i - 1]) / 2)) for i in range(3)) < 0.05:
        return
    point = circle_of_sliders(origins, angles, complex(*wanted))
    z = origins + point * np.exp(1j * angles)
    area = abs(np.imag(np.conj(z[1] - z[0]) * (z[2] - z[0])))
    # Rounding of the circle's radius, which may be large.
    assert area < 1e-10 * (1 + abs(point)) ** 2


def test_a_circle_through_points_in_line_is_a_finding() -> None:
    poses = Poses(x=(0, 0.1, 0.3), y=(0, 0.1, 0.3), angle=(0, 0.2, 0.4))
    task = PoseTask(poses=poses, crank_point=MovingPoint(x=0), rocker_point=MovingPoint(x=0.1))
    with pytest.raises(SynthesisError, match=r"straight line.*infinitely far.*slider"):
        lw.pose_guide(task)


def test_poses_on_two_branches_are_a_finding() -> None:
    bar = FourBar(0j, 0.16 + 0j, 0.05, 0.12, 0.11, "left")
    other = FourBar(0j, 0.16 + 0j, 0.05, 0.12, 0.11, "right")
    p, angle = [], []
    for each, at in ((bar, 0.3), (bar, 1.0), (other, 2.0)):
        motion = lw.kinematics(each.machine("x", points={"P": 0j}), [at])
        p.append(motion.points["P"].position[0])
        angle.append(float(motion.links["B.coupler"].angle[0]))
    x, y = zip(*p, strict=True)
    task = PoseTask(
        poses=Poses(x=x, y=y, angle=tuple(angle)),
        crank_point=MovingPoint(x=0),
        rocker_point=MovingPoint(x=0.12),
    )
    with pytest.raises(SynthesisError, match=r"different branches.*left, left, right"):
        lw.pose_guide(task)


def test_all_problems_of_a_task_are_told() -> None:
    with pytest.raises(MachineError) as caught:
        PoseTask(
            linkage="slider-crank",
            poses={"x": [0, 1, 2, 3], "y": [0, 1], "angle": [0]},
            crank_point={"x": "3 kg"},
            rocker_point={"x": 1},
        )
    assert [each.key for each in caught.value.problems] == ["crank_point.x"]
    with pytest.raises(MachineError) as caught:
        PoseTask(
            linkage="slider-crank",
            poses={"x": [0, 1, 2, 3], "y": [0, 1], "angle": [0]},
            crank_point={"x": 1},
            rocker_point={"x": 1},
        )
    keys = {each.key for each in caught.value.problems}
    assert keys == {"poses.x", "poses.y", "poses.angle", "slider_point", "rocker_point"}


def test_a_gap_between_positions_is_a_circuit_defect() -> None:
    """A double rocker closes in two ranges of its crank, mirror images in the frame line."""
    bar = FourBar(0j, 4 + 0j, 5, 2, 5)
    closes = bar.gap(np.linspace(-np.pi, np.pi, 2001)) >= 0
    assert (np.diff(closes.astype(int)) != 0).sum() == 4
    inside = np.radians([45.0, 60.0])
    assert travel(bar.gap, [*inside]) == pytest.approx(inside)
    assert travel(bar.gap, [inside[0], -inside[1]]) is None
    # Another order than that of the crank's turning.
    assert travel(bar.gap, [inside[0], inside[1], inside[0] + 0.01]) is None


def test_travel_turns_the_shorter_way_unless_told() -> None:
    free = FourBar(0j, 0.16 + 0j, 0.05, 0.12, 0.11).gap
    assert travel(free, [0.0, 5.0]) == pytest.approx([0, 5 - 2 * np.pi])
    assert travel(free, [0.0, 5.0], turn=1.0) == pytest.approx([0, 5])
    assert travel(free, [0.0, 2.0, 5.0]) == pytest.approx([0, 2, 5])


def test_poses_on_two_circuits_are_a_finding() -> None:
    bar = FourBar(0j, 4 + 0j, 5, 2, 5, "left")
    p, angle = [], []
    for at in (0.8, 1.0, -0.9):
        motion = lw.motions(bar.machine("x", points={"P": 0j}), [at], points=["P"], links=["B.coupler"])[0]
        p.append((motion[0, 0], motion[1, 0]))
        angle.append(float(np.arctan2(motion[7, 0], motion[6, 0])))
    x, y = zip(*p, strict=True)
    task = PoseTask(
        poses=Poses(x=x, y=y, angle=tuple(angle)),
        crank_point=MovingPoint(x=0),
        rocker_point=MovingPoint(x=2),
    )
    with pytest.raises(SynthesisError, match="neither direction"):
        lw.pose_guide(task)


def test_least_transmission_angle_between_samples() -> None:
    """Where crank and frame are in line, whatever angles are looked at; else at an end."""
    bar = FourBar(0j, 1 + 0j, 0.3, 0.9, 0.7)
    exact = np.arccos((0.9**2 + 0.7**2 - 0.7**2) / (2 * 0.9 * 0.7))
    assert least_transmission(bar.transmission_angle, -1.0, 0.5) == pytest.approx(exact, abs=1e-12)
    ends = bar.transmission_angle(np.array([0.5, 1.0]))
    assert least_transmission(bar.transmission_angle, 1.0, 0.5) == pytest.approx(ends.min(), abs=1e-12)


def test_three_poses_about_given_fixed_pivots() -> None:
    """Pivots that follow from points of the body give these points back."""
    guide = lw.pose_guide(PoseTask(poses=POSES, crank_point=A, rocker_point=B))
    points = guide.machine.mechanism.points
    pivots = {
        f"{name}_pivot": {"x": points[place].x, "y": points[place].y}
        for name, place in (("crank", "A0"), ("rocker", "B0"))
    }
    again = lw.pose_guide(PoseTask(poses=POSES, **pivots))
    for length in ("frame", "crank", "coupler", "rocker"):
        assert getattr(again, length) == pytest.approx(getattr(guide, length), rel=1e-11)
    assert again.pose_error < 1e-14
    one = lw.pose_guide(PoseTask(poses=POSES, crank_point=A, rocker_pivot=pivots["rocker_pivot"]))
    assert one.rocker == pytest.approx(guide.rocker, rel=1e-11)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"rocker_point": B}, "crank_point"),
        (
            {"crank_point": A, "crank_pivot": {"x": 0, "y": 1}, "rocker_point": B},
            "nothing beside crank_point",
        ),
        ({"crank_point": A, "rocker_point": B, "slider_point": B}, "has no such point"),
    ],
)
def test_ends_of_links_that_do_not_go_together(given: dict[str, object], words: str) -> None:
    with pytest.raises(MachineError, match=words):
        PoseTask(poses=POSES, **given)


def test_a_pivot_that_stays_in_the_body_is_refused() -> None:
    """The body turns about (0.1, 0): this pivot is no end of a link."""
    angles = np.array([0.0, 0.3, 0.8])
    origin = 0.1 - 0.1 * np.exp(1j * angles)
    poses = Poses(x=tuple(origin.real), y=tuple(origin.imag), angle=tuple(angles))
    with pytest.raises(SynthesisError, match="only turns about this pivot"):
        lw.pose_guide(PoseTask(poses=poses, crank_pivot={"x": 0.1, "y": 0.0}, rocker_point=B))
