"""Files in and out: text, tables, points, whole files or none, the library, templates.

| module | |
| --- | --- |
| `bounds` | Sizes of what a file holds, looked at before any of it is understood |
| `columns` | Columns of quantities from a file of comma-separated values, such as a measurement |
| `csv_text` | Tables as comma-separated values |
| `library` | The library: machine files that come with the package, each with its source |
| `lines` | Where each key stands |
| `output` | Files that are whole or not there, and never over those of others |
| `points` | Points from files of comma-separated values that a machine file names |
| `templates` | Files to start from |
| `text_file` | The text of a file that a user names: read whole, up to a limit, as UTF-8 |
"""
