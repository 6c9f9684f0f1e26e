// Says which picture the page has painted, and whether a slider (or a handle in a plot) moves, by a way of its own (app/bridge/socket.js): the
// server waits with the next picture until then, skips those for which there was no time, and while a slider moves sends
// only what is in front (app/shell/pace.py). #sb-picture carries the picture's number and the control that hears.
(() => {
  const REST_MS = 150;
  let seen = "0";
  let painted = "0";
  let held = false;
  let moving = false;
  let rest = 0;

  const picture = () => document.getElementById("sb-picture")?.dataset;
  const tell = () => window.schuler.tell(picture()?.answer, `${painted} ${Number(moving)}`);

  function look() {
    const number = picture()?.number;
    if (number === undefined || number === seen) return;
    seen = number;
    // After the frame in which the picture is painted; a hidden tab has no frames, and is not waited for.
    requestAnimationFrame(() =>
      setTimeout(() => {
        painted = number;
        tell();
      }),
    );
  }

  window.schuler.changed(look);

  function set(now) {
    clearTimeout(rest);
    if (now) rest = setTimeout(() => set(false), REST_MS);
    if (moving === now || picture() === undefined) return;
    moving = now;
    tell();
  }

  const MOVED = ".mantine-Slider-root, .sb-handle";
  const onSlider = (event) => event.target instanceof Element && event.target.closest(MOVED) !== null;
  addEventListener("pointerdown", (event) => (held = onSlider(event)), true);
  addEventListener("pointermove", (event) => held && event.buttons !== 0 && set(true), true);
  addEventListener("keydown", (event) => event.repeat && onSlider(event) && set(true), true);
  for (const kind of ["pointerup", "pointercancel", "keyup", "blur"]) {
    addEventListener(kind, () => set((held = false)), true);
  }
})();
