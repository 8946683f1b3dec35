"""Machine code of the core: its largest functions, its sum, and kernels that came apart.

``python benches/code_size.py [LIBRARY]`` reads the compiled module with its symbols, as `make build` leaves
it. It ends with 1

- if a function is larger than 64 kB, or core and derivatives together are larger than 4.5 MB: a compiler
  takes longer than linearly over a function, and so does everybody who builds;
- if more vector instructions than today are calls of functions: each takes as long as ten to twenty of the
  instructions, and a kernel of them is up to 25 times slower.

Needs binutils and a library in the ELF format.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

LIBRARY = Path(__file__).parents[1] / "python" / "linkwright" / "_core.abi3.so"

# A function, and core with derivatives [bytes].
LARGEST, ALL = 64 * 1024, 5_200_000

# Calls of single vector instructions. The few are in functions that a motion calls a few times: sorting
# kinks, collecting levels, numbers of a driveline.
CALLS = 900

# Of which crate a function is: the first in its name of those that stand highest.
CRATES = ("border", "derivatives", "driveline", "core", "torsion", "rods", "cam", "topper", "kernel")

SHOWN = 12

# A function of one instruction.
_INSTRUCTION = re.compile(r"\bcall.*<.*core_arch.*x86")


def told_by(*words: str) -> list[str]:
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout.splitlines()


def functions(library: Path) -> list[tuple[int, str]]:
    """Size [bytes] and name of each function, the largest first."""
    rows = (line.split(maxsplit=3) for line in told_by("nm", "-S", "-C", "--defined-only", str(library)))
    return sorted(
        ((int(row[1], 16), row[3]) for row in rows if len(row) == 4 and row[2] in "tTwW"), reverse=True
    )


def crate(name: str) -> str:
    """The crate that a function was compiled for."""
    return next((one for one in CRATES if f"linkwright_{one}" in name), "libraries")


def calls(library: Path) -> Counter[str]:
    """Functions that call single vector instructions, and how often."""
    found: Counter[str] = Counter()
    function = ""
    for line in told_by("objdump", "-d", "-C", "--no-show-raw-insn", str(library)):
        if line.endswith(">:"):
            function = line[line.index("<") + 1 : -2]
        elif "core_arch" in line and "core_arch" not in function and _INSTRUCTION.search(line):
            found[function] += 1
    return found


def shown(name: str) -> str:
    """A name that fits on a line."""
    return re.sub(r"linkwright_|registers::x86::|\[[0-9a-f]{16}\]|: usize|: u8", "", name)[:150]


def main() -> int:
    library = Path(sys.argv[1]) if sys.argv[1:] else LIBRARY
    if not library.exists():
        raise SystemExit(f"{library} is not built")
    rows, loose = functions(library), calls(library)
    if not rows:
        raise SystemExit(f"{library} has no symbols")
    for size, name in rows[:SHOWN]:
        print(f"{size:9,}  {shown(name)}")
    by_crate: Counter[str] = Counter()
    for size, name in rows:
        by_crate[crate(name)] += size
    print(", ".join(f"{name} {size / 1e6:.2f} MB" for name, size in by_crate.most_common()))
    print(f"{loose.total()} calls of single instructions in {len(loose)} functions:")
    for name, number in loose.most_common(5):
        print(f"{number:9}  {shown(name)}")
    core = by_crate["core"] + by_crate["derivatives"] + by_crate["kernel"]
    faults = [
        *(f"{shown(name)} has {size:,} bytes, {LARGEST:,} at most" for size, name in rows if size > LARGEST),
        *([f"the core has {core:,} bytes, {ALL:,} at most"] if core > ALL else []),
        *(
            [f"{loose.total()} calls of single instructions, {CALLS} at most"]
            if loose.total() > CALLS
            else []
        ),
    ]
    print("\n".join(faults) or f"core {core / 1e6:.2f} MB: within limits")
    return int(bool(faults))


if __name__ == "__main__":
    sys.exit(main())
