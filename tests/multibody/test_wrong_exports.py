"""What models of multibody dynamics cannot hold is refused with its place and a remedy."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from tests.multibody.test_mujoco import SIX_BAR

import linkwright as lw
from linkwright.app.application import application

ROOT = Path(__file__).parents[2]


def run(*arguments: str) -> tuple[int, str]:
    """Exit code and messages of the command line."""
    result = CliRunner().invoke(application(), ["export", *arguments])
    return result.exit_code, result.stderr


REFUSED = {
    "cam": (["roller_cam", "--to", "mjcf"], "mechanism.cams.cart", "linkwright motion"),
    "axes": (["servo_press", "--to", "urdf"], "axes", "leave it out"),
    "elastic": (["elastic_coupling_of_carts", "--to", "mjcf"], "drive", "stiffness"),
    "train": (["viscous_damper", "--to", "mjcf"], "mechanism", "a linkage with rigid links"),
    "no crank": (["scissor_lift", "--to", "mjcf"], "mechanism.cranks", "a crank"),
    "cylinder": (["scissor_lift_cylinder", "--to", "urdf"], "mechanism.cylinders.lift", "linkwright motion"),
    "motor": (["roller_one_cart", "--to", "mjcf"], "drive.motor", "--leave-out motor"),
    "efficiency": (["roller_one_cart", "--to", "mjcf"], "drive.gearbox.efficiency", "set 1"),
    "load": (["topper_crank", "--to", "mjcf"], "loads.cutting", "--leave-out cutting"),
    "law": (
        ["press_motion", "--to", "mjcf", "--set", "mechanism.cranks.A.law=0.5*sin(phi)"],
        "mechanism.cranks.A.law",
        "linkwright motion",
    ),
}


@pytest.mark.parametrize("name", list(REFUSED))
def test_refusals_name_key_and_remedy(name: str) -> None:
    """Exit code 2, with file and line, key and remedy."""
    arguments, key, remedy = REFUSED[name]
    code, message = run(*arguments)
    assert code == 2
    assert f": {key}\n" in message
    assert message.startswith(f"{arguments[0]}:")
    assert remedy in message


WRONG = {
    "format": ["press_motion"],
    "table": ["press_motion", "--to", "mjcf", "--table", "x.csv"],
    "speed": ["press_motion", "--to", "urdf", "--speed", "3 rad/s"],
    "two speeds": ["press_motion", "--to", "mjcf", "--speed", "3 rad/s", "--from-speed", "3 rad/s"],
    "step": ["press_motion", "--to", "mjcf", "--step", "0 s"],
    "nobody": ["press_motion", "--to", "mjcf", "--leave-out", "nobody"],
    "folder": ["press_motion", "--to", "mjcf", "--out", "no/such/folder/x.xml"],
}


@pytest.mark.parametrize("name", list(WRONG))
def test_wrong_options_are_refused(name: str) -> None:
    """Exit code 2 and a message about the option."""
    code, message = run(*WRONG[name])
    assert code == 2
    assert message


def test_positions_that_do_not_close_are_findings() -> None:
    """A mechanism that does not close at the initial angle, or all round, ends with exit code 1."""
    assert run("log_function_generator", "--to", "mjcf", "--from-angle", "-45 deg")[0] == 1
    assert run("log_function_generator", "--to", "urdf")[0] == 1


LOADS = {
    "a spring by a curve": 'kind = "spring", between = ["B", "K"], length = "0, 1 m", force = "0, 5 N"',
    "dry friction on a point": 'kind = "dry", on = "K", force = "3 N"',
    "dry friction on a link without mass": 'kind = "dry", on = "S.rod", torque = "1 N m"',
    "a force that turns with another link": 'kind = "force", on = "K", force = "3 N", along = "A"',
    "a spring wound by revolutions": 'kind = "torsional_spring", on = "A", stiffness = "1 N m/rad"',
}


@pytest.mark.parametrize("name", list(LOADS))
def test_loads_without_a_linear_law_are_refused_or_left_out(name: str) -> None:
    """Each is an input error, and an export without it succeeds."""
    machine = lw.loads(SIX_BAR + f"odd = {{ {LOADS[name]} }}\n")
    with pytest.raises(lw.InputError, match=r"loads\.odd"):
        lw.mjcf(machine)
    assert "loads.odd" not in lw.mjcf(machine, leave_out=["odd"]).text


def test_files_hold_what_the_results_say(tmp_path: Path) -> None:
    """--out writes the model and --table its table; neither replaces a file without --force."""
    model, table = tmp_path / "press.urdf", tmp_path / "press.csv"
    arguments = ["press_motion", "--to", "urdf", "--out", str(model), "--table", str(table)]
    assert run(*arguments)[0] == 0
    machine = lw.read(ROOT / "examples" / "press_motion" / "machine.toml")
    assert model.read_text(encoding="utf-8") == lw.urdf(machine).text
    assert len(table.read_text(encoding="utf-8").splitlines()) == 362
    assert run(*arguments)[0] == 2
    assert run(*arguments, "--force")[0] == 0


def test_json_and_warnings_of_bodies_without_mass() -> None:
    """The bodies that are given a mass are named, with the mass."""
    result = CliRunner().invoke(application(), ["export", "press_motion", "--to", "mjcf", "--json"])
    answer = json.loads(result.stdout)
    assert answer["results"]["export"]["massless"] == ["ram", "A", "ram.rod"]
    assert "ram, A, ram.rod" in answer["warnings"][0]
