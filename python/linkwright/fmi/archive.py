"""The archive that an FMU is: a zip with description, data and libraries.

The same machine gives the same bytes.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from io import BytesIO
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from linkwright.fmi.library import libraries

# The earliest date of a zip, for every file: the time of writing would make each archive another one.
_DATE = (1980, 1, 1, 0, 0, 0)

# A plain file that all may read.
_MODE = 0o100644 << 16

# Where the library of the FMU reads the machine.
MACHINE = "resources/machine.lw"

# Longest name of a library.
_NAME_MAX = 40


def identifier(name: str) -> str:
    """The name of a machine as an identifier of C: the library has it in the FMU."""
    kept = re.sub(r"[^A-Za-z0-9_]+", "_", name).strip("_")[:_NAME_MAX].strip("_") or "machine"
    return f"_{kept}" if kept[0].isdigit() else kept


def archive(description: bytes, machine: bytes, *, version: str, name: str) -> bytes:
    """Content of the file ``.fmu``. `name`: of the library in it."""
    written = BytesIO(_with_libraries(version, name))
    _add(written, {"modelDescription.xml": description, MACHINE: machine})
    return written.getvalue()


@lru_cache(maxsize=4)
def _with_libraries(version: str, name: str) -> bytes:
    """The archive with its libraries alone: to pack them takes longer than all else."""
    written = BytesIO()
    known = libraries().items()
    _add(written, {f"binaries/{each.folder(version)}/{name}{each.suffix}": data for each, data in known})
    return written.getvalue()


def _add(archive: BytesIO, files: Mapping[str, bytes]) -> None:
    """Add files to an archive."""
    with ZipFile(archive, "a", ZIP_DEFLATED) as target:
        for path, content in files.items():
            info = ZipInfo(path, _DATE)
            info.external_attr, info.compress_type = _MODE, ZIP_DEFLATED
            target.writestr(info, content)
