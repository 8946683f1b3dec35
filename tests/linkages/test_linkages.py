"""Linkages of all elements: laws, change points, groups against dyads, and findings in words."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import AssemblyError, InputError, loads
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine import compile_machine

HEAD = 'format = 1\nname = "linkage"\n'
FOUR_BAR = """
[mechanism.points]
B = { x = 0.16 }
[mechanism.cranks]
A = { radius = 0.05 }
"""
EXAMPLES = Path(__file__).parents[2] / "examples"
TRIAD = EXAMPLES / "three_circle_triad/machine.toml"


def machine(text: str) -> lw.Machine:
    return loads(HEAD + text)


def rates_error(motion: lw.Kinematics) -> float:
    """Largest difference of the rates of points from those of their Fourier series."""
    n = len(motion.angles)
    order = 1j * np.arange(n // 2 + 1)[:, None]
    pairs = [
        pair for each in motion.points.values() for pair in ((each.position, each.d1), (each.d1, each.d2))
    ]
    return max(
        float(np.abs(np.fft.irfft(np.fft.rfft(x, axis=0) * order, n, axis=0) - rate).max())
        for x, rate in pairs
    )


TURN = np.linspace(0, 2 * np.pi, 361)[:-1]


# -- the same linkage said in two ways -----------------------------------------------------------------------


def test_joints_and_bars_are_the_rocker() -> None:
    rocker = machine(
        FOUR_BAR + '[mechanism.rockers]\nC = { crank = "A", pivot = "B", coupler = 0.12, rocker = 0.11 }\n'
    )
    bars = machine(
        FOUR_BAR
        + "[mechanism.joints]\nC = { x = 0.1, y = 0.1 }\n[mechanism.bars]\n"
        + 'coupler = { start = "A", end = "C", length = 0.12 }\n'
        + 'rocker = { start = "C", end = "B", length = 0.11 }\n'
    )
    a, b = (lw.kinematics(each, TURN) for each in (rocker, bars))
    for left, right in zip(
        (a.points["C"].position, a.points["C"].d2), (b.points["C"].position, b.points["C"].d2), strict=True
    ):
        assert np.abs(left - right).max() < 1e-15
    # A bar that ends where the rocker starts runs the other way.
    turn = np.exp(1j * (a.links["C.rocker"].angle - b.links["rocker"].angle))
    assert np.abs(turn + 1).max() < 1e-14
    assert np.abs(a.links["C.rocker"].d2 - b.links["rocker"].d2).max() < 1e-14


@pytest.mark.parametrize("y", [0.1, -0.1])
def test_a_joint_is_assembled_on_the_side_where_it_is_given(y: float) -> None:
    bars = machine(
        FOUR_BAR
        + f"[mechanism.joints]\nC = {{ x = 0.1, y = {y} }}\n[mechanism.bars]\n"
        + 'coupler = { start = "A", end = "C", length = 0.12 }\n'
        + 'rocker = { start = "B", end = "C", length = 0.11 }\n'
    )
    assert np.sign(lw.kinematics(bars, [0.0]).points["C"].position[0, 1]) == np.sign(y)


def test_a_guide_that_turns_with_the_crank() -> None:
    """A pulley that turns with the crank carries the guide: crank, rod and guide are a rigid triangle."""
    turned = machine(
        """
[mechanism.cranks]
A = { radius = 0.1 }
[mechanism.gears]
still = { pivot = "O", meshes = "A", carrier = "A", kind = "belt", size = 1, size_other = 1 }
[mechanism.sliders]
S = { crank = "A", rod = 0.3, on = "still", angle = "30 deg", offset = 0.02 }
"""
    )
    motion = lw.kinematics(turned, TURN)
    assert np.ptp(motion.slides["S"].position) < 1e-15
    assert np.abs(motion.links["S.rod"].d1 - 1).max() < 1e-14


def test_guide_through_a_slider_goes_with_it() -> None:
    """A compound slide: the second slider moves on a guide that the first one carries along."""
    slides = machine(
        """
