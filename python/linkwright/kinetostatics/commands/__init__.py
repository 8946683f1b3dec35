"""``linkwright forces`` and ``linkwright balance``.

| module | |
| --- | --- |
| `balance` | `linkwright balance FILE`: counterweights against the forces on the frame |
| `forces` | `linkwright forces FILE`: what pins, guides and teeth bear, and what the drive must give |
"""
