"""Files in and out: text, tables, points, whole files or none, the library, templates.

| module | |
| --- | --- |
| `catalogue_file` | Catalogues of one's own: a row for each type |
| `cam_tables` | Tables of motion controllers as text |
| `dxf` | ezdxf as it is installed |
| `library` | Machine files that come with the package: the library, the examples, templates |
| `lines` | Where each key stands |
| `named_file` | Files that a document names: those of its folder |
| `output` | Files that are whole or not there, and never over those of others |
| `points` | Columns of files of comma-separated values: points of a machine file, measurements |
| `step` | STEP files by the Open CASCADE kernel |
| `text_file` | The text of a file, up to a limit, and sizes of what it holds |
"""
