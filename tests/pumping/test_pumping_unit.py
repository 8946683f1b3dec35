"""Pumping units: the engine against API's closed forms, catalogue, counterbalance."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import AssemblyError, FindingError, InputError, MachineError, pumping_unit, pumping_units
from linkwright.pumping.model.unit import PumpingUnit
from linkwright.pumping.model.unit_catalogue import catalogue_unit
from linkwright.pumping.unit import PumpingUnitMotion

INCH = 0.0254

EXAMPLE = Path(__file__).parents[2] / "examples" / "pumping_unit_torque" / "machine.toml"

# Proportions of a Mark II and of an air-balanced unit, made up: letters in metres. The equalizer bearing of
# a Mark II lies in front of the shaft.
CLASS_3 = {"A": 5.2, "C": 3.9, "I": 3.2, "P": 3.5, "H": 4.4, "G": 0.8, "R": 0.9}


def motion(unit: PumpingUnit, **drive: object) -> PumpingUnitMotion:
    return pumping_unit(lw.Machine(format=1, name="unit", pumping_unit=unit, drive=drive or None))


def class_3(geometry: str, **more: object) -> PumpingUnit:
    return PumpingUnit(**CLASS_3, geometry=geometry, **more)


def api(unit: PumpingUnit, theta: np.ndarray, phi: float) -> tuple[np.ndarray, np.ndarray]:
    """Torque factor and position of rods by API Spec 11E, φ the angle of K from the crank's zero.

    With the zero at 6 o'clock the figure of class III is that of class I, turned by 180° and mirrored, but
    the rod rises with ψ; API hides the sign in its α.
    """
    A, C, P, R = unit.A, unit.C, unit.P, unit.R
    K = np.hypot(unit.I, unit.H - unit.G)
    at = theta - phi
    beta = np.arccos((C**2 + P**2 - K**2 - R**2 + 2 * K * R * np.cos(at)) / (2 * C * P))
    J = np.sqrt(C**2 + P**2 - 2 * C * P * np.cos(beta))
    psi = np.arccos((C**2 + J**2 - P**2) / (2 * C * J)) - np.arcsin(R / J * np.sin(at))
    alpha = beta + psi - at
    ends = [np.arccos((C**2 + K**2 - (P + s * R) ** 2) / (2 * C * K)) for s in (1, -1)]
    rising = 1 if unit.is_class_3 else -1
    bottom, top = ends if rising < 0 else ends[::-1]
    return -rising * R * A / C * np.sin(alpha) / np.sin(beta), (psi - bottom) / (top - bottom)


def lean(unit: PumpingUnit) -> float:
    return float(np.arctan(unit.I / (unit.H - unit.G)))


THETA = np.arange(24) * np.pi / 12


@pytest.mark.parametrize("known", pumping_units(), ids=lambda known: known.designation)
def test_torque_factors_are_those_of_api(known) -> None:
    for hole in range(1, len(known.holes) + 1):
        unit = known.unit(hole)
        found = motion(unit)
        factors, positions = api(unit, THETA, lean(unit))
        # Rounding of an arc cosine between links of a metre, nothing more.
        np.testing.assert_allclose(found.torque_factors, factors, rtol=0, atol=1e-12)
        np.testing.assert_allclose(found.rod_positions, positions, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("geometry", "rotation", "sign"),
    [
        ("mark_ii", None, 1),
        ("mark_ii", "clockwise", -1),
        ("air_balanced", None, -1),
        ("air_balanced", "counter_clockwise", 1),
    ],
)
def test_class_3_by_api(geometry: str, rotation: str | None, sign: int) -> None:
    """From 6 o'clock counter-clockwise the saddle stands at 180° + atan(I/(H − G)); clockwise, back."""
    unit = class_3(geometry, rotation=rotation)
    found = motion(unit)
    factors, positions = api(unit, sign * THETA, np.pi + lean(unit))
    np.testing.assert_allclose(found.torque_factors, sign * factors, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found.rod_positions, positions, rtol=0, atol=1e-12)


