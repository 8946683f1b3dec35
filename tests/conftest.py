"""What all tests share: random cases are always the same ones, and a busy machine is no failure."""

from hypothesis import settings

settings.register_profile("same cases, any speed", derandomize=True, deadline=None)
settings.load_profile("same cases, any speed")
