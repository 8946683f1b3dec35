"""``python -m linkwright.app``, for where the console script is not installed."""

from linkwright.app import main

main()