def test_conventional_unit_turning_the_other_way() -> None:
    """The same places at the same positions of the crank, the torque factor with the other sign."""
    unit = catalogue_unit("C-114D-133-54").unit()
    other = PumpingUnit(**{**unit.model_dump(exclude_none=True), "rotation": "counter_clockwise"})
    usual, turned = motion(unit), motion(other)
    assert turned.rod_positions[1:] == pytest.approx(usual.rod_positions[:0:-1], abs=1e-12)
    assert turned.torque_factors[1:] == pytest.approx([-x for x in usual.torque_factors[:0:-1]], abs=1e-12)


def test_mark_ii_takes_longer_for_the_upstroke() -> None:
    """What the type is known for, as it turns by API; the other way round it is the downstroke."""
    ratio = motion(class_3("mark_ii")).stroke_ratio
    assert ratio > 1.04
    assert motion(class_3("mark_ii", rotation="clockwise")).stroke_ratio == pytest.approx(1 / ratio)


def test_stroke_is_reached_at_its_ends() -> None:
    for unit in (catalogue_unit("C-P57D-76-54").unit(2), class_3("mark_ii"), class_3("air_balanced")):
        found = motion(unit)
        phi = np.linspace(0, 2 * np.pi, 20001)
        machine = lw.Machine(format=1, name="unit", pumping_unit=unit)
        beam = lw.kinematics(machine, phi).links["beam.rocker"].angle
        # Samples of a parabola: the extremes are missed by the square of half a step.
        assert np.ptp(beam) * unit.A == pytest.approx(found.stroke, rel=1e-6)
        ends = lw.kinematics(machine, [found.bottom_angle, found.top_angle]).links["beam.rocker"]
        assert np.abs(ends.d1).max() < 1e-13
        assert found.upstroke_angle == pytest.approx((found.top_angle - found.bottom_angle) % (2 * np.pi))


def test_cable_carries_the_same_stroke() -> None:
    """The slide of the cable and the rotation of the beam are two ways to the polished rod."""
    known = catalogue_unit("C-114D-133-54").unit()
    # Turning counter-clockwise, its rear arm swings across 180°.
    other = PumpingUnit(**{**known.model_dump(exclude_none=True), "rotation": "counter_clockwise"})
    for unit in (known, other, class_3("mark_ii"), class_3("air_balanced")):
        found = motion(unit)
        machine = lw.Machine(format=1, name="unit", pumping_unit=unit)
        moved = lw.kinematics(machine, found.crank_angle)
        slide, hanger = moved.slides["polished_rod"], moved.points["polished_rod"]
        travel = found.stroke - found.rod_travel + unit.cable
        np.testing.assert_allclose(slide.position, travel, rtol=1e-13)
        np.testing.assert_allclose(slide.d1, -found.torque_factor, rtol=0, atol=1e-13)
        np.testing.assert_allclose(slide.d2, -found.torque_factor_d1, rtol=0, atol=1e-13)
        np.testing.assert_allclose(hanger.d1[:, 1], found.torque_factor, rtol=0, atol=1e-13)
        assert np.ptp(hanger.position[:, 0]) < 1e-14


def test_extremes_of_the_torque_factor() -> None:
    found = motion(catalogue_unit("C-114D-133-54").unit())
    fine = np.linspace(0, 2 * np.pi, 100001)
    factors = api(catalogue_unit("C-114D-133-54").unit(), fine, lean(catalogue_unit("C-114D-133-54").unit()))[
        0
    ]
    # The extreme of a parabola lies at most an eighth of the step's square above the samples.
    assert 0 <= found.torque_factor_max - factors.max() < 1e-8
    assert 0 <= factors.min() - found.torque_factor_min < 1e-8
    assert np.trapezoid(found.torque_factor, found.crank_angle) == pytest.approx(0, abs=1e-12)


