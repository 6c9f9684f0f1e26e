"""``/metrics``: what the server is doing, for Prometheus. No name, address or id of a visitor is in it."""

import threading
import time
from collections.abc import Callable, Iterable, Mapping

import prometheus_client
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector, CollectorRegistry

_ANSWER_S = (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0)

Figures = Callable[[], Mapping[str, float]]


class _Gathered(Collector):
    """Gauges and counters (``..._total``) that other parts of the program hold as plain numbers."""

    def __init__(self, sources: list[Figures]) -> None:
        self._sources = sources

    def collect(self) -> Iterable[Metric]:
        """Ask every part."""
        for source in self._sources:
            for name, value in source().items():
                kind = CounterMetricFamily if name.endswith("_total") else GaugeMetricFamily
                yield kind(f"schuler_{name}", name.replace("_", " "), value=value)


class Metrics:
    """The figures of one server.

    Attributes
    ----------
    sources : list of callable
        Each gives numbers by name; a name that ends in ``_total`` only ever grows.
    answers : prometheus_client.Histogram
        Told the time of each answer, s.
    """

    def __init__(self) -> None:
        began_s = time.time()
        self.sources: list[Figures] = [
            lambda: {"started_time_seconds": began_s, "threads": float(threading.active_count())}
        ]
        self._registry = CollectorRegistry(auto_describe=False)
        self._registry.register(_Gathered(self.sources))
        prometheus_client.ProcessCollector(registry=self._registry)
        self.answers = prometheus_client.Histogram(
            "schuler_answer_seconds",
            "from a change of a scenario to its figures on all pages",
            buckets=_ANSWER_S,
            registry=self._registry,
        )

    def text(self) -> bytes:
        """All figures in the text format of Prometheus."""
        return prometheus_client.generate_latest(self._registry)
