// plotly.js is fetched with the page, but not read at once: that would keep the page from connecting. It is read while the
// page waits for the server, or with the first figure. What viser asks of it before is done then; an event "plotly" at
// the window comes first, so that other scripts may add to it.
(() => {
  const waiting = new Map();
  const whenIdle = window.requestIdleCallback ?? setTimeout;
  let asked = false;

  function begin() {
    window.dispatchEvent(new Event("plotly"));
    for (const [figure, { given, done }] of waiting) done(window.Plotly.react(figure, ...given));
    waiting.clear();
  }

  function load() {
    if (asked) return;
    asked = true;
    const script = document.createElement("script");
    script.src = document.querySelector("link[data-later]").href;
    script.addEventListener("load", begin);
    document.head.append(script);
  }

  // viser connects (app/bridge/socket.js).
  addEventListener("connecting", () => whenIdle(load), { once: true });

  window.Plotly = {
    react(figure, ...given) {
      load();
      return new Promise((done) => waiting.set(figure, { given, done }));
    },
    purge: (figure) => waiting.delete(figure),
  };
})();
