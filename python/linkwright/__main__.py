"""``python -m linkwright``, for where the console script is not installed."""

from linkwright.app import main

main()
