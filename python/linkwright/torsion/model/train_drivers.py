r"""What drives a train: engines of one kind or several, turbines and motors, each with its part of the power.

Mean torques balance: with the resistance R and what is given as torques G, both referred to the first disc,
the other drivers give the rest by their shares,

.. math:: n_d M_d = \frac{s_d}{\sum s}\,(R - G)
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, NamedTuple

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.units import RATIO, Angle, not_negative, positive
from linkwright.torsion.model.engine.engine import ReciprocatingEngine
from linkwright.torsion.model.train_base import PositiveSpeed, PositiveTorque
from linkwright.torsion.model.train_torques import Exponent


class TrainDriver(CheckedDescription):
    """A turbine or motor that drives: with its share of the power, or with a torque over the speed."""

    on: str = Field(description="The disc that it drives.")
    share: Annotated[float, positive(RATIO)] = Field(
        1.0, description="Its part of the power that loads need, over that of the other drivers."
    )
    torque: PositiveTorque | None = Field(
        None, description="Mean torque at the speed given, whatever the loads need, in place of the share."
    )
    speed: PositiveSpeed | None = Field(None, description="Of the disc, at which the torque is given.")
    exponent: Exponent = Field(0.0, description="Of the torque over the speed; −1 at constant power.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.torque is None and (self.speed is not None or self.exponent):
            key = "speed" if self.speed is not None else "exponent"
            yield fault(key, found=getattr(self, key), expected="none without a torque", remedy="give torque")
        if self.torque is not None and self.speed is None and self.exponent:
            yield fault("speed", expected="the speed at which the torque holds, as it changes with it")

    def torque_at(self, speed: float) -> float:
        """Torque given, at a speed of its disc above zero [N m]."""
        assert self.torque is not None
        if self.speed is None:
            return self.torque
        torque: float = self.torque * (speed / self.speed) ** self.exponent
        return torque


class TrainEngine(Description):
    """One of several engines that drive a train."""

    phase: Angle = Field(
        0.0,
        description="Angle by which its crank leads that of [train.engine], seen at its own speed. Clutched "
        "engines have any: look for the worst.",
    )
    factors: dict[str, Annotated[float, not_negative(RATIO)]] = Field(
        default_factory=dict,
        description="Share of the combustion in cylinders that are not sound, by number; 0 misfires.",
    )
    engine: ReciprocatingEngine | None = Field(
        None, description="The engine itself, where it is another one than [train.engine]."
    )


class InstalledEngine(NamedTuple):
    """An engine in its place in a train."""

    name: str  # empty where there is but one
    engine: ReciprocatingEngine  # with its own factors
    phase: float  # angle by which its crank leads [rad]

    @property
    def throws(self) -> tuple[str, ...]:
        """Names of the discs that its throws are."""
        return throw_names(len(self.engine.throws), self.name)

    @property
    def cranks(self) -> tuple[str, ...]:
        """Names of the shafts between its throws."""
        return crank_names(len(self.engine.throws), self.name)

    @property
    def prefix(self) -> str:
        """Before the names of its parts."""
        return _prefix(self.name)


def throw_names(throws: int, engine: str = "") -> tuple[str, ...]:
    """Names of the discs that the throws of an engine are."""
    return tuple(f"{_prefix(engine)}throw_{n + 1}" for n in range(throws))


def crank_names(throws: int, engine: str = "") -> tuple[str, ...]:
    """Names of the shafts between the throws of an engine."""
    return tuple(f"{_prefix(engine)}crank_{n + 1}" for n in range(throws - 1))


def _prefix(engine: str) -> str:
    return f"{engine}_" if engine else ""
