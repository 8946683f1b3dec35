"""The JSON Schema is one, takes the shipped machines, and refuses what it can."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from linkwright.app.commands.schema import machine_schema as schema
from linkwright.kernel.files.library import template, templates

MACHINES = sorted((Path(__file__).parents[2] / "machines").glob("*.toml"))
TEXTS = {path.stem: path.read_text(encoding="utf-8") for path in MACHINES} | {
    n: template(n) for n in templates()
}


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft202012Validator:
    made = schema()
    jsonschema.Draft202012Validator.check_schema(made)
    return jsonschema.Draft202012Validator(made)


@pytest.mark.parametrize("name", TEXTS)
def test_shipped_machines_are_valid(validator: jsonschema.Draft202012Validator, name: str) -> None:
    validator.validate(tomllib.loads(TEXTS[name]))


@pytest.mark.parametrize(
    ("table", "key", "value"),
    [
        ("drive", "sped", 1),
        ("drive", "speed", [1]),
        ("drive", "speed", True),
        ("drive", "speed", -1),
        ("mechanism", "cranks", {"A": {}}),
        ("loads", "x", {"kind": "nothing"}),
    ],
)
def test_wrong_entries_are_refused(
    validator: jsonschema.Draft202012Validator, table: str, key: str, value: object
) -> None:
    machine = tomllib.loads(template("two-carts"))
    machine[table][key] = value
    with pytest.raises(jsonschema.ValidationError):
        validator.validate(machine)


# A description that goes on from its key: "offset: Of the guide …".
ELLIPTIC = re.compile(
    r"(?:Of|From|To|At|On|By|Between|Above|Along|Whether|Its|Their|How|What|When|Where|Which)\b"
)


def test_descriptions_stand_by_themselves() -> None:
    """The description of an entry begins with the noun of what it gives, as a handbook prints it."""
    parts = {"Machine": schema(), **schema()["$defs"]}
    texts = {
        f"{name}.{key}": each.get("description", "")
        for name, node in parts.items()
        for key, each in node.get("properties", {}).items()
    }
    assert len(texts) > 500
    assert {place: text for place, text in texts.items() if ELLIPTIC.match(text)} == {}


def test_every_key_is_described() -> None:
    def bare(name: str, node: dict[str, Any]) -> list[str]:
        entries = node.get("properties", {})
        return [
            f"{name}.{key}" for key, each in entries.items() if "description" not in each and key != "kind"
        ]

    made = schema()
    missing = [key for name, node in made["$defs"].items() for key in bare(name, node)]
    assert missing + bare("Machine", made) == []
