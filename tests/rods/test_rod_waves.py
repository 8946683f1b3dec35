"""The string between polished rod and pump: closed forms, marches in time, work."""

from __future__ import annotations

import numpy as np
import pytest
from tests.samples.sizes import random_cases
from tests.samples.wells import FOOT, INCH, random_well, well

import linkwright as lw
from linkwright.rods.core import cards_of, numbers_of, sample_counts, solve_rows, solve_string

GRAVITY = 9.80665


def uniform_well(**entries):
    """5000 ft of ¾ in rods whose speed of sound is 16 300 ft/s."""
    rigidity = 30.5e6 * 6894.757293168361 * np.pi / 4 * (0.75 * INCH) ** 2
    section = {"diameter": "0.75 in", "weight": rigidity / (16_300 * FOOT) ** 2, "length": "5000 ft"}
    return well(sections=[section], **entries)


def test_without_damping_and_pump_the_plunger_moves_as_the_cosine_of_the_wave_says():
    """y_p/y_0 = 1/cos(ωL/a): ωL/a = 0.51396 and 1.148365 of a free end at 16 strokes per minute."""
    string = uniform_well(damping=0.0).rod_string
    omega = 16 * 2 * np.pi / 60
    phase = omega * 5000 / 16_300
    assert phase == pytest.approx(0.51396, abs=1e-5)
    n, period = 512, 2 * np.pi / omega
    wave = np.cos(2 * np.pi * np.arange(n) / n)
    rigidity = float(string.columns.rigidity[0])
    # A free lower end needs the load EA k tan(kL) of a rod that moves up at its top.
    load = -rigidity * omega / (16_300 * FOOT) * np.tan(phase) * wave
    cards = cards_of(string, period, wave, load, 0.0)
    assert np.ptp(cards.position[-1]) / 2 == pytest.approx(1 / np.cos(phase), rel=1e-12)
    assert 1 / np.cos(phase) == pytest.approx(1.148365, abs=2e-6)
    assert np.abs(cards.load[-1]).max() < 1e-9 * np.abs(load).max()


def test_a_static_load_stretches_the_rods_by_the_sum_of_their_compliances():
    """The mean position falls from station to station by F L/(EA)."""
    string = well().rod_string
    n = 64
    cards = cards_of(string, 4.0, np.zeros(n), np.full(n, 1e4), 0.3)
    columns = string.columns
    falls = -np.diff(cards.position.mean(axis=1))
    np.testing.assert_allclose(falls, 1e4 * columns.length / columns.rigidity, rtol=1e-12)
    assert falls.sum() == pytest.approx(1e4 / string.stiffness, rel=1e-12)


def test_two_damped_sections_are_the_closed_form_of_their_matrices():
    """Position and load of one harmonic below two sections, by complex matrices written out here."""
    string = well().rod_string
    n, period, damping, order = 256, 3.75, 0.6, 5
    omega = 2 * np.pi * order / period
    top = np.array([0.4 - 0.1j, 3e3 + 8e3j])
    t = period * np.arange(n) / n
    position, load = ((2 * c * np.exp(1j * omega * t)).real for c in top)
    cards = cards_of(string, period, position, load, damping)
    state, columns = top, string.columns
    for i in range(2):
        k = np.sqrt((omega**2 - 1j * omega * damping) * columns.mass[i] / columns.rigidity[i])
        stiff = columns.rigidity[i] * k
        c, s = np.cos(k * columns.length[i]), np.sin(k * columns.length[i])
        state = np.array([[c, -s / stiff], [stiff * s, c]]) @ state
        for found, expected in zip((cards.position, cards.load), state, strict=True):
            wave = (2 * expected * np.exp(1j * omega * t)).real
            np.testing.assert_allclose(found[i + 1], wave, atol=1e-11 * np.abs(wave).max())


