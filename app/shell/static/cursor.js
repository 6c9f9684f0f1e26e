// Values at the cursor in every time plot, and the time of the cursor for the server, which moves the ship there.
// uPlot links the cursors of all time plots itself; a click holds them where they are until the next one. A click with Shift
// sets a second cursor: every plot then says by how much the curves differ between both. Another one there, or Escape, ends it.
(() => {
  const SECONDS = { min: 60, h: 3600 };
  const known = new WeakSet();
  const NEAR_PX = 4;
  let second = null; // time of the second cursor, s

  const charts = () => Object.values(window.__viserTestpoints?.uplots ?? {}).map((entry) => entry.chart);
  const unit = (label) => /\(([^()]*)\)\s*$/.exec(label ?? "")?.[1] ?? "";

  // Three digits are what an eye takes from a curve; the fourth tells neighbours apart.
  function digits(value) {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    return size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(2) : String(Number(value.toPrecision(4)));
  }

  const seconds = (chart) => SECONDS[unit(chart.series[0].label)] ?? 1;

  // Place in the data that is nearest to the second cursor; null without one, or where it is out of the plot.
  function secondPlace(chart) {
    if (second === null) return null;
    const { min, max } = chart.scales.x;
    const time = second / seconds(chart);
    return time >= min && time <= max ? chart.valToIdx(time) : null;
  }

  function drawSecond(chart) {
    const place = secondPlace(chart);
    let line = chart.root.querySelector(".sb-second");
    if (place === null) return line?.remove();
    if (line === null) {
      line = document.createElement("div");
      line.className = "sb-second";
      chart.over.append(line);
    }
    line.style.left = `${chart.valToPos(second / seconds(chart), "x")}px`;
  }

  function setSecond(time) {
    second = time;
    for (const chart of charts()) {
      drawSecond(chart);
      readout(chart);
    }
  }

  addEventListener("mousedown", (event) => {
    const over = event.shiftKey && event.button === 0 && event.target instanceof Element ? event.target.closest(".u-over") : null;
    const chart = over && charts().find((each) => each.over === over);
    if (!chart) return;
    event.stopPropagation(); // it neither zooms nor holds the cursor
    const left = event.clientX - over.getBoundingClientRect().left;
    const there = second !== null && Math.abs(chart.valToPos(second / seconds(chart), "x") - left) <= NEAR_PX;
    setSecond(there ? null : chart.posToVal(left, "x") * seconds(chart));
  }, true);

  addEventListener("keydown", (event) => {
    if (event.key === "Escape" && second !== null && !document.querySelector("dialog[open], [role=dialog]")) setSecond(null);
  });

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
    const other = secondPlace(chart);
    const values = chart.series.slice(1).flatMap((series, place) => {
      if (!series.show || series.label.startsWith("band, ")) return [];
      const word = document.createElement("span");
      word.style.color = typeof series.stroke === "function" ? series.stroke(chart, place + 1) : series.stroke;
      const value = chart.data[place + 1][at];
      word.textContent = other === null ? digits(value) : `Δ ${digits(value - chart.data[place + 1][other])}`;
      word.title = series.label;
      return [word];
    });
    const tail = document.createElement("span");
    const time = chart.data[0][at];
    const when = other === null ? `at ${digits(time)}` : `in ${digits(time - chart.data[0][other])}`;
    tail.textContent = `${unit(chart.axes[1].label)} ${when} ${unit(chart.series[0].label)}`;
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
      (chart.hooks.draw ??= []).push(drawSecond);
      drawSecond(chart);
    }
  }

  window.schuler.changed(watch);
  addEventListener("mouseover", watch, true);
})();
