"""Commands of studies.

| module | |
| --- | --- |
| `progress` | Rows done, rate and remaining time |
| `sweep` | ``linkwright sweep`` and ``linkwright sweep show`` |
"""
