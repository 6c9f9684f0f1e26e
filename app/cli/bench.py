"""``schuler bench``: how fast it is on this machine."""

from dataclasses import dataclass

from schuler_bench.cli.terminal import emit_result, on_terminal, say


@dataclass(frozen=True)
class BenchCommand:
    """Measure speed and memory on this machine: medians of at least five repeats.

    Attributes
    ----------
    json : bool
        Print one JSON document.
    """

    json: bool = False

    def execute(self) -> int:
        """Measure and print; 3 when the dashboard does not answer."""
        from schuler_bench.bench import bench
        from schuler_bench.cli.bench_text import bench_text

        def tell(what: str) -> None:
            if on_terminal():
                say(f"{what} ...")

        try:
            numbers = bench(tell)
        except (FileNotFoundError, RuntimeError, TimeoutError) as error:
            say(f"bench: stopped: {error}")
            return 3
        rounded = {key: round(value, 4) for key, value in numbers.items()}
        emit_result(self.json, rounded, lambda: bench_text(numbers))
        return 0
