"""The reproduction of paper 3: deviations of its formulas against ways that use none of the same code."""

from __future__ import annotations

import json
import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import eigh

from linkwright.papers.claim import holding, tolerance
from linkwright.papers.page import page, share
from linkwright.papers.paper3.paper import Paper3, paper3


@pytest.fixture(scope="module")
def paper() -> Paper3:
    return paper3()


def _throw_energy(paper: Paper3, number: int = 4096) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean of 2T/ω² of the rods and pistons of both banks, from places of points alone.

    Points are placed by circles meeting lines; speeds are the derivatives of their Fourier series, so that
    nothing of the product's kinematics is in them.
    """
    e = paper.trial.engine
    master, second = e.rod, paper.trial.articulated
    phi = 2 * np.pi * np.arange(number) / number
    pin = e.radius * np.exp(1j * phi)
    found = []
    big = pin
    for rod, bank in ((master, e.banks[0]), (second, e.banks[1])):
        axis = np.exp(1j * bank)
        local = big / axis
        small = (local.real + np.sqrt(rod.length**2 - local.imag**2)) * axis
        along = (small - big) / rod.length
        m, c, J = rod.body
        centre = big + c * along
        turning = np.abs(_rate(along)) ** 2
        found.append(m * np.abs(_rate(centre)) ** 2 + J * turning)
        found.append(e.piston_mass * np.abs(_rate(small)) ** 2)
        big = pin + second.pin_radius * np.exp(1j * second.pin_angle) * along
    return phi, np.array(found)


def _rate(values: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Derivative of a periodic curve by its Fourier series, exact but for rounding for smooth curves."""
    n = len(values)
    found: NDArray[np.complex128] = np.fft.ifft(1j * np.fft.fftfreq(n, 1 / n) * np.fft.fft(values))
    return found


def test_machine_has_the_published_strokes(paper: Paper3) -> None:
    """180 mm and 186.7 mm: the pin's place in the file is rounded to a tenth of a millimetre."""
    assert paper.inertia["strokes"] == pytest.approx((0.180, 0.1867), abs=5e-5)


def test_exact_disc_by_places_of_points(paper: Paper3) -> None:
    _, parts = _throw_energy(paper)
    means = parts.mean(axis=1)
    assert paper.trial.own + means.sum() == pytest.approx(paper.trial.inertia, rel=1e-10)
    assert paper.trial.own + means[:2].sum() == pytest.approx(paper.trial.master_inertia, rel=1e-10)
    assert means[2] == pytest.approx(paper.inertia["articulated_share"], rel=1e-9)


def test_disc_of_one_rod_by_the_series(paper: Paper3) -> None:
    """What (7) leaves out of the mean of the same two masses is λ⁴/16 of the moving masses, and more."""
    e, rod = paper.trial.engine, paper.trial.engine.rod
    ratio = e.radius / rod.length
    left_out = ratio**4 / 16 + 5 * ratio**6 / 128
    moving = e.radius**2 * (rod.mass_piston + e.piston_mass)
    two = paper.inertia["one_rod"], paper.inertia["split"]
    of_two = paper.trial.master_inertia * (1 + two[1])
    # The next term of the series is λ⁸/30 or so.
    assert -paper.inertia["series"] * of_two == pytest.approx(moving * left_out, rel=ratio**4)
    assert (1 + paper.inertia["series"]) * (1 + two[1]) - 1 == pytest.approx(two[0], abs=1e-14)


def test_speed_of_the_piston_by_its_third_term(paper: Paper3) -> None:
    """(3) is the first term of the series in λ: what is left is of the order λ³/8."""
    ratio = paper.trial.engine.radius / paper.trial.engine.rod.length
    phi = np.linspace(0, 2 * np.pi, 7201)
    exact = np.sin(phi) + ratio * np.sin(2 * phi) / (2 * np.sqrt(1 - (ratio * np.sin(phi)) ** 2))
    printed = np.sin(phi) + ratio / 2 * np.sin(2 * phi)
    wanted = np.abs(exact - printed).max() / np.abs(exact).max()
    # Both look at some thousand angles.
    assert paper.inertia["speed"] == pytest.approx(wanted, rel=1e-5)


def test_printed_roundings(paper: Paper3) -> None:
    assert paper.inertia["factor"] == pytest.approx(0.00051 * 2 * 981 - 1, abs=1e-15)
    assert paper.swing["factor"] == pytest.approx(358000 / (981 * (60 / math.pi) ** 2) - 1, abs=1e-15)
    assert paper.swing["edge"] == pytest.approx(paper.swing["factor"], abs=1e-12)


