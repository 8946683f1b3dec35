"""All commands, and where they are: one that is asked for is imported, and no other.

To add a command, write its file in the room of its subject and put it into `COMMANDS`, or into a group.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import click

from linkwright.kernel.command.common import reports_errors
from linkwright.kernel.command.group import Commands, Entry, completion_options
from linkwright.kernel.command.parameter import command
from linkwright.kernel.later import at_place


class Place(NamedTuple):
    """A command: one sentence for the list of commands, its function as ``module:name``, and whether it shows
    quantities of a machine, in units that may be asked for.
    """

    about: str
    function: str
    shows_quantities: bool = True


class Group(NamedTuple):
    """What a group is about, its help, its commands by name, and the function for a word that names none."""

    about: str
    help: str
    commands: Mapping[str, Place]
    default: str = ""


_ABOUT = "Computes how machines move: from the motor through gearbox and shaft to the mechanism and its work."

# Name → command, in the order of the help.
COMMANDS = {
    "run": Place("Run all analyses of a machine.", "app.commands.run:run"),
    "check": Place("Check a machine file.", "app.commands.check:check"),
    "motion": Place(
        "Positions, velocities and accelerations of points and links.", "linkages.commands:motion"
    ),
    "transient": Place("Compute the motion in time.", "driveline.commands:transient"),
    "elastic": Place("Steady motion of an elastic driveline.", "driveline.commands:elastic"),
    "plot": Place("Draw curves of a machine.", "app.commands.plot:plot"),
    "draw": Place("Draw a mechanism, still or in motion.", "app.commands.draw:draw", False),
    "forces": Place("Compute joint reactions and shaking force.", "kinetostatics.commands:forces"),
    "outline": Place("Mass and inertia of a link by its drawing.", "outlines.commands:outline"),
    "loads": Place("Loads on links, for finite elements.", "finite_elements.commands:loads"),
    "rods": Place("Rod string: cards, loads, stresses; measured cards.", "rods.commands:rods"),
    "axes": Place("Torque of servo axes, and their motors.", "axes.commands:axes"),
    "balance": Place("Find counterweights.", "kinetostatics.commands:balance"),
    "optimise": Place("Find the best machine within constraints.", "studies.commands.optimise:optimise"),
    "tolerance": Place(
        "Scatter of results due to tolerances, yield.", "studies.commands.tolerance:tolerance"
    ),
    "fit": Place("Fit a machine to a measured record.", "studies.commands.fit:fit"),
    "sensitivity": Place(
        "Derivatives of the results by the entries of the file.", "sensitivity.commands:sensitivity"
    ),
    "fmu": Place("Export a drive as an FMU for other simulation tools.", "fmi.commands:fmu"),
    "export": Place("Export a machine to MuJoCo (MJCF) or as URDF.", "multibody.commands:export"),
    "law": Place("Export the law of a cam or axis to a motion controller.", "axes.export.command:law"),
    "size": Place("Choose motor and flywheel.", "sizing.commands:size"),
    "motors": Place("List the motors of the catalogue.", "sizing.commands:motors"),
    "papers": Place("Recompute a published paper and compare.", "app.commands.papers:papers", False),
    "report": Place("Write the results of a command as HTML or PDF.", "app.commands.report:report", False),
    "new": Place("Write a machine file, a study or a task to start from.", "app.commands.new:new", False),
    "schema": Place("Print the JSON Schema of machine files.", "app.commands.schema:schema", False),
    "glossary": Place(
        "Define the terms of tables, messages and reports.", "app.commands.glossary:glossary", False
    ),
    "studio": Place("Edit and animate a machine in the browser.", "studio.command:studio", False),
    "mcp": Place("Serve an assistant: check, run, sweep, explain.", "app.commands.mcp:mcp", False),
}

GROUPS = {
    "synthesise": Group(
        "Find a linkage for poses, dead centres, a function, a path.",
        "Find a linkage for poses, dead centres, a function, a path or a straight line; the result is a "
        "machine file.",
        {
            "dead-centre": Place(
                "Crank-rocker or slider-crank for stroke and time ratio.",
                "synthesis.commands:dead_centre",
            ),
            "motion": Place(
                "Four-bar or slider-crank through two or three poses.", "synthesis.commands:motion"
            ),
            "function": Place(
                "Four-bar whose rocker follows a function of the crank angle.",
                "synthesis.commands:function",
            ),
            "path": Place("Four-bar whose coupler point passes given points.", "synthesis.commands:path"),
            "line": Place("Straight-line linkage from the catalogue.", "synthesis.commands:line"),
        },
    ),
    "cam": Group(
        "Analyse cams; compare motion laws; find small cams.",
        "Analyse the cams of a machine, with FILE; or one of the commands below.",
        {
            "laws": Place(
                "Factors of the motion laws, for a rise between two dwells.", "cam.commands.laws:laws", False
            ),
            "search": Place("Find the smallest cams within their limits.", "cam.commands.search:search"),
        },
        "cam.commands.file:cam_file",
    ),
    "torsion": Group(
        "Torsional vibration of a train; dampers; weak cylinders.",
        """Analyse the torsional vibration of a train, with FILE; or one of the commands below.

        FILE gives natural frequencies, mode shapes and nodes; with torques and [train.run] also critical
        speeds, torques, stresses, limits, barred speed ranges, speed fluctuation and heat. Exit code 1 if a
        limit is exceeded.
        """,
        {
            "damper": Place("Optimum damper for a mode.", "torsion.commands.damper:damper"),
            "diagnose": Place(
                "Find weak cylinders from the speed of a disc.",
                "torsion.commands.diagnose:diagnose",
            ),
        },
        "torsion.commands.torsion:torsion",
    ),
    "sweep": Group(
        "Compute many variants of a machine.",
        """Compute the rows of a study into a folder, with FILE; or one of the commands below.

        An interrupted run resumes with the same command. Failed rows keep their reason. Exit code 1 if no
        row has an answer.
        """,
        {"show": Place("Extremes, failed rows and figures of a sweep.", "studies.commands.sweep:show")},
        "studies.commands.sweep:sweep",
    ),
    "topper": Group(
        "Topper knives over fields of roots, and the best knife.",
        """Topper knives over fields of roots, and the best knife; FILE alone gives the knife itself, as
        `linkwright run FILE` does.

        Roots are those of [topper.field] in the machine file: random ones by distributions, or measured ones.
        """,
        {
            "field": Place("A field of roots: shares cut, haulm left, loss.", "topping.commands:field"),
            "best": Place("Optimum angle, length and speed of the knife.", "topping.commands:best"),
        },
        "app.commands.run:run",
    ),
}


def application() -> Commands:
    """The command line: its commands are imported when they are asked for."""
    entries = _entries(COMMANDS)
    entries |= {name: Entry(group.about, partial(_group, name, group)) for name, group in GROUPS.items()}
    version = click.Option(
        ["--version"],
        is_flag=True,
        is_eager=True,
        expose_value=False,
        callback=_version,
        help="Print the version and exit.",
    )
    return Commands("linkwright", _ABOUT, entries, params=(version, *completion_options()))


def _group(name: str, group: Group) -> Commands:
    default = partial(_loaded, None, Place("", group.default)) if group.default else None
    return Commands(name, group.help, _entries(group.commands), default)


def _entries(places: Mapping[str, Place]) -> dict[str, Entry]:
    return {name: Entry(place.about, partial(_loaded, name, place)) for name, place in places.items()}


def _loaded(word: str | None, place: Place) -> click.Command:
    """The command at a place below the package; its errors are messages."""
    return command(
        at_place(place.function),
        word,
        shows_quantities=place.shows_quantities,
        around=partial(reports_errors, machine_name=_machine_name, place=_place),
    )


def _version(context: click.Context, option: click.Parameter, wanted: bool) -> None:
    if wanted:
        from linkwright import __version__

        click.echo(f"linkwright {__version__}")
        context.exit()


def _machine_name(
    file: Path | None = None, set: list[str] | None = None, allow_outside: bool = False, **_: Any
) -> str | None:
    """Name of the machine that a command was asked about; None where it was none, or none can be read."""
    if file is None:
        return None
    from linkwright.kernel.errors import LinkwrightError
    from linkwright.machine.read import read

    try:
        return read(file, set or (), allow_outside=allow_outside).name
    except LinkwrightError:
        # silent: the name of the machine belongs to a finding, which is reported
        return None


def _place(error: Exception, file: Path | None = None, **_: Any) -> str:
    """File and line of the element that does not close, or of the table that it expands from; else empty."""
    from linkwright.kernel.errors import AssemblyError, LinkwrightError

    if file is None or not isinstance(error, AssemblyError) or not error.element:
        return ""
    from linkwright.kernel.files.lines import key_lines
    from linkwright.machine.read import text_of_machine

    try:
        lines = key_lines(text_of_machine(file))
    except LinkwrightError:
        # silent: the file was read before; without it the message has no place
        return ""
    own = [line for at, line in lines.items() if at[0] == "mechanism" and at[2:] == (error.element,)]
    table = "rod_rotator" if error.element.startswith("rotator") else "pumping_unit"
    line = next(iter(own), lines.get((table,)))
    return "" if line is None else f"{file}:{line}: "
