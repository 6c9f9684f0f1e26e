// Runs before viser's page.

(() => {
  // viser writes the address of its websocket into the address bar, and connects to whatever address stands there. The
  // page always belongs to the server it came from: keep the address short, and fit to be shared and bookmarked.
  const write = history.replaceState.bind(history);
  const withoutSocket = (url) => {
    const address = new URL(url ?? location.href, location.href);
    address.searchParams.delete("websocket");
    return address.href;
  };
  history.replaceState = (state, title, url) => write(state, title, withoutSocket(url));
  history.replaceState(history.state, "", location.href);

  // viser starts its sorter of Gaussian splats on every page. The sorter makes functions from text, which the
  // Content-Security-Policy of this server forbids. Nothing here draws splats: keep that one complaint off the console,
  // so that a real one is noticed. Where it comes from is `wasm://...` in Chromium's words, `wasm-function[...]` in Firefox's.
  addEventListener("unhandledrejection", (event) => {
    const error = event.reason;
    if (error instanceof EvalError && /wasm(:|-function)/.test(error.stack || "")) event.preventDefault();
  });
})();
