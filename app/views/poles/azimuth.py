"""The loops of the azimuth networks, as the pole map takes those of the level channels (theory.md 3.7)."""

from dataclasses import replace

import numpy as np

from navcore.analysis import analyse
from navcore.engine.run import MethodRun, Run
from navcore.law.policy.constant import Constant
from navcore.networks.azimuth_loop import AzimuthGains
from navcore.networks.undamped import UndampedNetwork


def azimuth_loops(run: Run) -> Run:
    """Put the slow oscillation's loop, s^2 + Omega^2 Y, in the place of each method's level loop.

    With damped level channels and no azimuth network it is that of Y = 1. A method without a network, and one
    with a gyrocompass, have none.
    """
    methods = tuple(_slow(method) for method in run.methods)
    scenario = run.scenario.model_copy(update={"method": tuple(method.method for method in methods)})
    return replace(run, scenario=scenario, methods=methods)


def _slow(run: MethodRun) -> MethodRun:
    method = run.method
    channel = method.kind.azimuth(method, run.network.omega_s)
    network = method.azimuth.at_earth_rate()
    loop = analyse(network)
    if not method.kind.uses_network or isinstance(channel, AzimuthGains):
        network, loop = UndampedNetwork().at_earth_rate(), replace(loop, poles=np.zeros(0, complex))
    alone = method.model_copy(update={"network": method.azimuth, "policy": Constant()})
    return replace(run, method=alone, network=network, loop=loop)
