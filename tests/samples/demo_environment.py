"""Commands of Linkwright without the packages of development: with what the package and some extras install.

    python demo_environment.py EXTRA,EXTRA 'linkwright new press' 'linkwright run press' …

runs the commands in one process, in the present folder, and writes a line of JSON for each: command, exit
code and output. A command that serves, ``linkwright studio``, stands alone and runs as it does in a shell.
"""

from __future__ import annotations

import json
import shlex
import sys
import tomllib
from collections.abc import Iterator, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

PROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def needed(extras: Sequence[str]) -> set[str]:
    """The distributions that the package with these extras brings, those that they need included."""
    texts = PROJECT["dependencies"] + [
        text for extra in extras for text in PROJECT["optional-dependencies"][extra]
    ]
    left = [(Requirement(text), "") for text in texts]
    known: set[tuple[str, str]] = set()
    while left:
        requirement, extra = left.pop()
        if requirement.marker is not None and not requirement.marker.evaluate({"extra": extra}):
            continue
        name = canonicalize_name(requirement.name)
        for wanted in {"", *requirement.extras}:
            if (name, wanted) not in known:
                known.add((name, wanted))
                left += [(Requirement(text), wanted) for text in metadata.requires(name) or ()]
    return {name for name, _ in known} | {"linkwright"}


def surplus(extras: Sequence[str]) -> set[str]:
    present = needed(extras)
    owners = metadata.packages_distributions().items()
    return {module for module, names in owners if not present & set(map(canonicalize_name, names))}


class Finder:
    """A finder of modules that does not find some of them."""

    def __init__(self, finder: Any, hidden: set[str]) -> None:
        self._finder = finder
        self._hidden = hidden

    def find_spec(self, name: str, *more: Any) -> Any:
        return None if name.partition(".")[0] in self._hidden else self._finder.find_spec(name, *more)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._finder, name)


def hide(extras: Sequence[str]) -> None:
    """Let only what the package with these extras brings be imported."""
    hidden = surplus(extras)
    sys.meta_path[:] = [Finder(finder, hidden) for finder in sys.meta_path]
    for name in [name for name in sys.modules if name.partition(".")[0] in hidden]:
        del sys.modules[name]


def answers(lines: Sequence[str]) -> Iterator[tuple[str, int, str]]:
    from click.testing import CliRunner

    from linkwright.app.application import application

    for line in lines:
        done = CliRunner().invoke(application(), shlex.split(line, comments=True)[1:])
        yield line, done.exit_code, done.output


if __name__ == "__main__":
    hide(sys.argv[1].split(","))
    if sys.argv[2].startswith("linkwright studio"):
        from linkwright.app import main

        sys.argv = shlex.split(sys.argv[2], comments=True)
        main()
    for answer in answers(sys.argv[2:]):
        print(json.dumps(answer), flush=True)
