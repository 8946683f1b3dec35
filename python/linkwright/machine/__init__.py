"""The machine as a whole: what its file holds, read, written, looked up by address, compiled for the core.

| module | |
| --- | --- |
| `analysis` | What an analysis is, and the results of a study |
| `tangents` | Exact derivatives of what follows from the entries by plain arithmetic |
| `address` | Entries by address |
| `file_argument` | The machine file of a command |
| `machine` | `Machine`: drive, mechanism, bodies, loads, run-up |
| `iso286` | Limit deviations of sizes by classes such as H7 |
| `own_motors` | What axes move by motors of their own, which the crankshaft does not feel |
| `overrides` | Overrides |
| `program/` | From a machine's description to the program of the core |
| `read` | Read a machine file |
| `size_limits` | Limits of a size by its tolerance, and by the clearance of a joint |
| `table` | The entries of a machine as rows of words, each number with its unit |
| `tolerances` | Tolerances behind the values of entries, and by address |
| `train_machines` | Machine files of the mechanisms on a train |
| `whole_mechanism` | The whole mechanism of a machine |
| `write` | Write a machine as a TOML file |
"""

from linkwright import exports

__getattr__ = exports(globals())
