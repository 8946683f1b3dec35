r"""The rotator of a sucker-rod string: motion of link, lever, worm and string, and the forces in them.

The lever closes the loop from the beam's pin through the link to the hanger, paper 4 (8). Link and lever are
a dyad whose ends are l_d apart; it closes while :math:`|l_4 - l_5| \le l_d \le l_4 + l_5`. Where one of
these is an equality link and lever are in line, a change point: the lever goes on in the same sense with
finite dφ_5/dφ_1, but the link has no arm about it, so friction must be overcome by the lever's own momentum
there.

Friction of the string, torque M, asks :math:`M/(u\,\eta)` of the worm of ratio u and efficiency η; the link
gives it with the force :math:`F = M/(u\,\eta\,l_5\,|\sin(\varphi_4 - \varphi_5)|)`, which loads the joints
at both of its ends and, by way of the lever, the hanger.

References
----------
.. [1] Paper 4, equations (8) to (18).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.linkages.closure import turn_angles
from linkwright.machine.machine import Machine
from linkwright.pumping.lever import Lever, LeverMotion, swing_of, takes_along, turns_of, worm_turns_of
from linkwright.pumping.model.rod_rotator import RodRotator
from linkwright.pumping.model.rotator_lengths import Lengths
from linkwright.pumping.unit import PolishedRod, turn_extreme

# Seconds of a day.
_DAY = 86400.0

# Angles of the revolution at which conditions are examined, a quarter of a degree.
_ANGLES = 1440

# Diagonals, and lengths, that differ by less than this share are the same: a hundred times rounding.
_SAME = 1e-13

# Difference of a swing from the wanted one that is rounding [rad]: near s = 180° a lever's swing changes with
# the root of its length, so that the last digits of a length are some 1e-8 of a swing.
_SAME_SWING = 1e-7

# Sine of the angle between link and lever below which the link has no arm: at a change point it is rounding.
_NO_ARM = 1e-6


_EXTREMES_COINCIDE = (
    "Whether l_d has its extremes where the beam has, as equations (5) and (6) of the paper take for granted."
)
_FINDINGS = "Requirements of the regime that the lever does not meet: full rotation, or the required swing."


@dataclass(frozen=True)
class RodRotatorMotion(Result):
    """Motion of a rotator over one revolution of the crank."""

    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad", "As in `PumpingUnitMotion`.")]
    link_angle: Annotated[
        Floats, Label("angle of the link", "φ_4", "rad", "From the beam's pin to the joint; continuous.")
    ]
    lever_angle: Annotated[
        Floats, Label("angle of the lever", "φ_5", "rad", "From the hanger to the joint; continuous.")
    ]
    link_transfer: Annotated[Floats, Label("transfer function of the link", "φ_4′", "", "dφ_4/dφ_1.")]
    lever_transfer: Annotated[Floats, Label("transfer function of the lever", "φ_5′", "", "dφ_5/dφ_1.")]
    link_transfer_d1: Annotated[Floats, Label("second transfer function of the link", "φ_4″", "")]
    lever_transfer_d1: Annotated[Floats, Label("second transfer function of the lever", "φ_5″", "")]
    diagonal: Annotated[Floats, Label("distance from pin to hanger", "l_d", "m", "Of the beam's pin.")]
    link_arm: Annotated[Floats, Label("arm of the link about the hanger", "", "m", "Of the link's force.")]
    regime: Annotated[str, About('``"continuous"`` or ``"intermittent"``, as described.')]
    link_length: Annotated[float, Label("length of the link", "l_4", "m", table="rotator")]
    lever_length: Annotated[float, Label("length of the lever", "l_5", "m", table="rotator")]
    lever_turns_per_cycle: Annotated[
        float,
        Label(
            "revolutions of the lever per revolution of the crank",
            "",
            "",
            "Whole revolutions, in either sense.",
            table="rotator",
        ),
    ]
    lever_swing: Annotated[
        float,
        Label(
            "range of the lever's angle",
            "",
            "rad",
            "A full revolution where it rotates fully.",
            table="rotator",
        ),
    ]
    transfer_min: Annotated[
        float, Label("minimum transfer function of the lever", "min φ_5′", "", table="rotator")
    ]
    transfer_max: Annotated[
        float, Label("maximum transfer function of the lever", "max φ_5′", "", table="rotator")
    ]
    diagonal_min: Annotated[float, Label("minimum distance from pin to hanger", "min l_d", "m")]
    diagonal_max: Annotated[float, Label("maximum distance from pin to hanger", "max l_d", "m")]
    extremes_coincide: Annotated[bool, About(_EXTREMES_COINCIDE)]
    change_points: Annotated[tuple[float, ...], About("Crank angles where link and lever are in line [rad].")]
    loop_residual: Annotated[
        float, Label("maximum gap in the loop over the longest link", "", "", "Of equation (8).")
    ]
    verdict: Annotated[str, About("Why the lever rotates fully, oscillates, or does not close.")]
    findings: Annotated[tuple[str, ...], About(_FINDINGS)]
    worm_turns_per_cycle: Annotated[
        float,
        Label(
            "revolutions of the worm per revolution of the crank",
            "",
            "",
            "That the lever gives it; through the clutch, in one sense only.",
            table="rotator",
        ),
    ]
    speed: Annotated[float | None, Label("design speed of the crank", "ω", "rad/s")]
    lever_speed: Annotated[Floats | None, Label("speed of the lever", "ω_5", "rad/s", "At that speed.")]
    lever_acceleration: Annotated[
        Floats | None, Label("acceleration of the lever", "ε_5", "rad/s²", "At that speed.")
    ]
    string_speed: Annotated[
        Floats | None, Label("speed of the rod string", "ω_s", "rad/s", "Zero while the clutch slips.")
    ]
    string_acceleration: Annotated[
        Floats | None,
        Label("acceleration of the rod string", "ε_s", "rad/s²", "Zero while the clutch slips."),
    ]
    string_turn_days: Annotated[
        float | None, Label("days per revolution of the rod string", "", "", table="rotator")
    ]
    string_turns_per_day: Annotated[float | None, Label("revolutions of the rod string in a day", "", "")]
    worm_torque: Annotated[
        float | None,
        Label("torque at the worm", "M_w", "N m", "That turns the string, quasi-static.", table="rotator"),
    ]
    link_force: Annotated[
        Floats | None,
        Label("force in the link", "F_4", "N", "Positive in tension; infinite at change points."),
    ]
    link_force_max: Annotated[
        float | None,
        Label(
            "maximum force in the link",
            "F_4,max",
            "N",
            "None where there are change points.",
            table="rotator",
        ),
    ]


@public
def rod_rotator(machine: Machine, *, n: int = 360) -> RodRotatorMotion:
    """Motion of the rotator of a rod string, its reduction, and its forces.

    Parameters
    ----------
    machine : Machine
        A machine with a pumping unit and a rotator.
    n : int
        Intervals of the revolution for the curves; the other numbers do not depend on it.

    Returns
    -------
    RodRotatorMotion
        Curves over the revolution, extremes, time for a revolution of the string.

    Raises
    ------
    InputError
        The machine has no rotator.
    AssemblyError
        The crank cannot rotate fully, link and lever cannot meet, or no lever has the required swing.

    Notes
    -----
    Speeds and accelerations are those at constant speed of the crank, ``drive.speed``.

    References
    ----------
    .. [1] Paper 4, equations (8) to (18).
    """
    unit, rotator = machine.pumping_unit, machine.rod_rotator
    if unit is None or rotator is None:
        raise InputError(f"{machine.name} has no [rod_rotator] on a [pumping_unit]: expected both")
    rod = PolishedRod.of(machine, unit)
    lever = Lever.of(machine, unit, rotator)
    curves = lever.motion(turn_angles(n))
    fine = lever.motion(turn_angles(_ANGLES))
    speed = machine.drive.speed if machine.drive else None
    diagonal_ends = [turn_extreme(lambda at: lever.motion(at).diagonal, sign)[0] for sign in (-1, +1)]
    at_ends = lever.motion(np.array([rod.top, rod.bottom])).diagonal
    turns, swing = turns_of(fine), swing_of(lever, fine)
    worm_turns = worm_turns_of(rotator, lever, fine, swing)
    takes = takes_along(rotator, rod, lever)
    days = _days(rotator, speed, worm_turns)
    return RodRotatorMotion(
        crank_angle=curves.angles,
        link_angle=curves.link,
        lever_angle=curves.lever,
        link_transfer=curves.link_d1,
        lever_transfer=curves.lever_d1,
        link_transfer_d1=curves.link_d2,
        lever_transfer_d1=curves.lever_d2,
        diagonal=curves.diagonal,
        link_arm=lever.lengths.lever * np.abs(np.sin(curves.link - curves.lever)),
        regime=rotator.regime,
        link_length=float(lever.lengths.link),
        lever_length=float(lever.lengths.lever),
        lever_turns_per_cycle=abs(turns),
        lever_swing=swing,
        transfer_min=turn_extreme(lambda at: lever.motion(at).lever_d1, -1)[0],
        transfer_max=turn_extreme(lambda at: lever.motion(at).lever_d1, +1)[0],
        diagonal_min=diagonal_ends[0],
        diagonal_max=diagonal_ends[1],
        extremes_coincide=bool(np.allclose(diagonal_ends, at_ends, rtol=_SAME, atol=0)),
        change_points=_change_points(lever.lengths, rod, at_ends),
        loop_residual=fine.residual,
        verdict=verdict(lever.lengths, diagonal_ends[0], diagonal_ends[1]),
        findings=tuple(_missed(rotator, lever.lengths, turns, swing)),
        worm_turns_per_cycle=worm_turns,
        string_turn_days=days,
        string_turns_per_day=None if days is None else 1 / days,
        **_at_speed(rotator, takes(curves), curves, speed),
        **_forces(lever, rotator, takes, curves),
    )


def _missed(rotator: RodRotator, known: Lengths, turns: float, swing: float) -> Iterator[str]:
    of = f"a lever of {known.lever:.6g} m with a link of {known.link:.6g} m"
    if rotator.regime == "continuous":
        if not turns:
            yield (
                f"the lever of the continuous regime does not rotate fully: {of} swings through "
                f"{np.degrees(swing):.4g}°; leave link_length and lever_length out, or choose another "
                "pin_distance"
            )
        return
    wanted = np.pi / 2 if rotator.swing is None else rotator.swing
    if rotator.link_length is None and abs(swing - wanted) > _SAME_SWING:
        yield (
            f"the lever does not have the required swing of {np.degrees(wanted):.6g}°: {of} swings through "
            f"{np.degrees(swing):.6g}°; give link_length and lever_length"
        )


def _change_points(known: Lengths, rod: PolishedRod, at_ends: Floats) -> tuple[float, ...]:
    in_line = (abs(known.link - known.lever), known.link + known.lever)
    is_change = [abs(end - other) <= 1e-12 * end for end, other in zip(at_ends, in_line, strict=True)]
    return tuple(sorted(angle for angle, yes in zip((rod.top, rod.bottom), is_change, strict=True) if yes))


def verdict(known: Lengths, least: float, greatest: float) -> str:
    """Whether the lever turns, rocks, or does not close, and by which lengths.

    ``known``: l_4 and l_5 [m]; ``least``, ``greatest``: extremes m and M of the diagonal [m].

    Grashof's rule names four fixed lengths; here the diagonal changes, so the dyad must close at both of
    its extremes. The paper's (18), l_5 + l_6 > l_3 + l_4, names one position and is not sufficient.
    """
    folded, stretched = abs(known.link - known.lever), known.link + known.lever
    close = 1e-9 * greatest
    spare = (
        f"the diagonal runs from {least:.4f} to {greatest:.4f} m, link and lever reach from {folded:.4f} to "
    )
    spare += f"{stretched:.4f} m"
    if greatest > stretched + close or least < folded - close:
        return f"does not close over the whole revolution: {spare}"
    meets = (abs(least - folded) <= close, abs(greatest - stretched) <= close)
    if all(meets):
        return f"rotates fully, through two change points: {spare}"
    if any(meets):
        return f"touches a change point at one end of the stroke and turns back from there: {spare}"
    return f"oscillates, never in line with its link: {spare}"


def _days(rotator: RodRotator, speed: float | None, worm_turns: float) -> float | None:
    """Days for a full revolution of the string; None without speed or ratio."""
    if speed is None or rotator.worm_ratio is None or not worm_turns:
        return None
    days: float = turn_days(rotator, speed, worm_turns)
    return days


def turn_days(rotator: Any, speed: Any, worm_turns: Any) -> Any:
    """Days for a full revolution of the string by the speed of the crank and the revolutions of the worm."""
    return rotator.worm_ratio / worm_turns * (2 * np.pi / speed) / _DAY


def worm_torque(rotator: Any) -> Any:
    """Torque at the worm that turns the string [N m]."""
    return rotator.string_torque / (rotator.worm_ratio * rotator.worm_efficiency)


def _at_speed(rotator: RodRotator, takes: Floats, curves: LeverMotion, speed: float | None) -> dict[str, Any]:
    names = ("lever_speed", "lever_acceleration", "string_speed", "string_acceleration")
    if speed is None:
        return {"speed": None} | dict.fromkeys(names)
    omega, epsilon = curves.lever_d1 * speed, curves.lever_d2 * speed**2
    if rotator.worm_ratio is None:
        string: tuple[Floats | None, ...] = (None, None)
    else:
        share = takes / rotator.worm_ratio
        string = (omega * share, epsilon * share)
    return {"speed": speed} | dict(zip(names, (omega, epsilon, *string), strict=True))


def _forces(
    lever: Lever,
    rotator: RodRotator,
    takes: Callable[[LeverMotion], Floats],
    curves: LeverMotion,
) -> dict[str, Any]:
    if rotator.string_torque is None or rotator.worm_ratio is None:
        return {"worm_torque": None, "link_force": None, "link_force_max": None}
    torque = worm_torque(rotator)

    def force(motion: LeverMotion) -> Floats:
        """The link pulls the joint toward the pin: its moment about the hanger is −F l_5 sin(φ_4 − φ_5)."""
        sine = np.sin(motion.link - motion.lever)
        with np.errstate(divide="ignore"):
            size = -torque * np.sign(motion.lever_d1) / (lever.lengths.lever * sine)
        size = np.where(np.abs(sine) < _NO_ARM, np.inf, size)
        return np.where(takes(motion) > 0, size, 0.0)

    return {
        "worm_torque": torque,
        "link_force": force(curves),
        "link_force_max": _greatest(lever, torque) if rotator.regime == "intermittent" else None,
    }


def _greatest(lever: Lever, torque: float) -> float | None:
    """Peak absolute value of the link's force over the revolution [N]; None where the link loses its arm."""
    # The clutch takes the lever along at every place of the beam, on the way up or on the way down, and the
    # arm depends on the place alone.

    def arm(angles: Floats) -> Floats:
        motion = lever.motion(angles)
        return np.abs(np.sin(motion.link - motion.lever))

    least = turn_extreme(arm, -1)[0]
    return None if least < _NO_ARM else torque / (float(lever.lengths.lever) * least)
