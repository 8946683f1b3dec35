"""Measured indicator diagrams: interpolation, harmonics of a known cycle, loads, faults."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cylinders import cylinder, diesel, measured, told
from pydantic import Field
from scipy.interpolate import PchipInterpolator

from linkwright import MachineError
from linkwright.kernel.description.problems import WholeDescription
from linkwright.machine import read_as
from linkwright.torsion import AnyGas, GasTorque, Indicator, gas_torque
from linkwright.torsion.model.engine.cycle_pressure import periodic_cubic

ROOT = Path(__file__).parents[2]
SPEEDS = np.array([100.0, 200.0])
# One exponent, so that the motored line is a polytrope.
GAS = diesel(isentropic_exponent=1.36)


def torque(gas: Any, speeds: np.ndarray = SPEEDS) -> GasTorque:
    return gas_torque(gas.cycle_pressure(cylinder(), speeds), cylinder())


def off(found: np.ndarray, wanted: np.ndarray) -> float:
    return float(np.abs(found - wanted).max() / np.abs(wanted).max())


def test_cubic_against_scipy() -> None:
    """On three periods of uneven points SciPy's PCHIP is periodic in the middle one."""
    rng = np.random.default_rng(3)
    knots = np.sort(rng.uniform(0, 4 * np.pi, 40))
    values = rng.uniform(1, 5, 40)
    at = np.linspace(-20, 30, 777)
    tiled = PchipInterpolator(
        np.concatenate([knots + k * 4 * np.pi for k in (-1, 0, 1)]), np.tile(values, 3), extrapolate=False
    )
    inside = np.mod(at, 4 * np.pi)
    assert periodic_cubic(knots, values, 4 * np.pi, at) == pytest.approx(tiled(inside), rel=1e-12)


def test_cubic_neither_overshoots_nor_bends() -> None:
    knots = np.linspace(0, 2 * np.pi, 30, endpoint=False)
    values = 1e5 + 1e7 * (np.abs(knots - 2) < 0.5)
    found = periodic_cubic(knots, values, 2 * np.pi, np.linspace(0, 7, 5000))
    assert found.min() == 1e5
    assert found.max() == pytest.approx(1.01e7, rel=1e-15)


def test_harmonics_of_a_sampled_cycle() -> None:
    """They come near those of the cycle itself with a power of the step."""
    exact = torque(GAS).firing
    errors = [off(torque(measured(GAS, step)).firing, exact) for step in (8.0, 4.0, 2.0, 1.0)]
    assert errors[3] < 5e-6
    assert all(coarse / fine > 7 for coarse, fine in pairwise(errors))


@pytest.mark.parametrize("start", [-360.0, -180.0, 0.0, 87.0, 720.0])
def test_a_cycle_may_begin_anywhere(start: float) -> None:
    """Points at the same angles of the cycle give the same harmonics, from wherever they are counted."""
    assert off(torque(measured(GAS, 1.0, start)).firing, torque(measured(GAS, 1.0)).firing) < 1e-12


def test_two_strokes() -> None:
    """A cycle of one revolution, its diagram a degree apart, from the bottom dead centre."""
    place, gas = cylinder(2), diesel(isentropic_exponent=1.36, mean_effective_pressure=9e5)
    angle = np.radians(np.arange(-180.0, 180.0))
    cycle = gas.cycle_pressure(place, SPEEDS)
    entries = {"kind": "table", "compression_ratio": 15.0, "angle": angle, "pressure": cycle.at(angle)[0][0]}
    diagram = Indicator(**entries)
    assert list(diagram.cycle_faults(2)) == []
    found, exact = (gas_torque(each, place) for each in (diagram.cycle_pressure(place, SPEEDS), cycle))
    assert off(found.firing, exact.firing) < 1e-5
    assert off(found.motored, exact.motored) < 1e-2


def test_an_end_that_repeats_the_start() -> None:
    once = measured(GAS, 1.0)
    twice = {
        "angle": [*once.angle, once.angle[0] + 4 * np.pi],
        "pressure": [*once.pressure, once.pressure[0]],
    }
    both = once.model_copy(update={key: tuple(each) for key, each in twice.items()})
    assert list(both.cycle_faults(4)) == []
    assert off(torque(both).firing, torque(once).firing) < 1e-12


