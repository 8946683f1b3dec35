"""The library: machine files that come with the package, each with its source; and those of the examples."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError


def library() -> tuple[str, ...]:
    """Names of the machines of the library, and of the examples, in order."""
    return tuple(sorted(_files()))


def library_path(name: str) -> Path:
    """The file of a machine of the library.

    Parameters
    ----------
    name : str
        One of `library`.

    Returns
    -------
    Path
        The machine file.

    Raises
    ------
    InputError
        There is no such machine; names close ones.
    """
    known = _files()
    if name not in known:
        remedy = suggestion(name, tuple(known))
        raise InputError(f"no machine {name!r} in the library" + (f"; {remedy}" if remedy else ""))
    return known[name]


@cache
def _files() -> dict[str, Path]:
    """Files by name. They lie beside the modules, in a checkout by links to the folders of the clone."""
    package = Path(__file__).parents[2]
    machines = {path.stem: path for path in (package / "library").glob("*.toml")}
    examples = {path.parent.name: path for path in (package / "examples").glob("*/machine.toml")}
    return machines | examples
