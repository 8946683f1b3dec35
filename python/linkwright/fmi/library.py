"""The compiled library that an FMU contains, one for each platform.

The package has that of its own platform, and releases have those of all, so that an FMU that was made on one
system runs on the others. A file ``_fmu.x86_64-linux.so`` beside the package is one of a platform by its name
in FMI 3.0 (3.0.1, section 2.5.1.4.1).
"""

from __future__ import annotations

import platform as system
import shutil
import sys
from functools import cache
from pathlib import Path
from typing import NamedTuple

import linkwright
from linkwright.kernel.errors import InputError

# System → how FMI 3.0 calls it, and how libraries end there.
_SYSTEMS = {"linux": ("linux", ".so"), "win32": ("windows", ".dll"), "darwin": ("darwin", ".dylib")}

# FMI 2.0 knows platforms of x86 alone (2.0.4, section 2.3); others have their later name.
_FMI2 = {"x86_64-linux": "linux64", "x86_64-windows": "win64", "x86_64-darwin": "darwin64"}

# What processors are called where Python runs.
_PROCESSORS = {"amd64": "x86_64", "arm64": "aarch64"}


class Platform(NamedTuple):
    """A platform."""

    name: str  # in FMI 3.0, such as `x86_64-linux`
    suffix: str  # of a library there

    def folder(self, version: str) -> str:
        """Folder of its library below `binaries`."""
        return _FMI2.get(self.name, self.name) if version == "2.0" else self.name


def own_file() -> str:
    """Name of the library of this computer."""
    processor = system.machine().lower()
    name, suffix = _SYSTEMS.get(sys.platform, _SYSTEMS["linux"])
    return f"_fmu.{_PROCESSORS.get(processor, processor)}-{name}{suffix}"


@cache
def libraries(folder: Path | None = None) -> dict[Platform, bytes]:
    """The libraries that the package has, by platform. Raises `InputError` if that of this computer is
    missing.
    """
    home = folder or Path(linkwright.__file__).parent
    suffixes = [suffix for _, suffix in _SYSTEMS.values()]
    files = sorted(path for path in home.glob("_fmu.*") if path.suffix in suffixes)
    if own_file() not in {path.name for path in files}:
        raise InputError(
            f"{home / own_file()}: found no library for an FMU on this computer; build it in the clone of "
            "Linkwright: make fmu"
        )
    return {Platform(path.stem.removeprefix("_fmu."), path.suffix): path.read_bytes() for path in files}


def copy_built(folder: Path, home: Path) -> None:
    """Copy the library that Cargo built into the package, under the name of its platform."""
    name, suffix = own_file(), Path(own_file()).suffix
    prefix = "" if suffix == ".dll" else "lib"
    shutil.copyfile(folder / f"{prefix}linkwright_fmu{suffix}", home / name)


if __name__ == "__main__":
    copy_built(Path(sys.argv[1]), Path(linkwright.__file__).parent)
