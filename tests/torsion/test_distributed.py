"""Shafts with distributed inertia: closed forms of rods, ever finer lumped trains, power in against heat."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

import linkwright as lw
from linkwright import MachineError

# Ends of next to no inertia: they change a frequency by less than their share of the rod.
_TINY = 1e-12


def rod(a: float | None, b: float, *, stiffness: float = 1000.0, inertia: float = 2.0) -> lw.Machine:
    """A uniform rod with a disc at each end, or held at its first one."""
    first = "" if a is None else f"a = {{ inertia = {a!r} }}\n"
    ends = '["ground", "b"]' if a is None else '["a", "b"]'
    return lw.loads(
        'format = 1\nname = "Rod"\n[train]\ninertia = "distributed"\nmodes = 6\n[train.discs]\n'
        f"{first}b = {{ inertia = {b!r} }}\n[train.shafts.s]\nbetween = {ends}\n"
        f"stiffness = {stiffness!r}\nown_inertia = {inertia!r}"
    )


def betas(machine: lw.Machine) -> np.ndarray:
    """ω √(j/k) of all modes."""
    return lw.free_vibration(machine).angular_frequencies * math.sqrt(2.0 / 1000.0)


def test_a_rod_without_discs() -> None:
    """Held at one end (2n − 1) π/2, free at both nπ (Rao, Mechanical Vibrations, 5th ed., table 8.12)."""
    np.testing.assert_allclose(betas(rod(None, _TINY)), (2 * np.arange(6) + 1) * math.pi / 2, rtol=1e-11)
    np.testing.assert_allclose(betas(rod(_TINY, _TINY)), np.arange(6) * math.pi, rtol=1e-11)


def test_a_rod_with_discs() -> None:
    """tan β = β (r_a + r_b)/(r_a r_b β² − 1), r being the disc's inertia over that of the rod."""
    found = betas(rod(3.0, 1.0))
    left = np.tan(found[1:]) - found[1:] * 2.0 / (0.75 * found[1:] ** 2 - 1)
    assert found[0] == 0
    # The tangent grows by its square with an error of β.
    assert np.abs(left).max() < 1e-11
    assert (np.floor(found[1:] / math.pi - 0.5) == np.arange(5) - 0).all() or len(set(found)) == 6


def test_published_roots_of_a_drill_pipe() -> None:
    """Thomson, Theory of Vibration with Applications, example 9.3-3: β tan β = 2.44, β = 1.135, 3.722."""
    found = betas(rod(None, 2.0 / 2.44))
    np.testing.assert_allclose(found[:2], [1.135, 3.722], atol=0.0005)


def test_discs_at_rest_hide_no_mode() -> None:
    """Three equal rods between two walls: modes by symmetry, those of rods between resting discs counted."""
    shafts = "".join(
        f'[train.shafts.{name}]\nbetween = ["{a}", "{b}"]\nstiffness = 1000.0\nown_inertia = 2.0\n'
        for name, a, b in (("p", "ground", "a"), ("q", "a", "b"), ("r", "b", "ground"))
    )
    machine = lw.loads(
        'format = 1\nname = "Rods"\n[train]\ninertia = "distributed"\nmodes = 8\n[train.discs]\n'
        f"a = {{ inertia = 2.0 }}\nb = {{ inertia = 2.0 }}\n{shafts}"
    )
    found = lw.free_vibration(machine)

    # Of half the train: the middle rod swings about its middle, or with it.
    def odd(x: float) -> float:
        return 1 / math.tan(x) + 1 / math.tan(x / 2) - x

    def even(x: float) -> float:
        return 1 / math.tan(x) - math.tan(x / 2) - x

    wanted = [brentq(even, 0.1, 2.0), brentq(odd, 0.1, 3.0), math.pi]
    np.testing.assert_allclose(betas(machine)[:3], wanted, rtol=1e-11)
    assert betas(machine)[5] == pytest.approx(2 * math.pi, rel=1e-11)
    # Neither disc moves, and the shape is that of the rods.
    assert np.abs(found.mode_shapes[2]).max() == 0
    assert np.abs(found.along[1].angles[2]).max() == pytest.approx(1.0, abs=0.03)


STEPPED = """
format = 1
name = "Stepped shaft between two discs"
[train]
inertia = "distributed"
[train.discs]
a = { inertia = 2.0 }
b = { inertia = 3.0 }
[train.shafts.s]
between = ["a", "b"]
density = 7850
loss_factor = 0.02
sections = [
    { length = 1.0, diameter = 0.1 },
    { length = 0.5, diameter = 0.08, kind = "taper", diameter_end = 0.05 },
    { length = 2.0, diameter = 0.06 },
]
[train.excitations.x]
on = "a"
harmonics = [{ order = 1, torque = 100.0 }, { order = 2, torque = 30.0 }]
[train.run]
speed_min = 50.0
speed_max = 3000.0
points = 40
"""


