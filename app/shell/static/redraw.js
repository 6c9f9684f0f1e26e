// Draws a plotly figure again without its layout while only the numbers of its lines have changed: Plotly.react lays out
// axes, labels and legend anew for each slider step, 80 ms for a Bode plot. An axis whose range has changed with them is
// laid out alone, a third of that. Everything else goes to Plotly.react. Leans on what plotly keeps of a figure, as
// pinned: tests/browser/test_page_redraw.py compares with a figure drawn anew.
(() => {
  let react = null;
  const drawn = new WeakMap();
  const held = new WeakMap(); // ranges of the axes by name, of a figure whose axes are to stay
  const given = new WeakMap(); // what a held figure was given last
  const homes = new WeakMap(); // ranges with which axes came
  const last = new WeakMap(); // what a figure was drawn from last
  const heights = new WeakMap(); // of a figure that fills its panel, px

  const SCALE = ["range", "dtick", "tickvals", "ticktext"]; // what an axis has of its own numbers
  const isAxis = (name) => /^[xy]axis\d*$/.test(name);

  // What of a figure must be the same, and the scales of its axes. Plotly changes the objects it is given, so they are
  // compared as text.
  function frameOf(layout) {
    const { run, handle, told, ...meta } = layout?.meta ?? {};
    const frame = { ...layout, meta };
    const scales = {};
    for (const name of Object.keys(frame).filter(isAxis)) {
      frame[name] = { ...frame[name] };
      for (const key of SCALE) {
        scales[`${name}.${key}`] = JSON.stringify(frame[name][key] ?? null);
        delete frame[name][key];
      }
    }
    return { frame: JSON.stringify(frame), scales };
  }
  const styleOf = ({ x, y, ...style }) => JSON.stringify(style);
  const text = (values) => values?.bdata ?? JSON.stringify(values);

  function remember(data, layout) {
    const lines = data.map((trace) => ({ style: styleOf(trace), x: text(trace.x), y: text(trace.y) }));
    return { ...frameOf(layout), lines };
  }

  function numbers(values) {
    if (Array.isArray(values)) return Float64Array.from(values, (value) => value ?? NaN);
    if (values?.dtype !== "f4") return null;
    const letters = atob(values.bdata);
    const bytes = new Uint8Array(letters.length);
    for (let place = 0; place < letters.length; place++) bytes[place] = letters.charCodeAt(place);
    return new Float32Array(bytes.buffer);
  }

  // Places of the traces whose numbers have changed; null when something else has, too.
  function changed(before, after) {
    if (before?.frame !== after.frame || before.lines.length !== after.lines.length) return null;
    const places = [];
    for (const [place, line] of after.lines.entries()) {
      const old = before.lines[place];
      if (old.style !== line.style) return null;
      if (old.x !== line.x || old.y !== line.y) places.push(place);
    }
    return places;
  }

  // Scales of axes that have changed, as Plotly.relayout takes them; null when the figure must be drawn anew: an axis in
  // which someone has zoomed stays as it is.
  function rescaled(figure, before, after) {
    const wanted = {};
    for (const [key, scale] of Object.entries(after)) {
      if (before[key] === scale) continue;
      const { range } = figure._fullLayout[key.split(".")[0]];
      const had = JSON.parse(before[key.replace(/\..*/, ".range")]);
      if (had === null || had.some((end, place) => Math.abs(end - range[place]) > 1e-9 * Math.abs(had[1] - had[0]))) return null;
      wanted[key] = JSON.parse(scale);
    }
    return wanted;
  }

  // What is needed to move one trace: its numbers, points, axes and path; null where the trace is no plain line.
  function lineOf(figure, groups, place, given) {
    const points = figure.calcdata?.[place];
    const trace = points?.[0]?.trace;
    const [x, y] = [numbers(given.x), numbers(given.y)];
    const paths = groups.get(trace)?.querySelectorAll("path.js-line");
    if (trace?.type !== "scatter" || trace.mode !== "lines" || (trace.fill ?? "none") !== "none") return null;
    if (paths?.length !== 1 || x === null || y === null || x.length !== points.length || y.length !== x.length) return null;
    const axis = (id) => figure._fullLayout[id.replace(/^([xy])/, "$1axis")];
    return { trace, points, x, y, path: paths[0], across: axis(trace.xaxis), up: axis(trace.yaxis) };
  }

  function move({ trace, points, x, y, path, across, up }) {
    let way = "";
    let pen = "M";
    for (const [place, point] of points.entries()) {
      point.x = Number.isFinite(x[place]) ? x[place] : undefined;
      point.y = Number.isFinite(y[place]) ? y[place] : undefined;
      const [left, top] = [across.c2p(x[place]), up.c2p(y[place])];
      if (Number.isFinite(left) && Number.isFinite(top)) {
        way += `${pen}${left.toFixed(2)},${top.toFixed(2)}`;
        pen = "L";
      } else pen = "M";
    }
    [trace.x, trace.y] = [x, y];
    path.setAttribute("d", way || "M0,0Z");
  }

  function movedInPlace(figure, data, layout, now) {
    const before = drawn.get(figure);
    const places = changed(before, now);
    if (places === null || !figure._fullLayout || figure._dragging || figure._transitioning) return false;
    const scales = rescaled(figure, before.scales, now.scales);
    if (scales === null) return false;
    const find = () => {
      const groups = new Map();
      for (const group of figure.querySelectorAll(".scatterlayer > g.trace")) groups.set(group.__data__?.[0]?.trace, group);
      return places.map((place) => lineOf(figure, groups, place, data[place]));
    };
    let lines = find();
    if (lines.includes(null)) return false;
    const keys = Object.keys(scales);
    if (keys.length > 0) {
      Plotly.relayout(figure, scales);
      for (const name of new Set(keys.map((key) => key.split(".")[0]))) goHomeTo(figure, name, layout[name].range);
      lines = find(); // plotly may have made its axes anew
      if (lines.includes(null)) return false;
    }
    lines.forEach(move);
    figure.data = data;
    figure.layout.meta = figure._fullLayout.meta = layout.meta;
    return true;
  }

  function goHomeTo(figure, name, range) {
    const shown = figure._fullLayout?.[name];
    if (shown) [shown._rangeInitial0, shown._rangeInitial1] = range ?? [];
  }

  // A double click goes back to the ranges that plotly drew first, also where another figure has taken the place since:
  // it is told those of the present one, as they came, for a zoom changes the axes that were given.
  async function redrawn(figure, data, layout, config, wanted) {
    const axes = Object.entries(wanted).filter(([name]) => isAxis(name));
    for (const [, axis] of axes) if (!homes.has(axis)) homes.set(axis, [...(axis.range ?? [])]);
    await react(figure, data, layout, config);
    for (const [name, axis] of axes) goHomeTo(figure, name, homes.get(axis));
  }

  function draw(figure, data, wanted, config) {
    last.set(figure, [data, wanted, config]);
    let layout = { ...wanted, height: heights.get(figure) ?? wanted.height };
    const ranges = held.get(figure);
    if (ranges !== undefined) {
      given.set(figure, [data, wanted, config]);
      for (const [name, range] of Object.entries(ranges)) layout[name] = { ...wanted[name], range: [...range] };
    }
    const now = remember(data, layout);
    const done = movedInPlace(figure, data, layout, now) ? Promise.resolve() : redrawn(figure, data, layout, config, wanted);
    drawn.set(figure, now);
    // For what we lay over a figure (handle.js).
    return done.finally(() => figure.dispatchEvent(new Event("drawn", { bubbles: true })));
  }

  Object.assign(window.schuler, {
    // Draw a figure in this height from now on (room.js), in the place of the server's, which `heightOf` tells.
    heightOf: (figure) => last.get(figure)?.[1].height,
    setHeight(figure, height) {
      heights.set(figure, height);
      draw(figure, ...last.get(figure));
    },
    // The axes of a figure stay while a handle in it is dragged: else the place under the pointer would be another one.
    holdAxes(figure) {
      const names = Object.keys(figure._fullLayout ?? {}).filter(isAxis);
      held.set(figure, Object.fromEntries(names.map((name) => [name, [...figure._fullLayout[name].range]])));
    },
    freeAxes(figure) {
      const last = given.get(figure);
      held.delete(figure);
      given.delete(figure);
      if (last !== undefined) draw(figure, ...last);
    },
  });

  // Once plotly is there (app/http/static/plotly.js).
  addEventListener("plotly", () => {
    react = Plotly.react;
    Plotly.react = draw;
  });
})();
