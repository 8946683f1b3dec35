"""The folder of a sweep: a description, and its rows in files of equal length; what is missing is computed.

    _study.json             machine, study, version, hash, rows a file, units
    part-000000.parquet     rows 0 to n - 1
    part-000001.parquet     rows n to 2 n - 1
    .linkwright-lock        a byte for each file, claimed by the process that computes it

A file is a function of the hash and of its number alone, whoever computes it and whenever. It is written
under another name, brought to the disk and renamed, so that one that has its name is whole; no list of files
is kept. Jobs of one study may share a folder if each computes files of its own; a second run for the same
files is refused. Readers of Parquet pass over names that begin with ``_`` or a point.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from time import sleep
from typing import IO, Any

from linkwright import __version__
from linkwright.kernel.errors import InputError
from linkwright.kernel.files.output import unwritable, write_file
from linkwright.kernel.files.text_file import TextError, require_no_pipe
from linkwright.kernel.system import claims
from linkwright.machine.read import loads
from linkwright.machine.write import dumps
from linkwright.studies.model import StudyFile
from linkwright.studies.parquet import encoded, is_whole, require_pyarrow
from linkwright.studies.plan import StudyPlan, plan
from linkwright.studies.rows import LAYOUT, Rows

MANIFEST = "_study.json"

# Byte 0 stands for the description, byte n + 1 for file n; no folder has as many.
_LOCK, _ALL = ".linkwright-lock", 1 << 30

# How often it is asked for, since one that ends claims all for a moment, and how much longer each time [s].
_TRIES, _PAUSE = 4, 0.05

# Rows in a file: some 1 MB, and one to five seconds of one core; where analyses are made one by one, as long.
_ROWS, _ROWS_SINGLE = 10_000, 500


@dataclass(frozen=True)
class SweepFolder:
    """A folder of results."""

    path: Path  # the folder
    manifest: dict[str, Any] = field(repr=False)  # what stands in its description

    @property
    def n_rows(self) -> int:
        """Rows of the whole sweep."""
        return int(self.manifest["rows"])

    @property
    def chunk(self) -> int:
        """Rows in a file."""
        return int(self.manifest["chunk"])

    @property
    def n_parts(self) -> int:
        """Files of the whole sweep."""
        return -(-self.n_rows // self.chunk)

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column."""
        return dict(self.manifest["units"])

    @cached_property
    def about(self) -> bytes:
        """What stands in the metadata of each file."""
        return _text(self.manifest).encode()

    def part(self, number: int) -> Path:
        """The file of a number."""
        return self.path / f"part-{number:06d}.parquet"

    def rows_of(self, number: int) -> tuple[int, int]:
        """First row of a file, and the one after its last."""
        return number * self.chunk, min((number + 1) * self.chunk, self.n_rows)

    def is_done(self, number: int) -> bool:
        """Whether a file is there and whole."""
        rows = range(*self.rows_of(number))
        return self.part(number).exists() and is_whole(self.part(number), rows, self.units, self.about)

    def parts(self) -> Iterator[Path]:
        """The files that are there and whole, in their order."""
        return (self.part(number) for number in range(self.n_parts) if self.is_done(number))

    def begin(self) -> None:
        """Make the folder, or see that it holds the same study; else, or if not writable, an `InputError`."""
        require_pyarrow()
        try:
            if (self.path / MANIFEST).exists() and (manifest := _manifest_of(self.path / MANIFEST)):
                _require_same(_known(self.path, manifest), self)
                return
            if self.path.exists() and not self.path.is_dir():
                raise InputError(f"{self.path}: found a file, expected a folder")
            if not (self.path / MANIFEST).exists() and self.path.exists():
                self._require_nothing_else()
            self.path.mkdir(parents=True, exist_ok=True)
            with self._alone(0, 1, wait=True):
                self._describe()
        except OSError as error:
            raise unwritable(self.path, error) from None

    def _describe(self) -> None:
        """Write the description, unless another run of the same study was first."""
        place = self.path / MANIFEST
        if place.exists() and (manifest := _manifest_of(place)):
            _require_same(_known(self.path, manifest), self)
            return
        self._require_own_rows()
        write_file(place, _text(self.manifest))

    @contextmanager
    def claimed(self, first: int, last: int) -> Iterator[None]:
        """Compute files from the first to the one before the last; an `InputError` if another run does."""
        with self._alone(first + 1, last - first):
            yield

    @contextmanager
    def _alone(self, first: int, count: int, *, wait: bool = False) -> Iterator[None]:
        place = self.path / _LOCK
        for n in range(_TRIES):
            try:
                lock = place.open("ab")
            except OSError as error:
                raise unwritable(self.path, error) from None
            with lock:
                # One that was removed meanwhile holds nobody off.
                if claims(lock, first, count, wait=wait) and _is_still(lock, place):
                    try:
                        yield
                    finally:
                        if claims(lock, 0, _ALL):
                            _remove(place)
                    return
            sleep(_PAUSE * n)
        raise InputError(
            f"{self.path}: another process computes rows of this sweep; wait until it ends, or share the "
            "files by --chunks"
        )

    def _require_nothing_else(self) -> None:
        if any(not _is_ours(path) for path in self.path.iterdir()):
            raise InputError(
                f"{self.path}: found a folder with other files, expected a new or empty one, or that of "
                "an earlier run of the same study"
            )

    def _require_own_rows(self) -> None:
        if any(self.path.glob("part-*.parquet")) and next(self.parts(), None) is None:
            raise InputError(
                f"{self.path / MANIFEST}: found no description of a sweep, and rows of another study or "
                "another version of Linkwright beside it; nothing was changed; name another folder"
            )

    def write(self, number: int, rows: Rows) -> None:
        """Write the file of a number; an `InputError` if the disk is full, or cannot be written to."""
        self.put(number, encoded(rows, self.rows_of(number)[0], self.units, self.about))

    def put(self, number: int, data: bytes) -> None:
        """Write the file of a number as it is, likewise."""
        try:
            write_file(self.part(number), data)
        except InputError as error:
            raise InputError(f"{error}; rows that are written stay, and the same command resumes") from None


