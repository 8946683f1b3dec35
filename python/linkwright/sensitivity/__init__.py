"""Sensitivities: how every result of a machine follows the numbers of its file.

| module | |
| --- | --- |
| `gradient` | Exact derivatives of results by entries of a machine |
| `sources` | Of which results there are some, and from where |
| `tables` | The entries that matter most, in a table |
| `figures` | The same as bars |
| `commands` | ``linkwright sensitivity`` |
"""
