"""Everything that is written to a disk: files that are whole or not there, and never over somebody else's.

A file is written beside its place under a name of its own, brought to the disk, and only then renamed, so
that a reader, a crash or a full disk meets the old file or the new one. A folder of results keeps a list of
the files in it, `MARKER`; a later run replaces those, and nothing else. A link is never followed: what it
leads to may lie anywhere.
"""

from __future__ import annotations

import os
import platform
import re
import secrets
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from errno import EDQUOT, EFBIG, ENOSPC
from pathlib import Path
from zlib import crc32

from linkwright.kernel import system
from linkwright.kernel.errors import InputError

# Lists the files of a folder that are ours.
MARKER = ".linkwright"

_HEAD = "# Files that Linkwright wrote into this folder: it replaces these and no others.\n"

# What every file that is not finished is called, before the computer and the process that write it. A run
# that is killed leaves it behind, and the next one that writes into the folder removes it.
_PART = ".linkwright-part-"
_PART_NAME = re.compile(re.escape(_PART) + r"([0-9a-f]{8})-(\d+)-[0-9a-f]{8}\b")

# Names that Windows keeps for devices, whatever follows a point (Microsoft, Naming Files, Paths, Namespaces).
_DEVICES = frozenset(
    ["con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(10))]
)

# Bytes of a name made from words: 255 is what file systems take, and endings follow.
_NAME_BYTES = 120

# Names in a message: as many as fit on a line.
_NAMED = 3

Contents = Mapping[str, str | bytes]


def write_file(path: str | os.PathLike[str], content: str | bytes, *, replace: bool = True) -> None:
    """Write one file, whole or not at all; a text becomes UTF-8 as it is.

    Raises `InputError` if the file exists and is not to be replaced, is a link or no file, or cannot be
    written.
    """
    place = Path(path)
    try:
        _require_free(place, replace=replace)
        _write_all({place: content})
    except OSError as error:
        raise unwritable(place, error) from None


def require_place(place: Path, *, replace: bool) -> None:
    """Refuse, before anything is computed, what `write_file` would refuse in the end."""
    try:
        _require_free(place, replace=replace)
        _require_writable(place)
    except OSError as error:
        raise unwritable(place, error) from None


def _require_free(place: Path, *, replace: bool) -> None:
    if os.path.lexists(place):
        _require_file(place)
        if not replace:
            raise InputError(f"{place}: exists already; --force replaces it")


def _require_writable(place: Path) -> None:
    """Raise the `OSError` of a folder in which no file can be made; rights alone do not tell."""
    part = _part(place)
    try:
        part.touch(exist_ok=False)
    finally:
        _remove([part])


@contextmanager
def trial(path: Path) -> Iterator[Path]:
    """A file for a program that writes by itself: it gets its name if all goes well, else it vanishes.

    Yields where to write meanwhile: in the same folder, with the same ending. A file that exists is replaced.
    """
    if os.path.lexists(path):
        _require_file(path)
    _remove_stale(path.parent)
    part = _part(path)
    try:
        yield part
        with part.open("rb+") as file:
            os.fsync(file.fileno())
        system.rename(part, path)
    finally:
        _remove([part])


@dataclass(frozen=True)
class OutputFolder:
    """A folder of results: new, empty, or written by an earlier run."""

    path: Path  # the folder; made when it is written to
    # Whether files of others may lie in it, and are replaced where the names are the same.
    force: bool = False

    def require(self) -> None:
        """Refuse by an `InputError` what is no folder, cannot be read, or holds files of no earlier run."""
        try:
            names = sorted(path.name for path in self.path.iterdir() if not path.name.startswith(_PART))
            _require_writable(self.path / MARKER)
        except FileNotFoundError:
            self._require_place_above()
            return
        except NotADirectoryError:
            raise InputError(f"{self.path}: found a file, expected a folder for --out") from None
        except OSError as error:
            raise unwritable(self.path, error) from None
        if names and MARKER not in names and not self.force:
            listed = ", ".join(names[:_NAMED]) + (", …" if len(names) > _NAMED else "")
            raise InputError(
                f"{self.path}: found a folder with other files ({listed}), expected a new or empty one, "
                "or one that Linkwright wrote; name another, or add --force"
            )

    def write(self, contents: Contents) -> list[Path]:
        """Write files, name → content, all of them or, if the disk is full, none; returns their paths.

        Raises `InputError` as `require`, if a file of others has one of the names, or if it cannot be written
        to.
        """
        self.require()
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            known = self._known()
            for name in contents:
                self._require_ours(name, known)
            listed = _HEAD + "".join(f"{name}\n" for name in sorted(known | contents.keys()))
            # The list comes first: whatever a crash leaves behind is known as ours.
            marked = {MARKER: listed, **contents}
            _write_all({self.path / name: content for name, content in marked.items()})
        except OSError as error:
            raise unwritable(self.path, error) from None
        return [self.path / name for name in contents]

    def _require_place_above(self) -> None:
        above = next((parent for parent in self.path.parents if parent.exists()), None)
        if above is None:
            return
        if not above.is_dir():
            raise InputError(f"{self.path}: found a file {above}, expected a folder for --out")
        try:
            _require_writable(above / self.path.name)
        except OSError as error:
            raise unwritable(self.path, error) from None

    def _known(self) -> frozenset[str]:
        marker = self.path / MARKER
        if not os.path.lexists(marker):
            return frozenset()
        _require_file(marker)
        lines = marker.read_text(encoding="utf-8", errors="replace").splitlines()
        return frozenset(line for line in lines if line and not line.startswith("#"))

    def _require_ours(self, name: str, known: frozenset[str]) -> None:
        place = self.path / name
        assert place.parent == self.path, "names are plain: see file_names"
        if not os.path.lexists(place):
            return
        _require_file(place)
        if name not in known and not self.force:
            raise InputError(f"{place}: exists and is not of an earlier run; --force replaces it")


def file_name(words: str) -> str:
    """A name that every file system takes: letters, digits, points, ``-``, others as ``_``; no ending."""
    kept = "".join(letter if letter.isalnum() or letter in "-_." else "_" for letter in words.strip())
    name = kept.encode()[:_NAME_BYTES].decode(errors="ignore").strip("_. ")
    head, point, rest = name.partition(".")
    return f"{head}_{point}{rest}" if head.casefold() in _DEVICES else name


def file_names(words: Mapping[str, str]) -> dict[str, str]:
    """Names of files for texts that may be the same but for letters that file systems do not take.

    Text → ending, such as ``{"cam.A/1": ".csv"}``, becomes text → name with its ending, no two the same, not
    even in letters of the other case.
    """
    names: dict[str, str] = {}
    taken: set[str] = set()
    for text, ending in words.items():
        stem = file_name(text) or "file"
        tries = (f"{stem}{f'_{n}' if n > 1 else ''}{ending}" for n in range(1, len(words) + 2))
        names[text] = next(name for name in tries if name.casefold() not in taken)
        taken.add(names[text].casefold())
    return names


def _write_all(contents: Mapping[Path, str | bytes]) -> None:
    for folder in {place.parent for place in contents}:
        _remove_stale(folder)
    parts: dict[Path, Path] = {}
    try:
        for place, content in contents.items():
            parts[place] = _part(place)
            _write_part(parts[place], place, _bytes(content))
        for place, part in parts.items():
            system.rename(part, place)
    finally:
        _remove(list(parts.values()))


def _remove(parts: list[Path]) -> None:
    """Remove unfinished files, all of them even if an interrupt comes meanwhile."""
    try:
        while parts:
            parts[-1].unlink(missing_ok=True)
            parts.pop()
    except KeyboardInterrupt:
        _remove(parts)
        raise


def _remove_stale(folder: Path) -> None:
    here = _computer()
    for place in folder.glob(f"{_PART}*"):
        name = _PART_NAME.match(place.name)
        if name is not None and name[1] == here and not system.is_alive(int(name[2])) and _is_ours(place):
            try:
                place.unlink(missing_ok=True)
            except PermissionError:
                # On Windows it may be held open, or be of another user; a later run removes it.
                continue


def _is_ours(place: Path) -> bool:
    """Whether a file is of this user: in a folder of all, such as /tmp, others' files cannot be removed."""
    return system.WINDOWS or (place.exists() and place.lstat().st_uid == os.getuid())


def _computer() -> str:
    """Short identifier of this computer: processes of others that share a folder are not seen."""
    return f"{crc32(platform.node().encode()):08x}"


def _bytes(content: str | bytes) -> bytes:
    """UTF-8; a path that is no text may stand in a command line that is quoted."""
    return content.encode(errors="backslashreplace") if isinstance(content, str) else content


def _part(place: Path) -> Path:
    return place.with_name(f"{_PART}{_computer()}-{os.getpid()}-{secrets.token_hex(4)}{place.suffix}")


def _write_part(part: Path, place: Path, data: bytes) -> None:
    """Bring bytes to the disk; with the permissions of the file that they replace."""
    with part.open("xb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    # Windows knows one permission, to write, and removes no file without it.
    if place.exists() and not system.WINDOWS:
        part.chmod(stat.S_IMODE(place.stat().st_mode))


def _require_file(place: Path) -> None:
    """Refuse to replace what is no plain file: a link, a folder, a device."""
    mode = os.lstat(place).st_mode
    if stat.S_ISLNK(mode):
        raise InputError(f"{place}: found a link, expected a file; name the file that it leads to")
    if not stat.S_ISREG(mode):
        found = "a folder" if stat.S_ISDIR(mode) else "a device"
        raise InputError(f"{place}: found {found}, expected a file")


def unwritable(place: Path, error: OSError) -> InputError:
    """The error for a file or folder that cannot be written."""
    if error.errno in (ENOSPC, EDQUOT, EFBIG):
        return InputError(
            f"{place}: the disk is full; nothing was replaced; free some space or write elsewhere"
        )
    is_held = system.WINDOWS and isinstance(error, PermissionError)
    remedy = "; close it in other programs, or name another" if is_held else ""
    return InputError(f"{place}: cannot be written ({error.strerror or error}){remedy}")
