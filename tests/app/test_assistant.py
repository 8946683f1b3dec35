"""An assistant that speaks the protocol checks, computes, sweeps and explains, and sees one folder alone."""

from __future__ import annotations

import asyncio
import json
import os
import re
import sys
import tomllib
from collections.abc import Awaitable, Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import click
import pytest
from command_line import invoke
from mcp import Client, MCPError, StdioServerParameters, stdio_client

import linkwright as lw
from linkwright import InputError
from linkwright.app.application import COMMANDS, GROUPS
from linkwright.app.assistant import SKILL
from linkwright.app.assistant.explained import entries, explained, quantities
from linkwright.app.assistant.offered import OFFERED, params, words
from linkwright.kernel.files.library import library_path, template
from linkwright.kernel.limits import ANSWER, FILE_BYTES

WRONG = template("slider-crank").replace('radius = "', 'radius = "-')
STUDY = """
machine = "roller_two_carts"
[variables.phase]
address = "mechanism.cranks.A2.phase"
range = ["80 deg", "100 deg"]
steps = 5
[responses]
delta = "steady_state.unevenness"
"""


class Answered(NamedTuple):
    """What a tool answered: its text, and whether it is an error."""

    text: str
    is_error: bool

    @property
    def object(self) -> Any:
        """The JSON object of an answer that is no error."""
        assert not self.is_error, self.text
        return json.loads(self.text)


Ask = Callable[..., Awaitable[Answered]]


