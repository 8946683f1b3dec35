"""Cam and follower: what presses on what, and how the follower really moves.

| module | answers |
| --- | --- |
| `hertz` | how hard do cam and roller press on each other, and how deep does it reach? |
| `checks` | inputs that make no sense, told by name |
"""
