r"""Free vibration of a train with damping: how fast each mode dies out.

With viscous damping C and hysteresis, the complex stiffness :math:`k (1 + i\eta)` of shafts, all is left to
itself as :math:`\theta e^{st}` with

.. math:: (s^2 J + s C + K + iH)\,\theta = 0, \qquad s = -\sigma \pm i\omega_d

Hysteresis is defined for vibration alone: H counts with the sign of :math:`\omega_d`, so that of each pair
the solution with :math:`\omega_d > 0` is taken, and motion without vibration (real s) feels C only. Without
C this is :math:`(K + iH)\,\theta = \omega^{*2} J\,\theta` with :math:`s = i\omega^*`.

The equation times :math:`\bar\theta^T` says, by its imaginary part, what each part damps,

.. math:: 2\sigma \sum J|\theta|^2 = \sum c|\Delta|^2 + \sum c_0|\theta|^2 + \sum \eta k|\Delta|^2/\omega_d
    + \bar\theta^T C_\zeta\theta

with C_ζ that of given damping ratios. A PI controller of the speed adds k_p to the damping c₀ of its disc and
k_i, which takes no energy, to its stiffness.

With the shapes Q and frequencies Ω of the train without damping, :math:`\theta = Q p`, the states
:math:`y = \Omega p` and :math:`v = \dot p` go on as

.. math:: \dot y = \Omega v, \qquad \dot v = -(\Omega + i\tilde H\Omega^{-1})\,y - \tilde C v

which without damping is a rotation: nothing is lost to differences of size between inertias and stiffnesses.
A motion without stiffness has a velocity but no y; one that nothing damps either has none of both, and its
s = 0 is known.

References
----------
.. [1] Friswell, Penny, Garvey and Lees, Dynamics of Rotating Machines, 2010, chapters 5 and 9.
.. [2] Tisseur and Meerbergen, The quadratic eigenvalue problem, SIAM Review 43 (2001) 235-286.
.. [3] Ewins, Modal Testing: Theory, Practice and Application, 2nd ed. 2000, chapter 2: hysteretic damping.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import SPEED
from linkwright.kernel.units.marks import positive
from linkwright.machine.machine import Machine
from linkwright.torsion.core.distributed import cut_up, dynamic, natural_frequencies
from linkwright.torsion.core.train import ReferredTrain, refer
from linkwright.torsion.excitation.drive_line import train_of
from linkwright.torsion.excitation.excited_train import prepared
from linkwright.torsion.excitation.harmonics import controllers
from linkwright.torsion.model.train import Train
from linkwright.torsion.modes.free import modes_wanted, scaled


@dataclass(frozen=True)
class DampedVibration(Result):
    """Free vibration of a train with damping, one row a mode.

    Modes come by their natural frequency: the motions as a whole first; then those that vibrate and, a row
    each, overdamped (aperiodic) motions.
    """

    natural_frequencies: Annotated[
        Floats,
        Label(
            "natural frequencies",
            "ω/2π",
            "Hz",
            "Size of s over 2π; of an overdamped one σ/2π.",
            shape="(modes,)",
        ),
    ]
    eigenvalues: Annotated[
        Complexes, Label("eigenvalues", "s", "1/s", "Complex, with an imaginary part of zero or more.")
    ]
    discs: Annotated[tuple[str, ...], About("Discs in the order of the file.")]
    mode_shapes: Annotated[
        Complexes,
        Label(
            "mode shapes",
            "θ",
            "",
            "Complex; the largest amplitude is 1, of several the first in the file.",
            shape="(modes, discs)",
        ),
    ]
    shafts: Annotated[tuple[str, ...], About("Shafts, then elastic meshes, in the order of the file.")]
    shaft_shares: Annotated[
        Floats,
        Label(
            "share of each shaft in the damping", "", "", "Zero where there is none.", shape="(modes, shafts)"
        ),
    ]
    disc_shares: Annotated[
        Floats,
        Label(
            "share of each disc in the damping",
            "",
            "",
            "Of its external damping; the remainder after shafts and discs is the share of given damping "
            "ratios.",
            shape="(modes, discs)",
        ),
    ]

    @property
    def damped_frequencies(self) -> Annotated[Floats, Label("damped natural frequencies", "ω_d/2π", "Hz")]:
        """ω_d/2π, (modes,)."""
        frequencies: Floats = self.eigenvalues.imag / (2 * math.pi)
        return frequencies

    @property
    def decay_rates(self) -> Annotated[Floats, Label("decay rates", "σ", "1/s")]:
        """σ, (modes,)."""
        rates: Floats = -self.eigenvalues.real
        return rates

    @property
    def damping_ratios(self) -> Annotated[Floats, Label("damping ratios", "ζ", "")]:
        """ζ = σ/|s|, (modes,): 1 without vibration, 0 for a motion as a whole."""
        size = np.abs(self.eigenvalues)
        return np.divide(self.decay_rates, size, out=np.zeros_like(size), where=size > 0)

    @property
    def logarithmic_decrements(self) -> Annotated[Floats, Label("logarithmic decrements", "", "")]:
        """2πσ/ω_d, (modes,): of two amplitudes a period apart; infinite without vibration."""
        omega, sigma = self.eigenvalues.imag, 2 * math.pi * self.decay_rates
        without = np.where(sigma == 0, 0.0, np.inf)
        return np.divide(sigma, omega, out=without, where=omega > 0)

    @property
    def amplitudes(
        self,
    ) -> Annotated[Floats, Label("amplitude of each disc", "", "", shape="(modes, discs)")]:
        """|θ|, (modes, discs)."""
        return np.abs(self.mode_shapes)

    @property
    def phases(
        self,
    ) -> Annotated[
        Floats,
        Label("lead of each disc before that of the largest amplitude", "", "rad", shape="(modes, discs)"),
    ]:
        """Lead of each disc before the one of the largest amplitude, (modes, discs), −π to π."""
        return np.angle(self.mode_shapes)

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Scalars and tables by name, with ``curves`` also arrays as lists; complex ones as their parts."""
        results = super().to_dict(curves=curves)
        return {
            name: result for name, result in results.items() if name not in ("eigenvalues", "mode_shapes")
        }


