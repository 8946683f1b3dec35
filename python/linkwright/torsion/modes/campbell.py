r"""Campbell's diagram of a train: natural frequencies over the speed, and where orders meet them.

The order ν excites the mode n at the speed

.. math:: \Omega = \omega_n/\nu

which is *critical*. How severe it is follows from the work of the torques in the mode, with θ its shape of
largest amplitude 1: the vector sum :math:`|\sum M_\nu\theta|`, the amplitude that it would have if it acted
slowly, and that of resonance, which damping limits,

.. math:: \theta_{st} = \frac{|\sum M_\nu \theta|}{\omega_n^2 \sum J\theta^2}, \qquad
    \theta_{res} = \frac{\theta_{st}}{2\zeta_n}, \qquad
    \zeta_n = \frac{\omega_n\,\theta^T C\theta + \theta^T H\theta}{2\,\omega_n^2 \sum J\theta^2}

The ratio :math:`\zeta_n` is that of light damping, and other modes are left out; forced vibration has both.

Damping moves the peak of the mode's response away from the undamped crossing. Where the torque grows with the
power q of the speed, the amplitude :math:`s^{q/2}/\sqrt{(1 - s)^2 + 4\zeta^2 s}` over
:math:`s = (\nu\Omega/\omega_n)^2` peaks at a root of

.. math:: (q - 2)\,s^2 + (q - 1)(4\zeta^2 - 2)\,s + q = 0

which is :math:`1 - 2\zeta^2` of a constant torque and :math:`1/(1 - 2\zeta^2)` of one of inertia (q = 2).
This peak is that of the mode alone. That of the forced response, in which the other modes and the damping
between modes take part, is found by `linkwright.torsion.limits.critical_response`.

References
----------
.. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963: vector sums, equilibrium
amplitude.
.. [2] Den Hartog, Mechanical Vibrations, 4th ed. 1956, section 5.5: work of an engine's torques in a
mode; section 2.8: amplitude of a damped vibration over the frequency.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats, Indices
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import COUNT, RATIO, SPEED
from linkwright.kernel.units.marks import not_negative, positive
from linkwright.machine.machine import Machine
from linkwright.torsion.excitation.harmonics import line_words
from linkwright.torsion.modes.free import FreeVibration
from linkwright.torsion.modes.modes_over_speed import ModesAt, constant, over_speed

# Secant steps to a critical speed: from neighbours on a grid, or exact where frequencies do not change.
_STEPS = 8

# Share of a speed by which the growth of a torque is examined: an order's torques are smooth.
_ASIDE = 1e-3

# Digits to which the growth of a torque is known.
_DIGITS = 6

# Speeds that differ by a smaller share are one.
_EQUAL = 1e-12


class CriticalSpeed(NamedTuple):
    """A speed at which an order meets a natural frequency.

    Attributes
    ----------
    speed : float
        Of the first disc [rad/s].
    order : float
        Cycles per revolution of the first disc.
    mode : int
        Row of `FreeVibration`.
    frequency : float
        [Hz].
    vector_sum : float or None
        |Σ Mθ|; None where torques are not known [N m].
    equilibrium_amplitude : float or None
        At the disc of largest amplitude [rad].
    damping_ratio : float or None
        ζ of the mode; None where it is not known.
    resonance_amplitude : float or None
        Of the mode alone, at the disc of largest amplitude; infinite without damping [rad].
    peak_speed : float or None
        At which the damped response of the mode alone to the order peaks; None where it has no peak, or the
        damping is not known. Neighbouring modes and strong dampers move the peak of the forced response, as
        `CriticalResponse` has it [rad/s].
    fixed : float
        Fixed frequency that adds to that of the order; 0 of an order alone [rad/s].
    """

    speed: float
    order: float
    mode: int
    frequency: float
    vector_sum: float | None
    equilibrium_amplitude: float | None
    damping_ratio: float | None
    resonance_amplitude: float | None
    peak_speed: float | None
    fixed: float = 0.0

    @property
    def line(self) -> str:
        """The order in words, with its fixed frequency."""
        return line_words(self.order, self.fixed)


@dataclass(frozen=True)
class CampbellDiagram(Result):
    """Natural frequencies over the speed, and critical speeds."""

    speeds: Annotated[
        Floats,
        Label("speed of the first disc", "ω", "rad/s", "From the lowest to the highest.", shape="(speeds,)"),
    ]
    frequencies: Annotated[
        Floats,
        Label(
            "natural frequencies",
            "ω/2π",
            "Hz",
            "One row a mode, also those of zero.",
            shape="(modes, speeds)",
        ),
    ]
    orders: Annotated[
        Floats, Label("excitation order of the first disc", "ν", "", shape="(orders,)", over="orders")
    ]
    critical: Annotated[tuple[CriticalSpeed, ...], About("Critical speeds in the range, by speed.")]
    fixed: Annotated[
        Floats, About("Fixed frequency beside each order, rad/s; empty where all lines are orders.")
    ] = field(default_factory=lambda: np.empty(0))

    @property
    def of_orders(self) -> tuple[CriticalSpeed, ...]:
        """Critical speeds of orders alone."""
        return tuple(one for one in self.critical if not one.fixed)

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Critical speeds by name, with ``curves`` also the arrays as lists."""
        results = super().to_dict(curves=curves)
        return results | {"critical": [crossing._asdict() for crossing in self.critical]}