def asked(folder: Path, questions: Callable[[Client, Ask], Awaitable[Any]], *options: str) -> Any:
    """What questions to a server for a folder give; the server runs as an assistant starts it."""
    line = ["-P", "-m", "linkwright", "mcp", "--folder", str(folder), *options]
    parameters = StdioServerParameters(command=sys.executable, args=line, env=dict(os.environ))

    async def session() -> Any:
        async with Client(stdio_client(parameters)) as client:

            async def ask(tool: str, **given: Any) -> Answered:
                answer = await client.call_tool(tool, given)
                return Answered("".join(part.text for part in answer.content), answer.is_error)

            return await questions(client, ask)

    return asyncio.run(session())


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a sound machine, a wrong one, a study, and ways out of it."""
    above = tmp_path_factory.mktemp("above")
    (above / "outside.toml").write_text("secret = 1", encoding="utf-8")
    root = above / "in"
    (root / "below").mkdir(parents=True)
    (root / "press.toml").write_text(template("slider-crank"), encoding="utf-8")
    (root / "wrong.toml").write_text(WRONG, encoding="utf-8")
    (root / "study.toml").write_text(STUDY, encoding="utf-8")
    (root / "below" / "carts.toml").write_text(template("two-carts"), encoding="utf-8")
    (root / "link.toml").symlink_to(above / "outside.toml")
    (root / "away").symlink_to(above)
    (root / "round.toml").symlink_to(root / "round.toml")
    (root / "inside.toml").symlink_to(root / "press.toml")
    (root / "far.toml").write_text(STUDY.replace("roller_two_carts", "../outside.toml"), encoding="utf-8")
    (root / "well.toml").write_text(Path(library_path("rod_string")).read_text("utf-8"), encoding="utf-8")
    for place in (root / "below", above):
        (place / "card.csv").write_text("position [m], load [N]\nsecret, 1\n", encoding="utf-8")
    (root / "large.toml").write_text("#" * (FILE_BYTES.most + 1), encoding="utf-8")
    return root


@pytest.fixture(scope="module")
def replies(folder: Path) -> Mapping[str, Any]:
    """Answers to what the tests below ask of one server."""

    async def questions(client: Client, ask: Ask) -> dict[str, Any]:
        listed = json.loads((await client.read_resource("linkwright://examples")).contents[0].text)
        refused = {}
        for name in ("library/nothing", "folder/away/outside.toml", "folder/../outside.toml"):
            try:
                refused[name] = (await client.read_resource(f"linkwright://example/{name}")).contents[0].text
            except MCPError as error:
                refused[name] = error
        return {
            "tools": (await client.list_tools()).tools,
            "instructions": client.instructions,
            "guide": (await client.read_resource("linkwright://guide")).contents[0].text,
            "schema": (await client.read_resource("linkwright://schema")).contents[0].text,
            "examples": listed,
            "texts": {
                each["name"]: (await client.read_resource(each["uri"])).contents[0].text
                for each in listed
                if each["name"] in ("cam", "study", "roller_two_carts", "below/carts.toml")
            },
            "refused": refused,
            "check": await ask("check", file="press.toml"),
            "inside": await ask("check", file="inside.toml"),
            "wrong": await ask("check", file="wrong.toml"),
            "set": await ask("check", file="press.toml", set=["drive.gearbox.ratio=abc"]),
            "carts": await ask("run", file="below/carts.toml", keys=["steady_state.unevenness", "forces"]),
            "pose": await ask("run", file="press.toml", command="motion", options={"at": "30 deg"}),
            "long": await ask("run", file="press.toml", options={"curves": True}),
            "no part": await ask("run", file="press.toml", keys=["steady_state.unevennes"]),
            "stalls": await ask("run", file="press.toml", set=["loads.work.force=4 MN"]),
            "sweep": await ask("sweep", file="study.toml", first=1, rows=3),
            "too many": await ask("sweep", file="study.toml", rows=1001),
            "far": await ask("sweep", file="far.toml"),
            "card": await ask("run", file="well.toml", command="rods", options={"card": "below/card.csv"}),
            "far card": await ask("run", file="well.toml", command="rods", options={"card": "away/card.csv"}),
            "motor": await ask("check", file="press.toml", set=["drive.motor.file=../outside.toml"]),
            "explain": await ask("explain", what="steady_state.unevenness"),
            "nothing": await ask("explain", what="unevenes"),
            **{name: await ask("check", file=name) for name in OUTSIDE},
        }

    return asked(folder, questions)


# Names that lead out of the folder, or to what is no machine file, and what is said of them.
OUTSIDE = {
    "../outside.toml": "lies outside the folder",
    "link.toml": "lies outside the folder",
    "away/outside.toml": "lies outside the folder",
    "/etc/passwd": "expected the name of a .toml file below",
    "press.toml\n": "expected the name of a .toml file below",
    "away": "no machine 'away' in the library",
    "none.toml": "no such file",
    "round.toml": "a link that leads to itself",
    "a" * 5000 + ".toml": "file name too long",
    "large.toml": "expected at most 1 000 000 bytes",
    "roller_two_cart": 'did you mean "roller_two_carts"',
}


def test_tools_are_those_of_the_docs_and_change_nothing(replies: Mapping[str, Any]) -> None:
    """Each tool with each of its arguments is described, and none writes."""
    page = (Path(__file__).parents[2] / "docs" / "assistants.md").read_text(encoding="utf-8")
    assert [tool.name for tool in replies["tools"]] == re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE)
    for tool in replies["tools"]:
        assert tool.annotations.read_only_hint
        assert len(tool.description) > 100
        assert all(entry["description"] for entry in tool.input_schema["properties"].values()), tool.name


def test_answers_are_those_of_the_command_line(replies: Mapping[str, Any], folder: Path) -> None:
    """The object of a tool is the object that ``--json`` prints, or the parts of it that were asked for."""
    assert replies["check"].object == json.loads(invoke("check", folder / "press.toml", "--json").stdout)
    assert replies["inside"].object == replies["check"].object
    pose = json.loads(invoke("motion", folder / "press.toml", "--at", "30 deg", "--json").stdout)
    assert replies["pose"].object == pose
    carts = json.loads(invoke("run", folder / "below" / "carts.toml", "--json").stdout)
    results = carts["results"]
    kept = {"steady_state.unevenness": results["steady_state"]["unevenness"], "forces": results["forces"]}
    assert replies["carts"].object == carts | {"results": kept}


def test_messages_are_those_of_the_command_line(
    replies: Mapping[str, Any], folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Wrong input is an error with the message that the command prints in that folder."""
    monkeypatch.chdir(folder)
    for name, line in {
        "wrong": ["check", "wrong.toml"],
        "set": ["check", "press.toml", "--set", "drive.gearbox.ratio=abc"],
    }.items():
        assert replies[name].is_error
        assert replies[name].text == invoke(*line).stderr.strip()
    assert re.match(r"wrong\.toml:\d+: mechanism\.cranks\.\w+\.radius\n  found: ", replies["wrong"].text)


def test_a_finding_is_an_answer(replies: Mapping[str, Any]) -> None:
    """A machine that stalls is answered with its finding, not with an error of the tool."""
    answer = replies["stalls"].object
    assert answer["findings"]
    assert answer["machine"]


@pytest.mark.parametrize("name", OUTSIDE, ids=lambda name: ascii(name))
def test_what_lies_outside_is_not_read(name: str, replies: Mapping[str, Any]) -> None:
    """Paths and links that lead out of the folder are refused, and nothing of their content is said."""
    assert replies[name].is_error
    assert OUTSIDE[name] in replies[name].text.lower()
    assert "secret" not in replies[name].text


