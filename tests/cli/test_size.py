"""``linkwright size`` and ``linkwright papers``: exit codes, JSON, files."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from command_line import invoke as run

from linkwright import read, steady_state
from linkwright.kernel.files.library import library_path
from linkwright.papers.paper import paper

TWO_CARTS = library_path("roller_two_carts")


@pytest.fixture(scope="module", autouse=True)
def recomputed_once() -> Iterator[None]:
    """A paper is asked for with files and for people, and computed once."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("linkwright.papers.paper.paper", cache(paper))
        yield


def test_size_in_json() -> None:
    done = run("size", TWO_CARTS, "--unevenness", "0.02", "--json")
    assert done.exit_code == 0
    found = json.loads(done.stdout)
    assert set(found) == {"machine", "results", "findings", "warnings"}
    results = found["results"]
    assert results["required_power"]["power"] == pytest.approx(10582.318, rel=1e-6)
    assert results["motor"]["chosen"]["type"] == "4A180M6U3"
    assert results["motor"]["chosen"]["inertia_estimated"] is True
    assert results["flywheel"]["unevenness"] == pytest.approx(0.02, abs=1e-6)
    assert any("by similarity" in text for text in found["warnings"])


def test_size_writes_the_machine(tmp_path: Path) -> None:
    out = tmp_path / "sized.toml"
    assert run("size", TWO_CARTS, "--unevenness", "0.02", "--out", out).exit_code == 0
    assert steady_state(read(out)).unevenness == pytest.approx(0.02, abs=1e-6)
    assert "# estimated from" in out.read_text()
    assert run("size", TWO_CARTS, "--out", out).exit_code == 2
    assert run("size", TWO_CARTS, "--out", out, "--force").exit_code == 0


def test_no_motor_suffices() -> None:
    done = run("size", TWO_CARTS, "--set", "loads.rolling1.force=1e5")
    assert done.exit_code == 1
    assert "% of the requirement" in done.stdout
    in_json = run("size", TWO_CARTS, "--set", "loads.rolling1.force=1e5", "--json")
    assert in_json.exit_code == 1
    found = json.loads(in_json.stdout)
    assert found["results"]["motor"]["chosen"] is None
    assert "% of the requirement" in found["findings"][0]


@pytest.mark.parametrize(
    "arguments",
    [
        ["--unevenness", "3"],
        ["--power-reserve", "-1"],
        ["--inertia", "4A180M6U3"],
        ["--inertia", "4A180M6=0.2"],
        ["--inertia", "4A180M6U3=2 kg"],
        ["--set", "drive.speed=nonsense"],
        ["--by", "luck"],
    ],
)
def test_wrong_input(arguments: list[str]) -> None:
    assert run("size", TWO_CARTS, *arguments).exit_code == 2


def test_papers(tmp_path: Path) -> None:
    assert "1" in run("papers").stdout
    assert run("papers", "7").exit_code == 2
    done = run("papers", "1", "--json", "--out", tmp_path)
    assert done.exit_code == 0
    found = json.loads(done.stdout)["results"]["paper1"]
    assert [each["carts"] for each in found["drives"]] == [1, 2, 3, 4]
    names = {path.name for path in tmp_path.glob("[!.]*")}
    machines = [f"roller_{name}" for name in ("one_cart", "two_carts", "three_carts", "four_carts")]
    figures = {f"{name}.{end}" for name in (*machines, "evenness") for end in ("svg", "png")}
    assert names == figures | {"papers1.html"}
    page = (tmp_path / "papers1.html").read_text(encoding="utf-8")
    # Self-contained: nothing is loaded from elsewhere.
    assert "src=" not in page
    assert "@import" not in page
    assert page.count("<svg") == 5


# Figures of a paper and words that its answer has; square brackets of a formula are no markup.
PAPERS = {
    "2": ("figure1 figure3 shape start alternatives course", ["reproduced to rounding", "continuous jerk"]),
    "3": (
        "scheme modes disc formulas amplitude unevenness cylinders delta weak",
        ["[m_1 +", "cannot be read"],
    ),
    "5": ("figure3 step bands heads", ["d[(v_h/v)", "500…600 mm"]),
}


@pytest.mark.parametrize("number", PAPERS)
def test_papers_with_their_figures(number: str, tmp_path: Path) -> None:
    figures, words = PAPERS[number]
    done = run("papers", number, "--json", "--out", tmp_path)
    assert done.exit_code == 0
    found = json.loads(done.stdout)["results"][f"paper{number}"]
    if number == "2":
        assert found["cam"]["diameter_min"] == pytest.approx(found["cam"]["diameter_max"], abs=1e-12)
    elif number == "3":
        assert len(found["exact"]["natural_frequencies"]) == 3
    else:
        assert found["verdict"]["lengths"] == [0.25, 0.3]
    names = {f"{name}.{end}" for name in figures.split() for end in ("svg", "png")}
    assert {path.name for path in tmp_path.glob("[!.]*")} == names | {f"papers{number}.html"}
    shown = run("papers", number).stdout
    assert all(word in shown for word in words)
    assert number != "2" or "not reproduced" not in shown


def test_the_flywheel_alone_for_the_motor_of_the_file(tmp_path: Path) -> None:
    out = tmp_path / "even.toml"
    done = run("size", TWO_CARTS, "--keep-motor", "--unevenness", "0.05", "--out", out, "--json")
    assert done.exit_code == 0, done.output
    assert list(json.loads(done.stdout)["results"]) == ["flywheel"]
    fitted, given = read(out), read(TWO_CARTS)
    assert steady_state(fitted).unevenness == pytest.approx(0.05, rel=1e-6)
    assert fitted.drive is not None
    assert given.drive is not None
    assert fitted.drive.motor == given.drive.motor
    told = run("size", TWO_CARTS, "--keep-motor", "--free-ratio")
    assert told.exit_code == 2
    assert "--keep-motor" in told.stderr


def test_checks_are_called_by_words() -> None:
    told = run("size", TWO_CARTS).stdout
    for words in ("run-up time", "root mean square torque", "peak torque", "starting torque, worst angle"):
        assert words in told