@public
def campbell(
    source: Machine | FreeVibration,
    orders: Sequence[float] | Floats | None = None,
    speed_range: tuple[float, float] | None = None,
    *,
    excitation: Complexes | None = None,
    damping_ratios: float | Floats | None = None,
) -> CampbellDiagram:
    """Critical speeds of a train.

    Parameters
    ----------
    source : Machine or FreeVibration
        A machine with a train, or its free vibration.
    orders : sequence of float, optional
        Cycles per revolution of the first disc; without them, those of the torques of the machine.
    speed_range : tuple of float, optional
        Lowest and highest speed of the first disc; without it, that of `[train.run]` [rad/s].
    excitation : ndarray of complex, shape (orders, discs), optional
        M_ν on each disc; without it, the torques of the machine at the critical speed [N m].
    damping_ratios : float or ndarray, shape (modes,), optional
        ζ; without it, that of the damping of the machine.

    Returns
    -------
    CampbellDiagram
        Frequencies and critical speeds. Of a machine, couplings have the slope at their mean torque, so that
        frequencies may change with the speed.

    Raises
    ------
    InputError
        Orders or speeds are missing or none above zero, or arrays have another shape.
    """
    modes = over_speed(source) if isinstance(source, Machine) else constant(source)
    speeds = modes.grid(_range(speed_range))
    omega = modes.frequencies(speeds)
    fixed = modes.fixed(speeds) if orders is None else np.empty(0)
    listed = modes.orders(speeds) if orders is None else _orders(np.asarray(orders, float))
    if excitation is not None and np.shape(excitation) != (len(listed), len(modes.discs)):
        wanted = f"({len(listed)}, {len(modes.discs)}), a row an order, a column a disc"
        raise InputError(f"excitation: found an array of shape {np.shape(excitation)}, expected {wanted}")
    at, mode, order = _crossings(modes, speeds, omega, listed, fixed)
    ratios = _ratios(damping_ratios, omega.shape[1])
    given = None if excitation is None else np.asarray(excitation, complex)[order]
    offsets = fixed[order] if len(fixed) else np.zeros(len(at))
    critical = _judged(modes, at, mode, np.stack([listed[order], offsets]), given, ratios)
    return CampbellDiagram(
        speeds=speeds,
        frequencies=omega.T / (2 * math.pi),
        orders=listed,
        critical=tuple(sorted(critical)),
        fixed=fixed,
    )


def _range(given: tuple[float, float] | None) -> tuple[float, float] | None:
    in_range(speed_range=(given, positive(SPEED)))
    if given is not None and not given[0] < given[1]:
        found = f"{given[0]:g} to {given[1]:g} rad/s"
        raise InputError(f"speed_range: found {found}, expected two speeds above 0, the lower one first")
    return given


def _orders(orders: Floats) -> Floats:
    in_range(orders=(orders, positive(COUNT)))
    if orders.ndim != 1 or not len(orders):
        raise InputError(f"orders: found {orders.tolist()}, expected a list of numbers above 0")
    return orders


def _ratios(given: float | Floats | None, modes: int) -> Floats | None:
    """A ζ for every mode, checked."""
    if given is None:
        return None
    in_range(damping_ratios=(given, not_negative(RATIO)))
    ratios = np.asarray(given, float)
    if ratios.shape not in ((), (modes,)):
        raise InputError(f"damping_ratios: found {ratios.tolist()}, expected one number, or {modes}")
    return np.broadcast_to(ratios, modes)


