"""A compiled core from other sources is refused before it computes anything."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from linkwright import CoreError, _core
from linkwright.machine.program.core import FORMAT, check_format, require

ROOT = Path(__file__).parents[2]

STALE = """
import sys
from linkwright import _core
{change}
sys.argv = ["linkwright", "run", "machines/roller_two_carts.toml", "--json"]
from linkwright.app import main
main()
"""


def test_sources_and_core_say_the_same() -> None:
    source = (ROOT / "crates/linkwright-core/src/plan/mod.rs").read_text(encoding="utf-8")
    found = re.search(r"pub const FORMAT: u32 = (\d+);", source)
    assert found is not None
    assert int(found[1]) == FORMAT == _core.FORMAT
    check_format(_core)


@pytest.mark.parametrize("change", ["_core.FORMAT += 1", "del _core.FORMAT"])
def test_another_core_ends_with_a_remedy(change: str) -> None:
    command = [sys.executable, "-c", STALE.format(change=change)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 2, done.stderr
    assert not done.stdout
    assert "Traceback" not in done.stderr
    assert f"expected format {FORMAT}" in done.stderr
    assert "build it again" in done.stderr


def test_the_error_has_both_numbers() -> None:
    with pytest.raises(CoreError) as caught:
        check_format(object())
    assert (caught.value.found, caught.value.expected) == (None, FORMAT)


def test_what_came_later_is_asked_for_by_its_name() -> None:
    """A core of the same format without a later function, or a later kind of load, is refused."""
    for there in ("motions_along", "What.Dry"):
        require(there)
    for missing in ("motions_beside", "What.Magnetic"):
        with pytest.raises(CoreError, match=f"{missing} is missing"):
            require(missing)
