"""What is wrong with an option is said by the name of the option, not by that of an argument in Python."""

from __future__ import annotations

import pytest
from command_line import invoke

CART, CAM, DIESEL = "machines/roller_one_cart.toml", "machines/roller_cam.toml", "machines/v_diesel.toml"
FIT = "examples/fit_from_run_down/study.toml"
PATH = "examples/coupler_path_tolerances/study.toml"
LINKAGE = ("synthesise", "dead-centre", "--swing", "60 deg", "--time-ratio", "1.2", "--frame", "1 m")

# A command, an option and a value that it cannot have.
WRONG = (
    (("run", CART), "--accuracy", "0"),
    (("transient", CART), "--revolutions", "1e-300"),
    (("transient", CART), "--duration", "0"),
    (("transient", CART), "--accuracy", "1"),
    (("motion", CART), "--zero", "[/x]"),
    (("motion", CART), "--law", "2*x"),
    (("motion", CART), "--speed", "1e-9 rad/s"),
    (("motion", CART, "--law", "t"), "--duration", "1e9"),
    (("balance", CART), "--links", "no"),
    (("balance", CART), "--slider", "no"),
    (("balance", CART, "--slider", "cart1"), "--share", "1e9"),
    (("size", CART), "--power-reserve", "-1"),
    (("size", CART), "--unevenness", "3"),
    (("size", CART), "--catalogue", "none.csv"),
    (("sensitivity", CART), "--of", "no.such"),
    (("tolerance", PATH), "--allocate", "1e-300"),
    (("tolerance", PATH), "--allocate", "1"),
    (("tolerance", PATH, "--allocate", "0.9"), "--cost-power", "11"),
    (("fit", FIT), "--level", "1e-300"),
    (("fit", FIT), "--level", "0.9999999999999999"),
    (("torsion", DIESEL), "--holzer", "-1"),
    (("topper", "field", "machines/topper.toml", "--over", "edge_length=0.2:0.3:3"), "--level", "1"),
    ((*LINKAGE,), "--swing", "0"),
    ((*LINKAGE,), "--time-ratio", "0"),
    ((*LINKAGE,), "--coupler-max", "0"),
)

# Options that take numbers, with a unit or without.
NUMBERS = (
    (("run", CART), "--accuracy"),
    (("size", CART), "--power-reserve"),
    (("draw", CART, "--out", "none.svg"), "--seconds"),
    (("balance", CART, "--links", "A1"), "--radius"),
    (("transient", CART), "--duration"),
    (("motors",), "--power-min"),
    (("cam", CAM), "--tolerance"),
    (("torsion", DIESEL), "--holzer"),
)


@pytest.mark.parametrize(("command", "option", "value"), WRONG, ids=lambda part: str(part)[-30:])
def test_the_option_is_named(command: tuple[str, ...], option: str, value: str) -> None:
    told = invoke(*command, option, value)
    assert told.exit_code == 2, told.output
    assert told.stderr.startswith(option), told.stderr


@pytest.mark.parametrize(("command", "option"), NUMBERS, ids=lambda part: str(part)[-30:])
@pytest.mark.parametrize("value", ["1e400", "nan", "9" * 400])
def test_a_number_that_is_none_is_shown_as_it_was_written(
    command: tuple[str, ...], option: str, value: str
) -> None:
    told = invoke(*command, option, value)
    assert told.exit_code == 2, told.output
    assert option in told.stderr
    assert value[:60] in told.stderr
    assert "inf" not in told.stderr
