"""Every number of the product: written to a file, and compared with those of another state of the tree.

``python benches/dump.py write OUT.json`` runs every command over all machines, examples and templates;
``python benches/dump.py compare BEFORE.json AFTER.json`` tells every number that differs by more than
1e-12 of the largest of its list, and ends with 1 if there is one.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]

COMMANDS = ("run", "torsion", "cam", "motion", "forces", "size", "check")

# Rounding of sums in another order; a list is measured by its largest number.
TOLERANCE = 1e-12

# Commands of one process: it starts once for all of them.
_RUN = """
import json, sys
from linkwright.app import application
from click.testing import CliRunner
app, runner = application(), CliRunner()
for command in json.loads(sys.argv[2]):
    answer = runner.invoke(app, [command, sys.argv[1], *(["--json"] if command != "check" else [])])
    broken = answer.exception if not isinstance(answer.exception, SystemExit) else None
    print(json.dumps([command, answer.exit_code, answer.stdout, answer.stderr, repr(broken)]), flush=True)
"""


def files() -> list[Path]:
    """Machine files of the library, the gallery and the templates."""
    found = [*ROOT.glob("machines/*.toml"), *ROOT.glob("examples/**/*.toml")]
    return sorted(found + list(ROOT.glob("python/linkwright/**/templates/*.toml")))


def answers(path: Path) -> dict[str, Any]:
    """What every command says of one file."""
    run = subprocess.run(
        [sys.executable, "-c", _RUN, str(path.relative_to(ROOT)), json.dumps(COMMANDS)],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env={**os.environ, "OMP_NUM_THREADS": "1", "COLUMNS": "200"},
        check=False,
    )
    lines = [json.loads(line) for line in run.stdout.splitlines()]
    if len(lines) != len(COMMANDS):
        raise SystemExit(f"{path}: {run.stderr}")
    return {command: _answer(*rest) for command, *rest in lines}


def _answer(code: int, out: str, err: str, broken: str) -> dict[str, Any]:
    """Exit code, what is printed as JSON or as text, and errors."""
    try:
        told: Any = json.loads(out)
    except json.JSONDecodeError:
        told = out
    return {"exit": code, "out": told, "err": err, "broken": broken}


def write(out: Path) -> None:
    """Run everything and keep it."""
    with ThreadPoolExecutor(2) as pool:
        told = dict(zip([_key(path) for path in files()], pool.map(answers, files()), strict=True))
    with tempfile.NamedTemporaryFile("w", dir=out.parent, delete=False) as file:
        json.dump(told, file)
    Path(file.name).replace(out)
    print(f"{len(told)} files, {sum(len(list(_numbers(each))) for each in told.values())} numbers")


def _key(path: Path) -> str:
    """A template keeps its name wherever the package keeps it."""
    return f"templates/{path.name}" if "templates" in path.parts else str(path.relative_to(ROOT))


def _numbers(told: Any) -> Iterator[float]:
    """All numbers in what was told."""
    if isinstance(told, dict):
        for each in told.values():
            yield from _numbers(each)
    elif isinstance(told, list):
        for each in told:
            yield from _numbers(each)
    elif isinstance(told, (int, float)):
        yield told


def differences(a: Any, b: Any, at: str, scale: float = 0.0) -> Iterator[str]:
    """Where two answers differ: keys, texts, numbers beyond the tolerance."""
    if isinstance(a, dict) and isinstance(b, dict):
        yield from (f"{at}: only before: {key}" for key in a.keys() - b.keys())
        yield from (f"{at}: only after: {key}" for key in b.keys() - a.keys())
        for key in a.keys() & b.keys():
            yield from differences(a[key], b[key], f"{at}.{key}")
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        largest = max((abs(x) for x in _numbers(a) if math.isfinite(x)), default=0.0)
        for i, pair in enumerate(zip(a, b, strict=True)):
            yield from differences(*pair, f"{at}[{i}]", largest)
    elif _are_numbers(a, b):
        if not abs(a - b) <= TOLERANCE * max(abs(a), abs(b), scale) and not (math.isnan(a) and math.isnan(b)):
            yield f"{at}: {a!r} → {b!r}"
    elif a != b:
        yield f"{at}: {str(a)[:300]!r} → {str(b)[:300]!r}"


def _are_numbers(a: Any, b: Any) -> bool:
    return all(isinstance(x, (int, float)) and not isinstance(x, bool) for x in (a, b))


def compare(before: Path, after: Path) -> int:
    """Print what differs; 1 if anything does."""
    found = list(differences(json.loads(before.read_text()), json.loads(after.read_text()), ""))
    print("\n".join(found) or "equal")
    return int(bool(found))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    todo = parser.add_subparsers(dest="todo", required=True)
    todo.add_parser("write").add_argument("out", type=Path)
    compared = todo.add_parser("compare")
    compared.add_argument("before", type=Path)
    compared.add_argument("after", type=Path)
    given = parser.parse_args()
    if given.todo == "write":
        write(given.out)
        return 0
    return compare(given.before, given.after)


if __name__ == "__main__":
    sys.exit(main())
