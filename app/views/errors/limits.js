// Lines of limits in the plots over time: each has a handle that is dragged, and the limit is set where it is let go.
// Which series is a limit's line the server says (Curve.limit of app/plots/uplot.py): what is limited, and how much the
// plot's unit is in that of the limit's box.
(() => {
  const known = new WeakSet();
  let held = null; // handle that is being dragged

  const charts = () => Object.values(window.__viserTestpoints?.uplots ?? {}).map(({ chart }) => chart);
  const unit = (chart) => /\(([^()]*)\)\s*$/.exec(chart.axes[1].label ?? "")?.[1] ?? "";
  const rounded = (value) => String(Number(value.toPrecision(3)));
  const stop = (event) => event.stopPropagation();

  function handleOf(chart, place) {
    const handle = document.createElement("div");
    handle.className = "sb-limit-line";
    const words = document.createElement("span");
    words.hidden = true;
    handle.append(words);
    const valueAt = (event) => {
      const { top, height } = chart.over.getBoundingClientRect();
      const y = Math.min(Math.max(event.clientY - top, 0), height);
      return [y, Math.abs(chart.posToVal(y, "y"))];
    };
    // uPlot would begin a zoom, and a click would hold the cursor
    for (const name of ["mousedown", "mouseup", "click", "dblclick", "touchstart"]) handle.addEventListener(name, stop);
    handle.addEventListener("pointerdown", (event) => {
      stop(event);
      if (event.button !== 0) return;
      handle.setPointerCapture(event.pointerId);
      held = handle;
    });
    handle.addEventListener("pointermove", (event) => {
      if (held !== handle) return;
      const [y, value] = valueAt(event);
      handle.style.top = `${y}px`;
      words.textContent = `${rounded(value)} ${unit(chart)}`;
      words.hidden = false;
    });
    const end = (event) => {
      if (held !== handle) return;
      held = null;
      const moved = !words.hidden;
      words.hidden = true;
      const [quantity, size] = chart.series[place].limit;
      const [, value] = valueAt(event);
      if (moved && event.type === "pointerup" && value > 0) window.schuler.command("limit", quantity, rounded(value * size));
      else arrange(chart);
    };
    handle.addEventListener("pointerup", end);
    handle.addEventListener("pointercancel", end);
    return handle;
  }

  // Puts a handle on each line that is in sight.
  function arrange(chart) {
    const had = new Map([...chart.over.querySelectorAll(".sb-limit-line")].map((handle) => [Number(handle.dataset.series), handle]));
    chart.series.forEach((series, place) => {
      if (!series.limit) return;
      const handle = had.get(place) ?? handleOf(chart, place);
      if (!had.delete(place)) {
        handle.dataset.series = String(place);
        chart.over.append(handle);
      }
      if (handle === held) return;
      const value = chart.data[place]?.find(Number.isFinite);
      const y = value === undefined ? -1 : chart.valToPos(value, "y");
      handle.hidden = !(y >= 0 && y <= chart.over.clientHeight);
      handle.style.top = `${y}px`;
      handle.title = value === undefined ? "" : `${series.label}: ${rounded(Math.abs(value))} ${unit(chart)}`;
    });
    for (const handle of had.values()) handle.remove();
  }

  window.schuler.changed(() => {
    for (const chart of charts()) {
      if (known.has(chart)) continue;
      known.add(chart);
      (chart.hooks.draw ??= []).push(arrange);
      arrange(chart);
    }
  });
})();