def test_literal_articulated_inertia(paper: Paper3) -> None:
    """(12) by hand, and the disc that (7) makes of it."""
    e, rod, light = paper.trial.engine, paper.trial.engine.rod, paper.trial.articulated
    m, c, J = rod.body
    about_small_end = J + m * (rod.length - c) ** 2
    I_a = about_small_end * light.mass / m
    assert paper.inertia["articulated_printed"] == pytest.approx(I_a, rel=1e-12)
    m_1 = about_small_end / rod.length**2
    R, lam = e.radius, e.radius / rod.length
    pistons = e.piston_mass * (1 + lam**2 / 4) / 2 + e.piston_mass * (1 + (R / light.length) ** 2 / 4) / 2
    disc = paper.trial.own + R**2 * (m_1 + (m - m_1) * (1 + lam**2 / 4) / 2 + pistons) + I_a
    assert paper.inertia["shifts"][0].value == pytest.approx(disc, rel=1e-12)


def test_other_discs_by_hand(paper: Paper3) -> None:
    """(7) with the articulated rod on the crank pin, and (9) with the rod's own k and the printed ones."""
    e, rod, light = paper.trial.engine, paper.trial.engine.rod, paper.trial.articulated
    R, both, own = e.radius, rod.mass + light.mass, paper.trial.own
    series = (1 + (R / rod.length) ** 2 / 4) / 2
    reduced = own + R**2 * (rod.share * both + ((1 - rod.share) * both + 2 * e.piston_mass) * series)
    assert paper.inertia["shifts"][1].value == pytest.approx(reduced, rel=1e-12)
    for shift, k in zip(paper.inertia["shifts"][2:], (rod.share, 0.25, 0.4), strict=True):
        # 0.00051 s²/cm by the paper's g is 0.50031 in SI, in place of ½.
        simple = own + 0.00051 * 981 * R**2 * ((1 + k) * both + 2 * e.piston_mass)
        assert shift.value == pytest.approx(simple, rel=1e-12)


def test_swings_of_a_compound_pendulum(paper: Paper3) -> None:
    """The period of the rod on the bore of its small end, from its equation of motion."""
    rod = paper.trial.engine.rod
    m, c, J = rod.body
    b = rod.length - c + paper.published["chosen"]["bore_radius"]
    omega = math.sqrt(m * 9.81 * b / (J + m * b**2))
    assert paper.swing["swings"][0] == pytest.approx(60 * omega / math.pi, rel=1e-12)
    # A difference magnifies the rounding by its larger part over the whole.
    length = 9.81 / omega**2
    assert paper.swing["centre"] == pytest.approx(paper.swing["factor"] * length / (length - b), rel=1e-9)
    assert abs(paper.swing["two_point_exact"]) < 1e-12


def test_frequencies_by_matrices(paper: Paper3) -> None:
    """Every frequency of the table by SciPy from the chain of discs, written out here."""
    train = paper.trial.machine.train
    assert train is not None
    throws = len(paper.trial.engine.throws)
    discs, shafts = train.discs, train.shafts
    for each in paper.shifts:
        J_throw = each.value if each.what == "J" else paper.trial.inertia
        k_throw = each.value if each.what == "k" else paper.trial.stiffness
        inertia = [discs["front"].inertia, *[J_throw] * throws]
        inertia += [discs["flywheel"].inertia, discs["generator"].inertia]
        stiffness = [shafts["nose"].rate, *[k_throw] * (throws - 1), shafts["tail"].rate]
        stiffness.append(float(train.couplings["coupling"].slope()))
        K = np.zeros((len(inertia), len(inertia)))
        for n, k in enumerate(stiffness):
            K[n : n + 2, n : n + 2] += k * np.array([[1, -1], [-1, 1]])
        values = eigh(K, np.diag(inertia), eigvals_only=True)[1:4]
        np.testing.assert_allclose(each.frequencies, np.sqrt(values) / (2 * np.pi), rtol=1e-9)


def test_change_of_a_frequency_follows_the_energy(paper: Paper3) -> None:
    """A small change of all throws moves ω² by their share of the kinetic energy, by Rayleigh's quotient."""
    free = paper.trial.free
    throws = [n for n, name in enumerate(free.discs) if name.startswith("throw_")]
    shift = paper.throw["shifts"][0]
    for mode, change in zip((1, 2, 3), shift.changes, strict=True):
        wanted = -0.5 * shift.deviation * free.kinetic_shares[mode, throws].sum()
        # Terms of the second order are the square of the deviation of 2e-4, against itself.
        assert change == pytest.approx(wanted, rel=1e-3)


