"""A driveline whose shafts twist: its train, what excites it, and its limit, the rigid driveline."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from scipy.linalg import eigh

import linkwright as lw
from linkwright import AssemblyError, InputError, MachineError, ShapeError, SteadyStateError, drive_line
from linkwright.machine import compile_machine
from linkwright.torsion.excitation.drive_line import mean_inertia

CART = """
format = 1
name = "Cart on an elastic driveline"
[mechanism.cranks.A]
radius = 0.2
[mechanism.sliders.cart]
crank = "A"
rod = 0.8
[bodies]
cart = { mass = 300 }
"cart.rod" = { mass = 40 }
[loads]
rolling = { kind = "dry", on = "cart", force = 900 }
drag = { kind = "viscous", on = "cart", damping = 150 }
"""

MOTOR = '[drive.motor]\nkind = "dc"\ninertia = 0.4\nspeed_no_load = 110\ntorque_stall = 900\n'
BOX = "[drive.gearbox]\nratio = {ratio}\ninertia = 0.3\nefficiency = 0.92\n"
SHAFT = "[drive.motor_shaft]\nstiffness = 4e3\n"
CRANKSHAFT = "[drive.crankshaft]\nstiffness = 3e5\n"
BELT = "[drive.gearbox]\nratio = {ratio}\ninertia = 0.3\nwheel_inertia = 2.5\nstiffness = 2e4\n"


def machine(*parts: str, ratio: float = 9.8) -> lw.Machine:
    return lw.loads(CART + "".join(parts).format(ratio=ratio))


def omega(found: lw.FreeVibration) -> np.ndarray:
    return 2 * np.pi * found.natural_frequencies


# Slider-crank with rod of mass M and inertia M l²/12, on paper: s = r cos φ + √(l² − r² sin² φ).
def inertia_on_paper(phi: np.ndarray, r: float = 0.2, rod: float = 0.8) -> np.ndarray:
    root = np.sqrt(rod**2 - (r * np.sin(phi)) ** 2)
    s_d1 = -r * np.sin(phi) - r**2 * np.sin(phi) * np.cos(phi) / root
    # The rod's middle is half way between pin and slider; its angle's sine is −r sin φ/l.
    middle = np.array([(s_d1 - r * np.sin(phi)) / 2, r * np.cos(phi) / 2])
    turn = -r * np.cos(phi) / root
    return 300 * s_d1**2 + 40 * (middle**2).sum(axis=0) + 40 * rod**2 / 12 * turn**2


def test_mean_inertia_is_that_on_paper() -> None:
    # A periodic function: the mean of even steps converges faster than any power of the step.
    phi = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    wanted = inertia_on_paper(phi).mean()
    assert mean_inertia(machine(MOTOR, BOX, SHAFT)) == pytest.approx(wanted, rel=1e-13)


def test_stations_of_a_drive_with_both_shafts() -> None:
    """The gearbox's inertia stands half on either side of its rigid teeth."""
    train = drive_line(machine(MOTOR, BOX, SHAFT, CRANKSHAFT))
    J = {name: disc.inertia for name, disc in train.discs.items()}
    assert J["motor"] == 0.4
    assert J["gearbox"] == pytest.approx(0.15)
    assert J["wheel"] == pytest.approx(0.15 * 9.8**2)
    assert {name: shaft.between for name, shaft in train.shafts.items()} == {
        "motor_shaft": ("motor", "gearbox"),
        "crankshaft": ("wheel", "crank"),
    }
    assert train.gears["gears"].between == ("gearbox", "wheel")


# All that a driveline may be: which of its three parts are elastic, geared or direct, what sits where.
ELASTIC = [each for each in product([False, True], repeat=3) if any(each)]
EXTRAS = [
    "",
    "[drive.coupling]\ninertia = 0.1\n[drive.flywheel]\ninertia = 4.0\n",
    '[drive.coupling]\ninertia = 0.1\nbeside = "gearbox"\n'
    '[drive.flywheel]\ninertia = 4.0\nbeside = "gearbox"\n',
    '[drive.flywheel]\ninertia = 0.2\non = "motor"\n'
    '[drive.brake]\ntorque = 5\ninertia = 0.3\nbeside = "gearbox"\n',
]


