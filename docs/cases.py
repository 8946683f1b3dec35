"""Write the page of cases that tools got wrong: ``python docs/cases.py``.

A case is a file ``tests/cases/NAME.toml``: question, mistake, answer, machine and command. Its right answer
is computed by the function NAME of `tests/cases/derivations.py`; Linkwright's is what the command gives while
the page is written. A test fails if the page is not what this file would write, or the numbers differ.
"""

from __future__ import annotations

import importlib.util
import json
import math
import os
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from click.testing import CliRunner

from linkwright.app.application import application

PAGE = Path(__file__).with_name("cases.md")
FOLDER = Path(__file__).parents[1] / "tests" / "cases"

# Unit of the page → how many of it an SI unit has.
UNITS = {"": 1.0, "mm": 1e3, "m/s": 1.0, "deg": 180 / math.pi, "rpm": 30 / math.pi}
UNITS |= {"Hz": 1.0, "N m": 1.0, "kg m²": 1.0}

_HEAD = """# Cases that tools got wrong

Public reports of wrong results in this field, and mistakes of calculations by hand, as questions with
numbers: what goes wrong, the right answer with its derivation, and Linkwright's. Each case is a test: the
closed form is computed apart from Linkwright, which must agree, and this page is written from both
(`python docs/cases.py`). "–" means that the mistake gives no number.

"""


class Case(NamedTuple):
    """A case with what Linkwright answers."""

    name: str
    told: dict[str, Any]  # the file of the case
    right: list[tuple[float, float | None]]  # right value and that of the mistake, in SI
    found: list[float]  # what Linkwright gives, in SI
    findings: list[str]


def cases() -> Iterator[Case]:
    """All cases in the order of the page."""
    for derive in _derivations().CASES:
        name = derive.__name__
        told = tomllib.loads((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))
        answer = _answer(name, told["machine"], told["command"])
        further = _answer(name, told["machine"], told["further"]) if "further" in told else {"findings": []}
        found = [_at(answer["results"], shown["key"]) for shown in told["shown"]]
        yield Case(name, told, derive(), found, [*answer["findings"], *further["findings"]])


def _derivations() -> Any:
    spec = importlib.util.spec_from_file_location("derivations", FOLDER / "derivations.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _answer(name: str, machine: str, command: str) -> Any:
    """The JSON object of a command on a machine."""
    here = Path.cwd()
    with TemporaryDirectory() as folder:
        try:
            os.chdir(folder)
            Path(f"{name}.toml").write_text(machine, encoding="utf-8")
            done = CliRunner().invoke(application(), [*shlex.split(_line(name, command)), "--json"])
        finally:
            os.chdir(here)
    assert done.exit_code in (0, 1), f"{name}: {done.output}"
    return json.loads(done.stdout)


def _line(name: str, command: str) -> str:
    return command.replace("FILE", f"{name}.toml")


def _at(results: Any, key: str) -> float:
    """The number at a key, with places of lists; names may contain points."""
    if not key:
        return float(results)
    if isinstance(results, list):
        place, _, rest = key.partition(".")
        return _at(results[int(place)], rest)
    head = max((each for each in results if key == each or key.startswith(f"{each}.")), key=len)
    return _at(results[head], key[len(head) + 1 :])


def page() -> str:
    """The page as it should be."""
    known = list(cases())
    listed = "".join(f"- [{case.told['title']}](#{_anchor(case.told['title'])})\n" for case in known)
    return _HEAD + listed + "".join(map(_section, known))


def _anchor(title: str) -> str:
    return "".join(each for each in title.lower().replace(" ", "-") if each.isalnum() or each == "-")


def _section(case: Case) -> str:
    told = case.told
    further = f"$ linkwright {_line(case.name, told['further'])}\n" if "further" in told else ""
    said = "".join(f"\n> {finding}\n" for finding in case.findings)
    return f"""
## {told["title"]}

{told["question"].strip()}

**What goes wrong.** {told["mistake"].strip()}

*Source:* {told.get("source", "a mistake of calculations by hand")}.

**Right answer.** {told["answer"].strip()}

```toml
# {case.name}.toml
{told["machine"].strip()}
```

```console
$ linkwright {_line(case.name, told["command"])} --json
{further}```

| result | Linkwright | closed form | by the mistake |
| --- | ---: | ---: | ---: |
{"".join(_rows(case))}{said}"""


def _rows(case: Case) -> Iterator[str]:
    for shown, found, (right, wrong) in zip(case.told["shown"], case.found, case.right, strict=True):
        unit = shown["unit"]
        values = " | ".join(_value(value, unit) for value in (found, right, wrong))
        yield f"| {shown['word']} (`{shown['key']}`) | {values} |\n"


def _value(value: float | None, unit: str) -> str:
    """A value in a unit with six digits."""
    if value is None:
        return "–"
    number = f"{value * UNITS[unit]:.6g}".replace("-", "−")
    return f"{number}°" if unit == "deg" else f"{number} {unit}".strip()


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
