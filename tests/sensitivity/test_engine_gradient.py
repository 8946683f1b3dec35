"""Derivatives of frequencies and torques by the data of an engine and by the points of a coupling's curve,
against extrapolated differences of the same analyses.
"""

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError
from linkwright.kernel.numerics.differences import slopes
from linkwright.machine import exchanged

VEE, V8 = "machines/v_diesel.toml", "machines/v8_diesel.toml"


def _difference(machine, address, measure, step=2e-4):
    """Richardson's extrapolation of central differences with steps h and 2h: errors h⁴, rounding 1e-13/h."""
    value = lw.get(machine, address)
    h = step * (abs(value) or 1.0)
    at = {k: measure(exchanged(machine, {address: value + k * h})) for k in (-2, -1, 1, 2)}
    return (8 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12 * h)


def _frequencies(machine):
    return lw.free_vibration(machine).natural_frequencies


@pytest.mark.parametrize("path", [VEE, V8])
def test_frequencies_follow_rods_pistons_throws_and_couplings(path):
    """By every number of engine and coupling, to 1e-9 of the largest influence."""
    machine = lw.read(path)
    found = lw.gradient(machine, ["free_vibration.natural_frequencies"])
    assert set(found.refused.values()) <= {"the curve of a coupling starts at zero"}
    modes = [int(name.rsplit(".", 1)[-1]) for name in found.responses]
    size = np.where(found.at == 0.0, 1.0, np.abs(found.at))
    scale = np.abs(found.derivatives * size).max(axis=1)
    moving = [
        place
        for place, name in enumerate(found.variables)
        if name.startswith(("train.engine.", "train.couplings.")) and found.derivatives[:, place].any()
    ]
    assert {"radius", "length", "mass", "piston_mass", "diameter"} <= {
        found.variables[place].rsplit(".", 1)[-1] for place in moving
    }
    for place in moving:
        name = found.variables[place]
        measured = _difference(machine, name, _frequencies)[modes]
        error = np.abs(found.derivatives[:, place] - measured) * size[place]
        assert np.all(error <= 1e-9 * np.maximum(scale, 1e-3)), name


def test_frequencies_follow_every_shape_of_a_throw():
    """Drillings, a bore beside the middle, counterweights as lumps and sectors, webs of any outline."""
    base = lw.read(VEE)
    throw = base.train.engine.throw.model_dump(exclude_unset=True)
    radius, reach = throw["radius"], throw["pin"]["diameter"] + throw["radius"]
    corners = [(-reach, -reach), (1.5 * reach, -reach), (1.5 * reach, reach), (-reach, reach)]
    along, across = (tuple(corner[n] for corner in corners) for n in (0, 1))
    thick = throw["web"]["thickness"]
    webs = (
        {"outline": "polygon", "width": reach, "along": along, "across": across, "thickness": thick},
        {
            "outline": "rectangle",
            "width": reach,
            "length": 2.5 * reach,
            "centre": 0.4 * radius,
            "thickness": thick,
        },
    )
    extra = {
        "drillings": [{"diameter": 0.02, "length": 0.1, "radius": 0.5 * radius, "inclination": 0.3}],
        "counterweights": [
            {"mass": 4.0, "radius": 0.1, "inertia": 0.01, "direction": 3.0},
            {"outer_radius": 0.2, "inner_radius": 0.1, "angle": 1.5, "thickness": 0.03},
        ],
    }
    for web in webs:
        changed = lw.replace(base, {"train.engine.throw": throw | extra | {"web": web}})
        found = lw.gradient(changed, ["free_vibration.natural_frequencies.1"])
        places = [
            n for n, name in enumerate(found.variables) if ".throw." in name and found.derivatives[0, n]
        ]
        assert len(places) > 15
        scale = np.abs(found.derivatives * found.at).max()
        for place in places:
            measured = _difference(changed, found.variables[place], _frequencies)[1]
            error = abs(found.derivatives[0, place] - measured) * (abs(found.at[place]) or 1.0)
            assert error <= 1e-9 * scale, found.variables[place]