def test_entries_and_resources_lead_nowhere_else(replies: Mapping[str, Any]) -> None:
    """A study names no machine outside the folder, and no resource has the text of such a file."""
    assert replies["far"].is_error
    assert "far.toml:2: machine" in replies["far"].text
    assert "card.csv" in replies["card"].text
    assert "secret" in replies["card"].text
    assert replies["far card"].is_error
    assert "'away/card.csv' lies outside the folder" in replies["far card"].text
    assert replies["motor"].is_error
    assert "a file in the folder of the machine file, or below it" in replies["motor"].text
    assert all(isinstance(each, MCPError) for each in replies["refused"].values()), replies["refused"]
    assert "secret" not in str(replies["refused"])


def test_long_answers_are_refused_with_their_parts(replies: Mapping[str, Any]) -> None:
    """Curves exceed what is read at once; the message names what may be asked for instead."""
    assert replies["long"].is_error
    assert ANSWER.words in replies["long"].text
    assert "steady_state" in replies["long"].text
    assert 'of which "unevennes" is no part' in replies["no part"].text
    assert "unevenness" in replies["no part"].text


def test_rows_of_a_sweep_are_those_of_single_machines(replies: Mapping[str, Any]) -> None:
    """Rows 1 to 3 of a sweep have the phases of the study and the δ of each variant by itself."""
    rows = replies["sweep"].object["results"]["rows"]
    assert rows["row"] == [1, 2, 3]
    for phase, delta in zip((85, 90, 95), rows["delta"], strict=True):
        machine = lw.read("roller_two_carts", {"mechanism.cranks.A2.phase": f"{phase} deg"})
        assert delta == pytest.approx(lw.steady_state(machine).unevenness, rel=1e-9)
    assert "at most 1 000" in replies["too many"].text


def test_resources_are_what_a_file_is_written_from(replies: Mapping[str, Any]) -> None:
    """Guide, schema and examples are those of the package; files of the folder are listed with them."""
    assert replies["instructions"] == replies["guide"]
    assert json.loads(replies["schema"]) == json.loads(invoke("schema").stdout)
    assert replies["texts"]["cam"] == template("cam")
    assert replies["texts"]["study"] == template("study")
    assert replies["texts"]["below/carts.toml"] == template("two-carts")
    assert lw.loads(replies["texts"]["roller_two_carts"]).name == lw.read("roller_two_carts").name
    titles = {each["name"]: each["title"] for each in replies["examples"]}
    assert titles["roller_two_carts"] == lw.read("roller_two_carts").name
    assert not {"link.toml", "study.toml", "large.toml"} & set(titles)


def test_a_call_ends_when_its_time_is_over(folder: Path) -> None:
    """No machine takes so little: the message says how to allow more, and the next call is answered."""

    async def questions(client: Client, ask: Ask) -> list[Answered]:
        return [await ask("run", file="press.toml"), await ask("explain", what="μ")]

    late, next_one = asked(folder, questions, "--seconds", "0.05")
    assert late.is_error
    assert late.text.startswith("run: no answer within 0.05 s")
    assert "--seconds" in late.text
    assert next_one.object["terms"]


def test_options_that_write_files_are_not_offered() -> None:
    """Every offered option exists, and none names a place to write to; commands take one file."""
    for command, names in OFFERED.items():
        known = {
            option.removeprefix("--"): each
            for each in params(command)
            if isinstance(each, click.Option)
            for option in each.opts
        }
        assert set(names) <= set(known), command
        assert not {"out", "force", "allow-outside", "study", "set", "json"} & set(names)
        # What writes has a parser of its own for its place (`out_option`).
        assert [name for name in names if known[name].type.name == "place"] == []
        takes = [each.name for each in params(command) if isinstance(each, click.Argument)]
        assert takes == ["file"], command


# Commands of one machine file with JSON that assistants have not, and why.
NOT_OFFERED = {
    "fmu": "its file is for another tool",
    "outline": "takes a drawing",
    "plot": "its curves are those of run with curves",
    "export": "its answer is a file",
    "law": "takes a name besides the file",
    "sweep": "a tool of its own",
}


def test_every_command_of_a_machine_is_offered() -> None:
    """A new command that takes a machine file and answers in JSON is offered, or it is said why not."""
    has = set()
    for name in {*COMMANDS, *(name for name, group in GROUPS.items() if group.default)}:
        options = {each.name for each in params(name)}
        if {"file", "json"} <= options:
            has.add(name)
    assert has - set(NOT_OFFERED) == set(OFFERED)


@pytest.mark.parametrize(
    ("command", "options", "message"),
    [
        ("plot", {}, 'command: found "plot", which is not offered'),
        ("run", {"out": "x"}, 'option of run: found "out"'),
        ("run", {"allow_outside": True}, 'option of run: found "allow_outside"'),
        ("run", {"curves": "yes"}, "options.curves: found 'yes', expected true or false"),
        ("motion", {"at": {"a": 1}}, "options.at: found"),
        ("motion", {"at": True}, "options.at: found True"),
    ],
)
def test_wrong_options_are_refused(command: str, options: dict[str, Any], message: str) -> None:
    """What is not offered, and what is no value, is an input error."""
    with pytest.raises(InputError, match=f"^{re.escape(message)}"):
        words(command, "a.toml", [], options, str)