def test_velocity_and_acceleration_at_speed() -> None:
    found = motion(catalogue_unit("C-114D-133-54").unit(), speed="10 rpm")
    omega = 10 * 2 * np.pi / 60
    assert found.rod_velocity_max == pytest.approx(found.torque_factor_max * omega)
    time = found.crank_angle / omega
    # A central difference of second order over a degree.
    differences = np.gradient(found.rod_velocity, time, edge_order=2)
    np.testing.assert_allclose(differences, found.rod_acceleration, atol=2e-3)
    assert motion(catalogue_unit("C-114D-133-54").unit()).rod_velocity is None


def test_strokes_of_the_catalogue_against_their_designations() -> None:
    """Designations name round inches; the mechanism is up to 1.8 in longer, never 0.3 in shorter."""
    off = {
        each.designation: float(each.unit(1).stroke - each.rating.stroke) / INCH for each in pumping_units()
    }
    assert len(off) == 27
    assert min(off.values()) > -0.3
    assert max(off.values()) < 1.8
    assert off["C-114D-133-54"] == pytest.approx(1.53, abs=0.01)
    assert off["C-P40D-76-48"] == pytest.approx(0.08, abs=0.01)


def test_designation() -> None:
    rating = catalogue_unit("c-p57d-89-42 ").rating
    assert rating.torque == pytest.approx(57000 * 4.4482216152605 * INCH)
    assert rating.load == pytest.approx(8900 * 4.4482216152605)
    with pytest.raises(MachineError, match='did you mean "C-114D-133-54"'):
        catalogue_unit("C-114D-133-45")
    with pytest.raises(InputError, match="hole 4"):
        catalogue_unit("C-114D-133-54").unit(4)


# -- counterbalance ------------------------------------------------------------------------------------------


def loaded(unit: PumpingUnit, **load: object):
    entries = unit.model_dump(exclude_none=True) | {"load": load}
    gear = motion(PumpingUnit(**entries)).gear
    assert gear is not None
    return gear


TABLE = {"position": [0, 1], "up": [45e3, 40e3], "down": [20e3, 15e3]}
CONVENTIONAL = catalogue_unit("C-114D-133-54").unit()


@pytest.mark.parametrize(
    "unit", [CONVENTIONAL, class_3("mark_ii"), class_3("air_balanced")], ids=lambda u: u.geometry
)
def test_best_counterbalance_has_equal_peaks(unit: PumpingUnit) -> None:
    gear = loaded(unit, **TABLE, efficiency=0.93)
    assert gear.torque_net_up == pytest.approx(gear.torque_net_down, rel=1e-12)
    size = gear.counterbalance or gear.counterbalance_effect
    key = "counterbalance_effect" if unit.geometry == "air_balanced" else "counterbalance"
    for factor in (0.95, 1.05):
        other = loaded(unit, **TABLE, efficiency=0.93, **{key: factor * size})
        assert max(other.torque_net_up, other.torque_net_down) > gear.torque_net_up


def test_work_is_that_of_the_load_alone() -> None:
    """Counterweights, and the unbalance, do no work over a revolution; losses add to it."""
    gear = loaded(CONVENTIONAL, **TABLE, counterbalance=2e4, phase=0.3)
    assert gear.torque_net_mean * 2 * np.pi == pytest.approx(gear.work, rel=1e-12)
    # 25 kN more on the way up, over the whole stroke; the loads jump where it turns.
    assert gear.work == pytest.approx(float(CONVENTIONAL.stroke) * 25e3, rel=1e-12)
    assert loaded(CONVENTIONAL, **TABLE, efficiency=0.9).torque_net_mean * 2 * np.pi > gear.work


