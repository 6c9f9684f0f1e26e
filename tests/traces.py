"""Numbers of a trace as the page receives them."""

import base64

import numpy as np


def unpacked(value: dict[str, str]) -> np.ndarray:
    """Inverse of `schuler_bench.plots.plotly_data.packed`, float32."""
    return np.frombuffer(base64.b64decode(value["bdata"]), dtype="<f4")
