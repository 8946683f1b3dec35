"""``linkwright forces`` and ``linkwright balance``.

| module | |
| --- | --- |
| `balance` | `linkwright balance FILE`: counterweights against the shaking forces |
| `forces` | `linkwright forces FILE`: joint reactions, driving torque, shaking force |
"""