@pytest.mark.parametrize("held", [False, True])
@pytest.mark.parametrize("extra", EXTRAS)
@pytest.mark.parametrize("ratio", [1.0, 4.0])
@pytest.mark.parametrize("elastic", ELASTIC)
def test_any_drive_is_four_discs_with_stiff_parts(
    elastic: tuple[bool, bool, bool], ratio: float, extra: str, held: bool
) -> None:
    """Against the matrices of four stations whose rigid parts are springs, far stiffer than the others."""
    motor = '[drive.motor]\nkind = "constant_speed"\nspeed = 100\ninertia = 0.4\n' if held else MOTOR
    k_motor, k_gears, k_crank = 4e3, 2e4, 3e5
    text = motor + "[drive.gearbox]\nratio = {ratio}\ninertia = 0.3\nwheel_inertia = 2.5\n"
    text += f"stiffness = {k_gears}\n" if elastic[1] else ""
    text += (SHAFT if elastic[0] else "") + extra + (CRANKSHAFT if elastic[2] else "")
    made = machine(text, ratio=ratio)
    each = zip((k_motor, k_gears, k_crank), elastic, strict=True)
    k = [value if on else 1e11 for value, on in each]
    rows = np.array([[1, -1, 0, 0], [0, 1, -ratio, 0], [0, 0, 1, -1]], float)
    J = np.diag([0.4, 0.3, 2.5, mean_inertia(made)])
    J += np.diag(
        {
            EXTRAS[0]: [0, 0, 0, 0],
            EXTRAS[1]: [0.05, 0.05, 0, 4.0],
            EXTRAS[2]: [0, 0.1, 4.0, 0],
            EXTRAS[3]: [0.2, 0.3, 0, 0],
        }[extra]
    )
    K = rows.T @ np.diag(k) @ rows
    own = slice(1, None) if held else slice(None)
    square = eigh(K[own, own], J[own, own], eigvals_only=True)
    found = omega(lw.free_vibration(made))
    assert len(found) == sum(elastic) + (not held)
    # Stiff parts err by 3e-6 of the elastic ones' energy; SciPy by rounding of the highest ω², 1e13.
    assert found**2 == pytest.approx(square[: len(found)], rel=2e-5, abs=0.1)


def test_the_whole_is_the_rigid_drive_line() -> None:
    """The motion as a whole has the inertia of the rigid drive, whatever sits where."""
    for extra in EXTRAS:
        made = machine(MOTOR, BOX, extra, SHAFT, CRANKSHAFT)
        rigid = compile_machine(machine(MOTOR, BOX, extra))
        # Even samples integrate what is smooth and periodic to rounding.
        inertia = rigid.reductions(np.linspace(0, 2 * np.pi, 720, endpoint=False)).inertia.mean()
        found = lw.free_vibration(made)
        crank = found.discs.index("crank")
        assert found.natural_frequencies[0] == 0
        whole = found.modal_inertia[0] / found.mode_shapes[0, crank] ** 2
        assert whole == pytest.approx(float(inertia), rel=1e-12)
        motor = found.discs.index("motor")
        assert found.mode_shapes[0, motor] == pytest.approx(9.8 * found.mode_shapes[0, crank], rel=1e-12)


def test_elastic_frequencies_leave_as_the_root_of_the_stiffness() -> None:
    """Both shafts stiffer by a million: frequencies higher by a thousand, and the rigid mode stays."""
    soft = lw.free_vibration(machine(MOTOR, BOX, SHAFT, CRANKSHAFT))
    entries = {"drive.motor_shaft.stiffness": 4e9, "drive.crankshaft.stiffness": 3e11}
    stiff = lw.free_vibration(lw.replace(machine(MOTOR, BOX, SHAFT, CRANKSHAFT), entries))
    assert stiff.natural_frequencies == pytest.approx(1e3 * soft.natural_frequencies, rel=1e-12)
    assert stiff.mode_shapes[0] == pytest.approx(soft.mode_shapes[0], rel=1e-12)


