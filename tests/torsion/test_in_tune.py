"""Masses in tune with an order hold the one that they hang on still: an absorber is no resonance."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sizes import cases, generator

import linkwright as lw
from linkwright import _core
from linkwright.torsion.core.response import _CORRECTIONS, _balance, _eliminated

FOUND = Path(__file__).parents[1] / "found"

# Rounding of some ten masses whose stiffnesses differ by a factor of ten, after the correction.
ROUNDING = 1e-10


def tuned(seed: int, *, damped: bool) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """A random tree at ω = 1, several branches of which are in tune to nothing or to rounding; its matrix."""
    draw = generator(41, seed)
    n = int(draw.integers(2, 10))
    parent = np.array([0, *(draw.integers(0, row) for row in range(1, n))], np.int32)
    inertia, k = draw.uniform(0.3, 3.0, n), draw.uniform(0.3, 3.0, n)
    k[0] = draw.choice([0.0, 1.0])
    ground = draw.uniform(0.0, 0.3, n) if damped else np.zeros(n)
    leaves = sorted(set(range(1, n)) - set(parent[1:].tolist()))
    for leaf in leaves[: int(draw.integers(1, len(leaves) + 1))]:
        # D + s = k − ω² J, and undamped.
        inertia[leaf], ground[leaf] = k[leaf] * (1.0 + draw.choice([0.0, 1e-15, 1e-12, 1e-9])), 0.0
    H = np.diag(k - inertia + 1j * ground)
    for row in range(1, n):
        H[parent[row], parent[row]] += k[row]
        H[row, parent[row]] = H[parent[row], row] = -k[row]
    return {"parent": parent, "inertia": inertia, "k": k, "ground": ground}, H


@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("torque_at_the_end", [False, True])
def test_amplitudes_are_those_of_the_matrix(damped: bool, torque_at_the_end: bool) -> None:
    for seed in range(cases(100, 2000)):
        train, H = tuned(seed, damped=damped)
        # Near a resonance rounding counts as often as the condition of the matrix says.
        if (worse := np.linalg.cond(H)) > 1e5:
            continue
        n = len(H)
        f = generator(42, seed).normal(size=n) + 0j
        if not torque_at_the_end:
            f[np.abs(np.diag(H)) < 1e-8] = 0.0
        exact = np.linalg.solve(H, f)
        limit = ROUNDING * worse * np.abs(exact).max()
        q = f[None, :, None].copy()
        flat = np.zeros((n, 1))
        _core.torsion_forced(
            parent=train["parent"],
            inertia=train["inertia"],
            speeds=np.array([1.0]),
            stiffness=train["k"][:, None].copy(),
            damping=flat,
            loss=flat,
            disc_damping=train["ground"][:, None].copy(),
            orders=np.array([1.0]),
            torques=q,
        )
        assert np.abs(q[0, :, 0] - exact).max() < limit, (seed, damped)
        own, k, f = (
            (x + 0j)[None, :, None] for x in (-train["inertia"] + 1j * train["ground"], train["k"], f)
        )
        q, is_held = _eliminated(train["parent"], own, k, f)
        for _ in range(_CORRECTIONS if is_held else 0):
            q += _eliminated(train["parent"], own, k, f - _balance(train["parent"], own, k, q))[0]
        assert np.abs(q[0, :, 0] - exact).max() < limit, (seed, damped)


def test_a_shaft_at_its_held_frequency_bears_the_torque() -> None:
    study = lw.torsion_study(lw.read(FOUND / "shaft_at_its_held_frequency.toml"))
    last = study.forced.shafts.index("s"), -1
    # k = J ω²: b moves against a until its shaft bears all of the 10 N m, and a stands still.
    assert study.forced.shaft_torque_vibratory[last] == pytest.approx(10.0, rel=1e-12)
    assert study.findings == []


def test_an_undamped_resonance_between_the_speeds_is_told() -> None:
    """Without damping the torque is unbounded at √(k/J), J of both discs in series."""
    inertias, stiffness = (2.0, 0.25), 2500.0
    machine = lw.loads(
        'format = 1\nname = "two discs"\n[train.discs.a]\ninertia = 2\n[train.discs.b]\ninertia = 0.25\n'
        '[train.shafts.s]\nbetween = ["a", "b"]\nstiffness = 2500\n[train.excitations.t]\non = "b"\n'
        "harmonics = [{ order = 1, torque = 10 }]\n"
        '[train.run]\nspeed_min = "859 rpm"\nspeed_max = "1050 rpm"\n'
    )
    resonance = np.sqrt(stiffness * (1 / inertias[0] + 1 / inertias[1])) * 30 / np.pi
    study = lw.torsion_study(machine)
    assert np.isinf(study.peaks.vibratory).all()
    assert any(f"Speeds of {resonance:.5g} rpm are undamped" in text for text in study.warnings)