ACTING = {
    VEE: [
        *(
            "train.engine.rod.mass",
            "train.engine.piston_mass",
            "train.engine.throw.radius",
            "train.engine.bore",
        ),
        *("train.engine.articulated.pin_radius", "train.engine.gas.compression_ratio"),
        *("train.engine.gas.mean_effective_pressure", "train.engine.gas.walls.wall_temperature"),
        *(
            "train.loads.generator.torque",
            "train.discs.flywheel.inertia",
            "train.couplings.coupling.stiffness",
        ),
    ],
    V8: [
        *(
            "train.engine.rod.length",
            "train.engine.gas.releases.0.start",
            "train.engine.gas.charge_temperature",
        ),
        *(
            "train.couplings.coupling.twist.2",
            "train.couplings.coupling.torque.1",
            "train.loads.generator.torque",
        ),
        *("train.discs.generator.inertia", "train.dampers.damper.damping", "train.shafts.nose.stiffness"),
    ],
}


@pytest.mark.parametrize("path", ACTING)
def test_torques_of_shafts_follow_an_engine(path):
    """At the speeds of the peaks, to 1e-7 of the largest influence: gas, masses, the coupling on its curve,
    and the mean torque that an engine gives.
    """
    machine = lw.read(path)
    found = lw.gradient(machine, ["forced_vibration"], ACTING[path])
    assert found.variables == tuple(ACTING[path])
    response = lw.forced_vibration(machine)
    rows = [name.split(".")[1:] for name in found.responses]
    assert {kind for kind, _ in rows} == {"shaft_torque_vibratory", "shaft_torque_max"}
    peaks = [int(getattr(response, kind)[response.shafts.index(shaft)].argmax()) for kind, shaft in rows]
    speeds, nth = np.unique(response.speeds[peaks], return_inverse=True)

    def measure(changed):
        at = lw.forced_vibration(changed, speeds)
        listed = zip(rows, nth, strict=True)
        return np.array([getattr(at, kind)[at.shafts.index(shaft), n] for (kind, shaft), n in listed])

    # Cycles between the speeds at which they are computed are interpolated to 1e-9.
    assert measure(machine) == pytest.approx(found.values, rel=1e-8)
    scale = np.abs(found.derivatives * found.at).max(axis=1)
    for place, name in enumerate(found.variables):
        measured = _difference(machine, name, measure, 5e-5)
        error = np.abs(found.derivatives[:, place] - measured) * abs(found.at[place])
        assert np.all(error <= 1e-7 * scale), name


def test_counts_and_ends_of_a_range_are_refused():
    machine = lw.read(V8)
    for name, reason in (
        ("train.engine.strokes", "count"),
        ("train.engine.gas.releases.0.share", "limit of its range, 1"),
    ):
        with pytest.raises(InputError, match=reason):
            lw.gradient(machine, ["forced_vibration"], [name])


def _slopes(function, x):
    """Derivatives of one or more functions, each an array of its own."""
    return slopes(function, x, function(x))


def test_differences_of_smooth_functions_corners_and_kinks():
    """A cubic and a sine to rounding; a bend that jumps; kinks and NaN have none, also beside large ones."""
    smooth = _slopes(lambda x: (np.array([x**3, np.sin(x)]),), 0.7)
    assert smooth[0] == pytest.approx([3 * 0.49, np.cos(0.7)], rel=1e-9)
    bent = _slopes(lambda x: (np.array([x + 0.5 * max(x - 2.0, 0.0) ** 2]),), 2.0)
    assert bent[0] == pytest.approx([1.0], rel=1e-8)
    for kink in (lambda x: abs(x - 2.0), lambda x: abs(x - 2.0) + x, lambda x: abs(x - 2.00001) + x):
        assert _slopes(lambda x, kink=kink: (np.array([1e8 * x]), np.array([kink(x)])), 2.0) is None
    assert _slopes(lambda x: (np.array([x, np.nan * x]),), 1.0) is None
    assert _slopes(lambda _: (np.array([3.0]),), 0.5)[0] == pytest.approx([0.0], abs=0.0)
