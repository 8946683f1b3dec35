"""``linkwright schema``: the JSON Schema of machine files, by which editors complete and check."""

from __future__ import annotations

from typing import Any

from linkwright.kernel.command.out import Force, Out, put

_DIALECT = "https://json-schema.org/draft/2020-12/schema"


def schema(out: Out = None, force: Force = False) -> None:
    """Print the JSON Schema of machine files.

    Editors complete and check a machine file with it.
    """
    import json

    put(json.dumps(machine_schema(), indent=2) + "\n", out, force=force)


def machine_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of a machine file as it is written, with texts that carry units.

    References between elements, and entries that belong together, are checked by `read` alone.
    """
    from linkwright.machine.machine import Machine

    title = {"title": "Linkwright machine file", "description": "A machine; numbers without unit are in SI."}
    made: dict[str, Any] = _tidy(Machine.model_json_schema(by_alias=True, mode="validation"))
    return {"$schema": _DIALECT} | made | title


def _tidy(node: Any) -> Any:
    if isinstance(node, list):
        return [_tidy(entry) for entry in node if entry != {"type": "null"}]
    if not isinstance(node, dict):
        return node
    kept = {key: _tidy(value) for key, value in node.items() if not _idle(key, value)}
    alternatives = kept.get("anyOf", ())
    if len(alternatives) == 1:
        del kept["anyOf"]
        return alternatives[0] | kept
    return kept


def _idle(key: str, value: Any) -> bool:
    """Whether an entry of the schema says nothing; a property may itself be called title or default."""
    return (key == "title" and isinstance(value, str)) or (key == "default" and value is None)
