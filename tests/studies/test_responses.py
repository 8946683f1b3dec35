"""Every analysis that a study knows gives the numbers of its result."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import MachineError, MachineFileError
from linkwright.studies.responses import ANALYSES, analysis
from linkwright.studies.slopes import slopes

DRIVE = ("roller_one_cart", "mechanism.cranks.A1.radius")
ROTATOR = ("rod_rotator_continuous", "pumping_unit.A")
TRAIN = ("v8_diesel", "train.discs.front.inertia")

WELL = Path(__file__).parents[1] / "samples" / "measured_well.toml"

# Analysis → a machine that has it, an entry that is a variable, a quantity; names of cams stand between.
CASES = {
    "reduction": (*DRIVE, "inertia_max"),
    "constant_energy": (*DRIVE, "unevenness"),
    "steady_state": (*DRIVE, "cyclic_load_factor"),
    "run_up": (*DRIVE, "time"),
    "run_down": (*DRIVE, "time"),
    "linkage": (*DRIVE, "period_turns"),
    "cycle_motion": (*DRIVE, "cart1.place.velocity.maximum"),
    "forces": (*DRIVE, "shaking_force_max"),
    "cam": ("roller_cam", "bodies.cart.mass", "cart.pressure_angle_max"),
    "cam_check": ("roller_cam", "bodies.cart.mass", "cart.n_faults"),
    "cam_force": ("roller_cam", "bodies.cart.mass", "cart.force_size"),
    "cylinder": ("scissor_lift_cylinder", "loads.load_B.force", "lift.force_max"),
    "axis": ("servo_carriage", "bodies.carriage.mass", "torque_max"),
    "dc_bus": ("servo_carriage", "bodies.carriage.mass", "power_max"),
    "elastic_motion": ("elastic_coupling_of_carts", "drive.crankshaft.stiffness", "period"),
    "elastic_run_up": ("elastic_coupling_of_carts", "drive.crankshaft.stiffness", "time"),
    "pumping_unit": (*ROTATOR, "stroke"),
    "rod_rotator": (*ROTATOR, "lever_swing"),
    "rod_string": ("rod_string", "rod_string.specific_gravity", "load_max"),
    "card_diagnosis": (str(WELL), "rod_string.specific_gravity", "plunger_stroke"),
    "turning_moment": ("flywheel_four_stroke", "turning_moment.speed", "flywheel_inertia"),
    "topper": ("topper", "topper.edge_length", "length_exact"),
    "topper_field": ("topper", "topper.edge_length", "share_complete"),
    "free_vibration": (*TRAIN, "natural_frequencies"),
    "damped_vibration": (*TRAIN, "damping_ratios"),
    "forced_vibration": (*TRAIN, "shaft_torque_vibratory"),
    "shaft_stress": (*TRAIN, "vibratory"),
}


@pytest.mark.parametrize("name", ANALYSES)
def test_a_study_gives_the_numbers_of_an_analysis(name: str, tmp_path: Path) -> None:
    machine, address, quantity = CASES[name]
    *of, attribute = quantity.split(".")
    is_list = name.endswith(("vibration", "stress"))
    asked = f"{name}.{quantity}"
    response = f'{{ curve = "{asked}", extreme = "max" }}' if is_list else f'"{asked}"'
    plan = lw.read_study(study(tmp_path, machine, address, response), allow_outside=True)
    rows = lw.evaluate(plan, {"entry": np.array([lw.get(plan.machine, address)])})
    assert rows.status.tolist() == [0], rows.reasons
    if name == "cycle_motion":
        result = lw.cycle_motion(lw.read(machine)).extremes[".".join(of)]
    else:
        result = analysis(name)(lw.read(machine), *of)
    by_itself = np.max(getattr(result, attribute))
    # A batch and a single machine agree to the accuracy of the batch.
    assert rows.columns["number"][0] == pytest.approx(by_itself, rel=1e-6)


def test_former_names_of_analyses_are_read(tmp_path: Path) -> None:
    """`rotator` is `rod_rotator`, and `gear_torque` stands within the pumping unit."""
    for name, asked in {
        "rotator.transfer_max": "rod_rotator.transfer_max",
        "gear_torque.work": "pumping_unit.gear.work",
    }.items():
        machine = ROTATOR[0] if name.startswith("rotator") else "pumping_unit_torque"
        numbers = []
        for response in (name, asked):
            plan = lw.read_study(study(tmp_path, machine, "pumping_unit.A", f'"{response}"'))
            rows = lw.evaluate(plan, {"entry": np.array([lw.get(plan.machine, "pumping_unit.A")])})
            numbers.append(rows.columns["number"][0])
        assert numbers[0] == numbers[1]


def test_reasons_are_those_of_rows(tmp_path: Path) -> None:
    """The third row has no machine, and nothing else is wrong with any."""
    plan = lw.read_study(study(tmp_path, *DRIVE, '"reduction.inertia_max"'))
    assert lw.evaluate(plan, {"entry": np.array([0.1, 0.2])}).reasons == [""]
    rows = lw.evaluate(plan, {"entry": np.array([0.1, 0.2, 50.0])})
    assert rows.status.tolist() == [0, 0, 1]
    assert rows.reasons == ["", rows.why(2)]
    assert rows.failures() == {rows.why(2): 1}


def study(tmp_path: Path, machine: str, address: str, response: str) -> Path:
    path = tmp_path / "study.toml"
    path.write_text(
        f'machine = "{machine}"\n[variables.entry]\naddress = "{address}"\nvalues = [1.0]\n'
        f"[responses]\nnumber = {response}\n",
        encoding="utf-8",
    )
    return path


def test_one_shaft_of_a_train(tmp_path: Path) -> None:
    """Its curve alone, while without a name all shafts count."""
    response = '{ curve = "forced_vibration.nose.shaft_torque_vibratory", extreme = "max" }'
    plan = lw.read_study(study(tmp_path, *TRAIN, response))
    rows = lw.evaluate(plan, {"entry": np.array([lw.get(plan.machine, TRAIN[1])])})
    forced = lw.forced_vibration(lw.read(TRAIN[0]))
    curve = forced.shaft_torque_vibratory[forced.shafts.index("nose")]
    assert rows.columns["number"][0] == pytest.approx(curve.max(), rel=1e-12)
    assert curve.max() < forced.shaft_torque_vibratory.max()


# File and entry → responses by the names that `linkwright sensitivity` has for them.
SAME_NAMES = {
    ("pumping_unit_torque", "pumping_unit.R"): ["pumping_unit.gear.torque_net_rms", "pumping_unit.gear.work"],
    ("elastic_coupling_of_carts", "drive.crankshaft.stiffness"): [
        "elastic_motion.torque_max.crankshaft",
        "elastic_motion.unevenness.crank",
    ],
    TRAIN: [
        "free_vibration.natural_frequencies.2",
        "free_vibration.mode_shapes.2.front",
        "forced_vibration.shaft_torque_max.nose",
        "forced_vibration.shaft_torque_vibratory.crank_1",
    ],
}


@pytest.mark.parametrize(("of", "name"), [(of, name) for of, names in SAME_NAMES.items() for name in names])
def test_names_of_derivatives_are_names_of_responses(of: tuple[str, str], name: str, tmp_path: Path) -> None:
    """With the same number, and the same derivative in a study."""
    plan = lw.read_study(study(tmp_path, *of, f'"{name}"'))
    gradient = lw.gradient(plan.machine, [name], [of[1]])
    at = np.array([lw.get(plan.machine, of[1])])
    found = slopes(plan, at, 1e-3 * at)
    assert found.values["number"] == pytest.approx(gradient.values[0], rel=1e-12)
    assert found.slopes["number"] == pytest.approx(gradient.derivatives[0], rel=1e-9)
    assert found.exact == {"number"}


def test_a_result_within_another_is_called_as_run_calls_it(tmp_path: Path) -> None:
    of = ("pumping_unit_torque", "pumping_unit.R")
    plan = lw.read_study(study(tmp_path, *of, '{ curve = "gear_torque.torque_net", extreme = "max" }'))
    rows = lw.evaluate(plan, {"entry": np.array([lw.get(plan.machine, of[1])])})
    gear = lw.pumping_unit(plan.machine).gear
    assert gear is not None
    assert rows.columns["number"][0] == gear.torque_net.max()


def test_stress_of_a_throw_is_a_response(tmp_path: Path) -> None:
    response = '{ curve = "shaft_stress.crank_2.vibratory", extreme = "max" }'
    plan = lw.read_study(study(tmp_path, *TRAIN, response))
    rows = lw.evaluate(plan, {"entry": np.array([lw.get(plan.machine, TRAIN[1])])})
    stress = lw.shaft_stress(plan.machine)
    assert rows.columns["number"][0] == stress.vibratory[stress.shafts.index("crank_2")].max()


WRONG = {
    '{ curve = "shaft_stress.nose.vibratory", extreme = "max" }': TRAIN,
    '"pumping_unit.gear.stroke"': ("pumping_unit_torque", "pumping_unit.R"),
    '"forced_vibration.shaft_torque_max.bow"': TRAIN,
    '"cam.valve.pressure_angle_max"': ("roller_cam", "bodies.cart.mass"),
    '"steady_state.cart.unevenness"': DRIVE,
    '{ curve = "forced_vibration.bow.shaft_torque_vibratory", extreme = "max" }': TRAIN,
    '{ curve = "forced_vibration.shaft_torque_vibratory", index = 1 }': TRAIN,
    '{ curve = "forced_vibration.nose.shaft_torques", index = 1 }': TRAIN,
    '{ curve = "forces.shaking_force", index = 1 }': DRIVE,
}


@pytest.mark.parametrize("response", WRONG)
def test_parts_that_do_not_exist_are_refused(response: str, tmp_path: Path) -> None:
    with pytest.raises(MachineFileError, match=r"responses\.number"):
        lw.read_study(study(tmp_path, *WRONG[response], response))


def test_a_place_beyond_the_end_of_a_list_is_refused_before_a_row_is_computed(tmp_path: Path) -> None:
    response = '{ curve = "free_vibration.natural_frequencies", index = 999 }'
    with pytest.raises(MachineFileError, match=r"expected: 0 to \d+: the list has") as error:
        lw.read_study(study(tmp_path, *TRAIN, response))
    assert "study.toml:6: responses.number.index" in str(error.value)
    last = len(lw.free_vibration(lw.read(TRAIN[0])).natural_frequencies) - 1
    plan = lw.read_study(study(tmp_path, *TRAIN, response.replace("999", str(last))))
    assert lw.evaluate(plan, {"entry": np.array([lw.get(plan.machine, TRAIN[1])])}).status[0] == 0
    with pytest.raises(MachineFileError, match=r"responses\.number"):
        lw.read_study(study(tmp_path, *TRAIN, response.replace("999", str(last + 1))))


@pytest.mark.parametrize(
    "quantity", ["unevenness", "dynamism", "motion_coefficient", "speed_mean_time", "speed_min"]
)
def test_what_a_batch_gives_is_computed_for_all_rows_at_once(quantity: str) -> None:
    """Row by row, a sweep takes a hundred times as long."""
    machines = Path(__file__).parents[2] / "machines"
    tables = {
        "variables": {"radius": {"address": "mechanism.cranks.A1.radius", "range": [0.19, 0.21], "steps": 2}},
        "responses": {"it": f"steady_state.{quantity}"},
    }
    plan = lw.new_study(lw.read(machines / "roller_two_carts.toml"), tables)
    assert all(asked.is_batch for asked in plan.asked)


EXAMPLES = Path(__file__).parents[2] / "examples"
STUDIES = sorted(path for path in EXAMPLES.glob("*/*.toml") if "[variables." in path.read_text("utf-8"))


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_shipped_studies_are_computed_at_once(path: Path) -> None:
    """As far as the core gives what they ask for; a batch that is refused is said."""
    plan = lw.read_study(path)
    if plan.asked and all(asked.is_batch for asked in plan.asked):
        rows = lw.evaluate(plan, plan.values(np.array([[0.3] * len(plan.axes), [0.6] * len(plan.axes)])))
        assert not rows.one_by_one


def test_rows_that_are_computed_one_by_one_say_so(tmp_path: Path) -> None:
    """A motor that is rated beyond its synchronous speed is none, and the core is given no such batch."""
    machine = lw.read(DRIVE[0])
    rated = lw.get(machine, "drive.motor.speed_rated")
    tables = {
        "variables": {"rated": {"address": "drive.motor.speed_rated", "values": [rated, 3 * rated]}},
        "responses": {"delta": "steady_state.unevenness"},
    }
    plan = lw.new_study(machine, tables)
    assert not lw.evaluate(plan, {"rated": np.array([rated])}).one_by_one
    rows = lw.evaluate(plan, {"rated": np.array([rated, 3 * rated])})
    assert rows.status.tolist() == [0, 2]
    ((why, count),) = rows.one_by_one.items()
    assert "drive.motor.speed_rated" in why
    assert count == 2
    assert lw.sweep(plan, tmp_path / "rows").one_by_one == {why: 2}
    assert "2 rows were computed one by one" in _warnings("sweep", "show", str(tmp_path / "rows"))


def _warnings(*arguments: str) -> str:
    done = invoke(*arguments, "--json")
    return "\n".join(json.loads(done.stdout)["warnings"])


_DRIVE_FILE = Path(__file__).parents[2] / "machines" / "roller_one_cart.toml"

_SCATTERS = """
[study.variables.rated]
address = "drive.motor.speed_rated"
tolerance = "± 5 rad/s"
cost = 1
[study.responses]
delta = "steady_state.unevenness"
[study.constraints.delta]
max = 0.5
"""

_VARIES = """
[study.variables.rated]
address = "drive.motor.speed_rated"
range = ["95 rad/s", "110 rad/s"]
[study.responses]
delta = "steady_state.unevenness"
period = "steady_state.period"
[study.goals]
delta = "minimise"
"""


@pytest.mark.parametrize(
    ("study", "command"),
    [
        (_SCATTERS, ("tolerance", "--rows", "100")),
        (_SCATTERS, ("tolerance", "--rows", "100", "--allocate", "0.5")),
        (_VARIES, ("optimise", "--evaluations", "20")),
        (_VARIES + 'period = "minimise"\n', ("optimise", "--evaluations", "20", "--points", "3")),
    ],
)
def test_every_study_says_what_is_computed_one_by_one(
    study: str, command: tuple[str, ...], tmp_path: Path
) -> None:
    """A rated speed beyond the synchronous one in a population refuses its batch."""
    path = tmp_path / "machine.toml"
    path.write_text(_DRIVE_FILE.read_text("utf-8") + study, "utf-8")
    assert "rows were computed one by one" in _warnings(command[0], str(path), *command[1:])


def test_a_search_that_goes_on_knows_what_was_computed_one_by_one(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(_DRIVE_FILE.read_text("utf-8") + _VARIES, "utf-8")
    plan, log = lw.read_study(path), tmp_path / "search.log"
    first, second = (lw.optimise(plan, 20, method="global", log=log).one_by_one for _ in range(2))
    assert first == second
    # All populations but the first.
    assert sum(first.values()) >= 12


def test_a_derived_entry_out_of_range_is_refused_as_in_a_machine(tmp_path: Path) -> None:
    """A rod of 8e149 m is no length, and its row alone has no answer; all others are computed at once."""
    text = study(tmp_path, *DRIVE, '"steady_state.unevenness"').read_text("utf-8")
    derived = (
        '[derived.rod]\nformula = "exp(1720*(entry - 0.2)) * 0.8"\naddress = "mechanism.sliders.cart1.rod"\n'
    )
    path = tmp_path / "derived.toml"
    path.write_text(text.replace("[responses]", f"{derived}[responses]"), "utf-8")
    rows = lw.evaluate(lw.read_study(path), {"entry": np.array([0.2, 0.4, 0.2001])})
    assert rows.columns["rod"][1] > 1e149
    assert rows.status.tolist() == [0, 2, 0]
    assert rows.why(1).startswith("mechanism.sliders.cart1.rod: expected a length greater than 0")
    assert not rows.one_by_one
    with pytest.raises(MachineError, match="at most 1e\\+06 m"):
        lw.replace(lw.read(DRIVE[0]), {"mechanism.sliders.cart1.rod": np.array([0.8, 8e149])})


DIGITS = """
format = 1
name = "Slider-crank with a crank called 1"
[mechanism.cranks.1]
radius = 0.1
[mechanism.sliders.P]
crank = "1"
rod = 0.3
[bodies]
P = { mass = 2.0 }
[drive]
speed = 10.0
"""


def test_a_part_whose_name_is_a_number_is_no_place_in_a_list(tmp_path: Path) -> None:
    (tmp_path / "digits.toml").write_text(DIGITS)
    of = (str(tmp_path / "digits.toml"), "bodies.P.mass")
    plan = lw.read_study(study(tmp_path, *of, '"forces.reaction_max.1"'))
    rows = lw.evaluate(plan, {"entry": np.array([2.0])})
    assert rows.columns["number"][0] == pytest.approx(lw.forces(plan.machine).reaction_max["1"], rel=1e-12)


def test_what_is_wrong_with_a_name_is_told_as_it_was_written(tmp_path: Path) -> None:
    name = "forced_vibration.shaft_torque_vibratory.bow"
    with pytest.raises(MachineFileError, match=rf'responses\.number\.quantity(.|\n)*"{name}"'):
        lw.read_study(study(tmp_path, *TRAIN, f'"{name}"'))
