"""``python -P -m linkwright``, without the console script; -P imports nothing from the present folder."""

from linkwright.app import main

main()
