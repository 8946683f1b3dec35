"""Commands of studies.

| module | |
| --- | --- |
| `progress` | Rows done, rate and remaining time |
| `optimise` | ``linkwright optimise`` |
| `fit` | ``linkwright fit`` |
| `tolerance` | ``linkwright tolerance`` |
| `sweep` | ``linkwright sweep`` and ``linkwright sweep show`` |
"""
