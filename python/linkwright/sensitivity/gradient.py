r"""Exact derivatives of results by entries of a machine.

.. math:: \frac{\mathrm d y_i}{\mathrm d x_j}, \qquad
    E_{ij} = \frac{x_j}{y_i}\frac{\mathrm d y_i}{\mathrm d x_j}

The derivative by an entry comes in two steps: of the numbers of the core's program by the entry
(`linkwright.machine.program.directions`), and of the result by these numbers (`linkwright.drive.gradient`).
Neither is a difference. What has no derivative is refused by name, with the reason.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.drive.gradient import steady_tangents
from linkwright.drive.steady_state import SteadyState
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Shown, declared, shown
from linkwright.kernel.result import Result
from linkwright.machine.address import addresses, get, kind
from linkwright.machine.machine import Machine
from linkwright.machine.program.directions import directions

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Gradient(Result):
    """Derivatives of ``n`` responses by ``m`` variables."""

    responses: Annotated[tuple[str, ...], About('What is differentiated, as "steady_state.unevenness".')]
    variables: Annotated[tuple[str, ...], About("Addresses of the entries.")]
    units: Annotated[tuple[str, ...], About("SI unit of each response.")]
    variable_units: Annotated[tuple[str, ...], About("SI unit of each variable.")]
    values: Annotated[Floats, About("Values of the responses, (n,) [SI].")]
    at: Annotated[Floats, About("Values of the variables, (m,) [SI].")]
    derivatives: Annotated[Floats, About("Response over variable, (n, m) [SI].")]
    ties: Annotated[
        dict[str, str], About("Responses that have a derivative on either side only, each with the reason.")
    ]
    refused: Annotated[dict[str, str], About("Entries that have no derivative, each with the reason.")]

    @property
    def elasticities(self) -> Annotated[Floats, About("Share of change of response over that of variable.")]:
        """x/y · dy/dx, (n, m) [–]; NaN where the response is zero."""
        with np.errstate(divide="ignore", invalid="ignore"):
            found = self.derivatives * self.at / self.values[:, None]
        return np.where(np.isfinite(found), found, np.nan)

    def of(self, response: str) -> dict[str, float]:
        """Derivatives of one response by address [SI]."""
        row = self.derivatives[self.responses.index(response)]
        return dict(zip(self.variables, row.tolist(), strict=True))

    def only(self, responses: Sequence[str]) -> Gradient:
        """Those of some responses, as far as they are here."""
        rows = [self.responses.index(name) for name in responses if name in self.responses]
        names = tuple(self.responses[row] for row in rows)
        return replace(
            self,
            responses=names,
            units=tuple(self.units[row] for row in rows),
            values=self.values[rows],
            derivatives=self.derivatives[rows],
            ties={name: why for name, why in self.ties.items() if name in names},
        )

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Derivatives and elasticities by response and address."""
        pairs = (("sensitivity", self.derivatives), ("elasticity", self.elasticities))
        tables = {
            name: {
                response: dict(zip(self.variables, row.tolist(), strict=True))
                for response, row in zip(self.responses, table, strict=True)
            }
            for name, table in pairs
        }
        values = dict(zip(self.responses, self.values.tolist(), strict=True))
        at = dict(zip(self.variables, self.at.tolist(), strict=True))
        return tables | {"values": values, "at": at, "ties": self.ties, "refused": self.refused}


@public
def gradient(
    machine: Machine, responses: Sequence[str] | None = None, variables: Sequence[str] | None = None
) -> Gradient:
    """Derivatives of results by entries of a machine, exact to rounding.

    Parameters
    ----------
    machine : Machine
        The machine, with a motor.
    responses : sequence of str, optional
        Such as ``"steady_state.unevenness"``; without them every scalar result of the steady motion.
    variables : sequence of str, optional
        Addresses, such as ``"mechanism.cranks.A2.phase"``; without them every number of the machine.

    Returns
    -------
    Gradient
        Derivatives in SI. An entry without a derivative (a count, a number of a table) is listed in
        ``refused`` if it was not asked for.

    Raises
    ------
    InputError
        There is no such response or entry, or an entry that was asked for has no derivative.
    SteadyStateError
        The machine has no steady motion.

    Notes
    -----
    An entry that others follow from counts with them: the rated speed of a motor moves its breakdown speed.
    Those that follow are varied with all entries of the file held. At a tie of two extremes the derivative is
    that of the extreme in the results, and ``ties`` says so.

    Examples
    --------
    >>> import linkwright as lw
    >>> machine = lw.read("machines/roller_two_carts.toml")
    >>> found = lw.gradient(machine, ["steady_state.unevenness"], ["mechanism.cranks.A2.phase"])
    >>> found.derivatives.shape
    (1, 1)
    """
    names = tuple(addresses(machine)) if variables is None else tuple(dict.fromkeys(variables))
    for name in names:
        get(machine, name)
    found = directions(machine, names)
    if variables is not None and found.refused:
        name, reason = next(iter(found.refused.items()))
        raise InputError(f"{name}: it has no derivative: {reason}; leave it out")
    steady = steady_tangents(machine, found.values)
    tangents = _scalars(steady.state)
    asked = tuple(tangents) if responses is None else tuple(dict.fromkeys(responses))
    for name in asked:
        if name not in tangents:
            raise InputError(f'no response "{name}" with a derivative: {suggestion(name, tangents)}')
    return Gradient(
        responses=asked,
        variables=found.variables,
        units=tuple(shown(SteadyState, name.partition(".")[2]).unit for name in asked),
        variable_units=tuple(_unit(machine, name) for name in found.variables),
        values=np.array([tangents[name].value for name in asked]),
        at=np.array([float(get(machine, name)) for name in found.variables]),
        derivatives=np.stack([tangents[name].d for name in asked]),
        ties={name: reason for name in asked if (reason := _tie(name, steady.ties))},
        refused=dict(found.refused),
    )


def _scalars(state: SteadyState) -> dict[str, Tangent]:
    """What is a number with derivatives, by name."""
    found = ((name, getattr(state, name)) for name, mark in _declared() if isinstance(mark, Shown))
    return {f"steady_state.{name}": value for name, value in found if isinstance(value, Tangent)}


def _declared() -> list[tuple[str, object]]:
    return [(name, mark) for name, (_, mark) in declared(SteadyState).items()]


# Extremes → what is made of them.
_MADE_OF = {
    "speed": (
        *("speed_mean_extremes", "unevenness", "unevenness_time", "motion_coefficient"),
        *("motion_coefficient_time", "dynamism", "torque_motor_min", "torque_motor_max", "power_motor_max"),
    ),
    "acceleration": ("dynamism", "dynamism_time", "motion_coefficient", "motion_coefficient_time"),
}


def _tie(response: str, ties: dict[str, str]) -> str:
    """Why a response has a derivative on either side only; empty if it has one."""
    name = response.partition(".")[2]
    for extreme, reason in ties.items():
        if name == extreme or name in _MADE_OF[extreme.partition("_")[0]]:
            return f"{extreme.replace('_', ' ')}: {reason}"
    return ""


def _unit(machine: Machine, address: str) -> str:
    found = kind(machine, address)
    return found.unit if found else ""
