"""The library: machine files that come with the package, each with its source."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError


def library() -> tuple[str, ...]:
    """Names of the machines of the library, in order."""
    return tuple(sorted(path.stem for path in _folder().glob("*.toml")))


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
    path = _folder() / f"{name}.toml"
    if name not in library():
        remedy = suggestion(name, library())
        raise InputError(f"no machine {name!r} in the library" + (f"; {remedy}" if remedy else ""))
    return path


def _folder() -> Path:
    """Where the library lies: beside the modules; in a checkout a link to ``machines/``."""
    return Path(str(files("linkwright"))) / "library"
