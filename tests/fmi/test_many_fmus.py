"""Many FMUs, made, loaded, simulated and freed: memory and handles stay, and no library stays loaded."""

from __future__ import annotations

import gc
import shutil
import sys
from pathlib import Path

import pytest
from fmus import opened, unpack
from sizes import cases

import linkwright as lw

# Memory that a library and an interpreter may take until all is loaded and arenas are full [kB].
_WARM = 8
_GROWTH = 15_000


@pytest.mark.skipif(sys.platform != "linux", reason="memory and handles by /proc")
def test_memory_and_handles_stay(tmp_path: Path) -> None:
    """Dozens of machines, a thousand in `make test-deep`, each unpacked elsewhere: nothing is lost, and the
    library is unloaded with its last instance.
    """
    machine = lw.read("roller_two_carts")
    before: tuple[int, int] | None = None
    count = cases(3 * _WARM, 1000)
    for nth in range(count):
        changed = lw.replace(machine, {"bodies.cart1.mass": 500.0 + nth})
        home = tmp_path / str(nth)
        home.mkdir()
        lw.fmu(changed, version="23"[nth % 2] + ".0").write(home / "machine.fmu")
        folder = unpack(home / "machine.fmu", home / "unpacked")
        with opened(folder, exchange=False) as unit:
            unit.start()
            unit.step(0.0, 0.05)
            assert unit.get("crank_angle")[0] > 0
            unit.restore(unit.kept())
        assert str(folder) not in Path("/proc/self/maps").read_text(encoding="utf-8")
        shutil.rmtree(home)
        if nth == _WARM:
            gc.collect()
            before = _memory(), _handles()
    gc.collect()
    assert before is not None
    assert _handles() <= before[1] + 2
    assert _memory() - before[0] < _GROWTH


def _memory() -> int:
    """Resident memory of this process [kB]."""
    text = Path("/proc/self/status").read_text(encoding="utf-8")
    return int(text.split("VmRSS:")[1].split()[0])


def _handles() -> int:
    """Files and libraries that this process has open."""
    return sum(1 for _ in Path("/proc/self/fd").iterdir())
