// A curve that stands still in a plot over time keeps its path: uPlot makes all of them anew with each picture, and a
// slider changes one of several. It stands still while the page has its numbers from before (app/bridge/curves.js).
(() => {
  const known = new WeakSet(); // series

  function keep(series) {
    const trace = series.paths;
    let had = null;
    series.paths = (chart, place, ...range) => {
      const { x, [series.scale]: y } = chart.scales;
      const { left, top, width, height } = chart.bbox;
      const from = [chart.data[0], chart.data[place], ...range, x.min, x.max, y.min, y.max, left, top, width, height];
      if (had === null || from.some((value, at) => value !== had.from[at])) had = { from, path: trace(chart, place, ...range) };
      return had.path;
    };
  }

  window.schuler.changed(() => {
    for (const { chart } of Object.values(window.__viserTestpoints?.uplots ?? {})) {
      for (const series of chart.series.slice(1)) {
        if (known.has(series)) continue;
        known.add(series);
        keep(series);
      }
    }
  });
})();
