"""Commands of studies.

| module | |
| --- | --- |
| `progress` | Rows done, rate and remaining time |
| `tolerance` | ``linkwright tolerance`` |
| `sweep` | ``linkwright sweep`` and ``linkwright sweep show`` |
"""