def test_misfire_follows_the_compression_line() -> None:
    found, exact = torque(measured(GAS, 1.0, exhaust_opens=math.radians(130))), torque(GAS)
    # The blow-down of a motored cylinder is only guessed from that of the diagram.
    assert off(found.motored, exact.motored) < 1e-2
    # The exponent is met: given, it changes nothing.
    given = torque(measured(GAS, 1.0, polytropic_exponent=1.36))
    assert off(given.motored, found.motored) < 1e-4


def test_loads_scale_combustion() -> None:
    gas = measured(GAS, 1.0, load={"kind": "table", "speed": [1, 2], "mean_effective_pressure": [4e5, 20e5]})
    plain = torque(measured(GAS, 1.0))
    speeds = np.array([1.0, 1.75, 2.0])
    found = torque(gas, speeds)
    # The trapezoids of both integrals are the same ones.
    assert found.mean_effective_pressure == pytest.approx([4e5, 16e5, 20e5], rel=1e-12)
    own, cold = plain.mean_effective_pressure[0], plain.motored[0, 0].real
    share = (16e5 - cold * 4 * np.pi / cylinder().swept_volume) / (
        own - cold * 4 * np.pi / cylinder().swept_volume
    )
    assert found.firing[1] == pytest.approx(plain.of(share)[0], rel=1e-10)
    assert found.motored == pytest.approx(np.tile(plain.motored[0], (3, 1)), rel=1e-12)


def test_diagrams_at_several_loads() -> None:
    """At their own loads they hold, between them is the mean, beyond the last combustion is scaled."""
    low, high = (
        diesel(mean_effective_pressure=6e5, charge_pressure=1.4e5),
        diesel(mean_effective_pressure=18e5),
    )
    alone = [torque(measured(each, 1.0)) for each in (low, high)]
    levels = [float(each.mean_effective_pressure[0]) for each in alone]
    table = [3e5, levels[0], sum(levels) / 2, levels[1], 20e5]
    load = {"kind": "table", "speed": [1.0, 2.0, 3.0, 4.0, 5.0], "mean_effective_pressure": table}
    for first, other in ((low, high), (high, low)):
        diagram = measured(other, 1.0)
        further = [{"kind": "table", "angle": diagram.angle, "pressure": diagram.pressure}]
        found = torque(measured(first, 1.0, other_loads=further, load=load), np.arange(1.0, 6.0))
        assert found.mean_effective_pressure == pytest.approx(table, rel=1e-12)
        assert found.firing[1] == pytest.approx(alone[0].firing[0], abs=1e-6)
        assert found.firing[3] == pytest.approx(alone[1].firing[0], abs=1e-6)
        assert found.firing[2] == pytest.approx((alone[0].firing[0] + alone[1].firing[0]) / 2, abs=1e-6)
        assert found.motored[0] == pytest.approx(alone[0].motored[0], abs=1e-6)
        assert found.motored[4] == pytest.approx(alone[1].motored[0], abs=1e-6)


def sound() -> dict[str, Any]:
    """The entries of a diagram without fault, in degrees and bars."""
    gas = measured(GAS, 2.0)
    return {
        "kind": "table",
        "compression_ratio": 15.0,
        "angle": [f"{math.degrees(each):.9g} deg" for each in gas.angle],
        "pressure": [f"{each / 1e5:.9g} bar" for each in gas.pressure],
    }


def without(first: int, last: int) -> dict[str, Any]:
    entries = sound()
    return entries | {key: entries[key][:first] + entries[key][last:] for key in ("angle", "pressure")}


def with_pressure(change: Any) -> dict[str, Any]:
    entries = sound()
    bars = [float(each.split()[0]) for each in entries["pressure"]]
    return entries | {"pressure": [f"{change(i, each):.9g} bar" for i, each in enumerate(bars)]}


def turned(degrees: float) -> dict[str, Any]:
    entries = sound()
    return entries | {"angle": [f"{float(each.split()[0]) + degrees} deg" for each in entries["angle"]]}


