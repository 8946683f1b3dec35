"""Files of the studio: machine files below the folder that it was started in, the library, the templates."""

from __future__ import annotations

import os
import stat
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from linkwright.kernel import system
from linkwright.kernel.errors import InputError
from linkwright.kernel.files.library import library, library_path, template, templates
from linkwright.kernel.files.output import write_file
from linkwright.kernel.files.text_file import TextError, text_of
from linkwright.kernel.limits import FILE_BYTES

# How deep below the folder machine files are looked for, and how many folders and files are listed.
_DEPTH = 4
_FOLDERS = 2000
_FILES = 500

# Characters of a name in a message: the longest name of a file.
_SHOWN = 255


@dataclass(frozen=True)
class Folder:
    """The folder that the studio was started in."""

    root: Path  # its real path

    @classmethod
    def of(cls, path: Path) -> Folder:
        """The folder at a path, links followed."""
        return cls(path.resolve())

    def inside(self, name: str, ending: str = ".toml") -> Path:
        """The real path of a machine file below the folder, wherever links lead; an `InputError` if it is
        none.

        `name`: relative to the folder, with strokes between its parts; `ending`: that of another file.
        """
        # On Windows a colon leads to another drive, or into a hidden stream of a file.
        is_elsewhere = Path(name).is_absolute() or (system.WINDOWS and ":" in name)
        if not name.isprintable() or not name.endswith(ending) or is_elsewhere:
            raise InputError(f"{name!r}: expected the name of a {ending} file below the folder {self.root}")
        try:
            path = (self.root / name).resolve()
        except (OSError, RuntimeError) as error:
            # A link that leads to itself is either, by the version of Python.
            words = getattr(error, "strerror", "") or "a link that leads to itself"
            raise InputError(f"{name[:_SHOWN]!r}: {words}") from None
        if not path.is_relative_to(self.root) or path.suffix != ending:
            raise InputError(f"{name!r} lies outside the folder {self.root}")
        return path

    def read(self, name: str) -> str:
        """The text of a machine file of the folder; an `InputError` if it cannot be read."""
        path = self.inside(name)
        try:
            if path.exists() and not stat.S_ISREG(path.stat().st_mode):
                raise InputError(f"{name!r}: expected a file")
            return text_of(path, FILE_BYTES)
        except TextError as error:
            expected = f", expected {error.expected}" if error.expected else ""
            raise InputError(
                f"{name}: found {error.found}{expected}; {error.remedy or 'choose another file'}"
            ) from None
        except OSError as error:
            raise InputError(f"{name}: {error.strerror}") from None

    def write(self, name: str, text: str, *, replace: bool) -> None:
        """Write a machine file whole or not at all; `InputError` if it cannot be, or is there unreplaced."""
        path = self.inside(name)
        if path.exists() and not (replace and path.is_file()):
            raise InputError(f"{name} exists already; choose another name")
        write_file(path, text)

    def machines(self) -> Iterator[dict[str, str]]:
        """Machine files of the folder: those that say their format."""
        for n, path in enumerate(self._files()):
            if n >= _FILES:
                return
            name = path.relative_to(self.root).as_posix()
            if title := _title(path):
                yield {"place": "folder", "name": name, "title": title}

    def _files(self) -> Iterator[Path]:
        for n, (at, folders, names) in enumerate(os.walk(self.root)):
            deep = len(Path(at).relative_to(self.root).parts)
            folders[:] = sorted(
                folder for folder in folders if folder[0] not in "._" and folder not in _NOT_OURS
            )
            if deep >= _DEPTH or n >= _FOLDERS:
                folders.clear()
            for name in sorted(names):
                path = Path(at) / name
                if name.endswith(".toml") and name[0] != "." and not path.is_symlink():
                    yield path


# Folders that hold no machine files of a user.
_NOT_OURS = frozenset({"node_modules", "target", "site", "build", "dist"})


def _title(path: Path) -> str:
    """Name of the machine of a file; empty if it is no machine file."""
    try:
        tables = tomllib.loads(text_of(path, FILE_BYTES))
    except (TextError, OSError, ValueError, RecursionError):
        return ""
    name = tables.get("name")
    is_machine = tables.get("format") == 1 and isinstance(name, str)
    return str(name) if is_machine else ""


def gallery(folder: Folder) -> list[dict[str, str]]:
    """Machines of library, templates and folder: ``place``, ``name`` and ``title``."""
    kept = [{"place": "library", "name": name, "title": _title(library_path(name))} for name in library()]
    begun = [{"place": "template", "name": name, "title": title} for name, title in templates().items()]
    return [*begun, *kept, *folder.machines()]


def opened(folder: Folder, place: str, name: str) -> str:
    """Text of a machine of ``"library"``, ``"template"`` or ``"folder"``; `InputError` if there is none."""
    if place == "library":
        return text_of(library_path(name), FILE_BYTES)
    if place == "template":
        return template(name)
    if place == "folder":
        return folder.read(name)
    raise InputError(f"{place!r}: expected library, template or folder")


def base(folder: Folder, place: str, name: str) -> str:
    """Path that a machine's further files, such as a table of points, are looked for beside."""
    if place == "library":
        return str(library_path(name))
    return str(folder.inside(name) if place == "folder" and name else folder.root / "unnamed.toml")
