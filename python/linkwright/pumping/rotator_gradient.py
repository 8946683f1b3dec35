r"""Derivatives of lengths, swing, transfer functions and forces of a rotator of a rod string.

The lever's angle is a function of the beam's alone. Diagonal, swing and the way of the worm lie between
places of the stroke, at its ends or where the lever turns back, and have the derivative of the curve there
(envelope theorem). The transfer function is that of the beam times the slope

.. math:: \frac{\mathrm d\varphi_5}{\mathrm d\varphi_3} = \pm\lambda' + \frac{s\,c'}{\sin\gamma},
    \qquad c = \cos\gamma = \frac{l_d^2 + l_5^2 - l_4^2}{2\,l_d\,l_5},

with λ the lean of the diagonal and s the side of the joint. At a change point it is 0/0 with a limit: the
curve is smooth there, and so are its derivatives, which are interpolated between angles around it.

The clutch takes the lever along at every place of the beam either on the way up or on the way down, and the
arm of the link depends on the diagonal alone: its force is largest at an extreme of the diagonal.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.extreme import TIE, chosen, common, differ, they_differ
from linkwright.kernel.numerics.tangent import Tangent, lifted, primal
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import CHANGE_POINTS, Derivatives, directions, followed, scalars_of
from linkwright.pumping.gradient import RodAlong
from linkwright.pumping.lever import Lever
from linkwright.pumping.model.rod_rotator import RodRotator, diagonal
from linkwright.pumping.model.rotator_lengths import (
    Lengths,
    LeverStroke,
    lengths,
    required,
    turning_shares,
    zeros_of_stroke,
)
from linkwright.pumping.model.unit import PumpingUnit
from linkwright.pumping.rod_rotator import RodRotatorMotion, rod_rotator, turn_days, worm_torque
from linkwright.pumping.unit import PolishedRod

_UNIT, _ROTATOR = "pumping_unit.", "rod_rotator."

# Places of a tie closer than this are one [rad].
_APART = 1e-2

# Distance from a change point [rad] within which derivatives are interpolated, and between how many angles
# around it: the transfer function of a lever bends within a radian.
_NEAR, _NODES = 0.06, 12

# Extremes by the ends of their names, and signs of the values of which they are the maximum.
_ENDS = (("min", -1), ("max", 1))

_WHOLE = "it is a whole number of revolutions"
_NO_ARM = "the link loses its arm where it comes into line with the lever"


def rotator_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Scalars of a rotator by some entries. Raises what `rod_rotator` raises."""
    along = RotatorAlong.of(machine, variables)
    listed = tuple(name for name in variables if name not in along.refused)
    tangents = scalars_of(along.result, along.scalars(), along.entries, listed)
    return Derivatives(listed, tangents, along.ties, _missing(along.result), along.refused)


def _missing(result: RodRotatorMotion) -> dict[str, str]:
    """Numbers without derivatives, with the reason."""
    missing = {"lever_turns_per_cycle": _WHOLE}
    if result.regime == "continuous" or result.lever_turns_per_cycle:
        missing["worm_turns_per_cycle"] = _WHOLE
    if result.lever_turns_per_cycle:
        missing["lever_swing"] = "the lever rotates fully"
    if result.worm_torque is not None and result.link_force_max is None:
        missing["link_force_max"] = _NO_ARM
    return missing


# Entries of the rotator that do not move it.
_OF_WORM = tuple(f"{_ROTATOR}{key}" for key in ("worm_ratio", "worm_efficiency", "string_torque"))


def _of_lengths(names: Sequence[str]) -> list[str]:
    """Entries by which link and lever come to be in line, or not."""
    sizes = {f"{_UNIT}{key}" for key in (*"ACIPHGR", "cable")}
    return [name for name in names if name in sizes or (name.startswith(_ROTATOR) and name not in _OF_WORM)]


@dataclass(frozen=True)
class _Parts:
    """What a rotator is described by, with derivatives or without."""

    unit: PumpingUnit
    rotator: RodRotator
    lengths: Lengths  # l_4 and l_5 [m]
    speed: Any  # of the crank [rad/s], or None

    @classmethod
    def of(cls, machine: Machine) -> _Parts:
        """Those of a machine; raises where an entry cannot be followed."""
        unit, rotator = machine.pumping_unit, machine.rod_rotator
        assert unit is not None
        assert rotator is not None
        return cls(unit, rotator, lengths(unit, rotator), machine.drive.speed if machine.drive else None)

    @property
    def excess(self) -> Any:
        """l_4² − l_5² [m²]."""
        return self.lengths.link**2 - self.lengths.lever**2

    def stroke(self, shares: Any) -> LeverStroke:
        """Places of the stroke."""
        return LeverStroke.of(self.unit, self.rotator, shares)