[mechanism.cranks]
A = { radius = 0.1 }
B = { radius = 0.05, phase = "90 deg" }
[mechanism.sliders]
S = { crank = "A", rod = 0.4 }
T = { crank = "B", rod = 0.9, through = "S", angle = "80 deg" }
"""
    )
    motion = lw.kinematics(slides, TURN)
    assert rates_error(motion) < 1e-11
    off = motion.points["T"].position - motion.points["S"].position
    assert np.abs(off @ [-np.sin(np.radians(80)), np.cos(np.radians(80))]).max() < 1e-15


def test_yoke_is_a_crossing() -> None:
    yoke = machine(
        "[mechanism.cranks]\nA = { radius = 0.1 }\n[mechanism.yokes]\n"
        'Y = { pin = "A", slot = "60 deg", guide = { offset = 0.05 } }\n'
    )
    motion = lw.kinematics(yoke, TURN)
    # The slot leans by 60°: s = x − (y − offset)/tan 60°.
    expected = 0.1 * np.cos(TURN) - (0.1 * np.sin(TURN) - 0.05) / np.tan(np.pi / 3)
    assert np.abs(motion.slides["Y"].position - expected).max() < 1e-15
    assert rates_error(motion) < 1e-12


def test_oscillating_cylinder_has_its_law_of_cosines() -> None:
    cylinder = machine(
        "[mechanism.points]\nP = { x = 0.3 }\n[mechanism.cranks]\nA = { radius = 0.1 }\n"
        '[mechanism.slotted_levers]\nL = { pin = "A", pivot = "P" }\n'
    )
    length = np.sqrt(0.01 + 0.09 - 0.06 * np.cos(TURN))
    motion = lw.kinematics(cylinder, TURN)
    assert np.abs(motion.slides["L"].position - length).max() < 1e-15
    assert np.abs(motion.slides["L"].d1 - 0.03 * np.sin(TURN) / length).max() < 1e-15


# -- change points -------------------------------------------------------------------------------------------


CRANK_ROCKER = """
[mechanism.points]
B = { x = 0.16 }
D = { x = 0.36 }
[mechanism.cranks]
A = { radius = 0.05 }
[mechanism.rockers]
C = { crank = "A", pivot = "B", coupler = 0.12, rocker = 0.11 }
"""


def test_folding_dyad_on_a_four_bar_linkage() -> None:
    """A parallelogram on the rocker of a crank-rocker folds in the middle of its swing, twice a revolution.

    The far bar turns exactly as the rocker at, near and far from there.
    """
    swing = lw.kinematics(machine(CRANK_ROCKER), TURN).links["C.rocker"].angle
    middle = 0.5 * (swing.min() + swing.max())
    side = "left" if swing[1] > middle else "right"
    along, across = 0.08 * np.cos(middle), -0.08 * np.sin(middle)
    far = f'E = {{ crank = "K", pivot = "D", coupler = 0.2, rocker = 0.08, assembly = "{side}" }}\n'
    place = f'link = "C.rocker", along = {along:.17g}, across = {across:.17g}'
    arm = f"[mechanism.rigid_points]\nK = {{ {place} }}\n"
    linkage = machine(CRANK_ROCKER + far + arm)
    folds = TURN[np.flatnonzero(np.diff(np.sign(swing - middle)))]
    assert len(folds) == 2
    # The fold itself, to rounding, by halving.
    for k, fold in enumerate(folds):
        low, high = fold, fold + TURN[1]
        up = np.sign(lw.kinematics(linkage, [high]).links["C.rocker"].angle[0] - middle)
        for _ in range(60):
            at = 0.5 * (low + high)
            ahead = np.sign(lw.kinematics(linkage, [at]).links["C.rocker"].angle[0] - middle) == up
            low, high = (low, at) if ahead else (at, high)
        folds[k] = low
    apart = 10.0 ** -np.arange(2.0, 13)
    near = (folds[:, None] + np.concatenate([-apart, [0.0], apart])).ravel()
    links = lw.kinematics(linkage, np.sort(np.concatenate([TURN, near]))).links
    assert np.abs(links["E.coupler"].d1).max() < 1e-10
    assert np.abs(links["E.rocker"].d1 - links["C.rocker"].d1).max() < 1e-10
    assert np.abs(links["E.rocker"].d2 - links["C.rocker"].d2).max() < 1e-7


# -- findings -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            FOUR_BAR.replace("0.16", "1")
            + "[mechanism.joints]\nJ = { x = 0.1, y = 0.3 }\n[mechanism.bars]\n"
            + 'a = { start = "A", end = "J", length = 0.3 }\nb = { start = "B", end = "J", length = 0.35 }\n',
            [
                "does not close at any crank angle",
                "a (0.3 m) and b (0.35 m)",
                "the joint J",
                "change their lengths",
            ],
        ),
        (
            "[mechanism.points]\nB = { x = 0.04 }\n[mechanism.cranks]\nA = { radius = 0.1 }\n"
            '[mechanism.slotted_levers]\nL = { pin = "A", pivot = "B", offset = 0.08 }\n',
            ["closes only at crank angles 49.46° to 310.54°", "the pin of L", "0.08 m", "reduce the offset"],
        ),
        (
            "[mechanism.points]\nB = { x = 0.1 }\n[mechanism.cranks]\nA = { radius = 0.1 }\n"
            '[mechanism.slotted_levers]\nL = { pin = "A", pivot = "B" }\n',
            ["L reaches a change point at crank angle 0.00°", "passes through its pivot", "move the pivot"],
        ),
    ],
)
def test_what_does_not_close_is_told(text: str, words: list[str]) -> None:
    with pytest.raises(AssemblyError) as caught:
        lw.reduction(machine(text))
    assert [word for word in words if word not in str(caught.value)] == []


GROUP = """
[mechanism.points]
B = { x = 0.4 }
C = { x = 0.9 }
[mechanism.cranks]
A = { radius = 0.05 }
[mechanism.joints]
J = { x = 0.35, y = 0.3 }
K = { x = 0.8, y = 0.3 }
[mechanism.bars]
a = { start = "B", end = "J", length = 0.3 }
b = { start = "C", end = "K", length = 0.3 }
c = { start = "J", end = "K", length = 0.45 }
d = { start = "A", end = "L", length = 0.45 }
[mechanism.rigid_points]
L = { link = "c", along = 0.1, across = 0.1 }
"""


def test_group_keeps_all_lengths_and_its_rates_are_derivatives() -> None:
    linkage = lw.read(TRIAD)
    motion = lw.kinematics(linkage, TURN)
    at = {name: point.position for name, point in motion.points.items()}
    for bar in linkage.mechanism.bars.values():
        assert np.abs(np.hypot(*(at[bar.end] - at[bar.start]).T) - bar.length).max() < 1e-12
    # 180 orders twice over, times rounding.
    assert rates_error(motion) < 1e-10


@pytest.mark.parametrize("pivot", [0.2176, 0.219, 0.221])
def test_group_closes_up_to_its_limits(pivot: float) -> None:
    # Towards a limit, where the places change as the root of the distance from it, as anywhere else.
    changes = {"mechanism.joints.C.y": 0.0762, "mechanism.points.B.x": pivot}
    chain = lw.replace(lw.read(EXAMPLES / "six_bar_chains/machine.toml"), changes)
    ends = lw.closure(chain).ranges[0]
    # A residual that rounding may leave moves the limit itself by less than 1e-9.
    distances = np.geomspace(1e-9, 0.3, 2000)
    compiled = compile_machine(chain)
    for angles in (ends[0] + distances, ends[1] - distances):
        assert (compiled.gaps(angles) > 0).all()
    # The whole range is looked at.
    swing = lw.linkage(chain).element("lever")
    assert np.isfinite([swing.low, swing.high]).all()


def test_group_stays_on_its_branch_in_whatever_order_it_is_asked() -> None:
    linkage = lw.read(TRIAD)
    shuffled = np.random.default_rng(1).permutation(TURN)
    together = lw.kinematics(linkage, shuffled).points["E"].position
    ahead = lw.kinematics(linkage, TURN).points["E"].position
    assert np.abs(together - ahead[np.searchsorted(TURN, shuffled)]).max() < 1e-12


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            ("{ x = 0.9 }", "{ x = 3 }"),
            ["the joints J and K do not close", "crank angle 0°", "change the lengths"],
        ),
        (
            ("x = 0.9", "x = 0.9"),
            ["closes only at crank angles", "a (0.3 m), b (0.3 m), c", "J and K"],
        ),
    ],
)
def test_group_that_does_not_close_is_told(change: tuple[str, str], words: list[str]) -> None:
    with pytest.raises(AssemblyError) as caught:
        lw.reduction(machine(GROUP.replace(*change)))
    assert [word for word in words if word not in str(caught.value)] == []


def test_redundant_bar_that_does_not_fit_is_told() -> None:
    text = (EXAMPLES / "change_points/machine.toml").read_text(encoding="utf-8")
    assert lw.closure(loads(text)).turns_fully
    with pytest.raises(AssemblyError, match=r"redundant bar third crank .* locked; correct the length"):
        lw.closure(loads(text.replace('end = "N", length = "100 mm"', 'end = "N", length = "101 mm"')))


# -- motions of other periods -------------------------------------------------------------------------------


def test_closure_looks_at_all_turns() -> None:
    """A crank pin on a wheel at half speed: its rod reaches all round only if both turns are looked at."""
    text = """