def test_rigid_unevenness_by_the_torques(paper: Paper3) -> None:
    """δ if nothing twisted: all torques added up and integrated over the angle."""
    from linkwright.torsion import excited_train

    speed = paper.trial.service
    at = excited_train(paper.trial.machine, np.array([speed]))
    total = at.torques.harmonics[:, :, 0].sum(axis=1)
    J = at.referred.inertia.sum()
    phi = np.linspace(0, 4 * np.pi, 20001)
    # J Ω dΩ/dφ is the torque beside its mean. Damping against the ground is left out, 4 % of the inertia at
    # order ½ and less at the others.
    swing = (np.exp(1j * np.outer(phi, at.torques.orders)) @ (total / (1j * at.torques.orders))).real
    delta = np.ptp(swing) / (J * speed**2)
    assert paper.uneven.delta_rigid == pytest.approx(delta, rel=2e-2)


def test_torsion_falsifies_the_unevenness(paper: Paper3) -> None:
    """What the paper concludes, as these numbers show it."""
    found = paper.uneven
    assert found.N[0] > 10 * found.N_rigid
    assert found.N[found.flywheel] > 5 * found.N_rigid
    assert found.N[-1] < found.N_rigid
    assert found.rise_rigid.min() > 1.4
    assert found.rise[:, 0].max() < 1.1
    assert found.rise[:, 0].min() < 1


def test_weak_cylinder_is_found_with_torsion_alone(paper: Paper3) -> None:
    found = paper.weak
    wanted = np.ones_like(found.elastic[0])
    wanted[found.cylinder - 1] = paper.published["chosen"]["weak"]
    # The weak engine gives less torque, so that the load pulsates less too: 1e-5 of the whole.
    np.testing.assert_allclose(found.elastic[:2], wanted[None].repeat(2, axis=0), atol=1e-4)
    assert np.abs(found.against_sound - wanted).max() > 0.2
    assert np.abs(found.rigid - wanted).max() > 1


def test_verdicts(paper: Paper3) -> None:
    kinds = {row.name: row.kind for row in paper.rows}
    assert kinds["(4)–(7) disc of equal mean energy"] == "reproduced"
    assert kinds["(7) with I_a as it is"] == "far"
    assert kinds["(8) distribution coefficient"] == "far"
    assert kinds["(13) about the knife edge"] == "reproduced"
    damaged = [row for row in paper.rows if row.printed.startswith("damaged")]
    assert [row.name[:4] for row in damaged] == ["(16)", "(17)"]
    assert all("cannot be read" in row.verdict for row in damaged)
    # Every formula has its row.
    told = " ".join(row.name for row in paper.rows)
    for formula in ("(1), (2)", "(3)", "(4)–(7)", "(8)", "(9)", "(10)–(12)", "(13)", "(14)", "(15)"):
        assert formula in told


def test_words_of_deviations() -> None:
    digits = tolerance("digits")
    assert holding(0.0, digits) == ("holds exactly", "reproduced")
    assert holding(4.87e-4, digits) == ("holds within 0.049 %", "reproduced")
    assert holding(-0.0036, digits) == ("holds within 0.36 %", "near")
    assert holding(1.0, digits) == ("does not hold", "far")
    told = [share(each).replace("\N{NO-BREAK SPACE}", " ") for each in (0.0, -0.211, 0.0031, 1.0)]
    assert told == ["0 %", "−21 %", "+0.31 %", "+100 %"]


def test_everything_is_told(paper: Paper3) -> None:
    told = json.loads(json.dumps(paper.to_dict(), allow_nan=False))
    assert told["conclusions"] == paper.conclusions
    assert len(told["rows"]) == len(paper.rows)
    drawn = paper.figures()
    text = page(paper, drawn)
    assert text.count("<svg") == len(drawn) == 9
    (table,) = paper.tables
    assert len(table.rows) == 1 + len(paper.shifts)
    assert all(len(row) == len(table.heads) for row in table.rows)
    for row in paper.rows:
        assert row.verdict.split("'")[0].split(":")[0] in text


def test_order_along_the_shaft(paper: Paper3) -> None:
    """Neighbours along the shaft are joined."""
    joined = {frozenset(each) for each in paper.trial.free.joined}
    assert all(frozenset(each) in joined for each in pairwise(paper.uneven.discs))
