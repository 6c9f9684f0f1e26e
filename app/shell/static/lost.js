// A page without its server is only paler: viser says no more. This says what it means, until the server is back.
(() => {
  const PATIENCE_MS = 1500;
  const WORDS = "The connection to the server is lost. The page shows the last state and takes no input. It connects " +
    "again by itself as soon as the server answers.";
  let connected = false;
  let since = 0;
  let banner = null;

  // viser makes what it has drawn half transparent and deaf while its websocket is not connected.
  const faded = () => document.querySelector('[style*="opacity: 0.5"][style*="pointer-events: none"]') !== null;

  function say() {
    banner = Object.assign(document.createElement("div"), { id: "sb-lost", textContent: WORDS });
    banner.setAttribute("role", "alert");
    document.body.append(banner);
  }

  setInterval(() => {
    const lost = faded();
    connected ||= !lost && document.getElementById("sb-run") !== null;
    since = lost && connected ? since || performance.now() : 0;
    if (banner === null && since > 0 && performance.now() - since > PATIENCE_MS) say();
    if (banner !== null && since === 0) {
      banner.remove();
      banner = null;
    }
  }, 500);
})();
