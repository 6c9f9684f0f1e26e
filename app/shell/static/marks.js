// Marks what page.css lays out: `data-sb-kind` on the block of a control or plot, `data-sb-holds` on the container of
// such blocks. CSS could find them by :has(), but then every change that plotly makes to its drawing lets the browser
// look at the whole page again: 100 to 200 ms a slider step. Leans on the names of viser's page, as pinned.
(() => {
  const KINDS = { slider: "Slider", select: "Select", text: "TextInput" };
  const HIDDEN = ["page state", "page command", "page painted"];
  const CONTAINERS = ["topbar", "tools", "compare"];
  const WIDE = ".sb-pins, .sb-no-pins, .sb-wide, .sb-look, .sb-legend, .mantine-Progress-root";

  // The child of ``container`` in which ``inner`` stands.
  function childWith(container, inner) {
    let at = inner;
    while (at !== null && at.parentElement !== container) at = at.parentElement;
    return at;
  }

  function found() {
    const kinds = new Map();
    const holds = new Map();
    const hold = (element, word) => element && holds.set(element, new Set(holds.get(element)).add(word));
    for (const row of document.getElementsByClassName("mantine-Flex-root")) {
      const label = row.firstElementChild?.querySelector(":scope > p > label");
      if (!label) continue;
      const of = ([, name]) => row.querySelector(`:scope > div .mantine-${name}-root`) !== null;
      const number = window.schuler.numberBox?.(label.htmlFor) !== undefined; // boxes.js
      const known = number ? "number" : (Object.entries(KINDS).find(of)?.[0] ?? "other");
      const kind = HIDDEN.includes(label.textContent) ? "hidden" : known;
      kinds.set(row.parentElement, kind);
      if (kind === "slider") hold(row.parentElement.parentElement, "sliders");
    }
    for (const plot of document.getElementsByClassName("uplot-container")) {
      kinds.set(plot.parentElement, "uplot");
      const container = plot.parentElement.parentElement;
      if (container.querySelector(":scope > div .sb-two")) hold(container, "two");
    }
    // viser as it is gives a figure's frame no name (app/bridge/program.py).
    for (const plot of document.querySelectorAll(".mantine-Paper-root:not(.plotly-container) > .js-plotly-plot, .mantine-Paper-root:not(.plotly-container) > div > .js-plotly-plot"))
      plot.closest(".mantine-Paper-root").classList.add("plotly-container");
    for (const name of CONTAINERS) {
      for (const mark of document.getElementsByClassName(`sb-${name}`)) {
        const container = mark.parentElement?.parentElement;
        if (!container) continue;
        hold(container, name);
        kinds.set(mark.parentElement, "mark");
        for (const paper of container.getElementsByClassName("plotly-container")) kinds.set(childWith(container, paper), "plot");
        for (const wide of container.querySelectorAll(WIDE)) kinds.set(childWith(container, wide), "wide");
      }
    }
    for (const paper of document.getElementsByClassName("plotly-container")) kinds.set(paper, "paper");
    // The top bar: the frame that viser draws around it, and its parts.
    const bar = document.querySelector(".sb-topbar")?.closest(".mantine-Paper-root");
    if (bar) kinds.set(bar, "bar");
    for (const part of document.querySelectorAll("[data-sb-part]")) kinds.set(part.parentElement, part.dataset.sbPart);
    return [
      ["data-sb-kind", kinds, (kind) => kind],
      ["data-sb-holds", holds, (words) => [...words].join(" ")],
    ];
  }

  // Our scripts know tabs and the controls through which they report by their texts: a browser that translates the page
  // leaves these alone.
  function keepWords() {
    for (const tab of document.querySelectorAll('[role="tab"]:not([translate])')) tab.setAttribute("translate", "no");
    for (const block of document.querySelectorAll('[data-sb-kind="hidden"]:not([translate])')) block.setAttribute("translate", "no");
  }

  function mark() {
    for (const [name, wanted, word] of found()) {
      for (const element of document.querySelectorAll(`[${name}]`)) {
        if (!wanted.has(element)) element.removeAttribute(name);
      }
      for (const [element, value] of wanted) {
        if (element.getAttribute(name) !== word(value)) element.setAttribute(name, word(value));
      }
    }
    keepWords();
  }

  const drawn = (node) =>
    node instanceof SVGElement || (node instanceof Element && node.closest(".js-plotly-plot, .uplot") !== null);
  // A text that has changed changes no layout: a slider step replaces some ten of them.
  const OURS = ["two", ...CONTAINERS].map((name) => `.sb-${name}`).join(", ").concat(", [data-sb-part]");
  const LAID_OUT = `[class*="mantine-"], label, .uplot-container, .js-plotly-plot, ${OURS}, ${WIDE}`;
  const laidOut = (node) => node instanceof Element && (node.matches(LAID_OUT) || node.querySelector(LAID_OUT) !== null);
  new MutationObserver((changes) => {
    const matters = ({ target, addedNodes, removedNodes }) => !drawn(target) && [...addedNodes, ...removedNodes].some(laidOut);
    if (changes.some(matters)) mark();
  }).observe(document.documentElement, { childList: true, subtree: true });
  addEventListener("numbers", mark); // which boxes hold numbers is known
})();
