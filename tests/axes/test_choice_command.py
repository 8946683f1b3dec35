"""``linkwright axes --catalogue``: pairs of motor and gearbox, what refuses others, the α–β chart."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import pytest
from command_line import invoke

from linkwright.kernel.reader.language import language

MOTORS = str(Path(__file__).parents[1] / "found" / "use" / "motors.csv")
GEARBOXES = """type, ratio, efficiency [%], inertia [kg cm^2], torque_max [N m], speed_max [rpm]
P5, 5, 96, 0.5, 60, 6000
P10, 10, 95, 0.4, 60, 6000
P20, 20, 93, 0.4, 60, 6000
P50, 50, 90, 0.4, 60, 6000
"""

MACHINE = """
format = 1
name = "feeder"
[master]
cycle_time = "1 s"
[axes.A]
sections = [{ swing = "180 deg", angle = "180 deg" }, { swing = "-180 deg", angle = "180 deg" }]
[mechanism.cranks.A]
radius = "120 mm"
[mechanism.sliders.carriage]
crank = "A"
rod = "400 mm"
[bodies]
carriage = { mass = "12 kg" }
"""


@pytest.fixture
def files(tmp_path: Path) -> tuple[str, str]:
    (tmp_path / "machine.toml").write_text(MACHINE)
    (tmp_path / "gearboxes.csv").write_text(GEARBOXES)
    return str(tmp_path / "machine.toml"), str(tmp_path / "gearboxes.csv")


def test_pairs_that_pass_come_first(files: tuple[str, str], tmp_path: Path) -> None:
    """An axis without a motor gets the smallest one; all pairs are in a file, with what refuses them."""
    machine, gears = files
    out = tmp_path / "out"
    words = ("axes", machine, "--catalogue", MOTORS, "--gearboxes", gears, "--json", "--out", str(out))
    done = invoke(*words)
    assert done.exit_code == 0, done.stderr
    choice = json.loads(done.stdout)["results"]["choice"]["A"]
    rows = list(csv.DictReader((out / "choice_A.csv").read_text(encoding="utf-8").splitlines()))
    assert choice["pairs"] == len(rows) == 16
    assert choice["passing"] == sum(row["passes"] == "yes" for row in rows) > 0
    assert all((row["refused_by"] == "") == (row["passes"] == "yes") for row in rows)
    powers = [pair["power_rated"] for pair in choice["chosen"]]
    assert powers == sorted(powers)
    first = choice["chosen"][0]
    assert first["passes"]
    own = next(row for row in rows if (row["motor"], row["gearbox"]) == (first["motor"], first["gearbox"]))
    for check in first["checks"]:
        assert float(own[f"{check['name']} [-]"]) == pytest.approx(check["utilisation"], rel=1e-9)
    assert (out / "ratios_A.svg").exists()


def test_the_headline_says_what_is_chosen_in_both_languages(files: tuple[str, str]) -> None:
    machine, gears = files
    done = invoke("axes", machine, "--catalogue", MOTORS, "--gearboxes", gears, "--goal", "rms")
    text = " ".join(done.stdout.split())
    found = re.search(
        r"axis A: SV \d+ with P\d+ passes all checks with the lowest [a-z ]+; \d+ of 16 pairs pass", text
    )
    assert found is not None, text[:500]
    assert not re.search(r"[a-z]{4}", language("uk")(found[0]))


def test_where_none_suffices_the_nearest_is_a_finding(files: tuple[str, str]) -> None:
    """Exit code 1, with the checks that refuse it, also in Ukrainian."""
    machine, _ = files
    heavy = ("--set", "bodies.carriage.mass=1e5", "--catalogue", MOTORS, "--json")
    done = invoke("axes", machine, *heavy)
    assert done.exit_code == 1
    (finding,) = json.loads(done.stdout)["findings"]
    assert finding.startswith(
        "axis A: none of 4 pairs of motor and gearbox suffices; the nearest, SV 3000 with "
    )
    assert "root mean square torque" in finding
    assert not re.search(r"[a-z]{4}", language("uk")(finding))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--goal", "cost"), "--goal: it belongs to --catalogue"),
        (("--catalogue", MOTORS, "--goal", "cost"), "SV 400 has no cost; add a column cost"),
        (
            ("--catalogue", MOTORS, "--axis", "B"),
            '--axis: found "B", expected an axis of the machine; there is "A"',
        ),
        (("--catalogue", MOTORS, "--gearboxes", MOTORS), r"motors.csv:\d+: gearboxes"),
    ],
)
def test_what_cannot_be_chosen_from_is_refused(
    words: tuple[str, ...], said: str, files: tuple[str, str]
) -> None:
    done = invoke("axes", files[0], *words)
    assert done.exit_code == 2
    assert re.search(said, done.stderr), done.stderr


def test_a_driver_along_a_line_needs_its_screw_before_a_motor_is_chosen(
    files: tuple[str, str], tmp_path: Path
) -> None:
    """Newtons are no newton metres: without `per_turn` no motor is judged."""
    line = MACHINE.replace("swing", "lift").replace("180 deg", "180 mm").replace('"180 mm" }', '"180 deg" }')
    line = (
        line[: line.index("[mechanism")] + "[mechanism.linear_drivers.A]\n[bodies]\nA = { mass = '2 kg' }\n"
    )
    machine = tmp_path / "line.toml"
    machine.write_text(line)
    done = invoke("axes", str(machine), "--catalogue", MOTORS, "--gearboxes", files[1])
    assert done.exit_code == 2
    assert "without per_turn" in done.stderr
    machine.write_text(line + '[axes.A.gearbox]\nper_turn = "100 mm"\n')
    done = invoke("axes", str(machine), "--catalogue", MOTORS, "--gearboxes", files[1])
    assert "passes all checks" in done.stdout


def test_a_choice_stands_the_start_and_stop_of_the_master(files: tuple[str, str], tmp_path: Path) -> None:
    """A stop in 10 ms needs more than the cycle: what is chosen passes all checks in the file too."""
    machine, gears = files
    # At φ = 0 the crank is amid its rise.
    text = Path(machine).read_text()
    text = text.replace("[axes.A]", '[axes.A]\nphase = "-90 deg"')
    stops = tmp_path / "stops.toml"
    stops.write_text(text.replace('"1 s"', '"1 s"\nstop_time = "10 ms"'))
    found = {}
    for name in (machine, str(stops)):
        done = invoke("axes", name, "--catalogue", MOTORS, "--gearboxes", gears, "--json")
        found[name] = json.loads(done.stdout)["results"]["choice"]["A"]
    cycle, stopping = found.values()
    assert stopping["passing"] < cycle["passing"]
    for pair in stopping.get("chosen", []):
        notes = [check for check in pair["checks"] if "while the master stops" in check["note"]]
        assert notes
        assert all(check["passed"] for check in pair["checks"])
