// Fingers on plots over time: uPlot knows a mouse only. A finger that moves across a plot is the mouse with its button
// down: it chooses a span of time, which is zoomed into. Two taps are a double click, which shows the whole run again: not
// every browser makes one of them. A single tap is a click, as browsers make it, and holds the cursor. Along a plot the
// finger scrolls (touch.css).
(() => {
  const SLOP_PX = 8;
  const NEAR_PX = 40;
  const TWICE_MS = 500;
  let held = null;
  let tapped = null;

  function send(kind, event) {
    const { clientX, clientY } = event;
    const buttons = kind === "mouseup" ? 0 : 1;
    // uPlot passes over a move with its button down that goes nowhere
    const made = new MouseEvent(kind, { bubbles: true, cancelable: true, clientX, clientY, buttons, movementX: 1, view: window });
    // uPlot waits on the document for the button to come up again
    (kind === "mouseup" ? document : held.over).dispatchEvent(made);
  }

  addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "touch") return;
    const on = event.isPrimary && event.target instanceof Element ? event.target : null;
    const over = on?.closest(".sb-limit-line") ? null : on?.closest(".u-over"); // a limit is dragged (limits.js)
    held = over ? { over, id: event.pointerId, x: event.clientX, y: event.clientY, moved: false } : null;
  }, true);

  addEventListener("pointermove", (event) => {
    if (held === null || event.pointerId !== held.id) return;
    if (!held.moved) {
      if (Math.abs(event.clientX - held.x) < SLOP_PX) return;
      held.moved = true;
      release(held.over);
      const from = { clientX: held.x, clientY: held.y };
      send("mouseenter", from);
      send("mousemove", from);
      send("mousedown", from);
    }
    send("mousemove", event);
  }, true);

  // A cursor that an earlier tap holds would not follow. Leans on viser's handles of its charts, as cursor.js does.
  function release(over) {
    for (const { chart } of Object.values(window.__viserTestpoints?.uplots ?? {})) {
      if (chart.over === over) chart.cursor._lock = false;
    }
  }

  function tap(event) {
    const last = tapped;
    tapped = { over: held.over, at: event.timeStamp, x: event.clientX, y: event.clientY };
    if (last?.over !== tapped.over || tapped.at - last.at > TWICE_MS) return;
    if (Math.hypot(tapped.x - last.x, tapped.y - last.y) > NEAR_PX) return;
    tapped = null;
    send("dblclick", event);
  }

  for (const kind of ["pointerup", "pointercancel"]) {
    addEventListener(kind, (event) => {
      if (held === null || event.pointerId !== held.id) return;
      if (held.moved) send("mouseup", event);
      else if (kind === "pointerup") tap(event);
      held = null;
    }, true);
  }
})();
