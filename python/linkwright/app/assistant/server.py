"""The server of ``linkwright mcp``: tools on files below a folder, and what one reads to write such files.

Nothing is written, and no file outside the folder is read; a machine file holds no code.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from functools import wraps
from json import dumps
from pathlib import Path
from typing import Annotated, Any

import anyio
from mcp.server.mcpserver import MCPServer
from mcp.server.mcpserver.exceptions import ResourceNotFoundError
from mcp.types import CallToolResult, TextContent, ToolAnnotations
from pydantic import Field

import linkwright
from linkwright.app.assistant import SKILL
from linkwright.app.assistant.calls import Calls
from linkwright.app.assistant.explained import explained
from linkwright.app.assistant.offered import OFFERED
from linkwright.app.commands.schema import machine_schema
from linkwright.kernel.errors import InputError
from linkwright.kernel.files.library import study_templates
from linkwright.kernel.result import finite
from linkwright.studio.files import gallery, opened

_READS = ToolAnnotations(read_only_hint=True, open_world_hint=False)

_ADDRESS = "linkwright://example"

_File = Annotated[
    str,
    Field(
        description="A .toml file below the folder of the server, by its path from there, or the name of a "
        "machine of the library or of an example."
    ),
]
_Set = Annotated[
    list[str] | None,
    Field(
        description='Entries that replace or add to those of the file: "drive.gearbox.ratio=18", '
        '"mechanism.cranks.A.radius=90 mm".'
    ),
]
_Command = Annotated[
    str,
    Field(description=f"One of {', '.join(OFFERED)}. optimise, fit and tolerance take a study file."),
]
_Options = Annotated[
    dict[str, Any] | None,
    Field(
        description='Options of the command: {"at": "30 deg"}, {"curves": true}, a list for one that may be '
        "repeated. A name that is unknown is answered with those that there are."
    ),
]
_Keys = Annotated[
    list[str] | None,
    Field(
        description='Parts of `results` to keep, such as "steady_state.unevenness" or "forces". Default: all.'
    ),
]


def server(folder: Path, seconds: float) -> MCPServer[Any]:
    """The server for the files below a folder. `seconds`: that a tool may take."""
    calls = Calls.of(folder, seconds)
    made: MCPServer[Any] = MCPServer(
        "linkwright",
        instructions=guide(),
        version=linkwright.__version__,
        log_level="ERROR",
    )
    _add_tools(made, calls)
    _add_resources(made, calls)
    return made


def guide() -> str:
    """What an assistant needs to know: the skill file without its head."""
    return SKILL.read_text(encoding="utf-8").split("---\n", 2)[2].strip()


def _answers(tool: Callable[..., Awaitable[dict[str, Any]]]) -> Callable[..., Awaitable[CallToolResult]]:
    """A tool whose answer is one JSON object, or the message of an `InputError`."""

    @wraps(tool)
    async def answer(**given: Any) -> CallToolResult:
        try:
            text = dumps(finite(await tool(**given)), allow_nan=False, ensure_ascii=False)
        except InputError as error:
            return CallToolResult(content=[TextContent(text=str(error))], is_error=True)
        return CallToolResult(content=[TextContent(text=text)])

    return answer


def _add_tools(made: MCPServer[Any], calls: Calls) -> None:
    @made.tool(annotations=_READS, structured_output=False)
    @_answers
    async def check(file: _File, set: _Set = None) -> dict[str, Any]:
        """Check a machine file: all errors at once, each with file, line, key, what was found, what was
        expected and a remedy; then whether the machine closes and moves. `findings` is empty if it is sound.
        """
        return await calls.run("check", file, set or ())

    @made.tool(annotations=_READS, structured_output=False)
    @_answers
    async def run(
        file: _File, command: _Command = "run", set: _Set = None, options: _Options = None, keys: _Keys = None
    ) -> dict[str, Any]:
        """Compute a machine: `machine`, `results` (SI units, angles in rad), `findings` (failed checks),
        `warnings`. Read findings and warnings before the numbers; explain says what a name means.
        """
        return await calls.run(command, file, set or (), options, keys or ())

    @made.tool(annotations=_READS, structured_output=False)
    @_answers
    async def sweep(
        file: Annotated[str, Field(description="A study file (.toml) below the folder of the server.")],
        set: _Set = None,
        first: Annotated[int, Field(description="First row that is wanted, from 0.")] = 0,
        rows: Annotated[int, Field(description="How many rows are wanted, at most 1000.")] = 100,
    ) -> dict[str, Any]:
        """Compute many variants of a machine by a study file: extremes of the responses with their rows, why
        rows failed, and the rows themselves as columns.
        """
        return await calls.sweep(file, set or (), first=first, rows=rows)

    @made.tool(annotations=_READS, structured_output=False)
    @_answers
    async def explain(
        what: Annotated[
            str,
            Field(
                description='An address or key of the file ("drive.gearbox.ratio"), a name of the results '
                '("steady_state.unevenness"), a term or symbol of the field, or a whole message.'
            ),
        ],
    ) -> dict[str, Any]:
        """Explain an entry of the machine file (what it holds, unit, bounds, default), a quantity of the
        results (words, symbol, unit), a term (definition, source), or what a message names.
        """
        return await anyio.to_thread.run_sync(explained, what)


def _add_resources(made: MCPServer[Any], calls: Calls) -> None:
    text, json = "text/plain", "application/json"

    @made.resource("linkwright://guide", name="guide", mime_type="text/markdown")
    def read_guide() -> str:
        """How to write and check a machine file."""
        return guide()

    @made.resource("linkwright://schema", mime_type=json)
    def schema() -> str:
        """JSON Schema of machine files, with the meaning of every entry."""
        return dumps(machine_schema())

    @made.resource("linkwright://examples", mime_type=json)
    def examples() -> str:
        """Machine files to start from: templates, the library with the examples, and those of the folder."""
        found = [
            *gallery(calls.folder),
            *({"place": "template", "name": name, "title": each} for name, each in study_templates().items()),
        ]
        listed = [each | {"uri": f"{_ADDRESS}/{each['place']}/{each['name']}"} for each in found]
        return dumps(listed, ensure_ascii=False)

    @made.resource(f"{_ADDRESS}/{{place}}/{{+name}}", mime_type=text)
    def example(place: str, name: str) -> str:
        """The text of a machine file: `place` is template, library or folder."""
        try:
            return opened(calls.folder, place, name)
        except InputError as error:
            raise ResourceNotFoundError(str(error)) from None
