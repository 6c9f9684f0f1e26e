// Values at the cursor in every time plot, and the time of the cursor for the server, which moves the ship there.
// uPlot links the cursors of all time plots itself; a click holds them where they are until the next one.
(() => {
  const SECONDS = { min: 60, h: 3600 };
  const known = new WeakSet();

  const charts = () => Object.values(window.__viserTestpoints?.uplots ?? {}).map((entry) => entry.chart);
  const unit = (label) => /\(([^()]*)\)\s*$/.exec(label ?? "")?.[1] ?? "";

  // Three digits are what an eye takes from a curve; the fourth tells neighbours apart.
  function digits(value) {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    return size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(2) : String(Number(value.toPrecision(4)));
  }

  function readout(chart) {
    let box = chart.root.querySelector(".sb-values");
    const at = chart.cursor.idx;
    if (at === null || at === undefined || chart.cursor.left < 0) {
      box?.replaceChildren();
      return;
    }
    if (box === null) {
      box = document.createElement("div");
      box.className = "sb-values";
      chart.over.append(box);
    }
    const values = chart.series.slice(1).flatMap((series, place) => {
      if (!series.show || series.label.startsWith("band, ")) return [];
      const word = document.createElement("span");
      word.style.color = typeof series.stroke === "function" ? series.stroke(chart, place + 1) : series.stroke;
      word.textContent = digits(chart.data[place + 1][at]);
      word.title = series.label;
      return [word];
    });
    const tail = document.createElement("span");
    const time = chart.data[0][at];
    tail.textContent = `${unit(chart.axes[1].label)} at ${digits(time)} ${unit(chart.series[0].label)}`;
    box.replaceChildren(...values, tail);
  }

  const playing = () => JSON.parse(document.getElementById("sb-playback")?.dataset.now ?? "{}").playing === true;

  function tell(chart) {
    if (!chart.over.matches(":hover") || chart.cursor.left < 0 || playing()) return;
    const time = chart.posToVal(chart.cursor.left, "x") * (SECONDS[unit(chart.series[0].label)] ?? 1);
    if (Number.isFinite(time)) window.schuler.stream("seek", Math.max(time, 0).toFixed(1));
  }

  function watch() {
    for (const chart of charts()) {
      if (known.has(chart)) continue;
      known.add(chart);
      (chart.hooks.setCursor ??= []).push((self) => {
        readout(self);
        tell(self);
      });
    }
  }

  window.schuler.changed(watch);
  addEventListener("mouseover", watch, true);
})();
