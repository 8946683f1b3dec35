r"""Exact derivatives of results by entries of a machine.

.. math:: \frac{\mathrm d y_i}{\mathrm d x_j}, \qquad
    E_{ij} = \frac{x_j}{y_i}\frac{\mathrm d y_i}{\mathrm d x_j}

None of them is a difference: `linkwright.sensitivity.sources` says of which results there are some, and how
they are found. What has no derivative is refused by name, with the reason.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby
from numbers import Number
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import FindingError, InputError, MachineError, cut
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About
from linkwright.kernel.result import Result
from linkwright.machine.address import addresses, entry_of, kind
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives
from linkwright.sensitivity.sources import SOURCES, analysis_of, chosen, source, usual_analysis

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


# Elasticity that is rounding error: a derivative is exact to some 1e-14 of the largest of its sum.
ROUNDED = 1e-13

# Entries of each response that a notebook shows; `to_frame` has all. Responses of a figure without names.
_SHOWN, _PLOTTED = 8, 6


@dataclass(frozen=True)
class Gradient(Result):
    """Derivatives of ``n`` responses by ``m`` variables."""

    responses: Annotated[tuple[str, ...], About('Responses, as "steady_state.unevenness".')]
    words: Annotated[tuple[str, ...], About("Names of the responses in words.")]
    variables: Annotated[tuple[str, ...], About("Addresses of the entries.")]
    units: Annotated[tuple[str, ...], About("SI unit of each response.")]
    variable_units: Annotated[tuple[str, ...], About("SI unit of each variable.")]
    values: Annotated[Floats, About("Values of the responses, (n,) [SI].")]
    at: Annotated[Floats, About("Values of the variables, (m,) [SI].")]
    derivatives: Annotated[
        Floats, About("Response over variable, (n, m) [SI]; NaN where `ties` says that there is none.")
    ]
    ties: Annotated[
        dict[str, str],
        About(
            "Responses with one-sided derivatives only, or without a derivative with respect to some "
            "entries, each with the reason."
        ),
    ]
    refused: Annotated[dict[str, str], About("Entries that have no derivative, each with the reason.")]
    missing: Annotated[
        dict[str, str],
        About("Responses of the analyses asked for that have no derivative, each with the reason."),
    ] = field(default_factory=dict)

    @property
    def elasticities(self) -> Annotated[Floats, About("Share of change of response over that of variable.")]:
        """x/y · dy/dx, (n, m) [–]; NaN where the response is zero."""
        with np.errstate(divide="ignore", invalid="ignore"):
            elasticities = self.derivatives * self.at / self.values[:, None]
        return np.where(np.isfinite(elasticities), elasticities, np.nan)

    @public
    def of(self, response: str) -> dict[str, float]:
        """Derivatives of one response by address [SI]; NaN where there is none."""
        row = self.derivatives[self._row(response)]
        return dict(zip(self.variables, row.tolist(), strict=True))

    def _row(self, response: str) -> int:
        """Place of a response."""
        if response not in self.responses:
            hint = suggestion(response, self.responses) or "see those of .responses"
            raise InputError(f"response: found {cut(response)}, which was not derived; {hint}")
        return self.responses.index(response)

    @public
    def only(self, responses: Sequence[str]) -> Gradient:
        """Those of some responses, as far as they are here."""
        rows = [self.responses.index(name) for name in responses if name in self.responses]
        names = tuple(self.responses[row] for row in rows)
        return replace(
            self,
            responses=names,
            words=tuple(self.words[row] for row in rows),
            units=tuple(self.units[row] for row in rows),
            values=self.values[rows],
            derivatives=self.derivatives[rows],
            ties={name: why for name, why in self.ties.items() if name in names},
        )

    @public
    def ranked(self, response: str) -> list[int]:
        """Places of the variables by their influence: change of the response for 1 % of each, largest first.

        Entries that are zero follow, by the size of the derivative. Rounding errors are left out.
        """
        row = self._row(response)
        slopes = self.derivatives[row]
        effect = np.abs(slopes * self.at)
        is_rounding = (self.at != 0) & (effect <= ROUNDED * np.abs(self.values[row]))
        known = np.flatnonzero(np.isfinite(slopes) & (slopes != 0) & ~is_rounding).tolist()
        return sorted(known, key=lambda at: (-effect[at], -abs(slopes[at])))

    def curves(self) -> dict[str, np.ndarray]:
        """None: derivatives run over nothing."""
        return {}

    def shown_rows(self) -> Iterator[tuple[str, str, float | tuple[float, float], str]]:
        """Each response, and its derivatives by the entries that influence it most."""
        for row, response in enumerate(self.responses):
            yield self.words[row], "", float(self.values[row]), self.units[row]
            for at in self.ranked(response)[:_SHOWN]:
                words = f"by {self.variables[at]}"
                yield words, "", float(self.derivatives[row, at]), derivative_unit(self, row, at)

    def to_frame(self) -> pd.DataFrame:
        """The derivatives as a table: a row for each variable, a column for each response.

        Returns
        -------
        pandas.DataFrame
            SI; NaN where `ties` says that there is no derivative.

        Raises
        ------
        InputError
            pandas is not installed, an extra; the message has the command that installs it.
        """
        from linkwright.kernel.extras import require

        require("pandas", "frame", "to_frame needs pandas")
        import pandas as pd

        index = pd.Index(self.variables, name="variable")
        return pd.DataFrame(self.derivatives.T, index=index, columns=list(self.responses))

    def plot(self, *names: str) -> Figure:
        """The change of responses for 1 % more of each entry as bars, those that matter most at the top.

        Parameters
        ----------
        *names : str
            Responses, such as ``"steady_state.unevenness"``; the first six without any.

        Returns
        -------
        matplotlib.figure.Figure
            A notebook shows it; ``figure.savefig(path)`` writes it.

        Raises
        ------
        InputError
            There is no such response, or none that is not zero.
        """
        from linkwright.sensitivity.figures import influence_figure

        drawn = [name for name in names or self.responses if self.values[self._row(name)] != 0]
        if not drawn:
            raise InputError("a response that is zero has no share of change to plot; use .to_frame()")
        return influence_figure(self, *(drawn if names else drawn[:_PLOTTED]))

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Derivatives and elasticities by response and address, as far as there are some."""
        pairs = (("sensitivity", self.derivatives), ("elasticity", self.elasticities))
        tables = {
            name: {
                response: {
                    address: value
                    for address, value, slope in zip(self.variables, row.tolist(), slopes, strict=True)
                    if np.isfinite(slope)
                }
                for response, row, slopes in zip(self.responses, table, self.derivatives, strict=True)
            }
            for name, table in pairs
        }
        values = dict(zip(self.responses, self.values.tolist(), strict=True))
        at = dict(zip(self.variables, self.at.tolist(), strict=True))
        reasons = {"ties": self.ties, "refused": self.refused, "missing": self.missing}
        return tables | {"values": values, "at": at} | reasons


