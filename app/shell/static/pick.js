// A click into a plotly figure goes to the server as a command with the place that was clicked, "place x y", in the
// numbers of the axes. viser's plots send no click. A figure says by layout.meta.pick that it takes one: the command's
// name, and the panels, each by the names of its axes.
(() => {
  const SLOP_PX = 4;
  const DOUBLE_MS = 300;
  let pressed = null;
  let waiting = 0;

  // Panels of a plot: the x and y axis of each subplot that takes clicks.
  function point(plot, event) {
    const layout = plot._fullLayout;
    const frame = plot.getBoundingClientRect();
    const x = event.clientX - frame.left;
    const y = event.clientY - frame.top;
    for (const [xName, yName] of layout.meta.pick.panels) {
      const [xaxis, yaxis] = [layout[xName], layout[yName]];
      const [left, top] = [x - xaxis._offset, y - yaxis._offset];
      if (left < 0 || left > xaxis._length || top < 0 || top > yaxis._length) continue;
      return [xaxis.p2d(left), yaxis.p2d(top)];
    }
    return null;
  }

  function plotOf(event) {
    const plot = event.target instanceof Element && event.target.closest(".js-plotly-plot");
    return plot && plot._fullLayout?.meta?.pick ? plot : null;
  }

  // A drag zooms: only what is released where it was pressed is a click. plotly lays its own area over the page
  // while a button is down, so the release is asked of the window.
  addEventListener(
    "pointerdown",
    (event) => {
      // The second press of a double click, which resets the zoom, takes the first one back.
      const second = waiting !== 0;
      clearTimeout(waiting);
      waiting = 0;
      const plot = event.button === 0 && !second ? plotOf(event) : null;
      const other = plot && event.target.closest(".legend, .modebar, .sb-handle");
      pressed = plot && !other ? { plot, x: event.clientX, y: event.clientY } : null;
    },
    true,
  );
  addEventListener(
    "pointerup",
    (event) => {
      const was = pressed;
      pressed = null;
      if (was === null || Math.hypot(event.clientX - was.x, event.clientY - was.y) > SLOP_PX) return;
      const found = point(was.plot, event);
      if (found === null || !found.every(Number.isFinite)) return;
      // plotly keeps the focus where it was: in a box the keys that take this back would not act
      if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
      const words = found.map((value) => value.toPrecision(6));
      waiting = setTimeout(() => {
        waiting = 0;
        window.schuler.command(was.plot._fullLayout.meta.pick.command, ...words);
      }, DOUBLE_MS);
    },
    true,
  );
})();
