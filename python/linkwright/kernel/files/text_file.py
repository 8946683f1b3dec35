"""The text of a file that a user names: read whole, up to a limit, as UTF-8."""

from __future__ import annotations

from pathlib import Path

from linkwright.kernel.limits import Limit


class TextError(Exception):
    """Why a file has no text: what it is, and what to change; whoever reads it says where that stands."""

    def __init__(self, found: str, remedy: str = "", expected: str = "") -> None:
        super().__init__(found)
        self.found = found
        self.remedy = remedy
        self.expected = expected


def text_of(path: Path, limit: Limit) -> str:
    """The text of a file.

    A device without end is read no farther than the limit. A mark that editors on Windows put in front of the
    text is left out.

    Parameters
    ----------
    path : Path
        The file.
    limit : Limit
        Bytes that it may have.

    Returns
    -------
    str
        Its text.

    Raises
    ------
    TextError
        It cannot be read, is too large, or is no UTF-8 text.
    """
    try:
        with path.open("rb") as file:
            data = file.read(limit.most + 1)
    except IsADirectoryError:
        raise TextError("a directory") from None
    except FileNotFoundError:
        raise TextError("no such file") from None
    except PermissionError:
        raise TextError("a file without permission to read it") from None
    except (OSError, ValueError) as error:
        raise TextError(f"a file that cannot be read ({error})") from None
    if len(data) > limit.most:
        raise TextError("a larger file", expected=limit.words)
    return _decoded(data)


def _decoded(data: bytes) -> str:
    """The bytes as text, without what only programs write."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise TextError("UTF-16 text", "save the file as UTF-8")
    if b"\0" in data:
        place = data.index(b"\0") + 1
        raise TextError(f"no text (byte {place} is 0)", "save the file as UTF-8 text")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise TextError(f"no UTF-8 text (byte {error.start + 1})", "save the file as UTF-8") from None
