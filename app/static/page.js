// Tells the server what viser does not: the size of the window and which tabs are in front. It is written into the
// control labelled "page state", which the page's style hides; the server reads it as "1920x1080|Frequency|Errors".
// And brings the tab to the front in which a newly chosen scenario opens: viser's server cannot.
(() => {
  const LABEL = "page state";
  const setter = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set;
  let waiting = 0;

  function box() {
    for (const label of document.getElementsByTagName("label")) {
      if (label.textContent === LABEL) return label.closest(".mantine-Flex-root")?.querySelector("input") ?? null;
    }
    return null;
  }

  function state() {
    const front = [...document.querySelectorAll('[role="tab"][aria-selected="true"]')].map((tab) => tab.textContent);
    return [`${innerWidth}x${innerHeight}`, ...front].join("|");
  }

  // What the server has heard is in #sb-heard: viser drops a value when several change at once.
  function report() {
    waiting = 0;
    const input = box();
    if (input === null) return;
    const text = state();
    if (document.getElementById("sb-heard")?.dataset.state === text) return;
    // The same text again would be no change.
    setter.call(input, input.value === text ? `${text} ` : text);
    input.dispatchEvent(new Event("input", { bubbles: true }));
  }

  // viser sends at most one value in 50 ms: a report made together with another change may be dropped.
  function soon(delay = 60) {
    clearTimeout(waiting);
    waiting = setTimeout(report, delay);
  }

  let opened = "";

  function openTab() {
    const wanted = document.getElementById("sb-focus")?.dataset ?? {};
    if (!wanted.scenario || wanted.scenario === opened) return;
    const tabs = [...document.querySelectorAll('[role="tab"]')];
    const tab = tabs.find((candidate) => candidate.textContent === wanted.tab);
    if (tab === undefined) return;
    opened = document.documentElement.dataset.opened = wanted.scenario;
    // viser's tabs react to a pointer's whole way, or to a key; a click alone does nothing.
    tab.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true, cancelable: true }));
    soon();
  }

  setInterval(openTab, 150);
  addEventListener("resize", () => soon(150));
  addEventListener("click", () => soon(), true);
  addEventListener("keyup", (event) => event.target instanceof Element && event.target.closest('[role="tab"]') && soon());
  setInterval(report, 1000);
  const started = setInterval(() => {
    if (box() === null) return;
    clearInterval(started);
    report();
  }, 20);
})();
