"""The machine as a whole: what its file holds, read, written, looked up by address, compiled for the core.

| module | |
| --- | --- |
| `tangents` | Exact derivatives of what follows from the entries by plain arithmetic |
| `address` | Entries by address |
| `machine` | `Machine`: drive, mechanism, bodies, loads, run-up |
| `overrides` | Overrides |
| `program/` | From a machine's description to the program of the core |
| `read` | Read a machine file |
| `table` | The entries of a machine as rows of words, each number with its unit |
| `whole_mechanism` | The whole mechanism of a machine |
| `write` | Write a machine as a TOML file |
"""