[mechanism.cranks]
A = { radius = 0.01 }
[mechanism.points]
P = { x = 0.5 }
[mechanism.gears]
wheel = { kind = "belt", pivot = "P", meshes = "A", size = 2, size_other = 1 }
[mechanism.rigid_points]
K = { link = "wheel", along = 0.2 }
[mechanism.sliders]
S = { crank = "K", rod = 0.3, through = "P", offset = OFFSET }
"""
    whole = lw.closure(machine(text.replace("OFFSET", "0.05")))
    assert whole.turns_fully
    assert whole.turns == 2
    # With the guide 0.15 m above, the pin is 0.35 m from it at its lowest: at 540°, in the second revolution.
    part = lw.closure(machine(text.replace("OFFSET", "0.15")))
    assert part.element == "S"
    low, high = part.ranges[0]
    # The pin must stay above −0.15 m, sin ψ = −3/4.
    sine = np.arcsin(0.75)
    assert (low, high) == pytest.approx((2 * (2 * np.pi - sine), 2 * (3 * np.pi + sine)), abs=1e-9)


def test_loads_that_repeat_after_six_revolutions_have_a_cycle_of_six() -> None:
    text = (EXAMPLES / "gears_and_guides/machine.toml").read_text(encoding="utf-8")
    drive = '\n[drive.flywheel]\ninertia = 1\non = "crank"\n'
    assert over_whole_cycle(compile_machine(loads(text + drive))).turns == 1
    mass = '\n[bodies]\nQ = { mass = "1 kg" }\n[loads]\ngravity = { kind = "gravity" }\n'
    assert over_whole_cycle(compile_machine(loads(text + drive + mass))).turns == 6


def test_screw_is_closed_as_far_as_it_goes() -> None:
    lift = loads((EXAMPLES / "scissor_lift/machine.toml").read_text(encoding="utf-8"))
    found = lw.closure(lift)
    assert found.turns is None
    # From one end of the arm, 50 mm behind, to the other.
    assert np.array(found.ranges[0]) / (2 * np.pi) == pytest.approx([-0.05 / 0.004, 1.15 / 0.004], rel=1e-9)
    with pytest.raises(AssemblyError, match="closes only at drive angles"):
        lw.kinematics(lift, [2 * np.pi * 300])


def test_the_path_of_a_point_that_stands_still_but_for_rounding() -> None:
    # The rocker runs from the joint to its pivot, where S lies: placed by the rocker, not by the frame.
    chain = machine(
        FOUR_BAR
        + "[mechanism.joints]\nC = { x = 0.1, y = 0.1 }\n[mechanism.bars]\n"
        + 'coupler = { start = "A", end = "C", length = 0.12 }\n'
        + 'rocker = { start = "C", end = "B", length = 0.11 }\n'
        + '[mechanism.rigid_points]\nS = { link = "rocker", along = 0.11 }\n'
    )
    path = lw.kinematics(chain, TURN).points["S"].position
    assert 0 < np.ptp(path, axis=0).max() < 1e-15
    found = lw.coupler_curve(chain, "S")
    assert (found.length, found.straight_length, found.double_points, found.cusps) == (0.0, 0.0, (), ())
    assert (found.x_min, found.y_min) == pytest.approx((0.16, 0.0), abs=1e-15)
    assert np.isnan(found.curvature).all()
    # Its neighbour moves.
    assert lw.coupler_curve(chain, "C").length > 0.1


def test_circuits_name_the_change_point_that_ties_them() -> None:
    kite = machine(
        "[mechanism.points]\nB = { x = 0.3 }\n[mechanism.cranks]\nA = { radius = 0.1 }\n[mechanism.rockers]\n"
        + 'R = { crank = "A", pivot = "B", coupler = 0.3, rocker = 0.1 }\n'
    )
    with pytest.raises(InputError, match=r"a change point of R at 0°, 180°.*change a length"):
        lw.circuits(kite)


def test_a_redundant_bar_fits_over_the_whole_cycle() -> None:
    """The nut stands for a revolution and moves in the next, where a bar that fits in the first locks."""
    text = """
[mechanism.points]
P = { x = 0.5, y = 0.2 }
[mechanism.linear_drivers]
N = { law = "0.1*(abs(sin(phi/2)) - HOW*sin(phi/2))" }
[mechanism.bars]
b = { start = "N", end = "P", length = 0.5385164807134504, redundant = true }
"""
    with pytest.raises(AssemblyError, match=r"redundant bar b .* at crank angle 540° .* locked"):
        lw.closure(machine(text.replace("HOW", "1")))
    still = text.replace("0.1*", "0*").replace("HOW", "1")
    assert lw.closure(machine(still)).turns_fully
