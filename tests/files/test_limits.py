"""What is beyond a limit is refused with its place, its value and the limit; work is counted, not timed."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from linkwright import (
    InputError,
    MachineError,
    MachineFileError,
    OneMass,
    UnitError,
    follower_vibration,
    loads,
    read,
)
from linkwright.drive import whole_steps
from linkwright.kernel.errors import Problem
from linkwright.kernel.limits import (
    DISCS,
    ENTRIES,
    FILE_BYTES,
    HARMONICS,
    LIST,
    NAME,
    PROBLEMS,
    RESPONSE,
    ROWS,
)
from linkwright.kernel.units.kinds import ANGLE, LENGTH, MASS, SPEED, Kind
from linkwright.kernel.units.reading import parse
from linkwright.machine import dumps

SLIDER = """format = 1
name = "S"
[mechanism.cranks.A]
radius = "0.1 m"
[mechanism.sliders.S]
crank = "A"
rod = "0.4 m"
"""
LOAD = SLIDER + '[loads.f]\nkind = "formula"\non = "A"\ntorque = "{}"\n'
TABLE = SLIDER + '[loads.f]\nkind = "force_position"\non = "S"\nposition = [{}]\nforward = [0, 1]\n'


def calls(act: Callable[[], Any]) -> int:
    """How many functions an act calls, ended or not: its work without a clock."""
    count = 0

    def counted(frame: FrameType, event: str, argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(counted)
    try:
        act()
    except InputError:
        pass
    finally:
        sys.setprofile(before)
    return count


def train(discs: int, more: str = "") -> str:
    names = range(discs)
    rows = "".join(f"[train.discs.d{k}]\ninertia = 1\n" for k in names)
    shafts = (f'[train.shafts.s{k}]\nbetween = ["d{k}", "d{k + 1}"]\nstiffness = 1e5\n' for k in names[1:])
    return f'format = 1\nname = "T"\n{rows}{"".join(shafts).replace(f"d{discs}", "d0")}{more}'


def excited(harmonics: str) -> str:
    return (
        f'format = 1\nname = "T"\n[train.discs.d0]\ninertia = 1\n[train.discs.d1]\ninertia = 1\n'
        f'[train.shafts.s]\nbetween = ["d0", "d1"]\nstiffness = 1e5\n'
        f'[train.excitations.e]\non = "d0"\nharmonics = [{harmonics}]\n'
        f"[train.run]\nspeed_min = 60\nspeed_max = 200\n"
    )


BEYOND = {
    "deep key": (SLIDER + ".".join("a" * 3000) + " = 1", "at most 32 keys"),
    "deep header": (SLIDER + "[" + " . ".join(["'a'"] * 100) + "]", "at most 32 keys"),
    "deep lists": ("a = " + "[" * 5000 + "]" * 5000, "at most 32 keys"),
    "deep lists with values": ("a = " + "[1," * 300 + "]" * 300, "at most 32 keys"),
    "deep inline tables": ("x = " + "{a = " * 5000 + "1" + "}" * 5000, "at most 32 keys"),
    "deep inline keys": ("x = {" + "a." * 5000 + "a = 1}", "at most 32 keys"),
    "hexadecimal": (SLIDER.replace('"0.1 m"', "0x" + "f" * 5000), "6021 digits"),
    "octal where none belongs": (SLIDER + "x = 0o" + "7" * 5000, "digits"),
    "digits": (SLIDER.replace('"0.1 m"', "9" * 5000), "a number below 9.2e18"),
    "many keys": (SLIDER + "".join(f"k{k} = 1\n" for k in range(20_000)), "at most 1 000 entries"),
    "many elements": (
        SLIDER + "".join(f'[mechanism.sliders.T{k}]\ncrank="A"\nrod=1\n' for k in range(2000)),
        "at most 1 000 entries",
    ),
    "long list": (TABLE.format(",".join(["1"] * 20_000)), "at most 10 000 values"),
    "long name": (SLIDER.replace("sliders.S", "sliders." + "S" * 300), "at most 100 characters"),
    "long text": (SLIDER.replace('"S"', '"' + "S" * 300_000 + '"', 1), "at most 10 000 characters"),
    "long number": (SLIDER.replace('"0.1 m"', '"' + "1" * 9000 + ' m"'), "must be finite"),
    "long unit": (SLIDER.replace('"0.1 m"', '"0.1 ' + "m" * 9000 + '"'), "not a known unit"),
    "sum of 970 terms": (LOAD.format("+".join(["phi"] * 970)), "at most 400 numbers, names and signs"),
    "maximum of 900": (LOAD.format(f"max({','.join(['phi'] * 900)})"), "at most 400 numbers"),
    "tower of powers": (LOAD.format("^".join(["phi"] * 150)), "inside one another"),
    "discs": (train(501), "at most 500 discs"),
    "order": (excited("{ order = 1e7, torque = 1 }"), "from 0.001 to 1000"),
    "orders": (
        excited(",".join(f"{{ order = {k / 2}, torque = 1 }}" for k in range(1, 600))),
        "at most 500 harmonics",
    ),
    "throws": (
        (Path(__file__).parents[2] / "machines" / "v8_diesel.toml").read_text(encoding="utf-8"),
        "at most 100 throws",
    ),
}


@pytest.mark.parametrize("name", BEYOND)
def test_beyond_a_limit(name: str) -> None:
    text, message = BEYOND[name]
    sets = {"train.engine.throws": [0.0] * 200} if name == "throws" else {}
    with pytest.raises(MachineFileError) as caught:
        loads(text, sets, path="x.toml")
    shown = str(caught.value)
    assert message in shown
    assert shown.startswith(("x.toml", "--set"))
    assert len(shown) < 8_000
    assert max(map(len, shown.splitlines())) <= 450


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("1 rad/s**9**9**9", SPEED),
        ("1 rad/s^9^9^9", SPEED),
        ("1 m^(9^9^9)", LENGTH),
        ("1 (m^99)^99", LENGTH),
        ("1 (((m^99)^99)^99)^99", LENGTH),
        ("1 9^9^9^9 m", LENGTH),
        ("1 m^999999999", LENGTH),
        ("1 m^99.5^99", LENGTH),
        ("1 kg*9**9**9**9", MASS),
        ("1 " + "deg*" * 5000, ANGLE),
    ],
)
def test_powers_of_units_are_not_worked_out(text: str, kind: Kind) -> None:
    # The powers would have more digits than there is memory; that this ends is the test.
    with pytest.raises(UnitError) as caught:
        parse(text, kind)
    assert len(str(caught.value)) < 1000


@pytest.mark.parametrize("text", ["1 m^2 kg/s^2", "1 kg m² s⁻²", "1 lbf^1 ft", "1 (N m)", "3 N/(m^-1)"])
def test_usual_powers_are_read(text: str) -> None:
    from linkwright.kernel.units.kinds import ENERGY

    assert parse(text, ENERGY) > 0


GROWING: dict[str, Callable[[int], str]] = {
    "unknown keys": lambda n: SLIDER + "[bodies]\n" + "".join(f"k{k} = 1\n" for k in range(n)),
    "list": lambda n: TABLE.format(",".join(map(str, range(n)))),
    "comments": lambda n: SLIDER + "# x\n" * n,
    "text": lambda n: SLIDER + f'description = "{"x" * n}"\n',
    "tables": lambda n: SLIDER + "".join(f"[a.k{k}]\nx = 1\n" for k in range(n)),
}


@pytest.mark.parametrize("name", GROWING)
def test_reading_is_linear_in_the_size_of_the_file(name: str) -> None:
    make = GROWING[name]
    few, many = (calls(lambda n=n: loads(make(n), path="x.toml")) for n in (200, 800))
    # Four times the text, four times the work, and what does not depend on it.
    assert many < 5 * few


def test_a_message_is_cut_at_a_screen() -> None:
    error = MachineError(Problem(f"k{k}", "x" * 5000, "nothing") for k in range(1234))
    shown = str(error)
    assert len(error.problems) == 1234
    assert shown.endswith("\n\n… and 1 224 more problems")
    assert shown.count("found:") == PROBLEMS.most
    assert max(map(len, shown.splitlines())) < 450


def test_files_beyond_a_limit(tmp_path: Path) -> None:
    file = tmp_path / "x.toml"
    file.write_bytes(b"#" * (FILE_BYTES.most + 1))
    endless = Path("/dev/zero")
    for path in (file, endless) if endless.exists() else (file,):
        with pytest.raises(MachineFileError, match=r"at most 1 000 000 bytes"):
            read(path)
    text = (Path(__file__).parent / "broken" / "topper_field_cell.toml").read_text(encoding="utf-8")
    points = tmp_path / "points.csv"
    file.write_text(text.replace("topper_field_cell.csv", "points.csv"), encoding="utf-8")
    head = "root_diameter [mm],cut_height [mm],offset [mm]\n"
    points.write_text(head + "1,1,1\n" * (ROWS.most + 1), encoding="utf-8")
    with pytest.raises(
        MachineFileError, match=rf"points.csv:{ROWS.most + 2}.*\n.*more rows\n.*at most 100 000"
    ):
        read(file)
    points.write_text(head + "1" * 200_000 + ",1,1\n", encoding="utf-8")
    with pytest.raises(MachineFileError, match=r"points.csv:2"):
        read(file)
    if not endless.exists():
        return
    file.write_text(text.replace("topper_field_cell.csv", "/dev/zero"), encoding="utf-8")
    with pytest.raises(MachineFileError, match="at most 20 000 000 bytes"):
        read(file, allow_outside=True)


def test_what_is_within_the_limits_is_read() -> None:
    assert loads(SLIDER.replace("sliders.S", "sliders." + "S" * NAME.most)).name == "S"
    orders = ",".join(f"{{ order = {k / 2}, torque = 1 }}" for k in range(1, HARMONICS.most + 1))
    assert loads(excited(orders)).train is not None
    assert loads(train(DISCS.most)).train is not None
    with pytest.raises(MachineFileError) as caught:
        loads(TABLE.format(",".join(map(str, range(LIST.most)))))
    assert "at most" not in str(caught.value)
    with pytest.raises(MachineFileError) as caught:
        loads(SLIDER + "".join(f"k{k} = 1\n" for k in range(ENTRIES.most - 3)))
    assert len(caught.value.problems) == ENTRIES.most - 3


def test_a_response_that_no_memory_holds() -> None:
    import linkwright as lw

    machine = loads(excited("{ order = 2, torque = 1 }"), {"train.run.points": 100_000})
    many = {"train.excitations.e.harmonics": [{"order": k, "torque": 1} for k in range(1, 101)]}
    assert RESPONSE.most < 100_000 * 100
    with pytest.raises(InputError, match=r"found 20 000 000, expected at most 4 000 000 orders, discs"):
        lw.forced_vibration(loads(dumps(machine), many))


def test_a_follower_that_vibrates_too_often() -> None:
    lift = read(Path(__file__).parents[2] / "machines" / "roller_cam.toml").mechanism.cams["cart"].lift
    with pytest.raises(InputError, match=r"found 50 000, expected at most 25 000 vibrations of a follower"):
        follower_vibration(lift, OneMass(1.0, 2.5e13, 0.05), 100.0)


def test_steps_of_the_step_method() -> None:
    import math

    with pytest.raises(InputError, match=r"found 36 000 000, expected at most 36 000 steps"):
        whole_steps(math.radians(1e-5))
    assert whole_steps(math.radians(0.01)) == 36_000
