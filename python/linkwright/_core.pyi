"""The compiled kernels, for files named `core` and `machine.program` alone; all is SI and contiguous."""

from collections.abc import Sequence
from typing import final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "FORMAT",
    "Cam",
    "Plan",
    "TopperKnife",
    "TorsionSystem",
    "cam_crossings",
    "follow_group",
    "gaps",
    "in_line",
    "kinks",
    "law_torques",
    "motions",
    "motor_torques",
    "reductions",
    "steady_rows",
    "steady_state",
    "third",
    "torsion_forced",
    "torsion_modes",
    "torsion_waves",
    "transient",
]

_Floats = NDArray[np.float64]
_Ints = NDArray[np.int32]

FORMAT: int

@final
class Plan:
    """A machine's structure: integer tables described in `crates/linkwright-core/src/plan.rs`."""

    def __new__(
        cls,
        sizes: _Ints,
        elements: _Ints,
        bodies: _Ints,
        loads: _Ints,
        drive: _Ints,
        table_starts: _Ints,
        table_x: _Floats,
        table_y: _Floats,
        formulas: _Ints,
        motion_laws: _Floats,
    ) -> Plan: ...
    @property
    def has_laws(self) -> bool:
        """Whether loads depend on both angle and speed in their own way, or on time."""

def steady_state(
    plan: Plan, q: _Floats, accuracy: float, phi: _Floats
) -> tuple[int, _Floats, _Floats | None]:
    """Status, scalars, and 7 curves (time, ω, ε, motor, drive and load torque, J) at the angles `phi`.

    The scalars are 18 of the motion, and for each other motion that repeats its least and greatest speed, its
    period and its multiplier.
    Without an answer the scalars are the angle at which the machine comes to rest (or does not close), the
    speed from which it slows down (or which it exceeds), and the accuracy reached; NaN where there is none.
    """

def steady_rows(
    plan: Plan, q: _Floats, slots: _Ints, values: _Floats, accuracy: float
) -> tuple[NDArray[np.uint8], _Floats, int]:
    """Status (n,), scalars (n, 13) and turns swept for n machines; `values` is (slots, n)."""

def motions(
    plan: Plan, q: _Floats, slots: _Ints, values: _Floats, phi: _Floats, what: _Ints, out: _Floats
) -> None:
    """Motions of n machines at the angles `phi` into `out`, flat (n, numbers, angles)."""

def third(plan: Plan, q: _Floats, phi: _Floats, what: _Ints) -> _Floats:
    """Third transfer functions at the angles `phi`: two rows for a point, one for a link or slide."""

def in_line(
    plan: Plan, q: _Floats, slots: _Ints, values: _Floats, element: int
) -> list[tuple[int, float, float, list[float], list[float], tuple[bool, bool]]]:
    """Where the links of a dyad come into line over the turn, in each row.

    Row, crank angle, length to spare, numbers of the change point (none where it is undecided) and of its
    arms (none unless the pin passes near its pivot), and whether the arm with S > 0, S < 0 after it has no
    digits left.
    """

def follow_group(
    plan: Plan, q: _Floats, element: int, phi: float, near: _Floats
) -> tuple[_Floats, list[_Floats], int | None] | None:
    """Crank angles, x and y of each joint of a group there, turns of a period; None if it does not close."""

def gaps(plan: Plan, q: _Floats, phi: _Floats) -> _Floats:
    """Radicand of each dyad at each angle (dyads, angles); negative where it does not close."""

def reductions(plan: Plan, q: _Floats, phi: _Floats) -> _Floats:
    """J, J′, load, dry torque and viscous coefficient, turning forward (5, angles)."""

def law_torques(plan: Plan, q: _Floats, phi: _Floats, omega: _Floats) -> _Floats:
    """Resisting torque of the laws at angles and speeds (speeds, angles)."""

def motor_torques(plan: Plan, q: _Floats, omega: _Floats) -> tuple[_Floats, _Floats]:
    """Motor torque at its shaft and at the crank, at crank speeds."""

def transient(
    plan: Plan,
    q: _Floats,
    phi: float,
    omega: float,
    duration: float,
    turns: float,
    accuracy: float,
) -> tuple[int, tuple[float, float], int, list[_Floats]]:
    """How it ended; drive and load torque there; evaluations; t, φ, ω, ε at the ends of the steps, and of
    each step seven factors of the angle and seven of the speed (`Stages::component` in `kernel/rk.rs`)."""