def forced_crank(made: lw.Machine, speed: float, orders: np.ndarray) -> np.ndarray:
    """Harmonics of the crank's speed, from matrices by themselves, with the damping of the stations."""
    train, c = drive_line(made), lw.station_damping(made, speed)
    place = {name: n for n, name in enumerate(train.discs)}
    J = np.diag([disc.inertia for disc in train.discs.values()])
    C = np.diag([c.get(name, 0.0) for name in train.discs])
    K = np.zeros_like(J)
    links = [(*shaft.between, 1.0, shaft.rate) for shaft in train.shafts.values()]
    # A rigid stage is one with a very stiff mesh.
    links += [(*gear.between, abs(gear.speed_ratio), gear.stiffness or 1e12) for gear in train.gears.values()]
    for a, b, ratio, k in links:
        row = np.zeros(len(place))
        row[place[a]], row[place[b]] = 1.0, -ratio
        K += k * np.outer(row, row)
    M = np.zeros((len(orders), len(place)), complex)
    M[:, place["crank"]] = lw.mechanism_harmonics(made, speed, orders)
    theta = [
        np.linalg.solve(K + 1j * nu * speed * C - (nu * speed) ** 2 * J, right)
        for nu, right in zip(orders, M, strict=True)
    ]
    return 1j * orders * speed * np.array(theta)[:, place["crank"]]


@pytest.mark.parametrize("ratio", [9.8, 1.0])
def test_a_rigid_drive_line_is_the_limit_of_the_elastic_one(ratio: float) -> None:
    """The swinging of the crank tends to the rigid steady motion's as 1/k, and with its linear part's error.

    A flywheel n times as heavy divides the speed fluctuation by n; the linear part errs by its square.
    """
    orders = np.arange(1.0, 9.0)
    errors = []
    for flywheel in (400.0, 4000.0):
        made = machine(
            MOTOR, BOX, f"[drive.flywheel]\ninertia = {flywheel}\n", SHAFT, CRANKSHAFT, ratio=ratio
        )
        steady = lw.steady_state(made, n=2048)
        speed = steady.speed_mean_time
        even = np.linspace(0, steady.period, 2048, endpoint=False)
        wanted = 2 * np.fft.rfft(np.interp(even, steady.time, steady.speed))[1:9] / 2048
        entries = {"drive.motor_shaft.stiffness": 1e9, "drive.crankshaft.stiffness": 1e10}
        rigid = forced_crank(lw.replace(made, entries), speed, orders)
        errors.append(np.abs(rigid - wanted).max() / np.abs(wanted).max())
    assert errors[0] < 0.01
    # Ten times the flywheel; what is left beside is the interpolation between 2048 points.
    assert errors[1] < errors[0] / 5
    base = {"drive.motor_shaft.stiffness": 1e7, "drive.crankshaft.stiffness": 1e8}
    away = [
        np.abs(
            forced_crank(lw.replace(made, {k: n * v for k, v in base.items()}), speed, orders) - rigid
        ).max()
        for n in (1, 4)
    ]
    assert away[0] / away[1] == pytest.approx(4, rel=0.05)


def test_harmonics_are_the_torque_of_the_rigid_machine() -> None:
    """Synthesis gives back −M_r − ½ J′ω², with friction's jumps at the dead centres away from them."""
    made = machine(MOTOR, BOX, SHAFT)
    speed, phi = 9.0, np.linspace(0.3, np.pi - 0.3, 50)
    orders = np.arange(0, 400.0)
    series = lw.mechanism_harmonics(made, speed, orders)
    found = (series * np.exp(1j * np.outer(phi, orders))).real.sum(axis=1)
    r, rod = 0.2, 0.8
    root = np.sqrt(rod**2 - (r * np.sin(phi)) ** 2)
    s_d1 = -r * np.sin(phi) - r**2 * np.sin(phi) * np.cos(phi) / root
    h = 1e-6
    slope = (inertia_on_paper(phi + h) - inertia_on_paper(phi - h)) / (2 * h)
    wanted = -900 * np.abs(s_d1) - 150 * speed * s_d1**2 - 0.5 * slope * speed**2
    # A jump of the slope leaves terms of order 1/ν² beyond the last order: 4·900·0.2/(π·400²)·few.
    assert found == pytest.approx(wanted, abs=2e-3 * np.abs(wanted).max())
    # Parseval's mean of squares, with the same tail.
    whole = (np.abs(series[1:]) ** 2).sum() / 2 + abs(series[0]) ** 2
    fine = np.linspace(0, 2 * np.pi, 20000, endpoint=False)
    root = np.sqrt(rod**2 - (r * np.sin(fine)) ** 2)
    s_d1 = -r * np.sin(fine) - r**2 * np.sin(fine) * np.cos(fine) / root
    slope = (inertia_on_paper(fine + h) - inertia_on_paper(fine - h)) / (2 * h)
    torque = -900 * np.abs(s_d1) - 150 * speed * s_d1**2 - 0.5 * slope * speed**2
    assert whole == pytest.approx((torque**2).mean(), rel=1e-6)