def test_words_that_begin_with_dashes_are_no_options() -> None:
    """Values, entries and names stay behind their option, whatever they begin with."""
    line = words("motion", "--out.toml", ["--allow-outside"], {"at": "--json", "--steps": 5}, str)
    assert line == [
        "motion",
        "--json",
        "--set=--allow-outside",
        "--at=--json",
        "--steps=5",
        "--",
        "--out.toml",
    ]


def test_explanations_are_the_declarations(replies: Mapping[str, Any]) -> None:
    """Entries, quantities and terms are those of schema, results and glossary."""
    (entry,) = explained("mechanism.cranks.A7.radius")["entries"]
    assert entry["unit"] == "m"
    assert entry["required"]
    (ratio,) = explained("drive.gearbox.ratio")["entries"]
    assert ratio["default"] == 1
    assert {kind for each in explained("loads.work.torque")["entries"] for kind in each["kinds"]} >= {
        "torque"
    }
    (delta,) = replies["explain"].object["quantities"]
    assert (delta["symbol"], delta["unit"]) == ("δ", "")
    assert explained("μ")["terms"][0]["term"] == "transmission angle"
    assert replies["nothing"].is_error
    assert "unevenness" in replies["nothing"].text
    message = "press.toml:9: mechanism.cranks.A.radius\n  found: 1 deg\n  expected: a length"
    assert explained(message)["entries"][0]["address"] == "mechanism.cranks.NAME.radius"
    assert "breakdown torque" in {each["term"] for each in explained("exceeds the breakdown torque")["terms"]}


@pytest.mark.parametrize(
    "what", ["", "  ", "a." * 200_000, "(" * 9_000], ids=["empty", "blank", "long", "odd"]
)
def test_what_is_too_long_or_nothing_is_refused_in_a_line(what: str) -> None:
    """The message does not repeat what nobody can read."""
    with pytest.raises(InputError) as error:
        explained(what)
    assert len(str(error.value)) < 300


def test_every_entry_of_shipped_machines_is_explained() -> None:
    """Each address of a machine of the library leads to an entry with words."""
    for name in ("roller_two_carts", "v8_diesel", "rod_string", "topper", "roller_cam"):
        for address in lw.addresses(lw.read(name)):
            found = explained(address)["entries"]
            assert found, address
            assert any(each["about"] for each in found) or address.endswith("kind"), address


def test_every_quantity_is_explained() -> None:
    """Each name of the list is found by itself."""
    assert len(quantities()) > 400
    assert len(entries()) > 1500
    for each in quantities()[::7]:
        assert each in explained(each["name"])["quantities"]


def test_the_skill_is_true(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its head is that of a skill, its machine is sound, its commands and its entries exist."""
    text = SKILL.read_text(encoding="utf-8")
    assert invoke("mcp", "--skill").stdout == text
    _, head, body = text.split("---\n", 2)
    assert re.fullmatch(r"name: [a-z-]+\ndescription: .{50,1000}\n", head)
    assert len(body.splitlines()) < 100
    (machine,) = re.findall(r"```toml\n(.*?)```", body, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    Path("machine.toml").write_text(machine, encoding="utf-8")
    assert lw.study(lw.read("machine.toml")).findings == ()
    assert json.loads(invoke("check", "machine.toml", "--json").stdout)["warnings"] == []
    for line in re.findall(r"`linkwright ([^`]*)`", body):
        assert invoke(*line.split()).exit_code == 0, line
    part = body.split("## Commands")[1]
    named = set(re.findall(r"`(\w+)`", part.split("Exit codes")[0]))
    assert named | {"check"} == set(OFFERED) | {"sweep"}
    assert all(explained(address)["entries"] for address in re.findall(r"`(drive\.[\w.]+)", body))
    assert tomllib.loads(machine)["format"] == 1


def test_what_is_missing_or_wrong_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the extra, without such a folder, or without time there is no server."""
    for line, message in {
        ("--folder", str(tmp_path / "none")): "--folder: there is no folder",
        ("--seconds", "0"): "--seconds: found 0, expected a time above 0",
    }.items():
        done = invoke("mcp", *line)
        assert done.exit_code == 2
        assert message in done.output
    for name in [each for each in sys.modules if each.split(".")[0] == "mcp"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "mcp", None)
    done = invoke("mcp")
    assert done.exit_code == 2
    assert "a server for assistants needs mcp 2, which is not installed" in done.output
    assert "pip install '.[mcp]'" in done.output