def test_a_march_in_time_agrees_with_the_harmonics():
    """Spectral elements with damping, marched by their exact exponential under a smooth pump load: to 1e-8
    of the stroke.
    """
    from scipy.linalg import expm

    string = well().rod_string
    columns, damping, period = string.columns, 0.9, 3.75
    omega = 2 * np.pi / period
    # Polished rod and pump load of two harmonics each.
    rod = {1: 0.4 + 0.1j, 2: -0.05j}
    pump = {1: 4e3 - 2e3j, 3: 1e3j}
    K, M, ends = spectral_elements(columns, 24)
    size = len(M)
    inside = np.arange(size) != ends[0]
    A = np.zeros((2 * (size - 1), 2 * (size - 1)))
    A[: size - 1, size - 1 :] = np.eye(size - 1)
    A[size - 1 :, : size - 1] = -K[np.ix_(inside, inside)] / M[inside, None]
    A[size - 1 :, size - 1 :] = -damping * np.eye(size - 1)
    # Harmonics of the forcing are states of their own, so that the exponential of a step is exact.
    orders = (1, 2, 3)
    forcing = np.zeros((2 * (size - 1), 6))
    last = np.flatnonzero(np.arange(size)[inside] == ends[1])[0]
    for j, n in enumerate(orders):
        cosine = 2 * rod.get(n, 0) * np.exp(0j)
        held = -K[inside, ends[0]] / M[inside]
        forcing[size - 1 :, 2 * j] += held * cosine.real
        forcing[size - 1 :, 2 * j + 1] -= held * cosine.imag
        load = 2 * pump.get(n, 0)
        forcing[size - 1 + last, 2 * j] -= load.real / M[ends[1]]
        forcing[size - 1 + last, 2 * j + 1] += load.imag / M[ends[1]]
    turning = np.zeros((6, 6))
    for j, n in enumerate(orders):
        turning[2 * j, 2 * j + 1], turning[2 * j + 1, 2 * j] = -n * omega, n * omega
    system = np.block([[A, forcing], [np.zeros((6, 2 * (size - 1))), turning]])
    samples = 32
    step = expm(system * period / samples)
    state = np.zeros(len(system))
    state[-6::2] = 1.0
    for _ in range(60 * samples):
        state = step @ state
    marched = []
    for _ in range(samples):
        marched.append(state[last])
        state = step @ state
    expected = pump_position(string, period, damping, rod, pump, samples)
    assert np.abs(np.array(marched) - expected).max() < 1e-8 * np.ptp(expected)


