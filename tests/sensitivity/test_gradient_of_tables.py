"""Derivatives by the values of tables: a table whose points follow a law has the derivatives of that law, by
the chain rule; so a machine with the law itself is the check, without a difference.
"""

import numpy as np
import pytest

import linkwright as lw
from linkwright.kernel.errors import InputError

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


def test_torque_over_speed_and_places():
    """A load over speed on a straight line; the places of its points are refused with the reason."""
    speeds = [0.0, 5.0, 20.0]
    machine = _with_load({"kind": "torque_speed", "speed": speeds, "torque": [8.0 * w for w in speeds]})
    _, along = _summed(machine, ["steady_state.energy_load"], "torque", np.array(speeds))
    viscous = _with_load({"kind": "viscous", "on": "A1", "damping_torsional": 8.0})
    expected = lw.gradient(viscous, ["steady_state.energy_load"], ["loads.more.damping_torsional"])
    assert along[0] == pytest.approx(expected.derivatives[0, 0], rel=1e-8)
    with pytest.raises(InputError, match="place of a point"):
        lw.gradient(machine, ["steady_state.unevenness"], ["loads.more.speed.1"])
