"""Derivatives by the points of tables. A table whose points follow a law has the derivatives of that law, by
the chain rule; so a machine with the law itself is the check of its values, without a difference. Places are
checked by differences of the same analyses.
"""

import numpy as np
import pytest
from test_gradient_of_laws import _forces, _run_up, _steady, errors

import linkwright as lw
from linkwright import FindingError, InputError

CART = "machines/roller_one_cart.toml"

# Crank angles of a table over the revolution.
ANGLES = (0.0, 1.0, 2.5, 4.0, 5.5)


def _with_load(load, *, rolling=True):
    """The drive of one cart with a load more, on the slider's line from a point of the frame."""
    machine = lw.read(CART).model_dump(by_alias=True, exclude_unset=True)
    machine["mechanism"]["points"] = {"W": {"x": 1.5, "y": 0.3}}
    loads = machine["loads"] if rolling else {"gravity": machine["loads"]["gravity"]}
    return lw.Machine.model_validate(machine | {"loads": loads | {"more": load}})


# By law: a machine with the law, its entry, a machine with the table, its values' key, and how they follow
# the entry.
LENGTHS, SPEEDS = np.linspace(0.2, 1.4, 7), np.linspace(-4.0, 4.0, 5)
CASES = {
    "torque": (
        {"kind": "torque", "on": "A1", "torque": -90.0},
        "torque",
        {"kind": "torque_angle", "angle": list(ANGLES), "torque": [90.0] * len(ANGLES)},
        "torque",
        -np.ones(len(ANGLES)),
    ),
    "resistance": (
        {"kind": "dry", "on": "cart1", "force": 800.0},
        "force",
        {
            "kind": "force_position",
            "on": "cart1",
            "position": [0.5, 0.7, 1.1],
            "forward": [800.0] * 3,
            "return": [800.0] * 3,
        },
        ("forward", "return"),
        np.ones(6),
    ),
    "spring": (
        {"kind": "spring", "between": ["cart1", "W"], "stiffness": 900.0, "free_length": 0.7},
        "stiffness",
        {
            "kind": "spring",
            "between": ["cart1", "W"],
            "length": LENGTHS.tolist(),
            "force": (900.0 * (LENGTHS - 0.7)).tolist(),
        },
        "force",
        LENGTHS - 0.7,
    ),
    "damper": (
        {"kind": "damper", "between": ["cart1", "W"], "damping": 150.0},
        "damping",
        {
            "kind": "damper",
            "between": ["cart1", "W"],
            "velocity": SPEEDS.tolist(),
            "force": (150.0 * SPEEDS).tolist(),
        },
        "force",
        SPEEDS,
    ),
}


