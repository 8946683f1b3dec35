"""Friction in pins, guides and slots."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import MachineError, Problem
from linkwright.kernel.public import public_type
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units.kinds import DAMPING, LENGTH, RATIO, TORSIONAL_DAMPING
from linkwright.kernel.units.marks import not_negative
from linkwright.linkages.model.structure import Pair


@public_type
@dataclass(frozen=True, slots=True)
class Friction:
    """Friction of one pair.

    Attributes
    ----------
    coefficient : float
        μ of dry friction [–].
    radius : float
        Of a pin: the friction torque is μ r R [m].
    viscous : float
        Torque per relative angular speed of a pin [N m s/rad], force per velocity of a guide or slot [N s/m].
    length : float
        Of a guide: between its two ends, which then share force and moment [m]. Default: the moment
        causes no friction.
    """

    coefficient: float = 0.0
    radius: float = 0.0
    viscous: float = 0.0
    length: float = 0.0

    @property
    def acts(self) -> bool:
        """Whether there is any."""
        return bool(self.coefficient or self.viscous)


FRICTIONLESS = Friction()


def checked(friction: Mapping[str, Friction], pairs: Mapping[str, Pair]) -> dict[str, Friction]:
    """Friction by pair, with names and numbers that make sense.

    `friction`: by name of the pair. Raises MachineError: a pair that does not exist or has no friction of
    this kind; a number that is missing; InputError: a number that is negative or beyond its range.
    """
    problems = [problem for name, entry in friction.items() if (problem := _problem(name, entry, pairs))]
    if problems:
        raise MachineError(problems)
    return dict(friction)


def _problem(name: str, friction: Friction, pairs: Mapping[str, Pair]) -> Problem | None:
    able = [key for key, pair in pairs.items() if pair.kind in ("pin", "guide", "slot")]
    key = f"friction.{name}"
    if name not in able:
        return Problem(
            key, name, f"the name of a pin, guide or slot: {', '.join(able)}", suggestion(name, able)
        )
    unit_of_viscous = TORSIONAL_DAMPING if pairs[name].kind == "pin" else DAMPING
    in_range(
        **{
            f"{key}.{entry}": (getattr(friction, entry), not_negative(kind))
            for entry, kind in (
                ("coefficient", RATIO),
                ("radius", LENGTH),
                ("viscous", unit_of_viscous),
                ("length", LENGTH),
            )
        }
    )
    if pairs[name].kind == "pin" and friction.coefficient and not friction.radius:
        return Problem(f"{key}.radius", "none", "the radius of the pin, since its torque is μ r R")
    if pairs[name].kind != "pin" and friction.radius:
        return Problem(f"{key}.radius", f"{friction.radius:g}", "no radius: this is a guide or a slot")
    if pairs[name].kind != "guide" and friction.length:
        return Problem(f"{key}.length", f"{friction.length:g}", "no length: this is not a guide")
    return None
