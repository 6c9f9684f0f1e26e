"""Target table: all numbers of a method as TOML, and as a page to print."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import tomlkit

from navcore.analysis import analyse, margins
from navcore.exporting.about import facts, filled, note_of, sources_of
from navcore.exporting.equations import equations_of
from navcore.exporting.form import Form
from navcore.exporting.target_c import vectors_csv
from navcore.foundation.answers import Column, Table
from navcore.foundation.text import Text
from navcore.networks.azimuth_loop import AzimuthGains
from navcore.networks.base import LinearNetwork
from navcore.networks.discrete import discretise

_DIRECT = "of double precision at least; never run it in single precision"


def files(form: Form, prefix: str, single: bool, bounds: Sequence[float]) -> dict[str, str]:
    """Return the files by name; parameters as of `navcore.exporting.target_c.files`."""
    del single
    document = table_of(form)
    values = facts(form, prefix, bounds) | {"tables": "\n".join(_html(document))}
    head = f"# {values['title']} Units of s: rad/s.\n"
    return {
        f"{prefix}.toml": head + tomlkit.dumps(_without_empty(document)),
        f"{prefix}.html": filled("table.html", values),
        "vectors.csv": vectors_csv(form),
    }


def table_of(form: Form) -> dict[str, Any]:
    """Return all numbers of a method, SI and radians.

    Parameters
    ----------
    form : Form
        The method.
    """
    subject, scenario = form.subject, form.subject.scenario
    method, omega_s = subject.method, subject.network.omega_s
    document: dict[str, Any] = {
        "law": {
            **{name: facts(form, "", ())[name] for name in ("scenario", "sha256", "method", "description")},
            "sources": sources_of(form),
            "rate_hz": subject.rate_hz,
            "step_s": subject.step_s,
            "omega_s_rad_s": omega_s,
            "latitude_deg": scenario.site.lat_deg,
            "log_hold_s": form.hold_s,
        }
    }
    if method.kind.uses_network:
        network = method.kind.network(method)
        document["network"] = network_table(subject.network, subject.step_s)
        gains = network.feedback_gains(omega_s)
        if gains is not None and network.external_form != "network" and method.kind.uses_log:
            document["velocity_feedback"] = dict(zip(("k1_per_s", "k2", "k3_per_s"), gains, strict=True))
        azimuth = method.kind.azimuth(method, omega_s)
        if isinstance(azimuth, AzimuthGains):
            document["gyrocompass"] = azimuth._asdict()
        elif azimuth is not None:
            document["azimuth"] = network_table(azimuth, subject.step_s, loop=False)
        for name in ("policy", "switching"):
            document[name] = getattr(method, name).model_dump(mode="json", by_alias=True, exclude_none=True)
        document["equations"] = {
            one.about: {"latex": one.latex, "text": one.text} for one in equations_of(scenario, method)
        }
    document["constants"] = {name: value for name, (value, _) in form.program.constants.items()}
    document["tables"] = {name: table.tolist() for name, (table, _) in form.program.tables.items()}
    document["interface"] = {
        part: [{"name": name, "what": note_of(form, name)} for name in names]
        for part, names in (("inputs", form.inputs), ("outputs", form.outputs))
    }
    return document


def network_table(network: LinearNetwork, step_s: float, loop: bool = True) -> dict[str, Any]:
    """Return a network as coefficients, roots, difference equation and state space, s in rad/s.

    Parameters
    ----------
    network : LinearNetwork
        H(s), or Y(s) of the azimuth channel.
    step_s : float
        Time between two calls, s.
    loop : bool
        Add what the closed level loop is like.
    """
    discrete = discretise(network, step_s)
    step = np.eye(discrete.order) + discrete.dA
    den_z = np.atleast_1d(np.real(np.poly(step)))
    row = -discrete.C[None, :]
    num_z = np.atleast_1d(np.real(np.poly(step - discrete.B[:, None] @ row))) + -discrete.D * den_z
    found: dict[str, Any] = {
        "id": network.id,
        "num": network.num.tolist(),
        "den": network.den.tolist(),
        "zeros": _pairs(network.zeros),
        "poles": _pairs(network.poles),
        "gain": network.gain,
        "h0": _finite(network.h0),
    }
    if loop:
        verdict, open_loop = analyse(network), margins(network)
        found |= {
            "closed_loop_poles": _pairs(verdict.poles),
            "damping_ratio": _finite(verdict.damping_ratio),
            "settling_s": _finite(verdict.settling_s),
            "margins": {} if open_loop is None else {k: _finite(v) for k, v in vars(open_loop).items()},
        }
    found["state_space"] = {
        "what": "Q = 1 - H of one channel in normalised discrete time: y = C x + D u, then x += dA x + B u",
        "dA": discrete.dA.tolist(),
        "B": discrete.B.tolist(),
        "C": (-discrete.C).tolist(),
        "D": 1.0 - discrete.D,
        "steady": discrete.steady_state(1.0).tolist(),
        "poles_z": _pairs(np.linalg.eigvals(step)),
    }
    found["difference_equation"] = {
        "what": f"Q(z) = num(z)/den(z), descending powers of z; {_DIRECT}",
        "num": num_z.tolist(),
        "den": den_z.tolist(),
    }
    return found


def _without_empty(block: dict[str, Any]) -> dict[str, Any]:
    """Leave out tables without entries; those with entries come last, as TOML wants them."""
    plain = {name: value for name, value in block.items() if not isinstance(value, dict)}
    inner = {
        name: _without_empty(value) for name, value in block.items() if isinstance(value, dict) and value
    }
    return plain | inner


def _pairs(roots: np.ndarray) -> list[list[float]]:
    return [[float(root.real), float(root.imag)] for root in np.asarray(roots, dtype=complex)]


def _finite(value: float | None) -> float | str:
    return float(value) if value is not None and math.isfinite(value) else "none"


def _html(document: dict[str, Any]) -> Iterator[str]:
    """Tables of a page to print: a block of the document each."""
    for name, block in document.items():
        rows: list[tuple[str, str]] = []
        if name == "interface":
            rows = [(one["name"], one["what"]) for part in block.values() for one in part]
        else:
            rows = list(_rows(block))
        if rows:
            columns = Column(Text("name"), left=True), Column(Text("value"), left=True)
            yield f"<h2>{name.replace('_', ' ')}</h2>{Table(columns, tuple(rows)).html()}"


def _rows(block: dict[str, Any], before: str = "") -> Iterator[tuple[str, str]]:
    for name, value in block.items():
        if isinstance(value, dict):
            yield from _rows(value, f"{before}{name} ")
        else:
            yield f"{before}{name}", value if isinstance(value, str) else json.dumps(value)
