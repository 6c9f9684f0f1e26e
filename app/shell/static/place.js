// A page that was idle may have given up its place to another visitor, or has lost its server. viser connects again by
// itself; the server lets it in when a place is free. Once a person is back at the page, it says so, and may take the
// place of another page that is idle.
(() => {
  const QUIET_MS = 5000;
  let last = Date.now();

  async function back() {
    const quiet = Date.now() - last;
    last = Date.now();
    if (document.visibilityState !== "visible" || quiet < QUIET_MS) return;
    const answer = await fetch("place", { cache: "no-store" }).catch(() => null);
    // The server has been started anew and does not know this session: begin another one.
    if (answer?.status === 410) location.reload();
  }

  for (const kind of ["pointerdown", "pointermove", "keydown", "focus"]) addEventListener(kind, back, true);
  document.addEventListener("visibilitychange", back);
})();
