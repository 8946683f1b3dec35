"""Commands of studies.

| module | |
| --- | --- |
| `optimise` | ``linkwright optimise`` |
| `fit` | ``linkwright fit`` |
| `tolerance` | ``linkwright tolerance`` |
| `sweep` | ``linkwright sweep`` and ``linkwright sweep show`` |
"""
