r"""Derivatives of the torques that shafts carry in forced vibration, by the adjoint of the dynamic stiffness.

At a speed, with :math:`H_\nu q_\nu = M_\nu`, the torque of a shaft is :math:`t_\nu = s_\nu (q_a - q_b)`,
:math:`s = k(1 + i\eta) + i\omega c`, and its extreme over the angle that of :math:`\mathrm{Re} \sum t_\nu
e^{i\nu\tau}` at τ*, where it is stationary (envelope theorem). With :math:`w_\nu = e^{i\nu\tau^*}`

.. math:: H_\nu \lambda_\nu = w_\nu s_\nu (e_a - e_b), \qquad
    dy = \mathrm{Re} \sum_\nu \bigl( w_\nu\,ds_\nu\,(q_a - q_b) + \lambda_\nu^T (dM_\nu - dH_\nu q_\nu) \bigr)

One solution a shaft and order serves all entries. A response is the largest over the speeds at which the
file looks at its train, and its derivative is that at this speed.

References
----------
.. [1] Haftka and Gürdal, Elements of Structural Optimization, 3rd ed. 1992, chapter 7: adjoint method.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine.machine import Machine
from linkwright.torsion.core.response import extremes
from linkwright.torsion.core.train import HELD, ReferredTrain
from linkwright.torsion.excitation.excited_train import ExcitedTrain, excited_train
from linkwright.torsion.excitation.harmonics import coefficients, orders_together, waveform
from linkwright.torsion.gradient.torques import TorqueTangents, torque_tangents
from linkwright.torsion.gradient.train import TrainTangents, train_tangents
from linkwright.torsion.response.forced import response_by_amplitudes, responses

# Peaks that are this near, as a share of the highest, tie; and derivatives that differ by less, of their
# largest, are one.
_TIE, _ONE = 1e-7, 1e-3

# Share by which the torque by twist may differ from that by equilibrium: beyond it, the shaft is as good as
# rigid.
_RIGID = 1e-9


@dataclass(frozen=True)
class ForcedTangents:
    """Largest torques of the shafts over the speeds [N m], with derivatives by `variables`.

    `vibratory` and `greatest` by shaft, the latter where the mean torque has derivatives; `ties` by
    ``quantity.shaft``.
    """

    variables: tuple[str, ...]
    vibratory: dict[str, Tangent]
    greatest: dict[str, Tangent]
    ties: dict[str, str]
    refused: dict[str, str]


def forced_tangents(machine: Machine, variables: Sequence[str]) -> ForcedTangents:
    """Torques of the shafts along entries of a machine. Raises what `forced_vibration` raises, and
    InputError for the train of a driveline, whose torques are those of its mechanism.
    """
    if machine.train is None:
        raise InputError("forced vibration of a driveline has no derivatives: describe its train in [train]")
    if machine.train.modal_damping is not None:
        raise InputError(
            "forced vibration with train.modal_damping has no derivatives: give dampings or loss factors"
        )
    refused = _refused(variables)
    train, referred, d = train_tangents(machine, variables, refused)
    _refuse_moved(d, refused)
    d = d.only([name for name in d.variables if name not in refused])
    at = excited_train(machine)
    q = responses(at)
    peaks = _peaks(at, q)
    places = sorted({place for _, _, place, _ in peaks})
    torques = torque_tangents(machine, train, referred, at.torques.speeds[places], d, refused)
    known = [name for name in d.variables if name not in refused]
    forced = _Adjoint(
        at, q, d.only(known), {place: torques[n].only(d.variables, known) for n, place in enumerate(places)}
    )
    tangents: dict[str, dict[str, Tangent]] = {"vibratory": {}, "greatest": {}}
    ties: dict[str, str] = {}
    for kind, shaft, place, tie in peaks:
        value, slope, twice = forced.response(kind, shaft, place)
        name = referred.shafts[shaft]
        tangents[kind][name] = Tangent(value, slope)
        if tie or twice:
            ties[f"{kind}.{name}"] = tie or twice
    return ForcedTangents(tuple(known), tangents["vibratory"], tangents["greatest"], ties, refused)


def _refused(variables: Sequence[str]) -> dict[str, str]:
    """Entries that change what is looked at."""
    refused: dict[str, str] = {}
    for name in variables:
        if name.startswith("train.run."):
            refused[name] = "it says at which speeds and orders the train is looked at"
        elif name.rsplit(".", 1)[-1] == "order":
            refused[name] = "an order says which torques meet"
    return refused


def _refuse_moved(d: TrainTangents, refused: dict[str, str]) -> None:
    """Entries that change the speeds of discs, and with them the orders."""
    for n, name in enumerate(d.variables):
        if d.speed[:, n].any():
            refused[name] = "it changes the speeds of discs, and with them the orders that meet"


def _peaks(at: ExcitedTrain, q: Complexes) -> list[tuple[str, int, int, str]]:
    """What is asked: quantity, place of the shaft, place of the speed where it is largest, why it ties."""
    response = response_by_amplitudes(at, q)
    curves = {"vibratory": response.shaft_torque_vibratory, "greatest": response.shaft_torque_max}
    peaks = []
    for kind, table in curves.items():
        for shaft, row in enumerate(table):
            if not np.isfinite(row).all() or not row.any():
                continue
            if _is_rigid(at, q, response.shaft_torques, shaft):
                continue
            best = int(row.argmax())
            others = np.flatnonzero(row >= row[best] * (1 - _TIE))
            speeds = " and ".join(f"{at.torques.speeds[k] * 30 / np.pi:.5g} rpm" for k in others)
            peaks.append((kind, shaft, best, f"it is reached at {speeds}" if len(others) > 1 else ""))
    return peaks


def _is_rigid(at: ExcitedTrain, q: Complexes, torques: Complexes, shaft: int) -> bool:
    """Whether the twist of a shaft is rounding."""
    twisted = _stiffness(at, shaft, slice(None)) * _twist(at.referred, q, shaft) / at.referred.lead[shaft]
    return bool(np.abs(twisted - torques[:, shaft]).max() > _RIGID * np.abs(torques[:, shaft]).max())


def _stiffness(at: ExcitedTrain, shaft: int, speed: Any) -> Complexes:
    """k(1 + iη) + iωc of a shaft, (orders, speeds)."""
    omega = at.torques.orders[:, None] * at.torques.speeds[speed]
    k, c = at.operating.stiffness[shaft, speed], at.referred.damping[shaft]
    stiffness: Complexes = k * (1 + 1j * at.referred.loss_factor[shaft]) + 1j * omega * c
    return stiffness


def _twist(referred: ReferredTrain, q: Complexes, shaft: int) -> Complexes:
    """q_a − q_b of a shaft; `q`: (orders, masses, …)."""
    first, second = referred.ends[shaft]
    zero = np.zeros_like(q[:, 0])
    return (q[:, first] if first != HELD else zero) - (q[:, second] if second != HELD else zero)


class _Adjoint:
    """Derivatives of what shafts carry at some speeds."""

    def __init__(
        self, at: ExcitedTrain, q: Complexes, d: TrainTangents, torques: dict[int, TorqueTangents]
    ) -> None:
        self.at, self.q, self.d, self.torques = at, q, d, torques
        self.lead = at.referred.lead
        self._orders = orders_together(at.torques.orders)

    def response(self, kind: str, shaft: int, place: int) -> tuple[float, Floats, str]:
        """Value, derivatives, and why it has one on either side only."""
        lead = self.lead[shaft]
        t = (
            _stiffness(self.at, shaft, [place])[:, 0]
            * _twist(self.at.referred, self.q, shaft)[:, place]
            / lead
        )
        mean = float(self.at.mean_torques[shaft, place])
        if kind == "vibratory":
            (top, high), (bottom, low) = self._ends(t, 0.0)
            first = self._slope(shaft, place, 0.5 * (high[0] - low[0]))
            rivals = [0.5 * (a - b) for a in high for b in low][1:]
            value, given = 0.5 * (top - bottom), np.zeros_like(first)
        else:
            (top, high), (bottom, low) = self._ends(t, mean)
            sign, ways = (1.0, high) if top >= -bottom else (-1.0, [-row for row in low])
            first = self._slope(shaft, place, ways[0])
            rivals, value, given = ways[1:], max(top, -bottom), sign * self.torques[place].mean[shaft]
        size = np.abs(first).max(initial=0.0)
        differ = any(
            np.abs(self._slope(shaft, place, w) - first).max(initial=0.0) > _ONE * size for w in rivals
        )
        return value, first + given, "it is reached at several angles" if differ else ""

    def _ends(
        self, t: Complexes, mean: float
    ) -> tuple[tuple[float, list[Complexes]], tuple[float, list[Complexes]]]:
        """Maximum and minimum over the angle, each with weights of the orders at the angles that have it."""
        orders = self._orders
        top, at_top, bottom, at_bottom = (
            float(extreme) for extreme in extremes(coefficients(orders, t[:, None], mean))[:, 0]
        )
        rest = float(np.abs(t[~orders.together]).sum())
        wave = waveform(orders, t[:, None], mean)[:, 0]
        return (
            (top + rest, [self._weights(t, tau, 1.0) for tau in (at_top, *_rivals(wave, at_top))]),
            (bottom - rest, [self._weights(t, tau, -1.0) for tau in (at_bottom, *_rivals(-wave, at_bottom))]),
        )

    def _weights(self, t: Complexes, tau: float, sign: float) -> Complexes:
        """What an extreme owes to each order, dy = Re Σ w dt."""
        orders = self._orders
        size = np.abs(t)
        alone = sign * np.conj(t) / np.where(size > 0, size, 1.0)
        weights: Complexes = np.where(orders.together, np.exp(1j * orders.harmonic * tau), alone)
        return weights

    def _slope(self, shaft: int, place: int, w: Complexes) -> Floats:
        """Re Σ (w ds Δ + λᵀ(dM − dH q)) by the variables."""
        at, d, r = self.at, self.d, self.at.referred
        lead = self.lead[shaft]
        q = self.q[:, :, place]
        twists = np.stack([_twist(r, q, s) for s in range(len(r.shafts))], axis=1)
        total = np.zeros(len(d.variables))
        for m, omega in enumerate(at.torques.orders * at.torques.speeds[place]):
            k = at.operating.stiffness[:, place]
            s = k * (1 + 1j * r.loss_factor) + 1j * omega * r.damping
            ds = (
                (1 + 1j * r.loss_factor)[:, None] * self.torques[place].stiffness
                + 1j * k[:, None] * d.loss_factor
            ) + 1j * omega * d.damping
            H = (r.joins.T * s) @ r.joins
            H[np.diag_indices_from(H)] += (
                -(omega**2) * r.inertia + 1j * omega * at.operating.disc_damping[:, place]
            )
            adjoint = np.linalg.solve(H, w[m] * s[shaft] * r.joins[shaft] / lead)
            own = -(omega**2) * d.inertia + 1j * omega * (d.disc_damping + self.torques[place].damping)
            inner = adjoint @ (self.torques[place].pulsating[m] - q[m][:, None] * own)
            inner -= ((r.joins @ adjoint) * twists[m]) @ ds
            total += (w[m] * ds[shaft] * twists[m, shaft] / lead + inner).real
        return total


def _rivals(wave: Floats, best: float) -> list[float]:
    """Angles of peaks of a wave as high as its highest, but for that at `best` [rad]."""
    left, right = np.roll(wave, 1), np.roll(wave, -1)
    peaks = np.flatnonzero((wave >= left) & (wave > right))
    bend, slope = left[peaks] - 2 * wave[peaks] + right[peaks], 0.5 * (right[peaks] - left[peaks])
    tops = wave[peaks] - 0.5 * slope**2 / bend
    tied = peaks[tops >= tops.max(initial=-np.inf) - _TIE * np.ptp(wave)]
    shift = 0.5 * (left[tied] - right[tied]) / (left[tied] - 2 * wave[tied] + right[tied])
    angles = 2 * np.pi * (tied + shift) / len(wave)
    apart = np.abs(np.angle(np.exp(1j * (angles - best)))) > 4 * np.pi / len(wave)
    return [float(angle) for angle in angles[apart]]
