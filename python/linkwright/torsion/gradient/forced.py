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
from functools import partial
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import columns
from linkwright.torsion.core.response import extremes, tree_of
from linkwright.torsion.core.train import HELD, ReferredTrain
from linkwright.torsion.excitation.excited_train import ExcitedTrain, excited_train, mean_shaft_torques
from linkwright.torsion.excitation.harmonics import coefficients, orders_together, waveform
from linkwright.torsion.gradient.train import TrainTangents, train_tangents
from linkwright.torsion.model.train import Train
from linkwright.torsion.response.forced import response_by_amplitudes, responses

# Entries of an engine that change its train, but none of its torques.
_OF_TRAIN = ("stiffness", "loss_factor", "damping", "throw_inertia")

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
    refused = _refused(machine, variables)
    train, referred, d = train_tangents(machine, variables, refused)
    at = excited_train(machine)
    q = responses(at)
    peaks = _peaks(at, q, has_engine=bool(machine.train.installed))
    places = sorted({place for _, _, place, _ in peaks})
    torques = _torque_tangents(machine, train, referred, at.torques.speeds[places], d.variables, refused)
    _refuse_moved(machine, d, torques, refused)
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


def _refused(machine: Machine, variables: Sequence[str]) -> dict[str, str]:
    """Entries that change what is looked at, or torques that do not follow from them by plain arithmetic."""
    refused: dict[str, str] = {}
    for name in variables:
        last = name.rsplit(".", 1)[-1]
        if name.startswith("train.run."):
            refused[name] = "it says at which speeds and orders the train is looked at"
        elif last == "order":
            refused[name] = "an order says which torques meet"
        elif name.startswith(("train.engine.", "train.engines.")) and last not in _OF_TRAIN:
            refused[name] = "gas and inertia torques of an engine have no derivatives"
        elif (
            name.startswith("train.loads.")
            and machine.train
            and machine.train.run
            and machine.train.run.loads_follow
        ):
            refused[name] = "the loads follow the engine"
    return refused


def _refuse_moved(
    machine: Machine, d: TrainTangents, torques: list[_TorqueTangents], refused: dict[str, str]
) -> None:
    """Entries that change the speeds of discs, so orders; and those that move a coupling along its curve."""
    assert machine.train is not None
    is_curved = any(coupling.twist is not None for coupling in machine.train.couplings.values())
    for n, name in enumerate(d.variables):
        if d.speed[:, n].any():
            refused[name] = "it changes the speeds of discs, and with them the orders that meet"
        elif is_curved and any(torque.mean[:, n].any() for torque in torques):
            refused[name] = "it changes the mean torque of a coupling, whose stiffness is that of a curve"


def _peaks(at: ExcitedTrain, q: Complexes, *, has_engine: bool) -> list[tuple[str, int, int, str]]:
    """What is asked: quantity, place of the shaft, place of the speed where it is largest, why it ties."""
    response = response_by_amplitudes(at, q)
    curves = {"vibratory": response.shaft_torque_vibratory}
    # What an engine gives beyond its loads goes into all inertias, and loops share by stiffness.
    if tree_of(at.referred) is not None and not has_engine:
        curves["greatest"] = response.shaft_torque_max
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


@dataclass(frozen=True)
class _TorqueTangents:
    """Derivatives of the torques of a train at a speed by its variables, the last axis."""

    pulsating: Complexes  # (orders, masses, variables) referred [N m]
    mean: Floats  # (shafts, variables) in the shafts at their own speed [N m]
    damping: Floats  # (masses, variables) of the loads, referred [N m s/rad]

    def only(self, variables: Sequence[str], known: Sequence[str]) -> _TorqueTangents:
        """Those by some of the variables."""
        at = [variables.index(name) for name in known]
        return _TorqueTangents(self.pulsating[..., at], self.mean[:, at], self.damping[:, at])


def _torque_tangents(
    machine: Machine,
    train: Train,
    referred: ReferredTrain,
    speeds: Floats,
    variables: Sequence[str],
    refused: dict[str, str],
) -> list[_TorqueTangents]:
    """Derivatives of the torques at each speed."""
    orders = excited_train(machine, speeds[:1]).torques.orders
    discs = list(train.discs)
    shape = (len(speeds), 2 * len(orders) + 2, len(discs))
    numbers = partial(_torques, discs=discs, turning=referred.speed, orders=orders, speeds=speeds)
    acting = [name for name in variables if name.startswith(("train.excitations.", "train.loads."))]
    derivatives = columns(machine, acting, numbers, refused)
    table = np.zeros((*shape, len(variables)))
    for name, column in derivatives.items():
        table[..., list(variables).index(name)] = column.reshape(shape)
    onto = np.zeros((len(referred.inertia), len(discs)))
    onto[referred.mass, np.arange(len(discs))] = referred.speed
    n = len(orders)
    waves = np.einsum("md,sodv->somv", onto, table[:, :n] + 1j * table[:, n : 2 * n])
    damping = np.einsum("md,sdv->smv", onto * referred.speed, table[:, -1])
    means = [
        np.array([mean_shaft_torques(referred, m[:, None])[:, 0] for m in value.T])
        .reshape(value.shape[1], len(referred.shafts))
        .T
        for value in table[:, -2]
    ]
    return [_TorqueTangents(*values) for values in zip(waves, means, damping, strict=True)]


def _torques(
    machine: Machine, discs: list[str], turning: Floats, orders: Floats, speeds: Floats
) -> Sequence[Any]:
    """Of file and loads at each speed: cosines and −sines of each order, means, dampings, on all discs."""
    train = machine.train
    assert train is not None
    table = np.zeros((len(speeds), 2 * len(orders) + 2, len(discs)), dtype=object)
    for k, speed in enumerate(speeds.tolist()):
        for excitation in train.excitations.values():
            disc = discs.index(excitation.on)
            factor = excitation.factor(turning[disc] * speed)
            for wave in excitation.harmonics:
                _add_wave(
                    table[k], orders, disc, turning[disc] * wave.order, wave.torque * factor, wave.phase
                )
        for load in train.loads.values():
            disc = discs.index(load.on)
            resistance = load.resistance(turning[disc] * speed)
            table[k, -2, disc] -= resistance
            table[k, -1, disc] += load.damping(turning[disc] * speed)
            for part in load.harmonics:
                _add_wave(
                    table[k], orders, disc, turning[disc] * part.order, -part.share * resistance, part.phase
                )
        for driver in train.drivers.values():
            if driver.torque is not None:
                disc = discs.index(driver.on)
                table[k, -2, disc] += driver.torque_at(turning[disc] * speed)
        if not train.installed and not any("ground" in shaft.between for shaft in train.shafts.values()):
            left = (turning * table[k, -2]).sum()
            for on, share in train.shares.items():
                table[k, -2, discs.index(on)] -= share * left / turning[discs.index(on)]
    return list(table.ravel())


def _add_wave(table: Any, orders: Floats, disc: int, order: float, size: Any, phase: Any) -> None:
    """Add size·e^{i phase} to the order of a disc."""
    nth = int(np.abs(orders - order).argmin())
    table[nth, disc] += size * np.cos(phase)
    table[len(orders) + nth, disc] += size * np.sin(phase)


class _Adjoint:
    """Derivatives of what shafts carry at some speeds."""

    def __init__(
        self, at: ExcitedTrain, q: Complexes, d: TrainTangents, torques: dict[int, _TorqueTangents]
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
                (1 + 1j * r.loss_factor)[:, None] * d.stiffness + 1j * k[:, None] * d.loss_factor
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
