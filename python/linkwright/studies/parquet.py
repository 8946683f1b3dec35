"""Tables of rows as Parquet, with units in their metadata; needs pyarrow, the extra ``studies``."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.extras import require
from linkwright.kernel.files.points import one_of, place_of
from linkwright.kernel.files.text_file import TextError, require_no_pipe
from linkwright.studies.rows import Rows

if TYPE_CHECKING:
    import pyarrow as pa

# Under which the description of a study stands in the metadata of a file.
KEY = b"linkwright"

# Under which it stands why rows of a file were computed one by one, and how many.
ONE_BY_ONE = b"linkwright_one_by_one"


def require_pyarrow() -> None:
    """Refuse to begin what ends in a Parquet file, by an `InputError`, without pyarrow."""
    require("pyarrow.parquet", "studies", "Parquet files need pyarrow")


def encoded(rows: Rows, start: int, units: Mapping[str, str], about: bytes) -> bytes:
    """A Parquet file of rows from number `start` on, the same for the same rows.

    `units`: of each column, for its metadata; `about`: description of the study, for those of the file.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    reasons = pa.array(rows.reason, mask=rows.status == 0)
    columns: dict[str, Any] = {
        "row": pa.array(np.arange(start, start + len(rows), dtype=np.int64)),
        **{name: pa.array(column) for name, column in rows.columns.items()},
        "status": pa.array(rows.status),
        "reason": pa.DictionaryArray.from_arrays(reasons, pa.array(rows.reasons, pa.string())),
        "fast_starts": pa.array(rows.fast_starts),
    }
    fields = [
        pa.field(name, column.type, metadata={"unit": units[name]} if units.get(name) else None)
        for name, column in columns.items()
    ]
    metadata = {KEY: about} | ({ONE_BY_ONE: json.dumps(rows.one_by_one).encode()} if rows.one_by_one else {})
    table = pa.Table.from_arrays(list(columns.values()), schema=pa.schema(fields, metadata=metadata))
    out = pa.BufferOutputStream()
    # Numbers of a sweep differ in all digits: neither dictionaries nor compression make them smaller.
    # Pages have checksums, by which a damaged file is recognised.
    pq.write_table(
        table,
        out,
        compression="none",
        use_dictionary=["status", "reason", "fast_starts"],
        write_statistics=True,
        write_page_checksum=True,
    )
    return out.getvalue().to_pybytes()  # type: ignore[no-any-return]


def is_whole(path: Path, rows: range, names: Iterable[str], about: bytes) -> bool:
    """Whether a file holds these rows of a study: not cut off, damaged, of another study or other rows."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    if not path.is_file():
        return False
    try:
        with pq.ParquetFile(path, page_checksum_verification=True) as file:
            metadata = file.schema_arrow.metadata or {}
            if file.metadata.num_rows != len(rows) or metadata.get(KEY) != about:
                return False
            # Names and counts stand outside of the pages, which alone have checksums.
            _counts(metadata)
            table = file.read()
            named = ["row", *names, "status", "reason", "fast_starts"]
            return table.column_names == named and np.array_equal(
                _as_array(table.column("row")), np.arange(rows.start, rows.stop)
            )
    except (pa.ArrowException, OSError, ValueError):
        return False


def one_by_one(path: Path) -> Counter[str]:
    """Why rows of a file were computed one by one → how many."""
    import pyarrow.parquet as pq

    return _counts(pq.read_schema(path).metadata or {})


def _counts(metadata: Mapping[bytes, bytes]) -> Counter[str]:
    return Counter(json.loads(metadata.get(ONE_BY_ONE, b"{}")))


def columns_of(path: Path, names: Sequence[str] | None = None) -> dict[str, Any]:
    """Columns of a file: arrays of numbers, and texts of reasons, None where there is none."""
    import pyarrow.parquet as pq

    table = pq.read_table(path, columns=None if names is None else list(names))
    return {name: _as_array(table.column(name)) for name in table.column_names}


def _as_array(column: pa.ChunkedArray) -> Any:
    import pyarrow as pa

    if not pa.types.is_dictionary(column.type):
        return column.to_numpy()
    coded = column.combine_chunks()
    # Texts by their number in the dictionary: row by row they take a tenth of a sweep of a million rows.
    texts = np.array([*coded.dictionary.to_pylist(), None], dtype=object)
    return texts[coded.indices.fill_null(len(texts) - 1).to_numpy()]


def parquet_columns(
    path: Path, names: Sequence[str], choices: Mapping[str, Sequence[str]]
) -> dict[str, Floats]:
    """Columns of a Parquet file [SI]; of `choices` the indices; `InputError` if unreadable or incomplete."""
    require_pyarrow()
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        require_no_pipe(path)
        table = pq.read_table(path)
    except TextError as error:
        raise InputError(f"{path}: found {error.found}, expected a Parquet file; {error.remedy}") from None
    except (pa.ArrowException, OSError) as error:
        raise InputError(f"{path}: cannot be read as Parquet ({' '.join(str(error).split())})") from None
    missing = [name for name in names if name not in table.column_names]
    if missing:
        listed = ", ".join(table.column_names)
        raise InputError(
            f"{path}: found no column {missing[0]} among {listed}; name columns as the variables"
        )
    columns = {}
    for name in names:
        column = table.column(name)
        if name in choices and (pa.types.is_string(column.type) or pa.types.is_large_string(column.type)):
            columns[name] = _places(path, name, column.to_pylist(), choices[name])
        elif pa.types.is_floating(column.type) or pa.types.is_integer(column.type):
            columns[name] = column.to_numpy().astype(float)
        else:
            expected = one_of(choices[name]) if name in choices else "numbers in SI"
            raise InputError(f"{path}: column {name}: found {column.type}, expected {expected}")
    return columns


def _places(path: Path, name: str, cells: Sequence[str | None], names: Sequence[str]) -> Floats:
    places = [place_of(cell or "", names) for cell in cells]
    if None in places:
        row = places.index(None)
        cell = cells[row]
        found = show(cell) if cell else "an empty cell"
        raise InputError(f"{path}: column {name}, row {row}: found {found}, expected {one_of(names)}")
    return np.array(places, dtype=float)
