"""Files of the package: machines of the library, examples, and templates to start from."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError

_PACKAGE = Path(__file__).parents[2]


def library() -> tuple[str, ...]:
    """Names of the machines of the library, and of the examples, in order."""
    return tuple(sorted(_files()))


def library_path(name: str) -> Path:
    """The file of a machine of the library; an `InputError` names close ones if there is none."""
    known = _files()
    if name not in known:
        remedy = suggestion(name, tuple(known))
        raise InputError(f"no machine {name!r} in the library" + (f"; {remedy}" if remedy else ""))
    return known[name]


@cache
def _files() -> dict[str, Path]:
    """Files by name. They lie beside the modules, in a checkout by links to the folders of the clone."""
    machines = {path.stem: path for path in _folder("library").glob("*.toml")}
    examples = {path.parent.name: path for path in _folder("examples").glob("*/machine.toml")}
    return machines | examples


def _folder(name: str) -> Path:
    """A folder beside the modules; Git on Windows may write the link of a clone as a file with its target."""
    place = _PACKAGE / name
    return _PACKAGE / place.read_text(encoding="utf-8").strip() if place.is_file() else place


def studies() -> dict[str, Path]:
    """Files of the studies of the examples, by the name of the example."""
    return {path.parent.name: path for path in sorted(_folder("examples").glob("*/study.toml"))}


_MACHINES = Path(__file__).with_name("templates")
_STUDIES = _PACKAGE / "studies" / "templates"
_TASKS = _PACKAGE / "synthesis" / "templates"


def templates() -> dict[str, str]:
    """Names of the templates of machine files → what they describe, from their first lines."""
    return _described(_MACHINES)


def study_templates() -> dict[str, str]:
    """Names of the templates of study files → what they describe."""
    return _described(_STUDIES)


def task_templates() -> dict[str, str]:
    """Names of the templates of tasks of synthesis → what they describe."""
    return _described(_TASKS)


def _described(folder: Path) -> dict[str, str]:
    paths = sorted(folder.glob("*.toml"))
    return {path.stem: path.read_text(encoding="utf-8").split("\n", 1)[0].lstrip("# ") for path in paths}


def template(name: str) -> str:
    """The text of a template such as ``"slider-crank"``; an `InputError` names close ones if none has it."""
    folders = {known: folder for folder in (_TASKS, _STUDIES, _MACHINES) for known in _described(folder)}
    if name not in folders:
        close = suggestion(name, tuple(folders))
        listed = "`linkwright new --list` names them all"
        raise InputError(
            f'there is no template "{name}"; ' + "; ".join(part for part in (close, listed) if part)
        )
    return (folders[name] / f"{name}.toml").read_text(encoding="utf-8")
