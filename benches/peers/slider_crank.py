"""The slider-crank of the transient by hand: angle and speed over time, with SciPy's solvers.

Crank 0.2 m, rod 0.8 m of 64 kg, slider 1000 kg, 48.4 kg m² on the crank, 500 N m, dry resistance 3562 N.
"""

from __future__ import annotations

from math import copysign, cos, pi, sin, sqrt
from typing import Any

import numpy as np

R, L, SLIDER, ROD, CRANK = 0.2, 0.8, 1000.0, 64.0, 48.4
LAM = R / L
J_ROD = ROD * L * L / 12.0
TORQUE, FRICTION = 500.0, 3562.0

# Start and duration of the motion.
SPEED, DURATION = 8.0, 2.0


def acceleration(phi: float, omega: float) -> float:
    """dω/dt [rad/s²] by the reduced equation of motion."""
    sa, ca = sin(phi), cos(phi)
    D = sqrt(1.0 - (LAM * sa) ** 2)
    bend = (ca * ca - sa * sa) / D + (LAM * sa * ca) ** 2 / D**3
    x1, x2 = -R * sa * (1.0 + LAM * ca / D), -R * (ca + LAM * bend)
    xs1, xs2 = -R * sa * (1.0 + 0.5 * LAM * ca / D), -R * (ca + 0.5 * LAM * bend)
    ys1, ys2 = 0.5 * R * ca, -0.5 * R * sa
    beta1, beta2 = -LAM * ca / D, LAM * sa * (1.0 - LAM * LAM) / D**3
    J = CRANK + SLIDER * x1 * x1 + ROD * (xs1 * xs1 + ys1 * ys1) + J_ROD * beta1 * beta1
    half = SLIDER * x1 * x2 + ROD * (xs1 * xs2 + ys1 * ys2) + J_ROD * beta1 * beta2
    return (TORQUE - copysign(FRICTION, omega) * abs(x1) - half * omega * omega) / J


def slope(_time: float, y: Any) -> tuple[float, float]:
    """The right-hand side for `solve_ivp`."""
    phi, omega = y
    return omega, acceleration(phi, omega)


def speeds(method: str, rtol: float, times: Any) -> Any:
    """Speed [rad/s] at given times, by one call of `solve_ivp`; the solver meets the kinks unprepared."""
    from scipy.integrate import solve_ivp

    span = (float(times[0]), float(times[-1]))
    options: dict[str, Any] = {"method": method, "rtol": rtol, "atol": rtol, "t_eval": times}
    return solve_ivp(slope, span, [0.0, SPEED], **options).y[1]


def speeds_by_pieces(method: str, rtol: float, times: Any) -> Any:
    """The same from dead centre to dead centre, where the dry resistance has its kinks."""
    from scipy.integrate import solve_ivp

    state, start, found = [0.0, SPEED], float(times[0]), np.full_like(times, SPEED)
    options: dict[str, Any] = {"method": method, "rtol": rtol, "atol": rtol, "dense_output": len(times) > 2}
    centre, end = pi, float(times[-1])
    while start < end:

        def reached(_time: float, y: Any, centre: float = centre) -> float:
            return float(y[0] - centre)

        reached.terminal = True  # type: ignore[attr-defined]
        piece: Any = solve_ivp(slope, (start, end), state, events=reached, **options)
        inside = (times > start) & (times < piece.t[-1])
        if inside.any():
            found[inside] = piece.sol(times[inside])[1]
        found[times == piece.t[-1]] = piece.y[1, -1]
        start, state, centre = float(piece.t[-1]), list(piece.y[:, -1]), centre + pi
    return found
