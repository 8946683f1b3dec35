"""What an engine is in a train: discs and stiffness of its throws by every formula, its firing, its gas."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Shown
from linkwright.kernel.result import Result
from linkwright.kernel.units import SPEED, positive
from linkwright.torsion.model.engine.engine import ReciprocatingEngine
from linkwright.torsion.model.engine.engine_motion import (
    mean_throw_inertia,
    own_inertia,
    running_gears,
    throw_stiffness,
)
from linkwright.torsion.model.engine.equivalent_inertia import published_throw_inertia
from linkwright.torsion.model.engine.firing import firing_angles
from linkwright.torsion.model.engine.throw_compliance import compliances
from linkwright.torsion.response.engine_torques import cylinder_torques

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class EngineData(Result):
    """An engine's part of a train."""

    own_inertia: Annotated[
        float, Shown("moment of inertia of what turns with a throw", "J_k", "kg m²", "Without rods.")
    ]
    throw_inertia: Annotated[
        float,
        Shown(
            "moment of inertia of the disc that stands for a throw",
            "",
            "kg m²",
            "Mean over the revolution of its exact inertia.",
        ),
    ]
    throw_inertia_published: Annotated[float, Shown("the same by paper 3, (7) and (12)", "", "kg m²")]
    stiffness: Annotated[
        float | None,
        Shown("stiffness from throw to throw", "k", "N m/rad", "As it is used; None with a single throw."),
    ]
    stiffness_by: Annotated[str, About('Formula that it is by, or "given".')]
    stiffness_formulas: Annotated[
        dict[str, float], About("Stiffness by every formula, where the geometry is known [N m/rad].")
    ]
    firing: Annotated[
        dict[str, float], About("Crank angle at which each cylinder fires, by number, in their order [rad].")
    ]
    speed: Annotated[float, Shown("speed at which the gas is reported", "ω", "rad/s")]
    mean_effective_pressure: Annotated[tuple[float, ...], About("Of a sound cylinder of each bank [Pa].")]
    peak_pressure: Annotated[tuple[float, ...], About("Of a sound cylinder of each bank [Pa].")]

    @property
    def intervals(self) -> tuple[float, ...]:
        """Angles from one firing to the next, in their order, but for the last [rad]."""
        return tuple(np.diff(list(self.firing.values())).tolist())

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """All of it."""
        tables = {"stiffness_formulas": self.stiffness_formulas, "firing": self.firing}
        return super().to_dict(curves=curves) | tables


@public
def engine_data(engine: ReciprocatingEngine, speed: float) -> EngineData:
    """What an engine is in a train.

    Parameters
    ----------
    engine : ReciprocatingEngine
        The engine.
    speed : float
        Of its crank, at which its gas is reported [rad/s].

    Returns
    -------
    EngineData
        Discs, stiffness, firing, gas.

    Raises
    ------
    InputError
        A speed that is not above zero.
    """
    in_range(speed=(speed, positive(SPEED)))
    given = engine.stiffness is not None
    formulas = {} if engine.throw is None else compliances(engine.throw)
    angles, _ = firing_angles(engine.places, engine.firing_order, engine.cycle)
    gas = cylinder_torques(engine, np.array([speed]), 1.0).banks
    return EngineData(
        own_inertia=own_inertia(engine),
        throw_inertia=mean_throw_inertia(engine),
        throw_inertia_published=published_throw_inertia(
            engine.radius, running_gears(engine), own_inertia(engine)
        ),
        stiffness=throw_stiffness(engine) if len(engine.throws) > 1 else None,
        stiffness_by="given" if given else engine.stiffness_formula,
        stiffness_formulas={name: 1.0 / each for name, each in formulas.items()},
        firing={str(number): angles[number - 1] for number in engine.firing_order},
        speed=speed,
        mean_effective_pressure=tuple(float(each.mean_effective_pressure[0]) for each in gas),
        peak_pressure=tuple(float(each.peak_pressure[0]) for each in gas),
    )
