"""Templates: machine files to start from, each complete and commented."""

from __future__ import annotations

from pathlib import Path

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError

_FOLDER = Path(__file__).with_name("templates")


def templates() -> dict[str, str]:
    """The templates that there are.

    Returns
    -------
    dict of str to str
        Name → what it describes, from its first line.
    """
    paths = sorted(_FOLDER.glob("*.toml"))
    return {path.stem: path.read_text(encoding="utf-8").split("\n", 1)[0].lstrip("# ") for path in paths}


def template(name: str) -> str:
    """The text of a template.

    Parameters
    ----------
    name : str
        Such as ``"slider-crank"``.

    Returns
    -------
    str
        A machine file.

    Raises
    ------
    InputError
        There is no such template.
    """
    known = templates()
    if name not in known:
        raise InputError(f'there is no template "{name}": {suggestion(name, known)}')
    return (_FOLDER / f"{name}.toml").read_text(encoding="utf-8")
