"""Two loops after the same initial tilt: the one a misprint makes, which grows, beside the corrected one."""

import numpy as np

from navcore.analysis import analyse, initial_tilt_response
from navcore.foundation.text import Text
from navcore.networks.base import LinearNetwork
from schuler_bench.misprints.base import TILT, TIME, Comparison, Curve, Number, growth_time


class TwoLoops:
    """The loops closed with a network as printed and as corrected.

    Parameters
    ----------
    printed, corrected : LinearNetwork
        The network's two forms; the printed one's loop is unstable.

    Attributes
    ----------
    printed, corrected : Loop
        Poles, damping and settling of the two loops.
    growth_s : float
        Time in which the printed loop grows e-fold, s.
    """

    def __init__(self, printed: LinearNetwork, corrected: LinearNetwork) -> None:
        self._networks = printed, corrected
        self.printed, self.corrected = analyse(printed), analyse(corrected)
        growth = growth_time(self.printed.poles)
        assert growth is not None
        self.growth_s = growth

    @property
    def damping(self) -> Number:
        """Least damping ratio of both."""
        return Number(Text("damping ratio"), "", self.printed.damping_ratio, self.corrected.damping_ratio)

    @property
    def growth(self) -> Number:
        """e-folding time of both, s."""
        return Number(Text("e-folding time"), "s", self.growth_s, growth_time(self.corrected.poles))

    @property
    def settling(self) -> Number:
        """Settling time of both, s."""
        return Number(Text("settling time (2 %)"), "s", self.printed.settling_s, self.corrected.settling_s)

    def compare(
        self, t: np.ndarray, labels: tuple[str, str], numbers: tuple[Number, ...], words: str
    ) -> Comparison:
        """Lay the tilts after an initial tilt of 1 beside each other.

        Parameters
        ----------
        t : ndarray, shape (n,)
            Times, s.
        labels : tuple of str
            Of the printed and of the corrected curve.
        numbers, words
            As `Comparison` has them.
        """
        printed, corrected = (initial_tilt_response(network, t) for network in self._networks)
        curves = Curve(labels[0], "printed", printed), Curve(labels[1], "corrected", corrected)
        return Comparison(x_axis=TIME, y_axis=TILT, x=t, curves=curves, numbers=numbers, words=words)