@public
def damped_vibration(machine: Machine, speed: float | None = None) -> DampedVibration:
    """Free vibration of a train with damping.

    Parameters
    ----------
    machine : Machine
        With a [train], or a [drive] that twists.
    speed : float, optional
        Of the first disc, at which the train runs: it sets the damping of loads, and the slope of couplings
        under their mean torque. Default: the train is at rest without torque [rad/s].

    Returns
    -------
    DampedVibration
        All modes.

    Raises
    ------
    InputError
        The machine has no train, or the speed is none above zero.
    """
    in_range(speed=(speed, positive(SPEED)))
    return damped_train(*_at(machine, speed), modes_wanted(machine, train_of(machine)))


def damped_train(
    train: ReferredTrain, disc_damping: Floats, control: Floats | None, count: int
) -> DampedVibration:
    """Modes of a train, the first `count` of one with distributed inertia.

    `disc_damping`: (discs,) at their own speeds [N m s/rad]; `control`: (masses,) springs of controllers
    [N m/rad].
    """
    referred = in_pieces(train, count) if train.rods else train
    controlled = referred.on_springs(control)
    ((eigenvalues, masses),) = damped_modes([replace(controlled, rods=())])
    if train.rods:
        eigenvalues, masses = eigenvalues[:count], masses[:count]
        swings = zip(eigenvalues.tolist(), masses, strict=True)
        eigenvalues = np.array([_exact(controlled, s, q) for s, q in swings])
    return _vibration(train, referred, disc_damping, eigenvalues, masses)


def damped_trains(
    trains: Sequence[tuple[ReferredTrain, Floats, Floats | None]],
) -> Iterator[DampedVibration]:
    """The same of trains of lumped masses, solved together."""
    modes = damped_modes([referred.on_springs(control) for referred, _, control in trains])
    for (referred, damping, _), (eigenvalues, masses) in zip(trains, modes, strict=True):
        yield _vibration(referred, referred, damping, eigenvalues, masses)


