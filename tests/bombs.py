"""Small files that cost a careless reader gigabytes, minutes or the whole process."""

import io

import numpy as np


def _parquet(columns: dict[str, object]) -> bytes:
    import pyarrow as pa
    import pyarrow.parquet as parquet

    stream = io.BytesIO()
    parquet.write_table(pa.table(columns), stream)
    return stream.getvalue()


def _repeated_text() -> bytes:
    import pyarrow as pa

    rows = 900_000
    text = pa.DictionaryArray.from_arrays(pa.array(np.zeros(rows, np.int32)), pa.array(["x" * 100_000]))
    return _parquet({"utc": text, "heading_deg": np.zeros(rows)})


def _matrix_in_a_cell() -> bytes:
    from scipy.io import savemat

    cell, stream = np.empty((1, 1), dtype=object), io.BytesIO()
    cell[0, 0] = np.zeros((5000, 5000))
    savemat(stream, {"t_s": np.arange(3.0), "heading_deg": cell}, do_compression=True)
    return stream.getvalue()


FILES = {
    "a line of one sentence's beginning": lambda: b"$GPRMC,123456.7,A," * 7282,
    "16 MB of it": lambda: b"$GPRMC,123456.7,A," * 900_000,
    "430,000 kinds": lambda: b"".join(b"$AB%04XQ,1*00\n" % (k % 65536) for k in range(430_000)),
    "4 M columns": lambda: b"t_s," + b"a," * 4_000_000 + b"\n1\n",
    "8 M rows": lambda: b"t_s,heading_deg\n" + b"1\n" * 8_000_000,
    "Parquet of 10 M rows": lambda: _parquet({n: np.zeros(10_000_000) for n in ("t_s", "heading_deg")}),
    "Parquet of one repeated text": _repeated_text,
    "MAT with a matrix in a cell": _matrix_in_a_cell,
}


SCENARIOS = {
    "40,000 named methods": ("".join(f'[[method]]\nname="{k}"\n' for k in range(40_000)), "blocks"),
    "90,000 methods": ("[[method]]\n" * 90_000, "blocks"),
    "900 methods": ("[[method]]\n" * 900, "method = 900: must be 1 to 12"),
    "16,000 zeros": ("[imu]\ngyro_bias_dph = [" + "0," * 16_000 + "]\n", "imu.gyro_bias_dph"),
    "16,000 points": ('[motion]\nkind = "profile"\npoint = [' + "0," * 16_000 + "]\n", "more fa"),
    "a dotted key": ("a." * 130_000 + "a = 1\n", "more than 12 parts"),
    "a dotted and quoted key": ('"a".' * 130_000 + "a = 1\n", "more than 12 parts"),
    "nested arrays": ("a = " + "[" * 100_000 + "]" * 100_000, "nested too deep"),
    "nested tables": ("a = " + "{b = " * 5000 + "1" + "}" * 5000, "nested too deep"),
    "900,000 digits": ("a = " + "9" * 900_000, "more than 300 digits"),
    "5,000 hexadecimal digits": ("a = 0x" + "f" * 5000, "more than 300 digits"),
    "200 digits": ("[run]\nseed = " + "9" * 200, "run.seed: is an integer of more than 64 bits"),
    "60,000 fields": ("".join(f"k{k} = 1\n" for k in range(60_000)), "fields"),
    "a long field": ('"' + "k" * 900_000 + '" = 1\n', "at most 80 characters"),
}