def new_folder(path: Path, ready: StudyPlan) -> SweepFolder:
    """The folder of a sweep, not made yet."""
    is_batch = all(asked.is_batch for asked in ready.asked)
    study = ready.study.model_dump(mode="json", by_alias=True, exclude_unset=True)
    known = {
        "machine": dumps(ready.machine),
        "study": study,
        "listed": _digest(ready),
        "version": __version__,
        "layout": LAYOUT,
        "rows": ready.n_rows,
        "chunk": ready.sweep.chunk or (_ROWS if is_batch else _ROWS_SINGLE),
        "units": ready.units,
    }
    return SweepFolder(path, {**known, "hash": _hash(known)})


def opened(path: Path) -> SweepFolder:
    """The folder of a sweep that was begun; an `InputError` if there is none."""
    require_pyarrow()
    place = path / MANIFEST
    manifest = _manifest_of(place)
    if manifest is None:
        raise InputError(
            f"{place}: found no description of a sweep; `linkwright sweep` with the same study writes it "
            "anew and keeps the rows that are there"
        )
    return _known(path, manifest)


def _known(path: Path, manifest: dict[str, Any]) -> SweepFolder:
    """The folder of a description; an `InputError` if its files have other columns."""
    if manifest.get("layout") != LAYOUT:
        raise InputError(
            f"{path / MANIFEST}: found files of another version of Linkwright, whose columns are others; "
            "open them with that version, or compute the sweep again in another folder"
        )
    return SweepFolder(path, manifest)


def _manifest_of(place: Path) -> dict[str, Any] | None:
    """The description of a sweep; None if the file holds none, an `InputError` if there is no file."""
    try:
        require_no_pipe(place)
        manifest = json.loads(place.read_text(encoding="utf-8"))
        if manifest.get("layout") not in (None, LAYOUT):
            return dict(manifest)
        known = {key: entry for key, entry in manifest.items() if key != "hash"}
        return dict(manifest) if manifest["hash"] == _hash(known) else None
    except FileNotFoundError:
        raise InputError(f"{place.parent}: found no {MANIFEST}, expected the folder of a sweep") from None
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError, TextError):
        return None
    except OSError as error:
        raise InputError(f"{place}: cannot be read ({error.strerror or error})") from None


def plan_of(manifest: dict[str, Any]) -> StudyPlan:
    """The study of a description: what a process elsewhere computes with."""
    study = StudyFile.model_validate(manifest["study"])
    return plan(loads(manifest["machine"]), study)


def _require_same(folder: SweepFolder, wanted: SweepFolder) -> None:
    if folder.manifest["hash"] == wanted.manifest["hash"]:
        return
    words = {"machine": "the machine", "study": "the study", "version": "the version of Linkwright"}
    parts = ({key: known.manifest.get(key) for key in words} for known in (folder, wanted))
    found, expected = ({key: json.dumps(value) for key, value in part.items()} for part in parts)
    other = [word for key, word in words.items() if found[key] != expected[key]]
    raise InputError(
        f"{folder.path}: found the results of another sweep ({' and '.join(other) or 'the list'} differs); "
        "nothing was changed; name another folder"
    )


def _is_ours(path: Path) -> bool:
    """Whether a file is what a run that was killed at its very beginning leaves behind."""
    return path.name == _LOCK or path.name.startswith(".linkwright-part-")


def _remove(place: Path) -> None:
    """Remove a file, unless it is held open, as on Windows, or gone."""
    try:
        place.unlink()
    except OSError:
        return


def _is_still(file: IO[bytes], place: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(file.fileno()), place.stat())
    except FileNotFoundError:
        return False


def _hash(manifest: dict[str, Any]) -> str:
    return sha256(_text(manifest).encode()).hexdigest()


def _text(manifest: dict[str, Any]) -> str:
    """A description as text, the same for the same study; variables in another order make other rows."""
    return json.dumps(manifest, ensure_ascii=False, indent=1) + "\n"


def _digest(ready: StudyPlan) -> str:
    return "" if ready.listed is None else sha256(ready.listed.tobytes()).hexdigest()