def lumped(parts: int) -> lw.Machine:
    """The same in pieces, half of the inertia of each at each of its ends."""
    pieces = []
    for length, d, end in ((1.0, 0.1, 0.1), (0.5, 0.08, 0.05), (2.0, 0.06, 0.06)):
        at = np.linspace(d, end, parts + 1).tolist()
        pieces += [(length / parts, *pair) for pair in pairwise(at)]
    names = ["a", *(f"m{n}" for n in range(1, len(pieces))), "b"]
    discs = {"a": 2.0, "b": 3.0} | dict.fromkeys(names[1:-1], 1e-12)
    text = STEPPED[STEPPED.index("[train.exc") :]
    lines = ["format = 1", 'name = "Fine"', "[train.discs]"]
    lines += [f"{name} = {{ inertia = {J!r} }}" for name, J in discs.items()]
    for n, (length, d, end) in enumerate(pieces):
        lines += [f'[train.shafts.s{n}]\nbetween = ["{names[n]}", "{names[n + 1]}"]', "density = 7850"]
        lines += ["loss_factor = 0.02"]
        lines += [f'sections = [{{ length={length!r}, diameter={d!r}, kind="taper", diameter_end={end!r} }}]']
    return lw.loads("\n".join([*lines, text]))


def test_finer_lumped_trains_come_to_it() -> None:
    """Frequencies, amplitudes and stresses, the error falling with the square of the number of parts."""
    machine = lw.loads(STEPPED)
    exact, forced = lw.free_vibration(machine).natural_frequencies, lw.forced_vibration(machine)
    stress = lw.shaft_stress(machine, forced)
    # The thin section behind the 32 pieces of the taper, or the last of these.
    assert forced.places["s"][0] >= 32
    errors = []
    for parts in (8, 16):
        fine = lumped(parts)
        swing = lw.forced_vibration(fine)
        ends = [0, swing.discs.index("b")]
        errors.append(
            (
                np.abs(lw.free_vibration(fine).natural_frequencies[1:4] / exact[1:4] - 1).max(),
                np.abs(swing.amplitudes[:, ends, :10] / forced.amplitudes[:, :, :10] - 1).max(),
                np.abs(
                    lw.shaft_stress(fine, swing).vibratory.max(axis=0)[:10] / stress.vibratory[0, :10] - 1
                ).max(),
            )
        )
    coarse, fine_errors = np.array(errors)
    assert (fine_errors < np.array([1e-3, 1e-2, 2e-2])).all()
    np.testing.assert_allclose((coarse / fine_errors)[:2], 4.0, rtol=0.1)


def test_power_becomes_heat() -> None:
    forced = lw.forced_vibration(lw.loads(STEPPED))
    np.testing.assert_allclose(forced.shaft_heat.sum(axis=0), forced.power, rtol=1e-9)


def test_energies_and_holzer() -> None:
    machine = lw.loads(STEPPED)
    found = lw.free_vibration(machine)
    np.testing.assert_allclose(
        (found.kinetic_shares.sum(axis=1) + found.shaft_kinetic_shares.sum(axis=1)), 1.0, rtol=1e-12
    )
    # Rayleigh: strain energy is kinetic energy, each known by itself.
    table = lw.holzer_table(machine, float(found.natural_frequencies[2]))
    assert abs(table.residual_torque) < 1e-9 * np.abs(table.torque).max()
    np.testing.assert_allclose(
        table.amplitude[1] / table.amplitude[0], found.mode_shapes[2, 1] / found.mode_shapes[2, 0], rtol=1e-8
    )


def test_modes_with_damping() -> None:
    """Hysteresis of all alike: s = iω √(1 + iη); a dashpot: the frequency at which D(s) is singular."""
    machine = lw.loads(STEPPED)
    omega = lw.free_vibration(machine).angular_frequencies[1:]
    found = lw.damped_vibration(machine).eigenvalues[1:]
    np.testing.assert_allclose(found, 1j * omega * np.sqrt(1 + 0.02j), rtol=1e-10)
    given = lw.replace(rod(None, 2.0), {"train.discs.b.damping": 20.0})
    s = lw.damped_vibration(given).eigenvalues[0]
    beta = s * math.sqrt(2.0 / 1000.0)
    assert abs(1000 * beta / np.tanh(beta) + 2.0 * s**2 + 20.0 * s) < 1e-8 * 1000


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("density = 7850", "density = 7850\nown_inertia = 1.0", "the stiffness beside it"),
        ("density = 7850", 'inertia = "distributed"', "an inertia of the shaft"),
        ("[train]", "[train]\nmodes = 0", "train.modes"),
    ],
)
def test_what_makes_no_sense(old: str, new: str, message: str) -> None:
    with pytest.raises(MachineError, match=message):
        lw.loads(STEPPED.replace(old, new, 1))