def kinks(plan: Plan, q: _Floats) -> _Floats:
    """Crank angles between which the reduced machine is smooth, from 0 to 2π."""

@final
class Cam:
    """A motion law over a turn and the kind of cam that follows it: `crates/linkwright-core/src/cam`."""

    def __new__(cls, law: _Floats, kind: int, sense: float, side: float) -> Cam: ...
    def shape(
        self, size: _Floats, n: int, levels: Sequence[tuple[int, float]]
    ) -> tuple[_Floats, NDArray[np.uint32], _Floats, _Floats, list[_Floats]]:
        """Angles, pieces, 12 rows, extremes (angle, value), and where rows pass levels (angle, sign)."""

    def rows(self, size: _Floats, phi: _Floats, before: bool) -> _Floats:
        """The 12 rows at angles."""

    def curve(self, size: _Floats, phi: _Floats, before: bool, away: float) -> _Floats:
        """x, y and their first and second derivatives of a curve beside the pitch curve, at angles (6, n)."""

    def search(self, columns: Sequence[_Floats], n: int, per_turn: int) -> _Floats:
        """Largest tan γ, least soundness, greatest and least bend of each cam (n, 4)."""

def cam_crossings(x: _Floats, y: _Floats) -> _Floats:
    """Crossings of the sides of a closed polygon: side and share of both, place (n, 4)."""

@final
class TopperKnife:
    """The knife of a topper: `crates/linkwright-core/src/topper`."""

    def __new__(
        cls,
        law: _Floats,
        in_pieces: bool,
        corners: Sequence[float],
        angle: float,
        forward: float,
        rate: float,
        drift: float,
        bounds: Sequence[float],
    ) -> TopperKnife: ...
    def cover(self, columns: Sequence[_Floats], n: int, length: float | None, fine: int) -> _Floats:
        """Length needed, place of the point that is reached last, areas left: right, left, between (n, 6)."""

def torsion_forced(
    parent: _Ints,
    inertia: _Floats,
    speeds: _Floats,
    tables: Sequence[_Floats],
    orders: _Floats,
    torques: _Floats,
) -> None:
    """Amplitudes (orders, discs, speeds) in place of torques, real and imaginary part in turn [N m → rad].

    Tables k, c, ηk of the shaft above each disc and c of the disc itself, (discs, speeds) each, flat.
    """

def torsion_waves(coefficients: _Floats, waves: int) -> _Floats:
    """Greatest value, its place, least, its place (4, waves) of sums of harmonics (harmonics, waves)."""

def torsion_modes(inertia: _Floats, ends: _Ints, stiffness: _Floats) -> tuple[_Floats, _Floats] | None:
    """Natural frequencies [rad/s], increasing, and mode shapes with Σ J q² = 1, one row a mode (n, n).

    Shafts join the masses of their ends (shafts, 2), −1 being the ground; without stiffness they do not.
    None where they close a loop.
    """

@final
class TorsionSystem:
    """A train in motion: lists described in `crates/linkwright-core/src/torsion/transient/system.rs`."""

    def __new__(
        cls,
        inertia: _Floats,
        damping: _Floats,
        swing_damping: _Floats,
        links: _Ints,
        link_numbers: _Floats,
        rotors: _Ints,
        rotor_numbers: _Floats,
        torques: _Ints,
        torque_numbers: _Floats,
        table_starts: _Ints,
        periods: _Floats,
        knots: _Floats,
        curve_starts: _Ints,
        points: _Floats,
    ) -> TorsionSystem: ...
    def follow(
        self,
        angle: _Floats,
        speed: _Floats,
        times: _Floats,
        start: float,
        duration: float,
        accuracy: float,
        method: int,
        steps_max: int,
    ) -> tuple[int, int, list[int], list[float], _Floats, _Floats, _Floats]:
        """End, method; steps, rejected, evaluations; time, fastest, energies; samples, extremes, work."""

    def net_torques(self, t: float, angle: _Floats, speed: _Floats) -> tuple[_Floats, _Floats]:
        """Sum of torques on each mass and its inertia at rows of angles (rows, masses)."""
