r"""Derivatives of the largest torques that shafts carry in forced vibration.

The extreme over the angle of what a shaft carries is that of :math:`\mathrm{Re} \sum t_\nu e^{i\nu\tau}`
at τ*, where it is stationary (envelope theorem), so that

.. math:: dy = \mathrm{Re} \sum_\nu e^{i\nu\tau^*}\,dt_\nu

with the derivatives of the torque at each order (`shaft_torques`). A response is the largest over the speeds
at which the file looks at its train, and its derivative is that at this speed; in a shaft with distributed
inertia it is that at the station where the torque counts, which stays where it is.

References
----------
.. [1] Haftka and Gürdal, Elements of Structural Optimization, 3rd ed. 1992, chapter 7: adjoint method.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.extreme import TIE_OF_SOLVED, differ
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives
from linkwright.torsion.core.response import extremes
from linkwright.torsion.excitation.excited_train import ExcitedTrain, excited_train
from linkwright.torsion.excitation.harmonics import coefficients, waveform
from linkwright.torsion.gradient.joints import joint_slopes
from linkwright.torsion.gradient.shaft_torques import CarriedTorques, ShaftTorques
from linkwright.torsion.gradient.torques import TorqueTangents, torque_tangents
from linkwright.torsion.gradient.train import TrainTangents, train_tangents
from linkwright.torsion.response.forced import response_by_amplitudes, responses

# Derivatives of rivals that differ by less than this share are one: angles of a waveform lie between samples.
_ONE = 1e-3

# Share by which the torque by twist may differ from that by equilibrium: beyond it, the shaft is as good as
# rigid.
_RIGID = 1e-9


# Quantity → its name among responses, and its words.
_KINDS = {
    "vibratory": ("shaft_torque_vibratory", "largest vibratory torque of"),
    "greatest": ("shaft_torque_max", "largest torque of"),
}


def forced_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Largest torques of the shafts over the speeds [N m], named ``shaft_torque_max.SHAFT``, where the mean
    torque has derivatives, and ``shaft_torque_vibratory.SHAFT``.

    Raises what `forced_vibration` raises, and InputError for the train of a driveline, whose torques are
    those of its mechanism.
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
    shafts = CarriedTorques.of(at, q)
    peaks = _peaks(at, q, shafts)
    places = sorted({place for _, _, place, _ in peaks})
    torques = torque_tangents(machine, train, referred, at.torques.speeds[places], d, refused)
    joints = joint_slopes(machine, at, d.variables, refused)
    known = [name for name in d.variables if name not in refused]
    acting = {place: torques[n].only(d.variables, known) for n, place in enumerate(places)}
    if joints is not None:
        joints = joints[..., [d.variables.index(name) for name in known]]
    forced = _Peaks(at, ShaftTorques(at, q, d.only(known), acting, shafts, joints), acting)
    tangents, words, ties = {}, {}, {}
    for kind, shaft, place, tie in peaks:
        value, slope, twice = forced.response(kind, shaft, place)
        (quantity, said), of = _KINDS[kind], referred.shafts[shaft]
        name = f"{quantity}.{of}"
        tangents[name], words[name] = Tangent(value, slope), f"{said} {of} over the speeds"
        if tie or twice:
            ties[name] = tie or twice
    units = dict.fromkeys(tangents, "N m")
    return Derivatives(tuple(known), tangents, ties, {}, refused, words=words, units=units)


def _refused(variables: Sequence[str]) -> dict[str, str]:
    """Entries that change what is looked at."""
    refused: dict[str, str] = {}
    for name in variables:
        if name.startswith("train.run."):
            refused[name] = "it selects the speeds and orders analysed"
        elif name.rsplit(".", 1)[-1] == "order":
            refused[name] = "an order is discrete: it determines which torques coincide"
        elif name.startswith("train.excitations.") and name.endswith(".frequency"):
            refused[name] = "a fixed frequency is discrete: it determines which torques coincide"
    return refused


def _refuse_moved(d: TrainTangents, refused: dict[str, str]) -> None:
    """Entries that change the speeds of discs, and with them the orders."""
    for n, name in enumerate(d.variables):
        if d.speed[:, n].any():
            refused[name] = "it changes the speed ratios of discs, and with them the orders that coincide"


def _peaks(at: ExcitedTrain, q: Complexes, shafts: CarriedTorques) -> list[tuple[str, int, int, str]]:
    """What is asked: quantity, place of the shaft, place of the speed where it is largest, why it ties."""
    response = response_by_amplitudes(at, q)
    curves = {"vibratory": response.shaft_torque_vibratory, "greatest": response.shaft_torque_max}
    rigid = _rigid(at, q, shafts)
    peaks = []
    for kind, table in curves.items():
        for shaft, row in enumerate(table):
            if not np.isfinite(row).all() or not row.any():
                continue
            if rigid[shaft]:
                continue
            best = int(row.argmax())
            others = np.flatnonzero(row >= row[best] * (1 - TIE_OF_SOLVED))
            speeds = " and ".join(f"{at.torques.speeds[k] * 30 / np.pi:.5g} rpm" for k in others)
            peaks.append((kind, shaft, best, f"the extreme occurs at {speeds}" if len(others) > 1 else ""))
    return peaks


def _rigid(at: ExcitedTrain, q: Complexes, shafts: CarriedTorques) -> list[bool]:
    """Whether the twist of each shaft is rounding."""
    stiffness, flow = shafts
    twists = np.einsum("sm,omw->osw", at.referred.joins, q)
    if at.joint_twists is not None:
        twists = twists + at.joint_twists / at.referred.lead[:, None]
    twisted = stiffness * twists
    off, size = np.abs(twisted - flow).max(axis=(0, 2)), np.abs(flow).max(axis=(0, 2))
    return [bool(rigid) for rigid in off > _RIGID * size]


class _Peaks:
    """Derivatives of the extremes of what shafts carry at some speeds."""

    def __init__(self, at: ExcitedTrain, shafts: ShaftTorques, torques: dict[int, TorqueTangents]) -> None:
        self._at, self._shafts, self._torques = at, shafts, torques
        self._orders = at.torques.together

    def response(self, kind: str, shaft: int, place: int) -> tuple[float, Floats, str]:
        """Value, derivatives, and why it has only one-sided ones."""
        along = self._shafts.along(shaft)
        if along is None:
            return self._at_station(kind, shaft, place, 0)
        ratio = along.ratio[:, place]
        station = int(ratio.argmax())
        value, slope, tie = self._at_station(kind, shaft, place, station)
        # The second end of a piece is where the first of the next one is.
        end, part = np.divmod(np.arange(len(ratio)), len(ratio) // 2)
        apart = end + part != end[station] + part[station]
        for rival in np.flatnonzero(apart & (ratio >= ratio[station] * (1 - TIE_OF_SOLVED))).tolist():
            other, change, _ = self._at_station(kind, shaft, place, rival)
            differs = differ(np.stack([slope, change]), alike=_ONE).any()
            if differs or abs(other - value) > TIE_OF_SOLVED * value:
                return value, slope, "the extreme occurs at several positions along the shaft"
        return value, slope, tie

    def _at_station(self, kind: str, shaft: int, place: int, station: int) -> tuple[float, Floats, str]:
        """The same at a station of a shaft; 0 for one without."""
        t = self._shafts.orders(shaft, place, station)
        dt = self._shafts.slopes(shaft, place, station)
        mean = float(self._at.mean_torques[shaft, place])
        if kind == "vibratory":
            (top, high), (bottom, low) = self._ends(t, 0.0)
            first, *rivals = (0.5 * (a - b) for a in high for b in low)
            value, given = 0.5 * (top - bottom), np.zeros(dt.shape[1])
        else:
            (top, high), (bottom, low) = self._ends(t, mean)
            sign, (first, *rivals) = (1.0, high) if top >= -bottom else (-1.0, [-row for row in low])
            value, given = max(top, -bottom), sign * self._torques[place].mean[shaft]
        slope: Floats = (first @ dt).real
        differs = differ(np.stack([slope, *((w @ dt).real for w in rivals)]), alike=_ONE).any()
        return value, slope + given, "the extreme occurs at several angles" if differs else ""

    def _ends(
        self, t: Complexes, mean: float
    ) -> tuple[tuple[float, list[Complexes]], tuple[float, list[Complexes]]]:
        """Maximum and minimum over the angle, each with weights of the orders at the angles that have it."""
        rest, ends = float(np.abs(t[self._orders.alone]).sum()), []
        for sign in (1.0, -1.0):
            total, taus = mean + sign * rest, []
            for places, family in self._orders.families:
                wave = sign * t[places]
                value, tau, *_ = (
                    float(extreme) for extreme in extremes(coefficients(family, wave[:, None]))[:, 0]
                )
                total += sign * value
                taus.append((tau, *_rivals(waveform(family, wave[:, None])[:, 0], tau)))
            ends.append((total, [self._weights(t, angles, sign) for angles in product(*taus)]))
        top, bottom = ends
        return top, bottom

    def _weights(self, t: Complexes, angles: tuple[float, ...], sign: float) -> Complexes:
        """What an extreme with each family at an angle owes to each order, dy = Re Σ w dt."""
        size = np.abs(t)
        weights = np.asarray(sign * t.conj() / np.where(size > 0, size, 1.0), complex)
        for (places, family), tau in zip(self._orders.families, angles, strict=True):
            weights[places] = np.exp(1j * family.harmonic * tau)
        return weights


def _rivals(wave: Floats, best: float) -> list[float]:
    """Angles of peaks of a wave as high as its highest, but for that at `best` [rad]."""
    left, right = np.roll(wave, 1), np.roll(wave, -1)
    peaks = np.flatnonzero((wave >= left) & (wave > right))
    bend, slope = left[peaks] - 2 * wave[peaks] + right[peaks], 0.5 * (right[peaks] - left[peaks])
    tops = wave[peaks] - 0.5 * slope**2 / bend
    tied = peaks[tops >= tops.max(initial=-np.inf) - TIE_OF_SOLVED * np.ptp(wave)]
    shift = 0.5 * (left[tied] - right[tied]) / (left[tied] - 2 * wave[tied] + right[tied])
    angles = 2 * np.pi * (tied + shift) / len(wave)
    apart = np.abs(np.angle(np.exp(1j * (angles - best)))) > 4 * np.pi / len(wave)
    return [float(angle) for angle in angles[apart]]
