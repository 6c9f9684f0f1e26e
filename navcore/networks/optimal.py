"""The network that is best for given sensors: LQG on the model of one level channel (theory.md 17)."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import PrivateAttr

from navcore.foundation.parameters import choice, quantity
from navcore.foundation.text import Text
from navcore.foundation.units import DEG_PER_HOUR, DEG_PER_SQRT_HOUR, MICRO_G
from navcore.networks.base import LinearNetwork, NetworkParameters, linear_network, refuse
from navcore.networks.lqg import Compensator, ControlProblem, SensorFigures, compensator, plant
from navcore.networks.seen_at import seen_at
from navcore.networks.state_space import state_spaces

EXAMPLE_SHIP = SensorFigures(
    gyro_white=0.003 * DEG_PER_SQRT_HOUR,
    gyro_drift=0.003 * DEG_PER_HOUR,
    gyro_tau_s=3600.0,
    accel_white=10.0 * MICRO_G,
    accel_drift=10.0 * MICRO_G,
    accel_tau_s=3600.0,
    log_noise=0.2,
    log_rate_hz=1.0,
    log_drift=0.1,
    log_tau_s=600.0,
)
"""Sensors of the example of theory.md 20: where neither the network nor the scenario has any."""
FRAGILE = 0.5
"""Modulus margin below which a loop counts as fragile."""

_ACCURACY = 1e-8
"""To which the running form must have the response of the network."""
_STATES = 4
"""States of the network that the law is reduced to (theory.md 17)."""
_UNSTABLE = Text("makes an unstable network with these figures: must be larger")
_FIELDS = {
    "gyro_arw_dpsh": ("gyro_white", DEG_PER_SQRT_HOUR),
    "gyro_instability_dph": ("gyro_drift", DEG_PER_HOUR),
    "gyro_tau_s": ("gyro_tau_s", 1.0),
    "accel_vrw_ugpshz": ("accel_white", MICRO_G),
    "accel_instability_ug": ("accel_drift", MICRO_G),
    "accel_tau_s": ("accel_tau_s", 1.0),
    "log_noise_mps": ("log_noise", 1.0),
    "log_rate_hz": ("log_rate_hz", 1.0),
    "log_drift_mps": ("log_drift", 1.0),
    "log_drift_tau_s": ("log_tau_s", 1.0),
}


def _figure(
    unit: str, label: str, slider: tuple[float, float], *, ge: float = 0.0, le: float, log: bool = False
) -> Any:
    help = Text(
        "The {label} that the network is designed for; that of the scenario when not given (theory.md 17).",
        label=label,
    )
    return quantity(None, unit=unit, ge=ge, le=le, slider=slider, log=log, label=label, help=help)


class OptimalNetwork(NetworkParameters):
    """H = 1 - Q with Q the LQG law for the sensors at hand: filter and feedback of the same order.

    With velocity feedback the same filter has a second output, which goes into the velocity itself.

    The figures of sensors and log are those of the scenario, as far as they are not given here; where the
    scenario has no random errors either, those of an example ship.
    """

    title: ClassVar[str] = Text("Optimal for the sensors (LQG)")
    source: ClassVar[str] = "theory.md 17"
    no_handle: ClassVar[str] = Text("its poles follow from the sensors, ρ and q")
    id: Literal["optimal"] = "optimal"
    rho: float = quantity(
        1e-2,
        ge=1e-6,
        le=1e3,
        slider=(1e-5, 10.0),
        log=True,
        label="ρ",
        help=Text(
            "Weight of the correction in φ² + q δV² + ρ u_c²: the smaller, the faster the loop and "
            "the nearer the tilt to the floor, and the larger the velocity error (theory.md 17)."
        ),
    )
    q: float = quantity(
        1.0,
        ge=0.0,
        le=1e3,
        slider=(0.0, 5.0),
        label="q",
        help=Text(
            "Weight of the velocity error beside that of the tilt; with 0 the tilt comes to the floor, "
            "and the 24 h mode grows within hours (theory.md 17)."
        ),
    )
    realisation: Literal["network", "feedback"] = choice(
        "network",
        label=Text("realisation"),
        help=Text(
            "network: the transport rate alone is corrected; feedback: the velocity too, as by K₁ of "
            "compass, which brings tilt and velocity near the floor; external damping only (theory.md 17)."
        ),
    )
    gyro_arw_dpsh: float | None = _figure("deg/sqrt(h)", Text("angular random walk"), (0.0, 0.05), le=100.0)
    gyro_instability_dph: float | None = _figure("deg/h", Text("gyro instability"), (0.0, 0.05), le=1e4)
    gyro_tau_s: float | None = _figure(
        "s", Text("gyro correlation time"), (10.0, 86400.0), ge=1.0, le=1e7, log=True
    )
    accel_vrw_ugpshz: float | None = _figure(
        "ug/sqrt(Hz)", Text("velocity random walk"), (0.0, 100.0), le=1e6
    )
    accel_instability_ug: float | None = _figure(
        "ug", Text("accelerometer instability"), (0.0, 100.0), le=1e5
    )
    accel_tau_s: float | None = _figure(
        "s", Text("accelerometer correlation time"), (10.0, 86400.0), ge=1.0, le=1e7, log=True
    )
    log_noise_mps: float | None = _figure("m/s", Text("log noise"), (0.0, 1.0), le=50.0)
    log_rate_hz: float | None = _figure("Hz", Text("log rate"), (0.1, 10.0), ge=0.001, le=1000.0, log=True)
    log_drift_mps: float | None = _figure("m/s", Text("log drift"), (0.0, 1.0), le=50.0)
    log_drift_tau_s: float | None = _figure(
        "s", Text("log drift time"), (10.0, 36000.0), ge=1.0, le=1e7, log=True
    )
    omega_s_radps: float | None = quantity(
        None,
        unit="rad/s",
        ge=1e-6,
        le=1.0,
        label=Text("designed for ωₛ"),
        help=Text(
            "The Schuler frequency that the network is designed for; that of the site when not given. A "
            "result that is written holds it, so that H(s) is the same wherever it is read."
        ),
    )
    _sensors: SensorFigures | None = PrivateAttr(default=None)

    def with_sensors(self, figures: SensorFigures) -> OptimalNetwork:
        """Return the same network for the sensors of a scenario."""
        designed = self.model_copy()
        designed._sensors = figures
        return designed

    def changed(self, field: str, value: Any) -> NetworkParameters:
        """Return the same network with one field changed, for the same sensors."""
        network = super().changed(field, value)
        return network if self._sensors is None else network.with_sensors(self._sensors)

    def taken(self) -> dict[str, Any]:
        """Return the figures of sensors and log that it is designed for and that are not given."""
        values, _ = self._values()
        return {field: value for field, value in values.items() if getattr(self, field) is None}

    def frozen(self, omega_s: float) -> OptimalNetwork:
        """Return the same H(s) with all figures and the Schuler frequency given."""
        return self.model_copy(
            update={"omega_s_radps": omega_s, **self.taken(), **self._given("omega_s_radps")}
        )

    def _given(self, *names: str) -> dict[str, float]:
        return {name: value for name in names if (value := getattr(self, name)) is not None}

    def figures(self) -> tuple[SensorFigures, tuple[str, ...]]:
        """Figures that the network is designed for, and warnings about those that are nobody's."""
        values, warnings = self._values()
        return SensorFigures(
            **{name: values[field] * unit for field, (name, unit) in _FIELDS.items()}
        ), warnings

    def _values(self) -> tuple[dict[str, float], tuple[str, ...]]:
        """Figures in the units of the fields, and warnings.

        The figures in SI are made from these, so that a network whose fields are all given has exactly the
        H(s) of one that has taken the same figures from a scenario.
        """
        base, warnings = self._sensors or EXAMPLE_SHIP, []
        given = self._given(*_FIELDS)
        values = _in_fields(base) | given
        used = SensorFigures(**{name: values[field] * unit for field, (name, unit) in _FIELDS.items()})
        for what, missing, prefixes in (
            (Text("gyros and accelerometers"), not used.inertial, ("gyro", "accel")),
            ("log", not used.log, ("log",)),
        ):
            if missing or (self._sensors is None and not any(name.startswith(prefixes) for name in given)):
                example = {k: v for k, v in _in_fields(EXAMPLE_SHIP).items() if k.startswith(prefixes)}
                values |= example | ({} if missing else given)
                warnings.append(
                    Text(
                        "optimal: no random error of the {what} is given; designed for those of the "
                        "example ship",
                        what=what,
                    )
                )
        return values, tuple(warnings)

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s) for a Schuler frequency in rad/s; one for ``omega_s_radps`` is seen there unchanged.

        Raises
        ------
        InputError
            No stable network of this kind exists for these figures.
        """
        if self.omega_s_radps is not None and self.omega_s_radps != omega_s:
            return seen_at(self.transfer(self.omega_s_radps), omega_s)
        figures, warnings = self.figures()
        try:
            with np.errstate(all="ignore"):  # of densities whose squares are no numbers any more
                law = _law(figures, self.rho, self.q, self.realisation == "feedback", omega_s)
        except (np.linalg.LinAlgError, FloatingPointError):
            raise refuse(
                "rho", self.rho, Text("the Riccati equations of these figures have no solution")
            ) from None
        poles = np.linalg.eigvals(law.A)
        zeros = np.linalg.eigvals(law.A + np.outer(law.B, law.C))
        network = linear_network(
            "optimal",
            omega_s,
            np.real(np.poly(zeros)),
            np.real(np.poly(poles)),
            zeros_p=zeros,
            poles_p=poles,
            realisation=self.realisation,
            feedback_p=_second_output(law) if self.realisation == "feedback" else None,
        )
        self._check(network, law)
        margin = modulus_margin(network)
        if margin < FRAGILE:
            fragile = Text(
                "fragile: modulus margin {margin:.2g}, below {fragile:g}; change ρ or q",
                margin=margin,
                fragile=FRAGILE,
            )
            warnings = (*warnings, fragile)
        return replace(network, warnings=warnings)

    def control_problem(self) -> ControlProblem:
        """Return what it is designed for, on one level channel."""
        return ControlProblem(self.figures()[0], self.rho, self.q, self.realisation == "feedback")

    @property
    def stated_omega_s(self) -> float | None:
        """The one that it was designed for, where it is given."""
        return self.omega_s_radps

    @property
    def external_form(self) -> str:
        """The realisation that was chosen."""
        return self.realisation

    @property
    def requires_reference(self) -> bool:
        """Whether the second output is used, which needs a reference to pull the velocity onto."""
        return self.realisation == "feedback"

    def _check(self, network: LinearNetwork, law: Compensator) -> None:
        """Refuse what cannot run: an unstable network or loop, or one too wide for double precision."""
        poles = network.poles / network.omega_s
        loop = np.roots(np.polyadd(np.append(network.den_p, [0.0, 0.0]), network.loop_num_p))
        if np.max(np.real(poles)) >= 0.0 or np.max(np.real(loop)) >= 0.0:
            raise refuse("rho", self.rho, _UNSTABLE)
        p = 1j * np.geomspace(1e-2, 1e2, 40)
        exact = [network.response(p.imag * network.omega_s)]
        nums = [network.num_p]
        if network.feedback_p is not None:
            exact.append(_responses(p, law.A, law.B) @ law.E)
            nums.append(network.feedback_p)
        systems = state_spaces(nums, poles)
        states = _responses(p, systems[0].A, systems[0].B)
        numerators = [states @ system.C + system.D for system in systems]
        # of a product: 0/0 is no deviation, and what is no number does not agree with anything
        pairs = zip(numerators, exact, strict=True)
        if not all(np.all(np.abs(f - e) <= _ACCURACY * np.abs(e)) for f, e in pairs):
            allowed = Text(
                "makes a network too fast for these figures to run in double precision: must be larger"
            )
            raise refuse("rho", self.rho, allowed)


def _in_fields(figures: SensorFigures) -> dict[str, float]:
    """Figures by the names and in the units of the fields."""
    return {field: getattr(figures, name) / unit for field, (name, unit) in _FIELDS.items()}


@lru_cache(maxsize=256)
def _law(figures: SensorFigures, rho: float, q: float, feedback: bool, omega_s: float) -> Compensator:
    try:
        law = compensator(plant(figures, omega_s).excited(), rho, q, feedback)
    except ValueError as error:  # scipy's word for a matrix with infinities
        raise FloatingPointError(str(error)) from None
    if not all(np.all(np.isfinite(part)) for part in (law.A, law.B, law.C, law.E)):
        raise FloatingPointError("the law is not finite")
    if np.max(np.real(np.linalg.eigvals(law.A))) >= 0.0:  # which has no balanced truncation
        raise refuse("rho", rho, _UNSTABLE)
    return law.reduced(_STATES)


def _second_output(law: Compensator) -> np.ndarray:
    """Numerator of E (p - A)^-1 B over the characteristic polynomial of A."""
    from scipy.signal import ss2tf

    num, _ = ss2tf(law.A, law.B[:, None], law.E[None, :], np.zeros((1, 1)))
    return num[0, 1:]


def _responses(p: np.ndarray, A: np.ndarray, B: np.ndarray) -> np.ndarray:
    """(p - A)^-1 B at each p, shape (len(p), n)."""
    return np.linalg.solve(p[:, None, None] * np.eye(len(B)) - A, B[:, None])[..., 0]


def modulus_margin(network: LinearNetwork) -> float:
    """Least distance of the open loop from -1: 1 is the best, 0 the limit of stability.

    Parameters
    ----------
    network : LinearNetwork
        H(s); the open loop is omega_s^2 H/s^2, and (H + p G)/p^2 with two outputs.
    """
    omega = network.omega_s * np.geomspace(1e-2, 1e5, 700)
    return float(np.min(np.abs(1.0 - (network.omega_s / omega) ** 2 * network.loop_response(omega))))
