"""``python -m linkwright.cli``, for where the console script is not installed."""

from linkwright.cli import main

main()
