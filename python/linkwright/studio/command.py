"""``linkwright studio [FILE]``: see a machine move, drag a length, watch every answer change."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated
from urllib.parse import quote

import click

from linkwright.kernel.command.parameter import Argument, Option
from linkwright.kernel.errors import InputError
from linkwright.kernel.extras import require

File = Annotated[
    str | None,
    Argument("[FILE]", "A machine file below the present folder, or a machine of the library."),
]
NoBrowser = Annotated[bool, Option("--no-browser", help="Print only the address.")]
Port = Annotated[
    int,
    Option("--port", "N", "Port on this computer; 0 for that of the folder, or a free one.", min=0),
]


def studio(file: File = None, no_browser: NoBrowser = False, port: Port = 0) -> None:
    """Work on a machine in the browser.

    The page is served on this computer alone; its address opens it until the studio ends. Files are opened
    and saved below the present folder. The studio ends with Ctrl+C.
    """
    for package in ("starlette", "uvicorn", "websockets"):
        require(package, "studio", f"the studio needs {package}")
    from linkwright.studio.server import Studio

    try:
        opened = Studio(Path.cwd(), port)
    except (OSError, OverflowError) as error:
        raise InputError(f"--port {port}: {error}; leave it out for a free one") from None
    fragment = _fragment(file) if file else ""
    click.echo(f"Linkwright studio: {opened.address(fragment)}")
    click.echo(f"Files below {opened.folder.root}; end with Ctrl+C.")
    if not no_browser:
        import webbrowser

        webbrowser.open(opened.address(fragment, once=True))
    opened.run()


def _fragment(file: str) -> str:
    from linkwright.kernel.files.library import library
    from linkwright.studio.files import Folder

    if file in library() and not Path(file).exists():
        return f"open=library/{quote(file)}"
    folder = Folder.of(Path.cwd())
    path = Path(file).resolve()
    if not path.is_relative_to(folder.root):
        raise InputError(f"{file} lies outside the present folder; change to its folder first")
    name = path.relative_to(folder.root).as_posix()
    folder.read(name)
    return f"open=folder/{quote(name)}"