@dataclass(frozen=True)
class RotatorAlong:
    """A rotator with derivatives by some entries."""

    result: RodRotatorMotion
    still: _Parts
    along: _Parts
    rod: RodAlong
    lever: Lever
    # entries: those by which there are derivatives; refused: those that have none, with the reason.
    entries: tuple[str, ...]
    refused: dict[str, str]
    ties: dict[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, machine: Machine, variables: Sequence[str]) -> RotatorAlong:
        """The rotator of a machine, by some entries. Raises what `rod_rotator` raises."""
        result, still = rod_rotator(machine, n=8), _Parts.of(machine)
        rod = PolishedRod.of(machine, still.unit)
        # The motion of the beam is that of the unit alone, which has no other entries.
        program = directions(rod.machine, [name for name in variables if name.startswith(_UNIT)])
        refused = dict(program.refused)
        if result.change_points and still.rotator.link_length is not None:
            refused |= dict.fromkeys(_of_lengths(variables), CHANGE_POINTS)
        own = [name for name in variables if name.startswith((_UNIT, _ROTATOR)) or name == "drive.speed"]
        asked = [name for name in own if name not in refused]
        known, parts = followed(machine, asked, _Parts.of, refused)
        values = np.zeros((len(program.values), len(known)))
        for place, name in enumerate(known):
            if name in program.variables:
                values[:, place] = program.values[:, program.variables.index(name)]
        beam = RodAlong.of_unit(rod, parts.unit, values)
        lever = Lever.of(machine, still.unit, still.rotator)
        return cls(result, still, parts, beam, lever, known, refused)

    def scalars(self) -> dict[str, Any]:
        """Numbers by name."""
        rotator: Any = self.along.rotator
        result = self.result
        numbers = dict(zip(("link_length", "lever_length"), self.along.lengths, strict=True))
        numbers |= self._diagonal() | self._way()
        numbers |= self._transfer()
        if result.string_turn_days is not None:
            turns = numbers.get("worm_turns_per_cycle", result.worm_turns_per_cycle)
            days = turn_days(rotator, self.along.speed, turns)
            numbers |= {"string_turn_days": days, "string_turns_per_day": 1 / days}
        if result.worm_torque is not None:
            numbers["worm_torque"] = worm_torque(rotator)
            if result.link_force_max is not None:
                numbers["link_force_max"] = self._force(numbers["worm_torque"], numbers)
        return numbers

    # -- over the stroke ---------------------------------------------------------------------------------

    def _diagonal(self) -> dict[str, Any]:
        """Extremes of the distance from pin to hanger."""

        def slope(share: Floats) -> Floats:
            rate: Floats = self.still.stroke(Tangent(share, np.ones((len(share), 1)))).distance.d[..., 0]
            return rate

        shares = zeros_of_stroke(slope)
        distance = self._array(self.along.stroke(shares).distance[0])
        return {f"diagonal_{end}": self._extreme(f"diagonal_{end}", distance, sign) for end, sign in _ENDS}

    def _way(self) -> dict[str, Any]:
        """Range of the lever's angle, and revolutions of the worm."""
        if self.result.lever_turns_per_cycle:
            return {}
        still, along, name = self.still, self.along, "worm_turns_per_cycle"
        if self.result.change_points:
            # Entries that move the lever have no derivatives then.
            numbers = {"lever_swing": self.result.lever_swing, name: self.result.worm_turns_per_cycle}
            return {key: number for key, number in numbers.items() if key not in _missing(self.result)}
        shares = turning_shares(still.unit, still.rotator, still.lengths.lever, still.excess)
        angle = self._array(along.stroke(shares).angle(along.lengths.lever, along.excess)[0])
        high, low = (self._extreme("lever_swing", angle, sign) for sign in (1, -1))
        swing = high - low
        if still.rotator.regime == "continuous":
            return {"lever_swing": swing}
        if still.rotator.link_length is None:
            # The lever is made for it, whatever else changes.
            swing = required(along.rotator)
        # What goes forward in one stroke comes back in the other.
        way: Any = swing if len(angle) == 2 else np.abs(angle[1:] - angle[:-1]).sum()
        return {"lever_swing": swing, name: way / (2 * np.pi)}

    def _force(self, torque: Any, numbers: dict[str, Any]) -> Any:
        """Maximum force in the link: at one end of the diagonal its arm l_5 sin(φ_4 − φ_5) is smallest."""
        link, lever = self.along.lengths
        distances = [numbers[f"diagonal_{end}"] for end, _ in _ENDS]
        forces = [torque * link / (d * lever * _sine(d, link, lever)) for d in distances]
        row = self._array(np.stack([lifted(force, len(self.entries)) for force in forces]))
        return self._extreme("link_force_max", row, 1)

    # -- over the revolution -----------------------------------------------------------------------------

    def _transfer(self) -> dict[str, Any]:
        """Extremes of the transfer function of the lever."""
        turn = np.array([0.0, 2 * np.pi])
        curve = turn_curve(lambda at: self.lever.motion(at).lever_d1[None], turn, "motion")
        numbers = {}
        for end, sign in _ENDS:
            angles: list[float] = []
            for angle in (curve.extreme(sign)[1], *curve.extremes(sign, 0, TIE).tolist()):
                if all(abs(np.sin(0.5 * (angle - other))) > 0.5 * _APART for other in angles):
                    angles.append(angle)
            rates = self._array(np.stack([self.transfer_at(angle) for angle in angles]))
            numbers[f"transfer_{end}"] = self._extreme(f"transfer_{end}", rates, sign)
        return numbers

    def transfer_at(self, angle: float) -> Any:
        """The transfer function of the lever at a crank angle."""
        for change in self.result.change_points:
            if abs(np.sin(0.5 * (angle - change))) < 0.5 * _NEAR:
                off = (angle - change + np.pi) % (2 * np.pi) - np.pi
                nodes = 2 * _NEAR * np.polynomial.chebyshev.chebpts1(_NODES)
                rates = self._rates(change + nodes)
                return (rates * _lagrange(nodes, off)).sum()
        return self._rates(np.array([angle]))[0]

    def _rates(self, angles: Floats) -> Any:
        """The transfer function at crank angles off the change points."""
        unit, (link, lever) = self.along.unit, self.along.lengths
        rise, rise_d1, _ = self.rod.motion(angles)
        front = unit.front_angle(unit.psi_bottom) + rise / unit.A
        dx, dy = diagonal(unit, self.along.rotator, front)
        way = self.along.rotator.pin_distance * np.sin(front)
        distance = np.hypot(dx, dy)
        # From the vertical, counter-clockwise as drawn.
        sense = -1.0 if unit.is_mirrored else 1.0
        lean, lean_d1 = sense * np.arctan2(dx, dy), sense * (way * dy + dx * dx) / distance**2
        # +1 for a joint on the left of the diagonal, seen from the pin.
        side = np.sign(np.sin(0.5 * np.pi + primal(lean) - self.lever.motion(angles).lever))
        distance_d1 = -dx * (dy - way) / distance
        cosine_d1 = distance_d1 * (distance**2 + self.along.excess) / (2 * lever * distance**2)
        return (lean_d1 + side * cosine_d1 / _sine(distance, link, lever)) * (rise_d1 / unit.A)

    # -- what extremes have in common ----------------------------------------------------------------------

    def _array(self, x: Any) -> Any:
        return lifted(x, len(self.entries))

    def _extreme(self, name: str, row: Any, sign: int) -> Any:
        """The maximum (+1) or minimum (−1); NaN where derivatives of equal extremes differ."""
        values = sign * row.value
        best = int(values.argmax())
        tied = values >= values[best] - TIE * np.abs(values).max()
        d = row.d[tied]
        differs = chosen(self.entries, differ(d))
        if differs:
            self.ties[name] = f"the extreme occurs at {len(d)} positions; {they_differ(differs)}"
        return Tangent(row.value[best], common(d))


def _sine(distance: Any, link: Any, lever: Any) -> Any:
    """sin γ between lever and diagonal, by the sides of their triangle: its differences vanish in line."""
    reach, apart = link + lever, link - lever
    product = (reach - distance) * (distance - apart) * (reach + distance) * (distance + apart)
    return np.sqrt(product) / (2 * distance * lever)


def _lagrange(nodes: Floats, at: float) -> Floats:
    """Weights of values at nodes in the polynomial through them, at a place."""
    others = [np.delete(nodes, k) for k in range(len(nodes))]
    return np.array([np.prod((at - o) / (x - o)) for x, o in zip(nodes, others, strict=True)])
