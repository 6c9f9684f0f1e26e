"""Closed-loop analysis of one level channel: poles, damping, settling, transfers, responses, margins."""

from navcore.analysis.loop import Loop, analyse
from navcore.analysis.margins import Margins, margins
from navcore.analysis.python_control import DiskMargin, disk_margin, to_control
from navcore.analysis.transfers import (
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
    "DiskMargin",
    "Loop",
    "Margins",
    "TransferOptions",
    "analyse",
    "disk_margin",
    "frequency_response",
    "initial_tilt_response",
    "margins",
    "network_step_response",
    "steady_state",
    "time_response",
    "to_control",
    "transfer",
]
