"""What the commands share: options, errors as messages, the terminal, progress, output folders.

| module | |
| --- | --- |
| `answer` | What a command answers: printed, given as JSON, written and ended in one way |
| `bar` | A bar on standard error that shows how much is done, once that takes long |
| `common` | What the commands share: options, and the way from an error to a message and an exit code |
| `console` | The terminal, by rich |
| `completion` | Completion in the shell |
| `group` | Groups of commands: those of the whole program, and those of a subject with a command for a file |
| `interrupt` | An interrupt from the keyboard ends the command line with exit code 130 |
| `out` | The option ``--out`` of all commands, and what is written there |
| `parameter` | A command from a function: what its parameters are on the command line stands at their types |
| `terminal` | An answer on the terminal: tables, findings in red, warnings in yellow; by rich |
"""