def test_many_speeds_at_once() -> None:
    """A formula of the speed among the loads, too."""
    fan = CART.replace("[loads]", '[loads]\nfan = { kind = "formula", on = "A", torque = "-0.7*omega^2" }')
    orders, speeds = np.arange(0, 6.0), np.array([3.0, 9.0])
    both = lw.mechanism_harmonics(lw.loads(fan), speeds, orders)
    each = [lw.mechanism_harmonics(lw.loads(fan), speed, orders) for speed in speeds]
    assert both == pytest.approx(np.array(each).T, rel=1e-13, abs=1e-11)
    found = lw.station_damping(lw.loads(fan + MOTOR + BOX.format(ratio=5)), speeds)
    assert found.keys() == {"motor", "crank"}
    # Rounding of means over the revolution, over a step of 1e-5.
    assert found["crank"][1] == pytest.approx(lw.station_damping(lw.loads(fan), 9.0)["crank"], rel=1e-8)


def test_high_harmonics_keep_their_digits() -> None:
    """A slider without rod (a yoke) is cos φ: J′ has order 2 alone, and ν = 100 is rounding."""
    yoke = lw.loads("""
        format = 1
        name = "Yoke"
        [mechanism.cranks.A]
        radius = 0.5
        [mechanism.yokes.Y]
        pin = "A"
        [bodies]
        Y = { mass = 8 }
    """)
    found = lw.mechanism_harmonics(yoke, 3.0, np.arange(0, 101))
    # J = m r² sin² φ, −½ J′ω² = −½ m r² ω² sin 2φ = Re(½ i m r² ω² e^{2iφ}).
    wanted = np.zeros(101, complex)
    wanted[2] = 0.5j * 8 * 0.25 * 9
    assert found == pytest.approx(wanted, abs=1e-12)


def test_halves_of_a_turn_are_not_there() -> None:
    assert lw.mechanism_harmonics(machine(MOTOR, BOX, SHAFT), 9.0, [0.5, 1.5]) == pytest.approx([0, 0])


def test_damping_of_the_stations() -> None:
    """A line of stall over no-load speed, with the gears' efficiency; the drag's mean of s′²."""
    found = lw.station_damping(machine(MOTOR, BOX, SHAFT), 9.0)
    # A central difference of a line has rounding alone.
    assert found["motor"] == pytest.approx(0.92 * 900 / 110, rel=1e-8)
    phi = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    root = np.sqrt(0.64 - (0.2 * np.sin(phi)) ** 2)
    s_d1 = -0.2 * np.sin(phi) - 0.04 * np.sin(phi) * np.cos(phi) / root
    assert found["crank"] == pytest.approx(150 * (s_d1**2).mean(), rel=1e-8)


def test_damping_of_a_fan() -> None:
    """A torque that grows with the square of the speed damps by twice its share."""
    fan = CART.replace("[loads]", '[loads]\nfan = { kind = "formula", on = "A", torque = "-0.7*omega^2" }')
    found = lw.station_damping(lw.loads(fan), 9.0)
    plain = lw.station_damping(lw.loads(CART), 9.0)
    assert found.keys() == {"crank"}
    assert found["crank"] - plain["crank"] == pytest.approx(2 * 0.7 * 9.0, rel=1e-7)


@pytest.mark.parametrize("orders", [[-1], [0.3], [np.nan], [[1, 2]]])
def test_wrong_orders(orders: list[float]) -> None:
    with pytest.raises(InputError, match="orders"):
        lw.mechanism_harmonics(machine(MOTOR, BOX), 9.0, orders)


