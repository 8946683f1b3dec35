"""What the commands share: options, errors as messages, the terminal, progress, output folders.

| module | |
| --- | --- |
| `answer` | What a command answers: printed, given as JSON, written and ended in one way |
| `bar` | A bar on standard error that shows how much is done, once that takes long |
| `common` | What the commands share: options, and the way from an error to a message and an exit code |
| `console` | The terminal, by rich |
| `default_command` | A group of commands in which a word that is none of them goes to one command |
| `interrupt` | An interrupt from the keyboard ends the command line with exit code 130 |
| `out` | The option ``--out`` of all commands, and what is written there |
| `terminal` | An answer on the terminal: tables, findings in red, warnings in yellow; by rich |
"""