def pump_position(string, period, damping, rod, pump, samples):
    """Position of the plunger by the cards of the package, with the load of the pump that is wanted."""
    n = 64
    t = np.arange(n) / n

    def wave(parts):
        return sum(((2 * c * np.exp(2j * np.pi * k * t)).real for k, c in parts.items()), np.zeros(n))

    def at_pump(load_top):
        cards = cards_of(string, period, wave(rod), wave(load_top), damping)
        return cards.position[-1], np.fft.rfft(cards.load[-1]) / n

    # The load at the pump is linear in that at the top, harmonic by harmonic.
    zero = at_pump({})[1]
    one = at_pump(dict.fromkeys((1, 2, 3), 1.0 + 0j))[1]
    top = {k: (pump.get(k, 0) - zero[k]) / (one[k] - zero[k]) for k in (1, 2, 3)}
    position, load = at_pump(top)
    for k in (1, 2, 3):
        assert load[k] == pytest.approx(pump.get(k, 0), abs=1e-6)
    return position[:: n // samples]


def spectral_elements(columns, order):
    """Stiffness and lumped mass of a string over its rigidity, by Gauss–Lobatto nodes; first and last
    node.
    """
    from numpy.polynomial import legendre

    coefficients = np.zeros(order + 1)
    coefficients[order] = 1
    inner = np.sort(legendre.legroots(legendre.legder(coefficients)))
    x = np.concatenate([[-1.0], inner, [1.0]])
    values = legendre.legval(x, coefficients)
    weights = 2 / (order * (order + 1) * values**2)
    D = np.array(
        [
            [values[i] / values[j] / (x[i] - x[j]) if i != j else 0.0 for j in range(order + 1)]
            for i in range(order + 1)
        ]
    )
    D[0, 0], D[-1, -1] = -order * (order + 1) / 4, order * (order + 1) / 4
    size = len(columns.length) * order + 1
    K, M = np.zeros((size, size)), np.zeros(size)
    for i, length in enumerate(columns.length):
        at = slice(i * order, (i + 1) * order + 1)
        K[at, at] += columns.rigidity[i] * (D.T * weights) @ D * 2 / length
        M[at] += columns.mass[i] * weights * length / 2
    return K, M, (0, size - 1)


def characteristics(string, period, motion, periods):
    """The undamped wave equation by characteristics at Courant number 1, with a full pump that slips: exact.

    ``motion``: samples (n,) of the polished rod; sections must take whole numbers of steps. Returns
    position and
    load of the plunger, and the load of the polished rod, over the last period.
    """
    columns = string.columns
    n = len(motion)
    step = period / n
    cells = np.round(columns.length * np.sqrt(columns.mass / columns.rigidity) / step).astype(int)
    impedance = np.sqrt(columns.rigidity * columns.mass)
    # D = F + Zv goes down, B = F − Zv up; the velocity of the polished rod is that of its harmonics.
    harmonics = np.fft.rfft(motion) * 2j * np.pi * np.arange(n // 2 + 1) / period
    harmonics[-1] = 0
    velocity = np.fft.irfft(harmonics, n)
    down = [np.zeros(m) for m in cells]
    up = [np.zeros(m) for m in cells]
    full, slip = float(string.fluid_load), float(string.pump.leak / string.pump.area)
    history = np.zeros((3, n))
    for i in range(periods * n):
        arriving_down = [wave[-1] for wave in down]
        arriving_up = [wave[0] for wave in up]
        v = velocity[i % n]
        starts_down = [arriving_up[0] + 2 * impedance[0] * v]
        starts_up = []
        for j in range(len(cells) - 1):
            above, below = impedance[j], impedance[j + 1]
            # Load and velocity are the same on both sides of a taper.
            speed = (arriving_down[j] - arriving_up[j + 1]) / (above + below)
            load = arriving_down[j] - above * speed
            starts_up.append(load - above * speed)
            starts_down.append(load + below * speed)
        load = min(max(arriving_down[-1] / (1 + impedance[-1] * slip / full), 0.0), full)
        starts_up.append(2 * load - arriving_down[-1])
        history[:, i % n] = (
            load,
            (arriving_down[-1] - load) / impedance[-1],
            0.5 * (arriving_up[0] + starts_down[0]),
        )
        for j in range(len(cells)):
            down[j] = np.concatenate([[starts_down[j]], down[j][:-1]])
            up[j] = np.concatenate([up[j][1:], [starts_up[j]]])
    return history


def string_of_cells(cells, n, period, **entries):
    """A string whose sections take whole numbers of steps of a stroke's n; its pump's numbers without a
    compliance of the liquid.
    """
    base = well(**entries).rod_string
    rods = [section.with_entries({"length": 1.0}) for section in base.sections[-len(cells) :]]
    sound = [np.sqrt(rod.modulus * rod.area / rod.mass) for rod in rods]
    sections = tuple(
        rod.with_entries({"length": float(m * period / n * a)})
        for rod, m, a in zip(rods, cells, sound, strict=True)
    )
    depth = sum(section.length for section in sections)
    string = base.with_entries(
        {"sections": sections, "pump": base.pump.with_entries({"fluid_level": 0.8 * depth})}
    )
    numbers = np.array([numbers_of(string, period)], dtype=float)
    numbers[0, 4 * len(cells) + 2] = 0.0
    return string, numbers


@pytest.mark.parametrize("cells", [(60,), (40, 75)])
def test_characteristics_at_courant_number_1_agree_with_the_harmonic_solution(cells):
    """Without damping of the rods, valves and all: the same wave at the pump to 1e-8 of the fluid load.

    What the pump lets slip damps instead: without either, vibrations would not die out.
    """
    n, period = 720, 4.0
    string, numbers = string_of_cells(cells, n, period, damping=0.0, pump={"leak": 1e-3})
    motion = 0.9 * (1 - np.cos(2 * np.pi * np.arange(n) / n))
    full = float(string.fluid_load)
    solved = solve_rows(string, numbers, motion[None], tolerance=1e-12)
    load, velocity, rod_load = characteristics(string, period, motion, 400)
    assert solved.ends[0, 1] <= 1e-12
    impedance = float(np.sqrt(string.columns.rigidity[-1] * string.columns.mass[-1]))
    wave = load + impedance * velocity
    assert np.abs(solved.wave[0] - wave).max() < 1e-8 * full
    assert load.min() == 0.0
    assert load.max() == full
    # Cards are those of lines between samples: harmonics of the samples times sinc².
    k = np.arange(n // 2)
    expected = np.fft.rfft(rod_load)[: n // 2] / n * np.sinc(k / n) ** 2
    found = np.fft.rfft(solved.load[0, 0])[: n // 2] / (2 * n)
    assert np.abs(found - expected).max() < 1e-5 * full


@pytest.mark.parametrize("cells", [(45,), (20, 25)])
def test_a_march_in_time_with_damping_and_valves_agrees_with_the_harmonic_solution(cells):
    """The damped wave equation marched under the wave that the valves return makes the same wave again, to
    1e-8 of the fluid load.
    """
    n, period, damping = 240, 4.0, 0.9
    string, numbers = string_of_cells(cells, n, period, damping=damping)
    motion = 0.9 * (1 - np.cos(2 * np.pi * np.arange(n) / n))
    solved = solve_rows(string, numbers, motion[None], tolerance=1e-12)
    wave, full = solved.wave[0], float(string.fluid_load)
    up = 2 * np.clip(wave, 0.0, full) - wave
    assert 0.1 < np.mean(wave > full) < 0.9
    # Steps of a march are of second order: three of them give the limit to the sixth.
    first, second, third = (damped_march(string, cells, period, up, damping, parts) for parts in (2, 4, 8))
    better, best = (4 * second - first) / 3, (4 * third - second) / 3
    assert np.abs((16 * best - better) / 15 - wave).max() < 1e-8 * full


def damped_march(string, cells, period, up, damping, parts):
    """The wave that arrives at the pump at n samples, under the wave `up` that it sends, straight between
    samples: characteristics with the damping by the trapezoidal rule, `parts` steps a sample.
    """
    n, columns = len(up), string.columns
    m, h = n * parts, period / (n * parts)
    Z = np.sqrt(columns.rigidity * columns.mass)
    q = damping * h / 4
    sent = np.interp(np.arange(m) / parts, np.arange(n + 1), np.append(up, up[0]))
    speed = 0.9 * 2 * np.pi / period * np.sin(2 * np.pi * np.arange(m) / m)
    D = [np.zeros(cell * parts + 1) for cell in cells]
    U = [np.zeros(cell * parts + 1) for cell in cells]
    arrived = np.zeros(m)
    for i in range(5 * m):
        # What a step along the characteristics brings, but for the damping at its end.
        down = [d[:-1] - q * (d - u)[:-1] for d, u in zip(D, U, strict=True)]
        rise = [u[1:] + q * (d - u)[1:] for d, u in zip(D, U, strict=True)]
        last = len(cells) - 1
        for j in range(last + 1):
            # D + q(D − U) and U − q(D − U) are known: their difference is (1 + 2q)(D − U).
            apart = (down[j][:-1] - rise[j][1:]) / (1 + 2 * q)
            D[j][1:-1], U[j][1:-1] = down[j][:-1] - q * apart, rise[j][1:] + q * apart
        v = speed[i % m]
        U[0][0] = rise[0][0] + q * 2 * Z[0] * v
        D[0][0] = U[0][0] + 2 * Z[0] * v
        for j in range(last):
            d, u = down[j][-1], rise[j + 1][0]
            v = (d - u) / ((Z[j] + Z[j + 1]) * (1 + 2 * q))
            F = d - Z[j] * v * (1 + 2 * q)
            D[j][-1], U[j][-1] = F + Z[j] * v, F - Z[j] * v
            D[j + 1][0], U[j + 1][0] = F + Z[j + 1] * v, F - Z[j + 1] * v
        U[last][-1] = sent[i % m]
        D[last][-1] = (down[last][-1] + q * U[last][-1]) / (1 + q)
        arrived[i % m] = D[last][-1]
    return arrived[::parts]


def test_work_of_every_card_balances():
    """Work past a station is work past the next one and the heat of the damping between, to 1e-10."""
    for _, generator in random_cases(4901, 8, 60):
        machine = random_well(generator)
        string = machine.rod_string
        period = 2 * np.pi / string.speed
        n = sample_counts(string, period, 512)[0]
        motion = 0.5 * string.stroke * (1 - np.cos(2 * np.pi * np.arange(n) / n))
        cards, n = solve_string(string, period, motion).cards, 2 * n
        assert (np.abs(cards.work[:-1] - cards.work[1:] - cards.loss) < 1e-10 * cards.work[0]).all()
        # The work of the cards that are returned is that of their own areas.
        for station, (position, load) in enumerate(zip(cards.position, cards.load, strict=True)):
            rate = np.fft.irfft(np.fft.rfft(position) * 2j * np.pi * np.arange(n // 2 + 1) / n, n)
            assert load @ rate == pytest.approx(cards.work[station], rel=1e-9)


def test_heat_of_the_damping_is_the_integral_of_its_power():
    """∫∫ c μ v² dx dt by 4000 shorter sections is the loss in closed form."""
    string = well(damping=0.8).rod_string
    n, period = 128, 3.0
    t = 2 * np.pi * np.arange(n) / n
    position, load = np.cos(t) + 0.1 * np.sin(3 * t), 5e3 * np.sin(t) + 2e3 * np.cos(2 * t)
    whole = cards_of(string, period, position, load, 0.8)
    columns, parts = string.columns, 400
    sections = tuple(
        section.with_entries({"length": section.length / parts})
        for section in string.sections
        for _ in range(parts)
    )
    fine = cards_of(string.with_entries({"sections": sections}), period, position, load, 0.8)
    rate = np.fft.irfft(
        np.fft.rfft(fine.position, axis=1) * 2j * np.pi * np.arange(n // 2 + 1) / period, n, axis=1
    )
    power = (rate**2).mean(axis=1)
    # Simpson's rule over pairs of parts.
    for i in range(2):
        at = power[i * parts : (i + 1) * parts + 1]
        integral = (
            (at[0] + at[-1] + 4 * at[1:-1:2].sum() + 2 * at[2:-1:2].sum()) * columns.length[i] / parts / 3
        )
        assert whole.loss[i] == pytest.approx(0.8 * columns.mass[i] * integral * period, rel=1e-9)


def test_surface_and_pump_load_of_a_real_string_do_not_correlate_to_one():
    """The pump card is never the surface card times a factor."""
    motion = lw.rod_string(well())
    assert abs(np.corrcoef(motion.load[0], motion.load[-1])[0, 1]) < 0.9