@pytest.mark.parametrize("speed", [0.0, -1.0, np.nan, np.inf])
def test_wrong_speed(speed: float) -> None:
    with pytest.raises(InputError, match="speed"):
        lw.mechanism_harmonics(machine(MOTOR, BOX), speed, [1])
    with pytest.raises(InputError, match="speed"):
        lw.station_damping(machine(MOTOR, BOX), speed)


def test_a_load_over_time_has_no_harmonics() -> None:
    text = CART.replace("[loads]", '[loads]\npulse = { kind = "formula", on = "A", torque = "sin(t)" }')
    with pytest.raises(SteadyStateError, match="pulse"):
        lw.mechanism_harmonics(lw.loads(text), 9.0, [1])


def test_a_mechanism_that_does_not_close() -> None:
    with pytest.raises(AssemblyError, match="cart"):
        lw.free_vibration(lw.replace(machine(MOTOR, BOX, SHAFT), {"mechanism.sliders.cart.rod": 0.15}))


def test_rigid_drive_says_what_to_give() -> None:
    with pytest.raises(InputError, match=r"\[train\.discs\].*drive\.motor_shaft\.stiffness"):
        lw.free_vibration(machine(MOTOR, BOX))


def test_a_drive_without_motor() -> None:
    """Nothing turns with the motor: the gears only turn along, and the gearbox stands at the crankshaft."""
    found = drive_line(machine("[drive.gearbox]\nratio = 5\ninertia = 0.3\n", CRANKSHAFT))
    assert list(found.discs) == ["gearbox", "crank"]
    assert found.discs["gearbox"].inertia == pytest.approx(0.3 * 25)
    assert not found.gears


@pytest.mark.parametrize(
    ("text", "key"),
    [
        (SHAFT + BOX, "drive.motor.inertia"),
        (MOTOR + SHAFT + "[drive.gearbox]\nratio = 4\n", "drive.gearbox.inertia"),
        (MOTOR + BELT.replace("wheel_inertia = 2.5\n", "") + CRANKSHAFT, "drive.gearbox.wheel_inertia"),
    ],
)
def test_discs_without_inertia(text: str, key: str) -> None:
    with pytest.raises(MachineError, match=key):
        lw.free_vibration(machine(text))


@pytest.mark.parametrize("value", [np.array([1.0, 2.0]), float("nan"), -1.0, 0.0])
@pytest.mark.parametrize("key", ["motor_shaft.stiffness", "crankshaft.stiffness", "gearbox.stiffness"])
def test_entries_exchanged_unchecked(key: str, value: object) -> None:
    made = machine(MOTOR, BELT, SHAFT, CRANKSHAFT)
    with pytest.raises(MachineError, match=key):
        lw.free_vibration(lw.replace(made, {f"drive.{key}": value}))


def test_an_array_of_machines() -> None:
    made = lw.replace(machine(MOTOR, BOX, SHAFT), {"bodies.cart.mass": np.array([1.0, 2.0])})
    with pytest.raises(ShapeError):
        lw.free_vibration(made)


def test_stiffness_changes_no_steady_motion() -> None:
    """What does not ask for torsion does not see it."""
    rigid = lw.steady_state(machine(MOTOR, BOX))
    elastic = lw.steady_state(machine(MOTOR, BOX, SHAFT, CRANKSHAFT))
    assert elastic.unevenness == rigid.unevenness


def test_thirds_of_a_load_over_three_revolutions() -> None:
    """A torque that repeats after three revolutions excites thirds, in the forced vibration as well."""
    load = (
        '[loads]\nmill = { kind = "formula", on = "A", torque = "-80-30*cos(phi/3)", cycle = "1080 deg" }\n'
    )
    text = CART.replace("[loads]", load.rstrip("\n"))
    found = lw.mechanism_harmonics(lw.loads(text), 9.0, [1 / 3, 2 / 3])
    bare = lw.mechanism_harmonics(lw.loads(CART), 9.0, [1])
    assert found == pytest.approx([-30, 0], abs=1e-9)
    assert lw.mechanism_harmonics(lw.loads(text), 9.0, [1]) == pytest.approx(bare, abs=1e-8)
    forced = lw.forced_vibration(lw.loads(text + "".join((MOTOR, BOX, SHAFT)).format(ratio=9.8)))
    # Orders of the results are those of the motor.
    assert np.abs(forced.orders * 9.8 - 1 / 3).min() < 1e-9
