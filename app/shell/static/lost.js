// A page without its server is only paler: viser says no more. This says what it means, until the server is back.
(() => {
  const PATIENCE_MS = 1500;
  const WORDS = "The connection to the server is lost. The page shows the last state and takes no input. It connects " +
    "again by itself as soon as the server answers.";
  let waiting = 0;
  let banner = null;

  function say() {
    banner = Object.assign(document.createElement("div"), { id: "sb-lost", textContent: WORDS });
    banner.setAttribute("role", "alert");
    document.body.append(banner);
  }

  // Both from socket.js; the first again with each attempt that fails.
  addEventListener("disconnected", () => {
    if (waiting === 0 && document.getElementById("sb-run") !== null) waiting = setTimeout(say, PATIENCE_MS);
  });
  addEventListener("connected", () => {
    clearTimeout(waiting);
    banner?.remove();
    [waiting, banner] = [0, null];
  });
})();
