"""What programs that write machine files, such as language models, ask of Linkwright.

They speak the Model Context Protocol (``linkwright mcp``). Tools are the commands of the command line, with
their messages and JSON; nothing is computed here.

| module | |
| --- | --- |
| `calls` | A command in a process of its own, within limits of time and size |
| `explained` | What an entry, a quantity, a term or a message means |
| `offered` | Commands and options that may be asked for |
| `server` | Tools and resources |
"""

from pathlib import Path

# What an assistant is to know before it writes a machine file, in the form in which assistants read skills.
SKILL = Path(__file__).with_name("SKILL.md")