def _crossings(
    modes: ModesAt, speeds: Floats, omega: Floats, orders: Floats, fixed: Floats
) -> tuple[Floats, Indices, Indices]:
    """Speeds at which ω_n − |νΩ + ω₀| is zero, with mode and order."""
    offsets = fixed if len(fixed) else np.zeros(len(orders))
    gap = omega[:, :, None] - np.abs(speeds[:, None, None] * orders + offsets)
    above = np.greater(gap, 0.0)
    crossed = np.not_equal(above[:-1], above[1:])
    # A zero at the end of a step belongs to that step, one at the lowest speed to the first.
    crossed[0] |= gap[0] == 0
    step, mode, order = np.nonzero(crossed & np.greater(omega.min(axis=0), 0.0)[:, None])
    low, high = speeds[step], speeds[step + 1]
    f, g = gap[step, mode, order], gap[step + 1, mode, order]
    at = low + (high - low) * f / (f - g)
    rows = np.arange(len(at))
    for _ in range(_STEPS if len(at) else 0):
        line = np.abs(orders[order] * at + offsets[order])
        here = modes.frequencies(at)[rows, mode] - line
        if (np.abs(here) <= _EQUAL * line).all():
            break
        before = (here > 0) == (f > 0)
        low, f = np.where(before, at, low), np.where(before, here, f)
        high, g = np.where(before, high, at), np.where(before, g, here)
        at = low + (high - low) * f / (f - g)
    return at, mode, order


def _judged(
    modes: ModesAt,
    at: Floats,
    mode: Indices,
    lines: Floats,
    given: Complexes | None,
    ratios: Floats | None,
) -> list[CriticalSpeed]:
    """Critical speeds with their severity under given torques (n, discs) or those of the machine.

    `lines`: (2, n) order and fixed frequency.
    """
    if not len(at):
        return []
    mode_shapes = modes.shapes(at, mode)
    torques = modes.torques(at, *lines) if given is None else given
    work = None if torques is None else np.abs((torques * mode_shapes.shapes).sum(axis=1))
    zeta = mode_shapes.damping_ratios if ratios is None else ratios[mode]
    unknown = work is None or given is not None
    growth = np.zeros(len(at)) if unknown else _growth(modes, at, lines, mode_shapes.shapes)
    listed = []
    for n, (speed, ν, f, k) in enumerate(zip(at.tolist(), *lines.tolist(), mode.tolist(), strict=True)):
        static = None if work is None else float(work[n] / mode_shapes.stiffness[n])
        ratio = None if zeta is None else float(zeta[n])
        listed.append(
            CriticalSpeed(
                speed=speed,
                order=ν,
                mode=k,
                frequency=float(mode_shapes.omega[n]) / (2 * math.pi),
                vector_sum=None if work is None else float(work[n]),
                equilibrium_amplitude=static,
                damping_ratio=ratio,
                resonance_amplitude=_resonance(static, ratio),
                # The curve of the peak is that of an order alone.
                peak_speed=None if f else _peak(speed, ratio, float(growth[n])),
                fixed=f,
            )
        )
    return listed


def _growth(modes: ModesAt, at: Floats, lines: Floats, shapes: Floats) -> Floats:
    """Exponent of the speed with which the work of each order in a mode grows, (n,)."""
    sizes = []
    for speeds in (at * (1 - _ASIDE), at * (1 + _ASIDE)):
        torques = modes.torques(speeds, *lines)
        sizes.append(np.zeros(len(at)) if torques is None else np.abs((torques * shapes).sum(axis=1)))
    below, above = sizes
    ratio = np.divide(above, below, out=np.ones(len(at)), where=(below > 0) & (above > 0))
    growth: Floats = np.log(ratio) / math.log((1 + _ASIDE) / (1 - _ASIDE))
    return growth


def _peak(speed: float, ratio: float | None, growth: float) -> float | None:
    """Speed of the resonance peak of the mode alone near a crossing."""
    if ratio is None:
        return None
    # What rounding leaves of a whole power would have the amplitude peak at no speed, or at any.
    growth = round(growth, _DIGITS)
    roots = np.roots([growth - 2, (growth - 1) * (4 * ratio**2 - 2), growth])
    real = roots.real[(roots.imag == 0) & (roots.real > 0)]
    # Of two the one near the crossing is the peak, the other a minimum value.
    return float(speed * math.sqrt(real[np.abs(real - 1).argmin()])) if len(real) else None


def _resonance(static: float | None, ratio: float | None) -> float | None:
    """Resonance amplitude limited by damping."""
    if static is None or ratio is None:
        return None
    if ratio == 0:
        return math.inf if static else 0.0
    return static / (2 * ratio)