def test_peaks_and_means_against_fine_samples() -> None:
    """A narrow peak of a table, a friction's jump: what 200 000 samples see, whose one is on the peak."""
    corners = np.array([0, 63_600, 63_663, 63_726, 127_000]) * 2 * np.pi / 200_000
    table = {"angle": list(corners), "force": [3e4, 3e4, 9e4, 3e4, 2e4]}
    load = {**table, "counterbalance": 1e4, "efficiency": 0.9}
    gear = loaded(CONVENTIONAL, **load)
    unit = PumpingUnit(**CONVENTIONAL.model_dump(exclude_none=True) | {"load": load})
    fine = pumping_unit(lw.Machine(format=1, name="unit", pumping_unit=unit), n=200_000).gear
    assert fine is not None
    net, is_up = fine.torque_net, fine.torque_rod >= 0
    assert gear.torque_net_up == pytest.approx(net[is_up].max(), rel=1e-9)
    assert gear.torque_net_min == pytest.approx(net.min(), rel=1e-8)
    assert gear.load_max == pytest.approx(9e4, rel=1e-12)
    assert gear.torque_net_mean == pytest.approx(np.trapezoid(net, fine.crank_angle) / (2 * np.pi), rel=1e-6)
    square = np.trapezoid(net**2, fine.crank_angle) / (2 * np.pi)
    assert gear.torque_net_rms == pytest.approx(np.sqrt(square), rel=1e-6)


def test_net_torque_by_its_formula() -> None:
    angles = np.radians([0, 90, 180, 270])
    gear = loaded(CONVENTIONAL, angle=list(angles), force=[3e4, 5e4, 4e4, 2e4], counterbalance=1e4, phase=0.2)
    unbalance = CONVENTIONAL.structural_unbalance
    factors = motion(CONVENTIONAL).torque_factor
    at = slice(0, None, 90)
    expected = factors[at] * (gear.rod_load[at] - unbalance) - 1e4 * np.sin(gear.crank_angle[at] + 0.2)
    np.testing.assert_allclose(gear.torque_net[at], expected, rtol=1e-12)
    np.testing.assert_allclose(gear.rod_load[at], [3e4, 5e4, 4e4, 2e4, 3e4])
    assert gear.torque_net_rms >= abs(gear.torque_net_mean)
    assert gear.cyclic_load_factor == pytest.approx(gear.torque_net_rms / gear.torque_net_mean)
    assert gear.gear_load == pytest.approx(max(gear.torque_net_up, gear.torque_net_down) / gear.torque_rated)


def test_phase_without_an_optimum_is_told() -> None:
    with pytest.raises(FindingError, match="phase"):
        loaded(CONVENTIONAL, **TABLE, phase=np.pi)


# -- description ---------------------------------------------------------------------------------------------

TEXT = """
format = 1
name = "unit"
[pumping_unit]
A = "72 in"
C = "64 in"
I = "64 in"
P = "74.5 in"
H = "116 in"
G = "41 in"
R = "24 in"
"""


def test_override_changes_the_stroke() -> None:
    short = lw.loads(TEXT, ["pumping_unit.R=16 in"])
    assert pumping_unit(short).stroke == pytest.approx(float(catalogue_unit("C-114D-133-54").unit(3).stroke))


def test_batch_over_an_entry() -> None:
    radii = np.array([16, 20, 24]) * INCH
    many = lw.replace(lw.loads(TEXT), {"pumping_unit.R": radii})
    found = lw.kinematics(many, np.linspace(0, 2 * np.pi, 721)).slides["polished_rod"].position
    assert found.shape == (3, 721)
    for n, radius in enumerate(radii):
        one = lw.replace(lw.loads(TEXT), {"pumping_unit.R": float(radius)})
        alone = lw.kinematics(one, np.linspace(0, 2 * np.pi, 721)).slides["polished_rod"].position
        np.testing.assert_allclose(found[n], alone, rtol=1e-14)


