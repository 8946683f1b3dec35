"""Commands of studies.

| module | |
| --- | --- |
| `optimise` | ``linkwright optimise`` |
| `fit` | ``linkwright fit`` |
| `tolerance` | ``linkwright tolerance`` |
| `study_file` | The study file of a command; the option ``--study`` of commands that are presets of studies |
| `sweep` | ``linkwright sweep`` and ``linkwright sweep show`` |
"""
