"""Derivatives of steady motion against extrapolated differences of the same analysis, and laws they obey."""

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import FindingError, InputError, LinkwrightError
from linkwright.drive import gradient_along, solved_along
from linkwright.machine import compile_machine, directions, exchanged
from linkwright.machine.program.compiled import Translation

TWO_CARTS = "machines/roller_two_carts.toml"
MACHINES = [
    TWO_CARTS,
    "machines/roller_three_carts.toml",
    "machines/roller_cam.toml",
    "examples/press_with_flywheel/machine.toml",
    "examples/fan_by_formula/machine.toml",
    "examples/gears_and_guides/machine.toml",
]

# A knot of the load of the press lies on its dead centre: there a difference errs by its step.
_TOUCHING = {"mechanism.cranks.A.radius", "mechanism.sliders.ram.rod"}

_NUMBERS = (
    "unevenness",
    "dynamism",
    "speed_mean_time",
    "period",
    "energy_load",
    "torque_motor_rms",
)


def _measures(machine):
    state = lw.steady_state(machine, accuracy=1e-12)
    return np.array([getattr(state, name) for name in _NUMBERS])


def _difference(machine, address):
    """Richardson's extrapolation of central differences with steps h, 2h: error h⁴, and rounding 1e-12/h."""
    value = lw.get(machine, address)
    h = 2e-4 * max(abs(value), 1e-2)
    at = {k: _measures(exchanged(machine, {address: value + k * h})) for k in (-2, -1, 1, 2)}
    return (8 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12 * h)