def _vibration(
    train: ReferredTrain, referred: ReferredTrain, disc_damping: Floats, eigenvalues: Complexes, q: Complexes
) -> DampedVibration:
    """Shapes and shares of modes of the masses, (modes, masses); `referred`: with rods in pieces."""
    angles = referred.scale * q[:, referred.mass]
    shapes = scaled(angles)
    size = np.abs(shapes).max(axis=1) / np.abs(angles).max(axis=1)
    inertia = 2 * size**2 * (referred.inertia * np.abs(q) ** 2).sum(axis=1)
    shafts = _of_shafts(train, referred, size[:, None] * q, eigenvalues.imag)
    discs = disc_damping * np.abs(shapes) ** 2
    # Divided by their own sum, which σ is within rounding.
    losses = shafts.sum(axis=1) + discs.sum(axis=1)
    if len(referred.ratios):
        losses += size**2 * np.einsum("ma,ab,mb->m", q.conj(), referred.modal_damping, q).real
    damped = (-eigenvalues.real * inertia > 0) & (losses > 0)
    losses = np.where(damped, losses, np.inf)[:, None]
    return DampedVibration(
        natural_frequencies=np.abs(eigenvalues) / (2 * math.pi),
        eigenvalues=eigenvalues,
        discs=referred.discs,
        mode_shapes=shapes,
        shafts=train.shafts,
        shaft_shares=shafts / losses,
        disc_shares=discs / losses,
    )


def _at(machine: Machine, speed: float | None) -> tuple[ReferredTrain, Floats, Floats | None]:
    """The train at a speed, the damping of its discs at their own [N m s/rad], springs of controllers."""
    if speed is None:
        train = train_of(machine)
        return at_rest(train, refer(train), np.array([disc.damping for disc in train.discs.values()]))
    at = prepared(machine, np.array([speed]))
    stiffness, damping = at.operating.stiffness[:, 0], at.operating.disc_damping[:, 0]
    referred = replace(at.referred, stiffness=stiffness, disc_damping=damping)
    return referred, at.disc_damping[:, 0], at.operating.disc_stiffness


def at_rest(
    train: Train, referred: ReferredTrain, damping: Floats
) -> tuple[ReferredTrain, Floats, Floats | None]:
    """The same without loads; `damping`: (discs,) of the discs themselves [N m s/rad]."""
    place = {name: n for n, name in enumerate(train.discs)}
    gains, control = controllers(train, place, np.zeros(1))
    own = damping + gains[:, 0]
    return replace(referred, disc_damping=_summed(referred, own)), own, _summed(referred, control)


def _summed(referred: ReferredTrain, of_discs: Floats) -> Floats:
    """Damping or stiffness of the discs, referred, as that of the masses."""
    masses = np.zeros(len(referred.inertia))
    np.add.at(masses, referred.mass, referred.scale**2 * of_discs)
    return masses


def _of_shafts(train: ReferredTrain, referred: ReferredTrain, masses: Complexes, omega: Floats) -> Floats:
    """Contributions of shafts to 2σ Σ J|θ|², (modes, shafts); of a shaft in pieces all of them."""
    square = np.abs(masses @ referred.joins.T) ** 2
    loss = referred.loss_factor * referred.stiffness
    hysteresis = np.divide(loss, omega[:, None], out=np.zeros(square.shape), where=omega[:, None] > 0)
    added = (referred.damping + hysteresis) * square
    shafts = np.zeros((len(masses), len(train.shafts)))
    for n, name in enumerate(referred.shafts):
        shafts[:, train.shafts.index(name)] += added[:, n]
    return shafts


# Largest β of a piece of which damped modes are found at first.
_PIECE = 0.4

# Share of an eigenvalue within which it is sought: pieces put it lower by β²/24 at most.
_NEAR = 0.02

# Newton steps to a damped mode of a train with distributed inertia, and the share of it that is none.
_STEPS, _NO_STEP = 12, 1e-11

# Share of an eigenvalue by which its derivative is examined; it changes the way there, not the end.
_ASIDE = 1e-6


