"""Files that a document names: machine files, studies and company files may come from a stranger.

What such an entry names lies in the folder of the document or below it, links followed, unless the user
allows more; nothing else is opened, and no message tells what is in it.
"""

from __future__ import annotations

from pathlib import Path

from linkwright.kernel.errors import MachineFileError, Problem, show

# What lets an entry lead out of the folder, where a command has that option.
ALLOW = ", or allow it: --allow-outside, or allow_outside=True in Python"


def named_file(
    name: str, folder: Path, key: str, *, allow_outside: bool = False, document: str = "machine file"
) -> Path:
    """The file that the entry at a key names, beside its document.

    `document`: what the entry stands in, for the message. Raises `MachineFileError` for a file that lies
    outside of the folder.
    """
    path = folder / name
    if not (allow_outside or _is_below(path, folder)):
        expected = f"a file in the folder of the {document}, or below it"
        remedy = "move it there" + (ALLOW if document != "company file" else "")
        raise MachineFileError([Problem(key, show(name), expected, remedy)])
    return path


def _is_below(path: Path, folder: Path) -> bool:
    """Whether a file lies in a folder or below it, links followed."""
    try:
        return path.resolve().is_relative_to(folder.resolve())
    except (OSError, ValueError, RuntimeError):
        # A name that no file has, or links in a circle: reading it tells what is wrong.
        return True
