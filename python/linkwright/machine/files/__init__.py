"""Machine files: TOML in and out, with problems told by file, line and key.

| module | does |
| --- | --- |
| `read` | text → overrides → checked machine |
| `overrides` | ``PATH=VALUE`` into the tables of a file |
| `lines` | where each key stands |
| `write` | machine → text that reads back equal |
| `csv_text` | tables as comma-separated values |
| `output` | files that are whole or not there, and never over those of others |
| `schema` | JSON Schema for editors |
| `templates` | files to start from |
| `points`, `columns` | values from files of comma-separated values |
"""

from linkwright.kernel.files.templates import template, templates
from linkwright.machine.files.read import loads, loads_as, read, read_as
from linkwright.machine.files.schema import schema
from linkwright.machine.files.write import dumps, write

__all__ = ["dumps", "loads", "loads_as", "read", "read_as", "schema", "template", "templates", "write"]
