"""What docs/llms.txt says is so: its machine files are sound, its tables, commands and keys exist."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from command_line import invoke

import linkwright as lw
from linkwright.app.application import COMMANDS as COMMANDS_OF_ALL
from linkwright.app.application import GROUPS

DOCS = Path(__file__).parents[2] / "docs"
TEXT = (DOCS / "llms.txt").read_text(encoding="utf-8")
# Name and content of each machine file.
MACHINES = {name: text for text, name in re.findall(r"```toml\n(# (\S+)\n.*?)```", TEXT, re.DOTALL)}
COMMANDS = re.findall(r"`(linkwright [a-z][^`]*)`", TEXT)
# Each command with --json and the keys below `results` that it is said to have.
ANSWERS = dict(
    re.findall(r"^- `(linkwright [^`]* --json)`: (.*?)(?=^- |\n\n)", TEXT, re.MULTILINE | re.DOTALL)
)

# Entries at the top of a machine file that a first machine does without.
UNNAMED = {"description", "source", "drawing", "rod_rotator", "run_up"}


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in MACHINES.items():
        Path(name).write_text(text, encoding="utf-8")


def output(line: str) -> str:
    done = invoke(*shlex.split(line)[1:])
    assert done.exit_code == 0, f"{line}\n{done.output}"
    return done.stdout


def test_it_is_short_and_complete() -> None:
    assert list(MACHINES) == ["crank.toml", "cam.toml", "train.toml"]
    assert len(TEXT.splitlines()) <= 165
    assert len(ANSWERS) >= 8


@pytest.mark.parametrize("name", MACHINES)
def test_machine_files_are_sound(name: str) -> None:
    assert output(f"linkwright check {name}").startswith("OK")
    assert json.loads(output(f"linkwright check {name} --json"))["warnings"] == []


def test_every_command_and_table_is_named() -> None:
    """A new command, and a new table at the top of a machine file, has its word here."""
    assert [name for name in (*COMMANDS_OF_ALL, *GROUPS) if not re.search(rf"\b{name}\b", TEXT)] == []
    keys = {field.alias or name for name, field in lw.Machine.model_fields.items()}
    assert [key for key in keys - UNNAMED if not re.search(rf"[\[`]{key}\b", TEXT)] == []


def test_commands_without_json_work() -> None:
    names = [line for line in COMMANDS if line not in ANSWERS]
    assert len(names) > 5
    for line in names:
        output(line)


def has(value: Any, path: str) -> bool:
    """Whether a path of keys, which may contain points, leads somewhere in a result."""
    if not path:
        return True
    keys = value if isinstance(value, dict) else ()
    heads = [key for key in keys if path == key or path.startswith(f"{key}.")]
    return any(has(value[key], path[len(key) + 1 :]) for key in heads)


@pytest.mark.parametrize("line", ANSWERS)
def test_keys_of_json_occur(line: str) -> None:
    answer = json.loads(output(line))
    assert all(f"`{key}`" in TEXT for key in answer if key != "files")
    keys = re.findall(r"`([^`]*)`", ANSWERS[line])
    assert keys
    assert [key for key in keys if not has(answer["results"], key)] == []


@cache
def tables() -> dict[str, dict[str, bool]]:
    """Keys below each heading of the page on the machine file, and whether one of them is required."""
    found: dict[str, dict[str, bool]] = {}
    open_heads: list[tuple[int, list[str]]] = []
    for line in (DOCS / "file_format.md").read_text(encoding="utf-8").splitlines():
        if head := re.match(r"(#+) (.*)", line):
            depth = len(head[1])
            names = re.findall(r"`\[+([\w.]+)\]+`", head[2]) or (
                ["mechanism.cams.NAME.sections"] * ("Motion programmes" in line)
            )
            open_heads = [one for one in open_heads if one[0] < depth] + [(depth, names)]
        elif row := re.match(r"\| `(\w+)` \|.*?\| (\*\*required\*\*|.*?) \|", line):
            for _, names in open_heads:
                for name in names:
                    keys = found.setdefault(name, {})
                    keys[row[1]] = keys.get(row[1], False) or "**required**" in line
    return found


def promised() -> Iterator[tuple[str, str, bool]]:
    """Each table, a key that it is said to have, and whether that is said to be required."""
    part = TEXT.split("asterisk marks")[1].split("```")[0]
    for item in re.split(r"^- ", part, flags=re.MULTILINE)[1:]:
        for names, words in re.findall(r"((?:`\[+[\w.]+\]+`(?:, )?)+): ((?:(?!`\[).)*)", item, re.DOTALL):
            for table in re.findall(r"\[+([\w.]+)\]+", names):
                for key, star in re.findall(
                    r"`(\w+)`(\*?)", re.sub(r"`linkwright.*?`.*|start from.*", "", words, flags=re.DOTALL)
                ):
                    yield table, key, bool(star)


def test_keys_of_tables_exist() -> None:
    said = list(promised())
    assert len(said) > 70
    assert [(table, key) for table, key, _ in said if key not in tables().get(table, {})] == []
    assert [(table, key) for table, key, star in said if star and not tables()[table][key]] == []


def test_templates_names_and_pages_exist() -> None:
    listed = output("linkwright new --list")
    (names,) = re.findall(r"start from the templates (.*)", TEXT)
    assert [name for name in names.split(", ") if f"{name} " not in listed] == []
    assert [name for name in re.findall(r"\blw\.(\w+)", TEXT) if not hasattr(lw, name)] == []
    pages = re.findall(r"\w+", TEXT.split("on the site):")[1])
    assert len(pages) > 10
    assert [page for page in pages if not (DOCS / f"{page}.md").is_file()] == []


def test_exit_codes_are_those_of_the_page() -> None:
    codes = set(re.findall(r"^\| (\d+) \|", (DOCS / "cli.md").read_text(encoding="utf-8"), re.MULTILINE))
    (told,) = re.findall(r"Exit codes: (.*?)\. ", TEXT, re.DOTALL)
    assert set(re.findall(r"(?:^|; )(\d+) ", told)) <= codes


def test_kinds_exist() -> None:
    kinds = set(re.findall(r'"const": "(\w+)"', output("linkwright schema")))
    items = TEXT.split("asterisk marks")[1].split("```")[0].split("\n- ")
    named = {word for item in items if "`kind`*" in item for word in re.findall(r'"(\w+)"', item)}
    assert len(named) > 12
    assert named <= kinds