def derivative_unit(gradient: Gradient, row: int, at: int) -> str:
    """Unit of the derivative of a response by a variable, both by their places."""
    unit = gradient.variable_units[at]
    return f"{gradient.units[row]} per {unit}".strip() if unit else gradient.units[row]


@public
def gradient(
    machine: Machine, responses: Sequence[str] | None = None, variables: Sequence[str] | None = None
) -> Gradient:
    """Derivatives of results by entries of a machine, exact to rounding.

    Parameters
    ----------
    machine : Machine
    responses : sequence of str, optional
        Such as ``"steady_state.unevenness"``, ``"free_vibration.natural_frequencies.1"`` or, of all modes,
        ``"free_vibration.natural_frequencies"``; an analysis stands for its usual ones. Without them every
        scalar of the steady motion, or where nothing gives a speed the natural frequencies of the train, or
        the scalars of the turning-moment diagram, of the topper, of the pumping unit or of the cams.
        ``"forces"`` stands for the largest driving torque, shaking force and reactions.
    variables : sequence of str, optional
        Addresses, such as ``"mechanism.cranks.A2.phase"``; without them every number of the machine.

    Returns
    -------
    Gradient
        Derivatives in SI. An entry without a derivative (a count, a cycle) is listed in
        ``refused`` if it was not asked for.

    Raises
    ------
    InputError
        There is no such response or entry, or an entry that was asked for has no derivative.
    FindingError
        The machine cannot do what is asked for, as it has no steady motion.

    Notes
    -----
    An entry that others follow from counts with them: the rated speed of a motor moves its breakdown speed.
    Those that follow are varied with all entries of the file held. At a tie of two extremes the derivative is
    that of the extreme in the results, and ``ties`` says so. Largest forces are those among the crank angles
    of `forces`; where one lies on a kink that an entry moves, it has no derivative by this entry.

    Examples
    --------
    >>> import linkwright as lw
    >>> machine = lw.read("machines/roller_two_carts.toml")
    >>> found = lw.gradient(machine, ["steady_state.unevenness"], ["mechanism.cranks.A2.phase"])
    >>> found.derivatives.shape
    (1, 1)
    """
    names = tuple(addresses(machine)) if variables is None else _entries(machine, variables)
    asked = [usual_analysis(machine)] if responses is None else list(dict.fromkeys(responses))
    if not asked:
        raise InputError("responses: found an empty list, expected one response or more")
    sources = {name: source(machine, name, names) for name in dict.fromkeys(map(analysis_of, asked))}
    refused = {name: why for source in sources.values() for name, why in source.refused.items()}
    if variables is None:
        refused |= {name: _not_found(at) for of in sources.values() for name, at in of.lost.items()}
    if variables is not None and refused:
        name, reason = next(iter(refused.items()))
        raise InputError(f"variables: {name} has no derivative: {reason}; leave it out")
    known = tuple(name for name in names if name not in refused)
    asked_of = [
        (sources[analysis_of(name)], response)
        for name in asked
        for response in _named(sources[analysis_of(name)], name)
    ]
    return Gradient(
        responses=tuple(name for _, name in asked_of),
        words=tuple(source.words[name] for source, name in asked_of),
        variables=known,
        units=tuple(source.units[name] for source, name in asked_of),
        variable_units=tuple(_unit(machine, name) for name in known),
        values=np.array([source.tangents[name].value for source, name in asked_of]),
        at=np.array([float(entry_of(machine, name)) for name in known]),
        derivatives=np.concatenate([_rows(*of, known) for of in _by_source(asked_of)]),
        ties={name: source.ties[name] for source, name in asked_of if name in source.ties},
        refused=refused,
        missing={
            name: why
            for analysis in asked
            if analysis in SOURCES
            for name, why in sources[analysis].missing.items()
        },
    )


