"""``linkwright size`` and ``linkwright motors``.

| module | |
| --- | --- |
| `motors` | ``linkwright motors``: the motors of the catalogue |
| `size` | ``linkwright size FILE``: the smallest motor and flywheel that will do |
"""