def in_pieces(referred: ReferredTrain, count: int) -> ReferredTrain:
    """A train with distributed inertia, cut into pieces short at the frequencies of its modes."""
    highest = float(natural_frequencies(referred, count)[-1])
    fine = (rod.refined(highest, _PIECE)[0] for rod in referred.rods)
    return cut_up(referred, [rod.parts(highest, _PIECE) for rod in fine])


def _exact(referred: ReferredTrain, start: complex, shape: Complexes) -> complex:
    """Eigenvalue with distributed inertia, by Newton on D(s) q = 0 from that of its pieces."""
    s, q = start, shape
    if s.imag == 0:
        return start
    for _ in range(_STEPS):
        D = _dynamic_matrix(referred, s)
        slope = (_dynamic_matrix(referred, s * (1 + _ASIDE)) - D) / (s * _ASIDE)
        u = np.linalg.solve(D, slope @ q)
        step = complex((q.conj() @ q) / (q.conj() @ u))
        s, q = s - step, u / np.abs(u).max()
        if abs(step) <= _NO_STEP * abs(s):
            break
    return s if abs(s - start) < _NEAR * abs(start) else start


def _dynamic_matrix(referred: ReferredTrain, s: complex) -> Complexes:
    """D(s) of a train whose shafts are rods [N m/rad]. `s`: [1/s]."""
    omega = np.array([s / 1j])
    at = dynamic(referred, referred.stiffness[:, None], omega)
    D: Complexes = (referred.joins.T * at.stiffness[:, 0]) @ referred.joins + s * referred.modal_damping
    D += np.diag(s**2 * at.inertia[:, 0] + s * referred.disc_damping)
    return D


# Share of the damping of its parts below which a motion as a whole is not damped within rounding.
_UNDAMPED = 1e-12


class _Reduced(NamedTuple):
    """A train in the shapes of its modes without damping."""

    free: Floats  # (free, masses) motions without stiffness
    omega: Floats  # (modes of vibration,)
    damping: Floats  # (kept, kept) C̃ of what moves: damped motions without stiffness, then modes
    loss: Floats  # (modes of vibration, modes of vibration) H̃
    shapes: Floats  # (kept, masses)


def damped_modes(trains: Sequence[ReferredTrain]) -> list[tuple[Complexes, Complexes]]:
    """Eigenvalues and shapes of trains with damping.

    Each has `eigenvalues`: (modes,) by their size; of pairs the one with a positive imaginary part [1/s];
    `shapes`: (modes, masses) of the masses, of no particular size.
    """
    reduced = [_reduced(one) for one in trains]
    modes = list[tuple[Complexes, Complexes]]()
    for one, (s, p) in zip(reduced, _solved(reduced), strict=True):
        s = np.concatenate([np.zeros(len(one.free)), s])
        shapes = np.concatenate([one.free, p @ one.shapes])
        order = np.argsort(np.abs(s), kind="stable")
        modes.append((s[order], shapes[order].astype(complex)))
    return modes


def _reduced(referred: ReferredTrain) -> _Reduced:
    omega, undamped = referred.modes()
    # The motions without stiffness, those come first: damped ones apart from the others.
    free = int(np.count_nonzero(omega == 0))
    Q = np.concatenate([_apart(undamped[:free], referred.damping_matrix), undamped[free:]])
    C = Q @ referred.damping_matrix @ Q.T
    damped = np.abs(C[:free]).max(axis=1, initial=0.0) > _undamped(Q[:free], referred.damping_matrix)
    kept = np.concatenate([np.flatnonzero(damped), np.arange(free, len(omega))])
    H = Q[free:] @ referred.loss_matrix @ Q[free:].T
    return _Reduced(undamped[:free], omega[free:], C[kept[:, None], kept], H, Q[kept])


def _undamped(Q: Floats, C: Floats) -> float:
    """What rounding leaves where damping cancels."""
    return _UNDAMPED * float((np.abs(Q) @ np.abs(C) @ np.abs(Q).T).max(initial=0.0))


def _apart(Q: Floats, C: Floats) -> Floats:
    """Motions without stiffness, rotated so that damping does not couple them."""
    if len(Q) < 2:
        return Q
    turned: Floats = np.linalg.eigh(Q @ C @ Q.T)[1].T @ Q
    return turned


