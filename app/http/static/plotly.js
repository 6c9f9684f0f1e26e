// plotly.js is 4.8 MB, and reading it keeps a page from drawing anything for a while. It is fetched with the page, but
// read only once there is a figure to draw and all else is painted. What viser asks of it before is done then; an event
// "plotly" at the window comes first, so that other scripts may add to it.
(() => {
  const waiting = new Map();
  let asked = false;

  function begin() {
    window.dispatchEvent(new Event("plotly"));
    for (const [figure, { given, done }] of waiting) done(window.Plotly.react(figure, ...given));
    waiting.clear();
  }

  function load() {
    const script = document.createElement("script");
    script.src = document.querySelector("link[data-later]").href;
    script.addEventListener("load", begin);
    document.head.append(script);
  }

  window.Plotly = {
    react(figure, ...given) {
      if (!asked) requestAnimationFrame(() => setTimeout(load));
      asked = true;
      return new Promise((done) => waiting.set(figure, { given, done }));
    },
    purge: (figure) => waiting.delete(figure),
  };
})();
