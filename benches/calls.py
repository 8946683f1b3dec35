"""Where a kernel calls a function for a single vector instruction, because something was not inlined.

``python benches/calls.py`` reads the core in `target/release`, built with CARGO_PROFILE_RELEASE_DEBUG=1 and
CARGO_PROFILE_RELEASE_STRIP=none. Each such call takes as long as ten to twenty of the instructions; a kernel
of them is up to 25 times slower. Prints the lines of functions and closures that make such calls, and how
many, and ends with 1 if there are any. Needs binutils.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
CORE = ROOT / "target" / "release" / "lib_core.so"

# Functions of one instruction each.
_CALL = re.compile(r"^\s*([0-9a-f]+):.*\bcall.*core_arch.*x86")

_PLACE = re.compile(r"linkwright-\w+/src/(\S+:\d+)")


def calls(core: Path) -> list[str]:
    """Addresses of the calls."""
    words = ["objdump", "-d", "--no-show-raw-insn", str(core)]
    code = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    return [found[1] for line in code.splitlines() if (found := _CALL.match(line))]


def places(core: Path, addresses: list[str]) -> Counter[str]:
    """Where in the function that makes each call it stands: what was inlined there lies deeper."""
    words = ["addr2line", "-a", "-i", "-e", str(core)]
    asked = "\n".join(addresses)
    told = subprocess.run(words, input=asked, capture_output=True, text=True, check=True).stdout
    found: Counter[str] = Counter()
    for frames in re.split(r"^0x[0-9a-f]+\n", told, flags=re.MULTILINE)[1:]:
        found[(_PLACE.findall(frames) or ["elsewhere"])[-1]] += 1
    return found


def main() -> int:
    if not CORE.exists():
        raise SystemExit(f"{CORE} is not built")
    found = places(CORE, calls(CORE))
    for place, number in sorted(found.items()):
        print(f"{number:5}  {place}")
    print(f"{found.total()} calls in {len(found)} lines")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