def as_plain_numbers(key: str) -> dict[str, Any]:
    entries = sound()
    return entries | {key: [float(each.split()[0]) for each in entries[key]]}


def coarse(n: int) -> dict[str, Any]:
    """A diagram with a point every ten degrees, as read by hand, without its last points."""
    entries = sound()
    return entries | {key: entries[key][::5][: 72 - n] for key in ("angle", "pressure")}


def test_a_sound_diagram_has_no_fault() -> None:
    assert told(sound()) == []
    assert told(coarse(0)) == []


@pytest.mark.parametrize(
    ("entries", "key", "text"),
    [
        (without(100, 106), "angle", "a gap of 14 deg, between -162 and -148 deg"),
        (without(100, 130), "angle", "a gap of 62 deg, between -162 and -100 deg"),
        (without(350, 360), "angle", "a gap of 22 deg, between 338 and 360 deg"),
        (without(0, 5), "angle", "a gap of 12 deg, between 358 and 370 deg"),
        (coarse(1), "angle", "a gap of 20 deg, between 340 and 360 deg"),
        (without(0, 250), "angle", "only a part of the cycle"),
        (sound() | {"angle": sound()["angle"][::-1]}, "angle.1", "more than 358 deg"),
        (sound() | {"pressure": sound()["pressure"][:-1]}, "pressure", "359 values"),
        (with_pressure(lambda i, p: p - 3), "pressure.271", "add the pressure of the air"),
        (as_plain_numbers("pressure"), "pressure", "pressure [bar]"),
        (with_pressure(lambda i, p: p * 14.5), "pressure", "check the unit"),
        (as_plain_numbers("angle"), "angle", "angle [deg]"),
        (with_pressure(lambda i, p: p + 0.03 * i), "pressure", "at the start of the cycle"),
        (turned(360.0), "angle", "subtract 360 deg"),
        (sound() | {"compression_ratio": 1.0}, "compression_ratio", "greater than 1"),
        (sound() | {"combustion_start": "-100 deg"}, "combustion_start", "-100 deg"),
        (sound() | {"exhaust_opens": "300 deg"}, "exhaust_opens", "300 deg"),
        (sound() | {"polytropic_exponent": 1.0}, "polytropic_exponent", "greater than 1"),
        (sound() | {"other_loads": [sound()]}, "other_loads.0.compression_ratio", ""),
        (sound() | {"file": "diagram.csv"}, "file", "with the machine file"),
        (
            sound()
            | {
                "load": {
                    "kind": "table",
                    "speed": [1, 2],
                    "mean_effective_pressure": [1e5, 2e5],
                    "charge_pressure": [1e5, 2e5],
                }
            },
            "load.charge_pressure",
            "in itself",
        ),
    ],
)
def test_faults(entries: dict[str, Any], key: str, text: str) -> None:
    found = told(entries)
    assert any(each.key.removeprefix("table.") == key and text in str(each) for each in found), found


def test_diagrams_that_no_load_leads_to() -> None:
    entries = sound()
    further = {key: entries[key] for key in ("kind", "angle", "pressure")}
    (problem,) = told(entries | {"other_loads": [further]})
    assert problem.key == "table.load"
    broken = without(100, 130)
    further = {key: broken[key] for key in ("kind", "angle", "pressure")}
    load = {"kind": "constant", "mean_effective_pressure": 1e6}
    assert told(entries | {"load": load, "other_loads": [further]})[0].key == "table.other_loads.0.angle"


def test_the_other_stroke_number() -> None:
    assert "more than the cycle" in told(sound(), strokes=2)[0].found


@pytest.mark.parametrize(
    ("entries", "text"),
    [
        ({"compression_ratio": 8.0}, "the zeros of pressure"),
        ({"pressure": [each + 1e6 for each in measured(GAS, 2.0).pressure]}, "the zeros of pressure"),
        (
            {"load": {"kind": "constant", "mean_effective_pressure": 1e2}},
            "at least that of the motored cylinder",
        ),
    ],
)
def test_diagrams_that_make_no_sense(entries: dict[str, Any], text: str) -> None:
    with pytest.raises(MachineError) as caught:
        torque(measured(GAS, 2.0, **entries))
    assert text in str(caught.value)
    assert caught.value.problems[0].key.startswith("train.engine.gas")


