"""Closed-loop analysis of one level channel: poles, damping, settling, transfers, responses, margins."""

from __future__ import annotations

from navcore.loop.analysis import Loop, analyse
from navcore.loop.margins import Margins, margins
from navcore.loop.python_control import to_control
from navcore.loop.transfers import (
    OUTPUTS,
    RADIUS,
    SOURCES,
    TransferOptions,
    frequency_response,
    initial_tilt_response,
    network_step_response,
    steady_state,
    time_response,
    transfer,
)

__all__ = [
    "OUTPUTS",
    "RADIUS",
    "SOURCES",
    "Loop",
    "Margins",
    "TransferOptions",
    "analyse",
    "frequency_response",
    "initial_tilt_response",
    "margins",
    "network_step_response",
    "steady_state",
    "time_response",
    "to_control",
    "transfer",
]