def _summed(machine, responses, keys, follow):
    """Derivatives along a change of all values of a table of the load."""
    keys = [keys] if isinstance(keys, str) else keys
    entries = [f"loads.more.{key}.{i}" for key in keys for i in range(len(follow) // len(keys))]
    found = lw.gradient(machine, responses, entries)
    assert list(found.variables) == entries
    return found, found.derivatives @ follow


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("analysis", ["steady_state", "run_up", "forces"])
def test_values_of_a_load_follow_its_law(name, analysis):
    """To 1e-8 of the largest: the accuracy of the motions."""
    law, entry, table, keys, follow = CASES[name]
    one, two = _with_load(law), _with_load(table)
    expected = lw.gradient(one, [analysis], [f"loads.more.{entry}"])
    found, along = _summed(two, [analysis], keys, np.asarray(follow))
    compared = 0
    for row, response in enumerate(found.responses):
        if response not in expected.responses or not np.isfinite(found.values[row]):
            continue
        place = expected.responses.index(response)
        size = max(abs(expected.values[place]), 1e-9)
        assert found.values[row] == pytest.approx(expected.values[place], rel=2e-8, abs=1e-9), response
        error = abs((along[row] - expected.derivatives[place, 0]) * lw.get(one, f"loads.more.{entry}"))
        assert error <= 2e-8 * max(size, np.abs(found.derivatives[row] * found.at).max()), response
        compared += 1
    assert compared >= 2


def test_values_of_a_motor_follow_its_line():
    """A motor of two points is a line: by its stall torque both values move, one up and one down."""
    machine = lw.read(CART).model_dump(by_alias=True, exclude_unset=True)
    stall, no_load = 400.0, 120.0
    kinds = [
        {"kind": "dc", "torque_stall": stall, "speed_no_load": no_load, "inertia": 0.05},
        {"kind": "table", "speed": [0.0, 2 * no_load], "torque": [stall, -stall], "inertia": 0.05},
    ]
    line, table = (
        lw.Machine.model_validate(machine | {"drive": machine["drive"] | {"motor": motor}}) for motor in kinds
    )
    for analysis in ("steady_state", "run_up"):
        expected = lw.gradient(line, [analysis], ["drive.motor.torque_stall"])
        found = lw.gradient(table, [analysis], ["drive.motor.torque.0", "drive.motor.torque.1"])
        assert found.responses == expected.responses
        along = found.derivatives @ [1.0, -1.0]
        assert np.all(np.abs(along - expected.derivatives[:, 0]) <= 2e-8 * np.abs(found.values) / stall)


def test_torque_over_speed():
    """A load over speed on a straight line."""
    speeds = [0.0, 5.0, 20.0]
    machine = _with_load({"kind": "torque_speed", "speed": speeds, "torque": [8.0 * w for w in speeds]})
    _, along = _summed(machine, ["steady_state.energy_load"], "torque", np.array(speeds))
    viscous = _with_load({"kind": "viscous", "on": "A1", "damping_torsional": 8.0})
    expected = lw.gradient(viscous, ["steady_state.energy_load"], ["loads.more.damping_torsional"])
    assert along[0] == pytest.approx(expected.derivatives[0, 0], rel=1e-8)


# Tables with corners inside the motion, and the key of their places.
CORNERS = {
    "angle": (
        {"kind": "torque_angle", "angle": list(ANGLES), "torque": [90.0, 300.0, 50.0, -100.0, 120.0]},
        "angle",
    ),
    "position": (
        {
            "kind": "force_position",
            "on": "cart1",
            "position": [0.5, 0.7, 1.1],
            "forward": [800.0, 2000.0, 300.0],
            "return": [500.0, 100.0, 900.0],
        },
        "position",
    ),
    "spring": (
        {
            "kind": "spring",
            "between": ["cart1", "W"],
            "length": [0.3, 0.6, 0.9, 1.2],
            "force": [-300.0, -20.0, 100.0, 900.0],
        },
        "length",
    ),
    "damper": (
        {
            "kind": "damper",
            "between": ["cart1", "W"],
            "velocity": [-3.0, -0.4, 0.1, 0.5, 3.0],
            "force": [-400.0, -150.0, 50.0, 250.0, 300.0],
        },
        "velocity",
    ),
    "speed": (
        {"kind": "torque_speed", "speed": [0.0, 8.5, 10.7, 20.0], "torque": [10.0, 100.0, 180.0, 300.0]},
        "speed",
    ),
}

MOTORS = {
    "curve": (
        {
            "kind": "table",
            "speed": [0.0, 60.0, 95.0, 104.0, 120.0],
            "torque": [60.0, 150.0, 120.0, 10.0, -200.0],
            "inertia": 0.05,
        },
        "speed",
    ),
    "limited": (
        {
            "kind": "dc",
            "torque_stall": 900.0,
            "speed_no_load": 120.0,
            "torque_max": 150.0,
            "inertia": 0.05,
        },
        ("torque_max", "torque_stall", "speed_no_load"),
    ),
}


def _places(machine, where, keys):
    """Entries of the places of a table that are not zero; each goes by its own size."""
    keys = (keys,) if isinstance(keys, str) else keys
    starts = tuple(f"{where}.{key}" for key in keys)
    listed = [name for name in lw.addresses(machine) if name.startswith(starts)]
    return [{name: abs(lw.get(machine, name))} for name in listed if lw.get(machine, name)]


@pytest.mark.parametrize("measure", [_steady, _run_up, _forces])
@pytest.mark.parametrize("name", [*CORNERS, *MOTORS])
def test_places_of_points_move_as_differences_do(name, measure):
    """To 1e-7 of the largest: what differences are good for."""
    if name in CORNERS:
        table, key = CORNERS[name]
        machine = _with_load(table)
        ways = _places(machine, "loads.more", key)
    else:
        motor, key = MOTORS[name]
        described = lw.read(CART).model_dump(by_alias=True, exclude_unset=True)
        drive = described["drive"] | {"motor": motor}
        machine = lw.Machine.model_validate(described | {"drive": drive})
        ways = _places(machine, "drive.motor", key)
    off = errors(machine, measure, ways)
    assert len(off) >= 3
    assert max(off.values()) <= 1e-7, {k: f"{v:.1e}" for k, v in off.items() if v > 1e-7}


def test_a_point_that_slides_along_its_line_changes_nothing():
    """Place and value together, where both lines beside the point have one slope."""
    speeds = [0.0, 8.5, 10.7, 20.0]
    machine = _with_load({"kind": "torque_speed", "speed": speeds, "torque": [8.0 * w for w in speeds]})
    entries = ["loads.more.speed.1", "loads.more.torque.1"]
    found = lw.gradient(machine, ["steady_state", "run_up"], entries)
    along = found.derivatives @ [1.0, 8.0]
    assert np.all(np.abs(along) <= 1e-9 * np.abs(found.derivatives).max(axis=1) + 1e-12)


def test_ends_of_a_table_that_closes_are_refused():
    closing = {"kind": "torque_angle", "angle": [0.0, 1.0, 2 * np.pi], "torque": [90.0, 300.0, 90.0]}
    machine = _with_load(closing)
    found = lw.gradient(machine, ["steady_state.unevenness"])
    ends = {"loads.more.angle.0", "loads.more.angle.2"}
    assert {name for name in found.refused if ".angle." in name} == ends
    with pytest.raises(InputError, match="the table closes"):
        lw.gradient(machine, ["steady_state.unevenness"], ["loads.more.angle.0"])


# The motor's curve has a point at 104 rad/s, the crank's speed there by the ratio of 9.8.
AT_RATED = 104.0 / 9.8


def _sharing(others):
    """Tables with a point at one speed, and the addresses of their places there."""
    fan = {"kind": "torque_speed", "speed": [0.0, 8.5, 20.0], "torque": [10.0, 60.0, 300.0]}
    described = _with_load(fan).model_dump(by_alias=True, exclude_unset=True)
    speed = AT_RATED if others == "motor" else 10.6
    table = {"kind": "torque_speed", "speed": [0.0, speed, 20.0], "torque": [0.0, 30.0, 400.0]}
    if others == "motor":
        described["drive"]["motor"] = MOTORS["curve"][0]
    loads = {f"fan {n}": table for n in range(1 if others == "motor" else 1 + others)}
    machine = lw.Machine.model_validate(described | {"loads": described["loads"] | loads})
    state = lw.steady_state(machine)
    assert state.speed_min < speed < state.speed_max
    places = [f'loads."{name}".speed.1' for name in loads]
    return machine, [*places, "drive.motor.speed.3"] if others == "motor" else places


@pytest.mark.parametrize("analysis", ["steady_state", "run_up", "forces"])
@pytest.mark.parametrize("others", [1, 2, "motor"])
def test_places_that_would_part_kinks_at_one_speed_are_refused(others, analysis):
    """The place of one moves away from those of the others; the other entries move all of them together."""
    machine, places = _sharing(others)
    found = lw.gradient(machine, [analysis])
    assert {*places} <= {*found.refused}
    assert all("separate" in found.refused[name] for name in places)
    if others == "motor":
        # The ratio moves the kink of the motor alone.
        assert "drive.gearbox.ratio" in found.refused
    with pytest.raises(FindingError, match="two kinks at one speed separate"):
        lw.gradient(machine, [analysis], places[:1])


@pytest.mark.parametrize("measure", [_steady, _run_up, _forces])
@pytest.mark.parametrize("others", [1, 2, "motor"])
def test_values_beside_kinks_at_one_speed(others, measure):
    machine, places = _sharing(others)
    values = [name.replace("speed", "torque") for name in places]
    off = errors(machine, measure, [{name: abs(lw.get(machine, name))} for name in values])
    assert len(off) >= 3
    assert max(off.values()) <= 1e-7, {key: f"{x:.1e}" for key, x in off.items() if x > 1e-7}