def test_a_motored_diagram_cannot_be_scaled() -> None:
    gas = measured(GAS, 1.0)
    _, motored = GAS.cycle_pressure(cylinder(), SPEEDS[:1]).at(np.array(gas.angle))
    entries = {
        "kind": "table",
        "compression_ratio": 15.0,
        "angle": gas.angle,
        "pressure": motored[0].tolist(),
    }
    plain = torque(Indicator(**entries))
    assert off(plain.firing, plain.motored) < 5e-3
    with pytest.raises(MachineError, match="a diagram with combustion"):
        torque(Indicator(**entries, load={"kind": "constant", "mean_effective_pressure": 5e5}))


class SomeFile(WholeDescription):
    """A file with a gas, that tells its problems as a machine does."""

    gas: AnyGas = Field(description="The gas.")


def test_a_diagram_from_a_file(tmp_path: Path) -> None:
    """With a comment before its head, as measuring systems write it."""
    entries = sound()
    rows = zip(*(entries[key] for key in ("angle", "pressure")), strict=True)
    body = "\n".join(",".join(each.split()[0] for each in row) for row in rows)
    (tmp_path / "full.csv").write_text(f'# an "indicator diagram\nangle [deg], pressure [bar]\n{body}\n')
    (tmp_path / "gas.toml").write_text('[gas]\nkind = "table"\nfile = "full.csv"\ncompression_ratio = 15.0\n')
    found = read_as(SomeFile, tmp_path / "gas.toml").gas
    assert isinstance(found, Indicator)
    assert off(torque(found).firing, torque(measured(GAS, 2.0)).firing) < 1e-8


def test_a_gap_in_a_file_is_told_with_its_key(tmp_path: Path) -> None:
    entries = without(100, 106)
    rows = zip(*(entries[key] for key in ("angle", "pressure")), strict=True)
    body = "\n".join(",".join(each.split()[0] for each in row) for row in rows)
    (tmp_path / "full.csv").write_text(f"angle [deg], pressure [bar]\n{body}\n")
    (tmp_path / "gas.toml").write_text('[gas]\nkind = "table"\nfile = "full.csv"\ncompression_ratio = 15.0\n')
    with pytest.raises(MachineError) as caught:
        read_as(SomeFile, tmp_path / "gas.toml")
    assert "gas.angle" in str(caught.value)
    assert "between -162 and -148 deg" in str(caught.value)


EXAMPLE = {
    "compression_ratio": 15.0,
    "mean_effective_pressure": 8e5,
    "charge_pressure": 95e3,
    "walls": {"kind": "woschni"},
    "releases": [
        {"start": "-10 deg", "duration": "14 deg", "form_factor": 1.5, "share": 0.2},
        {"start": "-6 deg", "duration": "75 deg", "form_factor": 0.9, "share": 0.8},
    ],
}


def test_the_example_diagram() -> None:
    """The file beside the machines is the cycle that its head names, rounded to a hundredth of a bar."""
    path = ROOT / "machines" / "v_diesel_indicator.csv"
    head = path.read_text(encoding="utf-8").split("angle [deg]")[0]
    assert "not measured" in head
    columns = np.genfromtxt(path, delimiter=",", comments="#", skip_header=head.count("\n") + 1)
    p, _ = diesel(**EXAMPLE).cycle_pressure(cylinder(), np.array([50 * np.pi])).at(np.radians(columns[:, 0]))
    assert columns[:, 1] == pytest.approx(p[0] / 1e5, abs=0.0051)
    gas = Indicator(
        kind="table",
        compression_ratio=15.0,
        angle=np.radians(columns[:, 0]).tolist(),
        pressure=(columns[:, 1] * 1e5).tolist(),
    )
    assert list(gas.cycle_faults(4)) == []
    assert torque(gas).mean_effective_pressure[0] == pytest.approx(8e5, rel=1e-3)
