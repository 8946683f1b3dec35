"""``linkwright schema``: the JSON Schema of machine files, for editors."""

from __future__ import annotations

from linkwright.kernel.command.out import Force, Out, put


def schema(out: Out = None, force: Force = False) -> None:
    """Print the JSON Schema of machine files.

    Editors complete and check a machine file with it.
    """
    import json

    from linkwright.machine.schema import schema as made

    put(json.dumps(made(), indent=2) + "\n", out, force=force)
