r"""The turning-moment diagram: fluctuation of energy over a cycle, and the flywheel that evens the motion.

With the torque of the driver T and that of the load M, equal in their means, the energy that the shaft has
taken up is

.. math:: E(\varphi) = \int_0^\varphi (T - M)\,d\varphi, \qquad \Delta E = E_{\max} - E_{\min},

and from :math:`\tfrac12 J(\omega_{\max}^2 - \omega_{\min}^2) = \Delta E` with the mean of the extremes ω,

.. math:: \delta = \frac{\omega_{\max} - \omega_{\min}}{\omega} = \frac{\Delta E}{J \omega^2},

exactly, for a moment of inertia J that does not change with the angle.

References
----------
.. [1] S. S. Rattan, Theory of Machines, 4th edition, chapter 13: turning-moment diagrams, flywheels.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError, require_within
from linkwright.kernel.limits import ROWS_OUT
from linkwright.kernel.numerics.turn_curve import TurnCurve
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.turning.model import TurningMoment
from linkwright.turning.rim import RimSize, rim_size

# Works of driver and load that differ by less than this share are equal: printed torques have four digits or
# more, and a difference of this size changes the speed by a hundredth of its fluctuation in a cycle.
_BALANCED = 1e-4

# Share of all areas that they may fail to add up to zero: areas that are measured in a drawing, or printed
# with three digits, do by some thousandths (Norton's example of a four-bar linkage by 2.2e-3).
_READING = 1e-2

# Rows of the curves of excess, driver and load.
EXCESS, DRIVER, LOAD = range(3)


def _nothing() -> Floats:
    return np.empty(0)


_AREAS = (
    "Areas between driver and load in order: ``start``, ``end`` [rad] or None, ``energy`` [J] and "
    "``energy_after`` [J], the excess at its end counted from the start of the first."
)


@dataclass(frozen=True)
class TurningMomentDiagram(Result):
    """A shaft over a cycle of its turning moments. What cannot be determined is None."""

    cycle: Annotated[float, Label("angle of a cycle", "", "rad")]
    speed_mean: Annotated[
        float, Label("mean speed", "ω", "rad/s", "Of the extreme speeds.", table="flywheel")
    ]
    energy_fluctuation: Annotated[
        float, Label("maximum fluctuation of energy", "ΔE", "J", table="turning_moment")
    ]
    accuracy: Annotated[
        float, Label("error of the fluctuation of energy over itself", "", "", "As measured.")
    ]
    areas: Annotated[tuple[dict[str, float | None], ...], About(_AREAS)]

    @property
    def warnings(self) -> tuple[str, ...]:
        """What its designer should know."""
        if self.torque_mean is not None or self.accuracy <= _BALANCED:
            return ()
        left = self.accuracy * self.energy_fluctuation
        return (
            f"The areas between driver and load do not add up to zero: {left:.4g} J are left, "
            f"{100 * self.accuracy:.2g} % of the fluctuation of energy, which is uncertain by as much.",
        )

    torque_mean: Annotated[
        float | None,
        Label(
            "mean torque",
            "T_mean",
            "N m",
            "Of driver and load.",
            table="turning_moment",
            before="energy_fluctuation",
        ),
    ] = None
    power_mean: Annotated[
        float | None, Label("mean power", "P_mean", "W", table="turning_moment", before="energy_fluctuation")
    ] = None
    energy_cycle: Annotated[
        float | None,
        Label("work of the driver per cycle", "A", "J", table="turning_moment", before="energy_fluctuation"),
    ] = None
    energy_coefficient: Annotated[
        float | None,
        Label(
            "coefficient of fluctuation of energy",
            "C_E",
            "",
            "ΔE over the work of a cycle.",
            table="turning_moment",
        ),
    ] = None
    torque_driver_max: Annotated[
        float | None,
        Label("maximum torque of the driver", "T_max", "N m", table="turning_moment", before="power_mean"),
    ] = None
    torque_driver_max_angle: Annotated[
        float | None, Label("angle of the maximum torque of the driver", "φ(T_max)", "rad")
    ] = None
    torque_driver_min: Annotated[
        float | None,
        Label("minimum torque of the driver", "T_min", "N m", table="turning_moment", before="power_mean"),
    ] = None
    torque_driver_min_angle: Annotated[
        float | None, Label("angle of the minimum torque of the driver", "φ(T_min)", "rad")
    ] = None
    speed_max_angle: Annotated[float | None, Label("angle of the maximum speed", "φ(ω_max)", "rad")] = None
    speed_min_angle: Annotated[float | None, Label("angle of the minimum speed", "φ(ω_min)", "rad")] = None
    inertia: Annotated[
        float | None,
        Label(
            "moment of inertia of the shaft",
            "J",
            "kg m²",
            "With its flywheel.",
            table="flywheel",
            before="speed_mean",
        ),
    ] = None
    flywheel_inertia: Annotated[
        float | None,
        Label(
            "moment of inertia of the flywheel",
            "J_f",
            "kg m²",
            "For the required speed fluctuation; zero if none is needed.",
            table="flywheel",
            before="inertia",
        ),
    ] = None
    flywheel_mass: Annotated[
        float | None,
        Label(
            "mass of the flywheel",
            "m",
            "kg",
            "At the given radius of gyration.",
            table="flywheel",
            before="inertia",
        ),
    ] = None
    unevenness: Annotated[
        float | None,
        Label(
            "coefficient of speed fluctuation",
            "δ",
            "",
            "That results.",
            table="flywheel",
            before="speed_mean",
        ),
    ] = None
    speed_max: Annotated[float | None, Label("maximum speed", "ω_max", "rad/s", table="flywheel")] = None
    speed_min: Annotated[float | None, Label("minimum speed", "ω_min", "rad/s", table="flywheel")] = None
    acceleration_max: Annotated[
        float | None, Label("maximum acceleration", "ε_max", "rad/s²", "Of the shaft.", table="flywheel")
    ] = None
    acceleration_min: Annotated[
        float | None, Label("minimum acceleration", "ε_min", "rad/s²", "Of the shaft.", table="flywheel")
    ] = None
    acceleration_max_angle: Annotated[
        float | None, Label("angle of the maximum acceleration", "φ(ε_max)", "rad")
    ] = None
    acceleration_min_angle: Annotated[
        float | None, Label("angle of the minimum acceleration", "φ(ε_min)", "rad")
    ] = None
    rim_radius: Annotated[float | None, Label("mean radius of the rim", "R", "m", table="rim")] = None
    rim_speed: Annotated[float | None, Label("mean speed of the rim", "v", "m/s", table="rim")] = None
    rim_stress: Annotated[
        float | None,
        Label("hoop stress of the rim", "σ", "Pa", "At the mean speed, away from arms and hub.", table="rim"),
    ] = None
    rim_mass: Annotated[float | None, Label("mass of the rim", "m_r", "kg", table="rim")] = None
    rim_area: Annotated[float | None, Label("cross-section of the rim", "A_r", "m²", table="rim")] = None
    rim_width: Annotated[float | None, Label("width of the rim", "b", "m", table="rim")] = None
    rim_thickness: Annotated[
        float | None, Label("thickness of the rim", "t", "m", "In the direction of the radius.", table="rim")
    ] = None
    crank_angle: Annotated[
        Floats,
        Label("crank angle", "φ", "rad", "Empty where areas are given, as all curves.", shape="(n + 1,)"),
    ] = field(default_factory=_nothing)
    torque_driver: Annotated[Floats, Label("torque of the driver", "T", "N m")] = field(
        default_factory=_nothing
    )
    torque_load: Annotated[Floats, Label("torque of the load", "M", "N m")] = field(default_factory=_nothing)
    energy: Annotated[
        Floats, Label("energy that the shaft has taken up", "E", "J", "From the start of the cycle.")
    ] = field(default_factory=_nothing)
    speed: Annotated[
        Floats, Label("speed of the shaft", "ω", "rad/s", "Empty without a moment of inertia.")
    ] = field(default_factory=_nothing)


class _FlywheelEffect(NamedTuple):
    """Effect of a moment of inertia on a fluctuation of energy; fields of the result."""

    inertia: float | None = None
    flywheel_inertia: float | None = None
    flywheel_mass: float | None = None
    unevenness: float | None = None
    speed_min: float | None = None
    speed_max: float | None = None


@public
def turning_moment(machine: Machine, *, n: int = 720) -> TurningMomentDiagram:
    """Fluctuation of energy of a shaft over a cycle, and its flywheel.

    Parameters
    ----------
    machine : Machine
        A machine with the table ``turning_moment``.
    n : int
        Intervals of the curves over the cycle, 1 to 100 000. Scalars do not depend on it.

    Returns
    -------
    TurningMomentDiagram
        What follows from the diagram.

    Raises
    ------
    InputError
        The machine has no such table, or n makes no sense.
    FindingError
        Driver and load do not balance over a cycle, a torque has no value, or the shaft is too light to
        keep turning.
    """
    described = machine.turning_moment
    if described is None:
        raise InputError("turning_moment: the machine has no table of this name")
    require_within(ROWS_OUT, n, f"n = {n}", "take fewer intervals")
    return _of_areas(described) if described.areas else _of_curves(described, n)


def _of_areas(described: TurningMoment) -> TurningMomentDiagram:
    """From the areas of a diagram: the energies at its crossings are all that matters."""
    areas = described.area_scale * np.asarray(described.areas)
    after, gross = np.cumsum(areas), float(np.abs(areas).sum())
    # What summing rounds.
    after[np.abs(after) < len(areas) * np.finfo(float).eps * gross] = 0.0
    if abs(after[-1]) > _READING * gross:
        raise FindingError(
            f"turning_moment.areas: they add up to {after[-1]:.6g} J, {100 * abs(after[-1]) / gross:.3g} % "
            f"of the sum of their sizes, at most {100 * _READING:g} %: the shaft would gain that in every "
            "cycle; areas above and below the mean have to be equal"
        )
    change = float(np.ptp(np.append(after, 0.0)))
    rows = tuple(
        {"start": None, "end": None, "energy": float(area), "energy_after": float(then)}
        for area, then in zip(areas, after, strict=True)
    )
    return TurningMomentDiagram(
        cycle=described.cycle,
        speed_mean=described.speed,
        accuracy=float(abs(after[-1])) / change,
        areas=rows,
        **of_fluctuation(described, change),
    )


def _of_curves(described: TurningMoment, n: int) -> TurningMomentDiagram:
    cycle = described.cycle
    curves = fitted_curves(described)
    driver, load = curves.mean()[[DRIVER, LOAD]]
    _require_balance(float(driver), float(load), curves, described)
    energy = curves.excess(EXCESS, EXCESS, 0.0)
    most, at_most = energy.extreme(+1)
    least, at_least = energy.extreme(-1)
    change = most - least
    peaks = {(k, sign): curves.extreme(sign, k) for k in (DRIVER, EXCESS) for sign in (+1, -1)}
    numbers = of_torques(described, float(driver), change, {end: peak[0] for end, peak in peaks.items()})
    phi = np.linspace(0.0, cycle, n + 1)
    _, T, M = curves.at(phi)
    E = energy.at(phi)[0]
    places = {
        "torque_driver_max_angle": peaks[DRIVER, +1][1],
        "torque_driver_min_angle": peaks[DRIVER, -1][1],
        "speed_max_angle": at_most,
        "speed_min_angle": at_least,
    }
    if numbers["inertia"] is not None:
        places |= {
            "acceleration_max_angle": peaks[EXCESS, +1][1],
            "acceleration_min_angle": peaks[EXCESS, -1][1],
        }
    return TurningMomentDiagram(
        cycle=cycle,
        speed_mean=described.speed,
        **numbers,
        **places,
        accuracy=float(curves.error[EXCESS] / change) if change else 0.0,
        areas=_areas(curves, energy, cycle),
        crank_angle=phi,
        torque_driver=T,
        torque_load=M,
        energy=E,
        speed=_speed(E - least, numbers),
    )


def of_fluctuation(described: TurningMoment, change: Any) -> dict[str, Any]:
    """Scalars that follow from the fluctuation of energy, with derivatives if it or the table has some."""
    effect = evened(described, change)
    return {"energy_fluctuation": change} | effect._asdict() | rim_of(described, effect)._asdict()


def of_torques(
    described: TurningMoment, mean: Any, change: Any, peaks: Mapping[tuple[int, int], Any]
) -> dict[str, Any]:
    """Scalars that follow from torques, likewise; `peaks`: extremes of driver and excess by their sign."""
    numbers, work = of_fluctuation(described, change), mean * described.cycle
    J = numbers["inertia"]
    numbers |= {
        "torque_mean": mean,
        "power_mean": mean * described.speed,
        "energy_cycle": work,
        "energy_coefficient": change / work if work else None,
    }
    for end, sign in (("max", +1), ("min", -1)):
        numbers[f"torque_driver_{end}"] = peaks[DRIVER, sign]
        numbers[f"acceleration_{end}"] = None if J is None else peaks[EXCESS, sign] / J
    return numbers


def fitted_curves(described: TurningMoment) -> TurnCurve:
    """Excess, driver and load over the cycle; what is left out is the mean of the other."""
    cycle, driver, load = described.cycle, described.driver, described.load
    kinks = [torque.kinks(cycle) for torque in (driver, load) if torque is not None]
    ends = np.unique(np.concatenate([[0.0, cycle], *kinks]))

    def fit(of: Callable[[Floats], tuple[Floats, ...]]) -> TurnCurve:
        return turn_curve(lambda phi: np.stack(of(phi)), ends, "turning moment")

    if driver is not None and load is not None:
        return fit(lambda phi: _excess(driver.at(phi, cycle), load.at(phi, cycle)))
    alone = driver or load
    assert alone is not None
    fitted = fit(lambda phi: (alone.at(phi, cycle),))
    mean = float(fitted.mean()[0])
    if driver is not None:
        return fitted.combined(np.array([[1.0], [1.0], [0.0]]), np.array([-mean, 0.0, mean]))
    return fitted.combined(np.array([[-1.0], [0.0], [1.0]]), np.array([mean, mean, 0.0]))


def _excess(driver: Floats, load: Floats) -> tuple[Floats, ...]:
    """Excess, driver and load [N m], (n,) each."""
    return driver - load, driver, load


def _require_balance(driver: float, load: float, curves: TurnCurve, described: TurningMoment) -> None:
    size = float(curves.size[DRIVER] + curves.size[LOAD]) / described.cycle
    if abs(driver - load) > _BALANCED * size:
        raise FindingError(
            f"turning_moment: the mean torque of the driver is {driver:.6g} N m, that of the load "
            f"{load:.6g} N m: the speed does not repeat; leave one of the two out if it is constant, or make "
            "their means equal"
        )


def evened(described: TurningMoment, change: Any) -> _FlywheelEffect:
    """The flywheel that is asked for, or the speed fluctuation that the given inertia gives."""
    omega, wanted, own = described.speed, described.unevenness, described.inertia or 0.0
    flywheel = mass = None
    total = own
    if wanted is not None:
        flywheel = max(change / (wanted * omega**2) - own, 0.0)
        total = own + flywheel
        radius = described.radius_of_gyration
        mass = None if radius is None else flywheel / radius**2
    if total == 0.0:
        return _FlywheelEffect(None, flywheel, mass)
    delta = change / (total * omega**2)
    if delta >= 2.0:
        raise FindingError(
            f"turning_moment.inertia: {total:.6g} kg m² cannot keep the shaft turning: at {omega:.6g} "
            f"rad/s the energy changes by {change:.6g} J in a cycle, which asks for more than "
            f"{change / (2 * omega**2):.6g} kg m²"
        )
    return _FlywheelEffect(total, flywheel, mass, delta, omega * (1 - delta / 2), omega * (1 + delta / 2))


def rim_of(described: TurningMoment, effect: _FlywheelEffect) -> RimSize:
    """The rim of the flywheel that is asked for, or else of the inertia that the shaft has."""
    wanted = effect.flywheel_inertia
    return rim_size(described.rim, described.speed, effect.inertia if wanted is None else wanted)


def _areas(curves: TurnCurve, energy: TurnCurve, cycle: float) -> tuple[dict[str, float | None], ...]:
    at = curves.crossings(EXCESS)
    first, last = (float(curves.at(np.array([phi]))[EXCESS, 0]) for phi in (0.0, cycle * (1 - 1e-12)))
    if first * last < 0:
        # It crosses where one cycle meets the next.
        at = np.append(0.0, at)
    if len(at) < 2:
        return ()
    E = energy.at(at)[0]
    gains = np.append(np.diff(E), E[0] - E[-1])
    ends = np.append(at[1:], at[0] + cycle)
    rows = zip(at, ends, gains, np.cumsum(gains), strict=True)
    return tuple(
        {"start": float(a), "end": float(b), "energy": float(gain), "energy_after": float(then)}
        for a, b, gain, then in rows
    )


def _speed(above: Floats, numbers: Mapping[str, Any]) -> Floats:
    """Speed by the energy above its minimum, (n,) [rad/s]; no curve without a moment of inertia."""
    if numbers["inertia"] is None:
        return _nothing()
    return np.asarray(np.sqrt(numbers["speed_min"] ** 2 + 2 * np.maximum(above, 0.0) / numbers["inertia"]))