@pytest.mark.parametrize("path", MACHINES)
def test_derivatives_are_those_of_the_analysis(path):
    """To 1e-6 of the largest of a response: what the differences themselves are good for."""
    machine = lw.read(path)
    if machine.drive is None or machine.drive.motor is None or machine.drive.motor.kind == "constant_speed":
        pytest.skip("no steady motion to differentiate")
    found = lw.gradient(machine)
    rows = [found.responses.index(f"steady_state.{name}") for name in _NUMBERS]
    tied = np.array([f"steady_state.{name}" in found.ties for name in _NUMBERS])
    given = [name for name, value in zip(found.variables, found.at, strict=True) if value]
    given = [name for name in given if "press" not in path or name not in _TOUCHING]
    # Sections of a cam have to close: in pairs they are varied elsewhere.
    given = [name for name in given if ".sections." not in name or ".law." in name]
    scale = np.abs(found.derivatives[rows] * found.at).max(axis=1)
    for address in given[:: max(1, len(given) // 8)]:
        place = found.variables.index(address)
        exact = found.derivatives[rows, place] * found.at[place]
        measured = _difference(machine, address) * found.at[place]
        assert np.all(np.abs(exact - measured)[~tied] <= 1e-6 * scale[~tied]), address


def test_lengths_and_times_scale():
    """Buckingham: masses, inertias, torques and forces k times as large leave every speed as it is."""
    machine = lw.read(TWO_CARTS)
    found = lw.gradient(machine)
    kinds = {"kg": 1, "kg/m": 1, "N": 1, "N m": 1, "kg m^2": 1, "kg m²": 1, "W": 1}
    grows = [at for at, unit in enumerate(found.variable_units) if unit in kinds]
    given = [at for at in grows if not found.variables[at].startswith("drive.motor.power")]
    row = found.responses.index("steady_state.unevenness")
    share = (found.derivatives[row] * found.at)[given].sum()
    assert abs(share) <= 1e-8 * found.values[row]


@pytest.mark.parametrize(
    "path", [TWO_CARTS, "examples/jansen_leg/machine.toml", "examples/scissor_lift/machine.toml"]
)
def test_numbers_of_the_program_follow_the_entries(path):
    """Against central differences of the translation: arithmetic alone, h² and rounding."""
    machine = lw.read(path)
    names = [name for name, value in lw.addresses(machine).items() if value]
    found = directions(machine, names)
    assert set(found.variables) | set(found.refused) == set(names)
    n = len(Translation(machine, motor=True, brake=False).program.parameters)
    for place, name in enumerate(found.variables):
        value = lw.get(machine, name)
        h = 1e-6 * abs(value)
        up, down = (
            np.array(
                Translation(
                    exchanged(machine, {name: value + step}), motor=True, brake=False
                ).program.parameters,
                dtype=float,
            )
            for step in (h, -h)
        )
        slope = (up - down)[:n] / (2 * h)
        assert found.values[:n, place] == pytest.approx(
            slope, rel=1e-6, abs=1e-6 * np.abs(slope).max() + 1e-9
        )


def test_a_load_that_ends_on_the_dead_centre():
    """Work of the press per revolution: the integral of its force, and that of its guide."""
    machine = lw.read("examples/press_with_flywheel/machine.toml")
    found = lw.gradient(machine, ["steady_state.energy_load"], sorted(_TOUCHING))
    # The force is zero at both ends of the stroke, so its integral stays; 4 r times 250 N grows with r.
    assert found.derivatives[0] == pytest.approx([1000.0, 0.0], abs=1e-6)


def test_symmetric_carts_tie():
    """Two equal carts at 90° have their minimum speed once each half revolution: a tie that is reported."""
    machine = lw.replace(lw.read(TWO_CARTS), {"mechanism.cranks.A2.phase": np.pi})
    found = lw.gradient(machine, ["steady_state.unevenness"])
    assert "steady_state.unevenness" in found.ties


@pytest.mark.parametrize("steep", [1.0, 300.0])
def test_equal_carts_tie_wherever_they_are(steep):
    """n equal carts repeat their motion n times a revolution; 7 times is at no even angles."""
    n = 7
    motor = f'{{ kind = "dc", speed_no_load = 100, torque_stall = {200 * steep} }}'
    rows = [f"A{k} = {{ radius = 0.2, phase = {2 * np.pi * k / n} }}" for k in range(n)]
    slides = [f's{k} = {{ crank = "A{k}", rod = 0.5, offset = 0.1 }}' for k in range(n)]
    loads = [f'd{k} = {{ kind = "dry", on = "s{k}", force = 400 }}' for k in range(n)]
    text = f"""format = 1
name = "equal carts"
[drive]
motor = {motor}
gearbox = {{ ratio = 10 }}
flywheel = {{ inertia = 2 }}
[mechanism.cranks]
{chr(10).join(rows)}
[mechanism.sliders]
{chr(10).join(slides)}
[bodies]
{chr(10).join(f"s{k} = {{ mass = 50 }}" for k in range(n))}
[loads]
{chr(10).join(loads)}
"""
    names = [f"steady_state.{name}" for name in _EXTREMES]
    found = lw.gradient(lw.loads(text), names, ["drive.gearbox.ratio", "bodies.s0.mass"])
    for name in names:
        assert "° and 3 angles more; the derivatives with respect to" in found.ties[name], name
        assert "bodies.s0.mass" in found.ties[name], name
    # All parts of the revolution change alike with the ratio; where a steep motor bends the motion within
    # rounding of its angle, that is not known.
    tied = lw.gradient(lw.loads(text), names, ["drive.gearbox.ratio"]).ties
    assert set(tied) <= ({"steady_state.acceleration_max"} if steep > 1 else set())


@pytest.mark.parametrize("name", ["roller_cam", "roller_three_carts"])
def test_entries_tie_where_differences_to_both_sides_differ(name):
    """A symmetrical machine has a derivative by what it keeps its symmetry with, such as its flywheel."""
    machine = lw.read(name)
    responses = [f"steady_state.{extreme}" for extreme in _EXTREMES]
    middle = lw.steady_state(machine, accuracy=1e-11)
    found = lw.gradient(machine, responses)
    n_tied = 0
    # Sections of a cam do not close when one of them alone is another.
    closing = [not (".sections." in name and ".law." not in name) for name in found.variables]
    for entry, value in zip(np.array(found.variables)[closing].tolist(), found.at[closing], strict=True):
        h = 1e-6 * (abs(value) or 1.0)
        try:
            beside = [lw.replace(machine, {entry: value + step}) for step in (h, -h)]
        except InputError:
            # It is at the end of its range.
            continue
        up, down = (lw.steady_state(one, accuracy=1e-11) for one in beside)
        tied = lw.gradient(machine, responses, [entry]).ties
        for extreme, response in zip(_EXTREMES, responses, strict=True):
            here = getattr(middle, extreme)
            slopes = np.array([getattr(up, extreme) - here, here - getattr(down, extreme)]) / h
            # Second derivatives and the accuracy of the motion over the step.
            slack = 2e-3 * np.abs(slopes).max() + 5e-11 * abs(here) / h
            assert (abs(slopes[0] - slopes[1]) > slack) == (response in tied), (entry, response)
            n_tied += response in tied
    assert (n_tied > 50) == (name == "roller_three_carts")


_EXTREMES = ("speed_min", "speed_max", "acceleration_min", "acceleration_max")


def test_what_has_no_derivative_is_told():
    machine = lw.read(TWO_CARTS)
    with pytest.raises(InputError, match="expected one with a derivative"):
        lw.gradient(machine, ["steady_state.uneveness"])
    with pytest.raises(InputError, match="variables: found"):
        lw.gradient(machine, None, ["mechanism.cranks.A2.phas"])
    points = lw.read("examples/change_points/machine.toml")
    lengths = [name for name in lw.addresses(points) if name.endswith("radius")]
    with pytest.raises(LinkwrightError, match=r"change points|motor"):
        lw.gradient(points, None, lengths[:1])


@pytest.mark.parametrize("address", ["bodies.cart1.mass", "drive.gearbox.ratio"])
def test_peaks_of_acceleration_are_differentiated_at_their_peak(address: str) -> None:
    """Not where they were read, some millionths of a step beside, which makes 9e-7 for the mass of a cart."""
    machine = lw.read(TWO_CARTS)
    value = dict(lw.addresses(machine))[address]

    def peak(share: float) -> float:
        changed = exchanged(machine, {address: value * (1 + share)})
        return lw.steady_state(changed, n=16, accuracy=1e-12).acceleration_max

    rough = [(peak(share) - peak(-share)) / (2 * share * value) for share in (8e-3, 4e-3, 2e-3)]
    finer = [(4 * rough[k + 1] - rough[k]) / 3 for k in range(2)]
    expected = (16 * finer[1] - finer[0]) / 15
    found = lw.gradient(machine, ["steady_state.acceleration_max"], [address])
    assert found.derivatives[0, 0] == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(("mass", "inertia", "rotor"), [(10, 0.2, 0.0), (20, 0.1, 1e-4)])
def test_kinks_under_a_steep_motor_have_derivatives(mass, inertia, rotor):
    """Rounding, which such a motor enlarges, moves kinks a little without end; and no lane spoils another."""
    machine = lw.loads(f"""
    format = 1
    name = "slider-crank on a steep motor"
    [drive.motor]
    kind = "induction"
    speed_synchronous = "1000 rpm"
    speed_rated = "985 rpm"
    torque_rated = "60 N m"
    torque_breakdown = "150 N m"
    inertia = {rotor}
    [drive.gearbox]
    ratio = 10
    efficiency = 0.9
    [mechanism.cranks.A]
    radius = 0.2
    [mechanism.sliders.S]
    crank = "A"
    rod = 0.8
    [bodies]
    S = {{ mass = {mass} }}
    A = {{ inertia = {inertia} }}
    [loads]
    push = {{ kind = "force", on = "S", force = 300, direction = 0.6 }}
    """)
    names = ["acceleration_max", "speed_min", "multiplier"]
    gradient = lw.gradient(machine, [f"steady_state.{name}" for name in names])
    for name in names:
        assert np.isfinite(list(gradient.of(f"steady_state.{name}").values())).all(), name
    of = gradient.of("steady_state.acceleration_max")
    for address in ("mechanism.cranks.A.radius", "loads.push.force", "drive.gearbox.efficiency"):
        value, h = lw.get(machine, address), 2e-4 * lw.get(machine, address)
        peak = {
            k: lw.steady_state(exchanged(machine, {address: value + k * h}), accuracy=1e-12).acceleration_max
            for k in (-2, -1, 1, 2)
        }
        difference = (8 * (peak[1] - peak[-1]) - (peak[2] - peak[-2])) / (12 * h)
        # The peak is known to some 1e-9 of it, the difference to that over its step.
        assert of[address] == pytest.approx(difference, rel=1e-5, abs=1e-5 * abs(peak[1] / value))


def test_jumps_one_after_another_under_a_stiff_drive():
    """The motion passes the jump of a load four times: where it passes the second depends on how it passed
    the first. The largest acceleration lies behind a jump. To 1e-6, or the rounding of differences, 1e-12
    over their step."""
    machine = lw.loads("""
    format = 1
    name = "press on a stiff motor, with a load that jumps over speed"
    [drive.motor]
    kind = "dc"
    speed_no_load = 215.4
    torque_stall = 12.8
    inertia = 1e-5
    [drive.gearbox]
    ratio = 5
    efficiency = 0.7
    [mechanism.cranks]
    A = { radius = 0.0639 }
    A1 = { radius = 0.0553, phase = 1.914 }
    [mechanism.sliders]
    S0 = { crank = "A", rod = 0.13, angle = 1.5707963267948966 }
    S1 = { crank = "A1", rod = 0.156, angle = 2.051 }
    [bodies]
    A = { inertia = 1.122e-4 }
    S0 = { mass = 0.892 }
    S1 = { mass = 2.077 }
    [loads]
    dry0 = { kind = "dry", on = "S0", force = 458.5 }
    vis0 = { kind = "viscous", on = "S0", damping = 3.4 }
    vis1 = { kind = "viscous", on = "S1", damping = 9.16 }
    f = { kind = "formula", on = "A", torque = "-(10.09 + 0.764*cos(phi) + where(omega > 23.74, -14.95, 0))" }
    """)
    for address in ("bodies.A.inertia", "bodies.S0.mass", "drive.gearbox.ratio"):
        found = lw.gradient(machine, [f"steady_state.{name}" for name in _NUMBERS], [address])
        exact, measured = found.derivatives[:, 0] * found.at, _difference(machine, address) * found.at
        assert np.all(np.abs(exact - measured) <= 1e-6 * np.abs(measured) + 1e-8 * np.abs(found.values)), (
            address
        )


def test_a_motor_without_load_has_no_torque() -> None:
    """Where its torque goes through zero it is 3e-17 of that at rest, which is rounding of the speed."""
    machine = lw.loads("""
    format = 1
    name = "idle"
    [drive.motor]
    kind = "table"
    speed = [0.0, 10.551615498139943, 21.103230996279887, 31.654846494419825]
    torque = [0.18390883707811134, 0.22988604634763918, 0.09195441853905567, -0.18390883707811134]
    [drive.gearbox]
    ratio = 1
    efficiency = 0.9
    [mechanism.cranks.A]
    radius = 0.2
    [bodies.A]
    mass = 0.2
    """)
    assert 0.0 < lw.steady_state(machine).torque_motor_rms < 1e-15
    found = lw.gradient(machine)
    assert "steady_state.speed_max" in found.responses
    torques = [
        name for name in found.responses if "torque" in name or "power" in name or "load_factor" in name
    ]
    assert not torques
    assert found.missing["steady_state.torque_motor_rms"] == "it is zero within rounding error"
    assert found.missing["steady_state.power_motor_mean"] == "it is zero within rounding error"
    with pytest.raises(FindingError, match="zero within rounding error"):
        lw.gradient(machine, ["steady_state.torque_motor_rms"])


def test_what_an_analysis_has_without_a_derivative_is_told() -> None:
    """The largest torque of this motor is that at breakdown, between its extreme speeds."""
    done = invoke("sensitivity", "roller_one_cart", "--json")
    answer = json.loads(done.stdout)
    name = "steady_state.torque_motor_max"
    assert "breakdown" in answer["results"]["missing"][name]
    assert any(text.startswith(f"{name} has no derivative: ") for text in answer["warnings"])
    assert name not in answer["results"]["sensitivity"]


def test_an_analysis_without_any_derivative_is_said() -> None:
    """A press without masses or loads: every force is zero."""
    with pytest.raises(FindingError, match=r"^forces: nothing has a derivative: forces\.torque_drive_max: "):
        lw.gradient(lw.read("examples/press_motion/machine.toml"), ["forces"])


@pytest.mark.parametrize(
    ("of", "by", "told"),
    [
        ([], ["nix"], '--by: found "nix", expected the address of a number'),
        ([], ["mechanism.cranks.A9.phase"], 'did you mean "mechanism.cranks.A2.phase"'),
        ([], ["drive"], '--by: found "drive", expected the address of a number, such as drive.speed'),
        (["steady_state.foo"], [], '--of: found "steady_state.foo", expected one with a derivative'),
        (["nix.foo"], [], '--of: found "nix.foo"'),
    ],
)
def test_the_command_names_its_option(of, by, told):

    asked = [
        *(word for name in of for word in ("--of", name)),
        *(word for name in by for word in ("--by", name)),
    ]
    found = invoke("sensitivity", TWO_CARTS, *asked)
    assert found.exit_code == 2
    assert told in " ".join(found.output.split())


def test_a_gearbox_without_losses_has_derivatives_by_its_factors() -> None:
    """While the load drives the motor 1/η counts: at η = 1 the torque is smooth, its derivative by η leaps.

    To 1e-7 as other derivatives; without an end of a step at the leap, numbers are off by up to 7e-4.
    """
    text = Path("machines/roller_one_cart.toml").read_text(encoding="utf-8")
    text = text.replace("efficiency = 0.9", "efficiency = 1.0").replace('reverse = "same"', "")
    machine = lw.loads(text)
    state = lw.steady_state(machine)
    assert state.torque_motor_min < 0.0 < state.torque_motor_max
    found = lw.gradient(machine, [f"steady_state.{name}" for name in _NUMBERS], ["drive.gearbox.efficiency"])
    # The work of dry friction depends on the path alone.
    size = np.where(np.array(_NUMBERS) == "energy_load", found.values, 0.0)
    error = found.derivatives[:, 0] - _difference(machine, "drive.gearbox.efficiency")
    assert (np.abs(error) < 1e-7 * np.abs(found.derivatives[:, 0]) + 1e-11 * size).all()


# A steep motor turns a lever about a pivot; gravity gives back what it takes.
NO_WORK = """
format = 1
name = "Lever"
mechanism.cranks.A.radius = 0.2
mechanism.points.P = { x = 0, y = -0.5 }
mechanism.slotted_levers.L = { pin = "A", pivot = "P", length = 0.6 }
bodies.A = { mass = 1, inertia = 0.2 }
bodies.L.mass = 10
loads.gravity.kind = "gravity"
[drive.motor]
kind = "induction"
speed_synchronous = 60
speed_rated = 59.8
torque_rated = 200
torque_breakdown = 500
"""


def test_what_is_zero_to_the_accuracy_of_the_motion_has_no_derivative() -> None:
    """Works of gravity alone, ratios of them, and a multiplier far below rounding."""
    machine = lw.loads(NO_WORK)
    state = lw.steady_state(machine)
    assert state.efficiency is None
    assert 0 < state.multiplier < 1e-40
    found = lw.gradient(machine, ["steady_state"])
    nothing = {"energy_motor", "energy_drive", "energy_load", "power_motor_mean", "multiplier"}
    assert {f"steady_state.{name}" for name in nothing} <= set(found.missing)
    assert "steady_state.efficiency" not in found.responses


def test_an_efficiency_of_zero_is_named() -> None:
    """Without load the motor works against the losses of the gearbox alone, whatever moves."""
    text = NO_WORK.replace('loads.gravity.kind = "gravity"\n', "")
    machine = lw.loads(text + "[drive.gearbox]\nratio = 1\nefficiency = 0.8\n")
    assert lw.steady_state(machine).efficiency == 0.0
    found = lw.gradient(machine, ["steady_state"], ["bodies.A.inertia", "drive.gearbox.efficiency"])
    assert found.values[found.responses.index("steady_state.energy_motor")] > 0.01
    assert found.of("steady_state.efficiency") == dict.fromkeys(found.variables, 0.0)
    with_weight = lw.loads(NO_WORK + "[drive.gearbox]\nratio = 1\nefficiency = 0.8\n")
    found = lw.gradient(with_weight, ["steady_state"])
    assert found.missing["steady_state.efficiency"] == "it is zero within rounding error"


def test_a_motor_of_constant_speed_without_work_has_no_efficiency() -> None:
    """Its motion is exact, its works are sums that leave rounding alone."""
    text = NO_WORK.split("[drive.motor]")[0] + '[drive.motor]\nkind = "constant_speed"\nspeed = 60\n'
    assert lw.steady_state(lw.loads(text)).efficiency is None
    assert lw.steady_state(lw.loads(text + '[loads.d]\nkind = "dry"\non = "A"\ntorque = 1\n')).efficiency == (
        pytest.approx(1.0, abs=1e-9)
    )


def test_derivatives_do_not_depend_on_what_else_is_asked_for():
    """The motor's torque changes sign where no entry of another bundle of lanes moves the motion."""
    machine = lw.loads("""
    format = 1
    name = "idling crank"
    [drive]
    motor = { kind = "table", speed = [0, 6.5, 13, 19.5], torque = [1.55, 1.94, 0.776, -1.55] }
    gearbox = { ratio = 3, efficiency = 0.9 }
    flywheel = { inertia = 85 }
    [mechanism]
    points.P = { x = 0.3, y = -0.1 }
    cranks.A = { radius = 0.08 }
    sliders.S = { crank = "A", rod = 0.3 }
    rockers.R = { crank = "A", pivot = "P", coupler = 0.32, rocker = 0.16 }
    [bodies]
    A = { mass = 3 }
    R = { mass = 40 }
    """)
    asked = "mechanism.rockers.R.coupler"
    others = ["bodies.A.mass", "drive.gearbox.ratio", "drive.flywheel.inertia", "mechanism.points.P.x"]
    others += ["mechanism.points.P.y", "mechanism.cranks.A.radius", "mechanism.rockers.R.rocker"]
    # A slider without mass moves nothing: with this one there is a second bundle.
    others += ["mechanism.sliders.S.angle"]
    angles = np.linspace(0.0, 2 * np.pi, 721)

    def curve(names):
        compile_machine(machine).kept.clear()
        along = directions(machine, names)
        _, solution, _ = solved_along(machine, along)
        return gradient_along(machine, solution, along).curves(angles).speed[:, along.variables.index(asked)]

    np.testing.assert_array_equal(curve([asked, *others]), curve([asked]))


def test_the_driving_torque_of_a_nearly_neutral_drive():
    """The torques of inertia are a million times as large as that of the motor, which they leave."""
    machine = lw.loads("""
    format = 1
    name = "idling slider-crank"
    [drive]
    motor = { kind = "dc", speed_no_load = 368, torque_stall = 4.4 }
    gearbox = { ratio = 1, efficiency = 0.7 }
    flywheel = { inertia = 20 }
    [mechanism.cranks.A]
    radius = 0.56
    phase = -2.4
    [mechanism.sliders]
    S = { crank = "A", rod = 1.2 }
    T = { crank = "A", rod = 2.0, offset = 0.24, angle = 2.0 }
    [bodies]
    S = { mass = 270 }
    T = { mass = 19 }
    """)
    name, entry, step = "forces.torque_drive_max", "mechanism.cranks.A.phase", 1e-4
    found = lw.gradient(machine, [name], [entry])
    value = lw.get(machine, entry)

    def around(n):
        near = lw.replace(machine, {entry: value + n * step})
        return lw.forces(near, lw.steady_state(near, accuracy=1e-13)).torque_drive_max

    once, twice = ((around(n) - around(-n)) / (2 * n * step) for n in (1, 2))
    # Rounding of the speed is all that differences know of such a torque.
    assert found.derivatives[0, 0] == pytest.approx((4 * once - twice) / 3, rel=1e-4)
