"""The compiled kernels. Used by `linkwright.engine` only; everything is SI and contiguous."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

class Plan:
    """A machine's structure: integer tables described in `crates/linkwright-core/src/plan.rs`."""

    def __new__(
        cls,
        sizes: Ints,
        elements: Ints,
        bodies: Ints,
        loads: Ints,
        drive: Ints,
        table_starts: Ints,
        table_x: Floats,
        table_y: Floats,
    ) -> Plan: ...

def steady_state(
    plan: Plan, q: Floats, accuracy: float, phi: Floats
) -> tuple[int, Floats | None, Floats | None]:
    """Status, 18 scalars, and 7 curves (time, ω, ε, motor, drive and load torque, J) at the angles `phi`."""

def steady_rows(
    plan: Plan, q: Floats, slots: Ints, values: Floats, accuracy: float
) -> tuple[NDArray[np.uint8], Floats, int]:
    """Status (n,), scalars (n, 13) and turns swept for n machines; `values` is (slots, n)."""

def motions(plan: Plan, q: Floats, slots: Ints, values: Floats, phi: Floats, what: Ints, out: Floats) -> None:
    """Motions of n machines at the angles `phi` into `out`, flat (n, numbers, angles)."""

def gaps(plan: Plan, q: Floats, phi: Floats) -> Floats:
    """Radicand of each dyad at each angle (dyads, angles); negative where it does not close."""

def reductions(plan: Plan, q: Floats, phi: Floats, sense: float) -> Floats:
    """J, J′, load, dry torque and viscous coefficient (5, angles)."""

def motor_torques(plan: Plan, q: Floats, omega: Floats) -> tuple[Floats, Floats]:
    """Motor torque at its shaft and at the crank, at crank speeds."""

def transient(
    plan: Plan,
    q: Floats,
    phi: float,
    omega: float,
    duration: float,
    turns: float,
    accuracy: float,
) -> tuple[int, tuple[float, float], int, list[Floats]]:
    """How it ended; drive and load torque there; evaluations; t, φ, ω, ε at the ends of the steps."""

def kinks(plan: Plan, q: Floats) -> Floats:
    """Crank angles between which the reduced machine is smooth, from 0 to 2π."""

def has_motor(plan: Plan) -> bool:
    """Whether anything drives."""
