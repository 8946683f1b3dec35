"""Commands that an assistant may run, with the options that it may give: none of them writes a file.

An option that names a file takes one below the folder of the assistant.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import click

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError

# Command, of one machine or study file → its options, as they are written after the dashes.
OFFERED: Mapping[str, tuple[str, ...]] = {
    "check": (),
    "run": ("zero", "accuracy", "method", "step", "curves"),
    "motion": ("at", "speed", "acceleration", "zero", "steps"),
    "transient": (
        *("from-angle", "from-speed", "duration", "revolutions", "no-motor", "brake", "clockwise"),
        *("switch", "rigid", "zero", "accuracy", "steps", "curves"),
    ),
    "elastic": ("over", "from", "to"),
    "forces": (
        *("at", "speed", "acceleration", "angles", "zero", "case", "friction", "pressure-angle", "curves"),
    ),
    "loads": ("link", "speed", "acceleration", "angles", "zero", "friction", "pressure-angle", "curves"),
    "rods": ("card", "period", "damping", "harmonics", "curves"),
    "axes": ("speed", "clearance", "keep", "catalogue", "gearboxes", "axis", "goal", "curves"),
    "balance": ("links", "slider", "share", "radius", "planes", "speed"),
    "sensitivity": ("of", "by"),
    "size": (
        *("power-reserve", "unevenness", "by", "free-ratio", "together", "catalogue", "keep-motor"),
        "minimum-cost",
        *("per-kilowatt", "per-kilogram", "flywheel-radius", "run-up-time", "inertia"),
        *("pressure-angle", "contact-stress", "shaft", "stress", "torque", "part"),
    ),
    "cam": ("curves",),
    "torsion": ("holzer", "measured", "curves"),
    "topper": ("zero", "accuracy", "curves"),
    "optimise": ("evaluations", "seed", "method", "starts", "points"),
    "fit": ("record", "vary", "motion", "level"),
    "tolerance": ("rows", "seed", "indices", "allocate", "cost-power"),
}


def words(
    command: str,
    file: str,
    entries: Sequence[str],
    options: Mapping[str, Any],
    place: Callable[[str], str],
) -> list[str]:
    """The command line of a command of `OFFERED` that answers in JSON.

    `entries`: as for ``--set``; `options`: by name, with or without dashes; `place`: name of a file that an
    option names → its real place. Raises `InputError` for a command or an option that is not offered.
    """
    if command not in OFFERED:
        raise InputError(_refusal("command", command, OFFERED))
    given = [word for name, value in options.items() for word in _option(command, name, value, place)]
    # A word with its option cannot be taken for another one; after the dashes a name is no option either.
    return [command, "--json", *(f"--set={entry}" for entry in entries), *given, "--", file]


def _option(command: str, name: str, value: Any, place: Callable[[str], str]) -> Iterator[str]:
    """An option as words of a command line: a flag, a value, or each of several."""
    key = name.lstrip("-").replace("_", "-")
    if key not in OFFERED[command]:
        raise InputError(_refusal(f"option of {command}", name, OFFERED[command]))
    option = next(each for each in params(command) if f"--{key}" in each.opts)
    if isinstance(option, click.Option) and option.is_flag:
        if not isinstance(value, bool):
            raise InputError(f"options.{name}: found {value!r}, expected true or false")
        yield from [f"--{key}"] if value else ()
        return
    for each in value if isinstance(value, list) else (value,):
        if isinstance(each, bool) or not isinstance(each, str | int | float):
            raise InputError(f'options.{name}: found {each!r}, expected a text such as "30 deg", or a number')
        yield f"--{key}={place(str(each)) if isinstance(option.type, click.Path) else each}"


def _refusal(what: str, found: str, known: Sequence[str] | Mapping[str, Any]) -> str:
    """The sentence on a name that is not offered."""
    near = suggestion(found, known) or f"there is {', '.join(known)}"
    return f'{what}: found "{found}", which is not offered to assistants; {near}'


def params(command: str) -> list[click.Parameter]:
    """The options and arguments of a command, or of that for a file where it is a group."""
    from linkwright.app.application import application
    from linkwright.kernel.command.group import Commands

    found = application().get_command(None, command)
    if isinstance(found, Commands):
        found = found.for_a_file
    assert found is not None, command
    return found.params
