"""What the commands share: options, errors as messages, the terminal, progress, output folders.

| module | |
| --- | --- |
| `answer` | What a command answers: printed, given as JSON, written and ended in one way |
| `common` | What the commands share: options, and the way from an error to a message and an exit code |
| `console` | Consoles by rich: texts as they are, progress, tables, findings in red, warnings in yellow |
| `group` | Groups of commands that are imported when asked for; completion in the shell |
| `interrupt` | An interrupt from the keyboard ends the command line with exit code 130 |
| `out` | The option ``--out`` of all commands, and what is written there |
| `parameter` | A command from a function: what its parameters are on the command line stands at their types |
| `value` | Values of options that are quantities |
"""