def _entries(machine: Machine, variables: Sequence[str]) -> tuple[str, ...]:
    """Addresses of numbers that were asked for, each once."""
    known = addresses(machine)
    for name in variables:
        try:
            value = entry_of(machine, name)
        except MachineError:
            remedy = "; ".join(filter(None, ["the address of a number", suggestion(name, known)]))
            raise InputError(f'variables: found "{cut(name)}", expected {remedy}') from None
        if not isinstance(value, Number):
            below = next((entry for entry in known if entry.startswith(f"{name}.")), "")
            example = f", such as {below}" if below else ""
            raise InputError(f'variables: found "{cut(name)}", expected the address of a number{example}')
    return tuple(dict.fromkeys(variables))


def _named(of: Derivatives, name: str) -> list[str]:
    """The responses that a name means."""
    if name in SOURCES:
        if not of.usual:
            one = next(iter(of.missing.items()), None)
            raise FindingError(f"{name}: nothing has a derivative" + (f": {one[0]}: {one[1]}" if one else ""))
        return list(of.usual)
    without = chosen(of.missing, name)
    if name in without:
        raise FindingError(f"{name} has no derivative: {of.missing[name]}")
    named = chosen(of.tangents, name)
    if without and not named:
        raise FindingError(f"{without[0]} has no derivative: {of.missing[without[0]]}")
    if not named:
        remedy = "; ".join(filter(None, ["one with a derivative", suggestion(name, of.tangents)]))
        raise InputError(f'responses: found "{cut(name)}", expected {remedy}')
    return named


def _by_source(asked_of: Sequence[tuple[Derivatives, str]]) -> Iterator[tuple[Derivatives, list[str]]]:
    """Responses that follow each other from one source."""
    for _, pairs in groupby(asked_of, lambda pair: id(pair[0])):
        listed = list(pairs)
        yield listed[0][0], [name for _, name in listed]


def _rows(of: Derivatives, names: Sequence[str], variables: Sequence[str]) -> Floats:
    """Derivatives of responses by some of the variables of their source."""
    places = {variable: place for place, variable in enumerate(of.variables)}
    rows = np.stack([of.tangents[name].d for name in names])[:, [places[variable] for variable in variables]]
    for nth in np.flatnonzero(~np.isfinite(rows).all(axis=1)).tolist():
        _require_found(of, names[nth], variables, rows[nth])
    return rows


def _require_found(of: Derivatives, name: str, variables: Sequence[str], row: Floats) -> None:
    """Raise FindingError if a derivative of a response is missing without a reason."""
    unknown = [variable for variable, slope in zip(variables, row, strict=True) if not np.isfinite(slope)]
    lost = next((variable for variable in unknown if name not in of.ties or variable in of.lost), None)
    if lost is not None:
        why = _not_found(of.lost.get(lost))
        raise FindingError(
            f"{name}: its derivative with respect to {lost} was not found: {why}; leave this entry out, or "
            "vary it in a sweep"
        )


def _not_found(at: float | None) -> str:
    """Why the move of a kink of the motion, at a crank angle [rad], is not known."""
    place = "" if at is None else f" at {np.degrees(at):.4g}°"
    return (
        f"the shift of the kink of the motion{place} is within rounding error, or two kinks at one speed "
        "separate"
    )


def _unit(machine: Machine, address: str) -> str:
    entry = kind(machine, address)
    return entry.unit if entry else ""
