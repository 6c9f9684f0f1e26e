// plotly.js is fetched with the page, but not read at once: that takes a quarter of a second, in which the page would
// neither connect nor show its first plots. It is read with the first figure, or when the page is at rest. What viser asks
// of it before is done then; an event "plotly" at the window comes first, so that other scripts may add to it.
(() => {
  const waiting = new Map();
  const whenIdle = window.requestIdleCallback ?? setTimeout;
  const REST_MS = 4000;
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
  addEventListener("connecting", () => setTimeout(() => whenIdle(load), REST_MS), { once: true });

  window.Plotly = {
    react(figure, ...given) {
      load();
      return new Promise((done) => waiting.set(figure, { given, done }));
    },
    purge: (figure) => waiting.delete(figure),
  };
})();