def test_bodies_and_loads_on_the_parts_of_a_unit() -> None:
    more = """
[bodies]
"beam.rocker" = { mass = "500 kg" }
rods = { on = "polished_rod", mass = "2000 kg" }
[loads]
rods = { kind = "force", on = "polished_rod", force = "20 kN", direction = "-90 deg" }
"""
    machine = lw.loads(TEXT + more)
    reduced = lw.reduction(machine, n=72)
    found = pumping_unit(machine, n=72)
    # A weight on the polished rod asks of the crank its size times the torque factor.
    np.testing.assert_allclose(reduced.torque_load, 20e3 * found.torque_factor, rtol=1e-10, atol=1e-7)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("[mechanism.points]\nsaddle = { x = 1 }\n", "the pumping unit has a part of this name"),
        ('[bodies]\nx = { on = "beem", mass = 1 }\n', 'did you mean "beam"'),
        (
            "[pumping_unit.load]\nposition = [0, 1]\nup = [1, 2]\n",
            "a list; position, up, down belong together",
        ),
        ("[pumping_unit.load]\ncounterbalance = 3\n", "either angle and force, or position, up and down"),
        (
            '[pumping_unit.load]\nangle = [0, 3]\nforce = [1, 2]\ncounterbalance = "best"\n',
            '"optimal", or a torque',
        ),
        ("[rod_rotator]\nregime = 'continuous'\npin_distance = '80 in'\n", "less than pumping_unit.A"),
        ("[rod_rotator]\nregime = 'continuous'\npin_distance = 1\nlink_length = 2\n", "given together"),
        (
            "[rod_rotator]\nregime = 'continuous'\npin_distance = 1\nswing = 1\n",
            "a swing is wanted of an intermittent",
        ),
    ],
)
def test_faults_are_told(more: str, message: str) -> None:
    with pytest.raises(MachineError) as error:
        lw.loads(TEXT + more)
    assert message in str(error.value)


def test_a_rotator_needs_a_unit() -> None:
    with pytest.raises(MachineError, match="pumping_unit"):
        lw.loads(
            "format = 1\nname = 'x'\n[mechanism]\n[rod_rotator]\nregime = 'continuous'\npin_distance = 1\n"
        )


def test_air_and_weights_are_not_mixed() -> None:
    load = {"angle": [0.0, 3.0], "force": [1.0, 2.0]}
    for geometry, key, remedy in (
        ("air_balanced", "counterbalance", "no counterweights"),
        ("mark_ii", "counterbalance_effect", "only air-balanced"),
    ):
        unit = CLASS_3 | {"geometry": geometry, "load": load | {key: 1.0}}
        with pytest.raises(MachineError, match=remedy):
            lw.Machine(format=1, name="unit", pumping_unit=unit)


def test_unit_that_does_not_close() -> None:
    with pytest.raises(AssemblyError, match="beam"):
        pumping_unit(lw.loads(TEXT, ["pumping_unit.R=70 in"]))


def test_no_unit() -> None:
    with pytest.raises(InputError, match="pumping_unit"):
        pumping_unit(lw.read("machines/roller_one_cart.toml"))


def test_an_overloaded_gearbox_is_a_finding() -> None:
    """110 % of the designation ends with exit code 1, as a limit of torsion does; below it there is none."""
    path = str(EXAMPLE)
    result = invoke("run", path, "--json")
    assert result.exit_code == 1
    (finding,) = json.loads(result.stdout)["findings"]
    assert "The gearbox is overloaded" in finding
    assert "110 % of its rating" in finding
    lighter = ["--set", 'pumping_unit.load.up=["26.6 kN", "37 kN", "35 kN"]']
    result = invoke("run", path, "--json", *lighter)
    assert (result.exit_code, json.loads(result.stdout)["findings"]) == (0, [])


def test_counterbalance_effect_of_weights() -> None:
    """Weights with M = E TF at 90° balance a load E + B at the rod there: the gearbox is free of torque."""
    machine = lw.read(EXAMPLE)
    found = pumping_unit(machine, n=3600)
    gear = found.gear
    assert gear is not None
    assert gear.counterbalance_effect is not None
    at = int(np.argmin(np.abs(gear.crank_angle - 0.5 * np.pi)))
    factor = gear.torque_rod[at] / (gear.rod_load[at] - machine.pumping_unit.structural_unbalance)  # type: ignore[union-attr]
    free = gear.torque_rod[at] + gear.torque_counterbalance[at]
    assert gear.counterbalance_effect == pytest.approx(gear.rod_load[at] - free / factor, rel=1e-9)
    table = invoke("run", EXAMPLE).stdout
    assert "counterbalance effect" in table
    assert "maximum moment of the counterweights" in table