def _solved(trains: Sequence[_Reduced]) -> list[tuple[Complexes, Complexes]]:
    """Eigenvalues with ω_d of zero or more, and p of their modes, of each train."""
    solved = _pairs([one._replace(loss=np.zeros_like(one.loss)) for one in trains])
    with_losses = [n for n, one in enumerate(trains) if one.loss.any()]
    for n, lossy in zip(with_losses, _pairs([trains[n] for n in with_losses]), strict=True):
        solved[n] = _with_losses(*solved[n], *lossy)
    return solved


def _with_losses(
    s: Complexes, p: Complexes, lossy: Complexes, shapes: Complexes
) -> tuple[Complexes, Complexes]:
    """What creeps has no hysteresis, and of what vibrates there are as many as without."""
    vibrating, vibrates = s.imag > 0, lossy.imag > 0
    ratio = np.divide(-lossy.real, np.abs(lossy), out=np.full(len(lossy), np.inf), where=vibrates)
    least = np.argsort(ratio, kind="stable")[: np.count_nonzero(vibrating)]
    return np.concatenate([s[~vibrating], lossy[least]]), np.concatenate([p[~vibrating], shapes[least]])


def _pairs(trains: Sequence[_Reduced]) -> list[tuple[Complexes, Complexes]]:
    """Eigenvalues with an imaginary part of zero or more; p, a row each; of trains of one size together."""
    together: dict[tuple[int, int, bool], list[int]] = {}
    for n, one in enumerate(trains):
        together.setdefault((len(one.omega), len(one.damping), bool(one.loss.any())), []).append(n)
    pairs: dict[int, tuple[Complexes, Complexes]] = {}
    for members in together.values():
        alike = [trains[n] for n in members]
        A = _states(*(np.stack(parts) for parts in list(zip(*alike, strict=True))[1:4]))
        s, vectors = np.linalg.eig(A)
        # Nothing drives a train that is left to itself: a growth as small as this is rounding.
        rounding = 1e-14 * A.shape[1] * np.abs(A).max(axis=(1, 2), initial=0.0)[:, None]
        s = np.where((s.real > 0) & (s.real < rounding), 1j * s.imag, s)
        for n, one, *solution in zip(members, alike, s, vectors, s.imag >= 0, strict=True):
            pairs[n] = _shaped(one, *solution)
    return [pairs[n] for n in range(len(trains))]


def _states(omega: Floats, C: Floats, H: Floats) -> Floats | Complexes:
    """Matrices of the states y and v of trains of one size, (trains, states, states)."""
    n, m = omega.shape[1], C.shape[1]
    lossy = bool(H.any())
    A = np.zeros((len(omega), n + m, n + m), complex if lossy else float)
    y = np.arange(n)
    A[:, y, m + y] = omega
    A[:, m + y, y] = -omega
    if lossy:
        A[:, m:, :n] -= 1j * H / omega[:, None]
    A[:, n:, n:] -= C
    return A


def _shaped(train: _Reduced, s: Complexes, vectors: Complexes, kept: Any) -> tuple[Complexes, Complexes]:
    """The kept eigenvalues, and p of their modes."""
    s, vectors = s[kept], vectors[:, kept]
    at_rest = s == 0
    p = vectors[len(train.omega) :] / np.where(at_rest, 1.0, s)
    return s, (np.where(at_rest, _at_rest(train.omega, train.damping, vectors), p) if at_rest.any() else p).T


def _at_rest(omega: Floats, C: Floats, vectors: Complexes) -> Complexes:
    """p of eigenvalues that are zero within rounding: elastic part by stiffness, free part by damping."""
    # Where s is zero, so are the velocities s p, and p = y/ω of the elastic motions; those without stiffness
    # follow in the limit of (s + C_ff) p_f = -C_fe p_e, since each of them is damped and none damps another.
    n, m = len(omega), len(C)
    elastic = vectors[:n] / omega[:, None]
    free = m - n
    following = -(C[:free, free:] @ elastic) / np.diag(C)[:free, None]
    p: Complexes = np.concatenate([following, elastic])
    return p
