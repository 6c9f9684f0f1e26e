// Names and roles for people who do not see the page or do not use a mouse, where viser's page has none: sliders, text
// boxes, icon buttons, plots, the 3D view, landmarks. docs/accessibility.md says what is checked.
(() => {
  const ICONS = { "list-search": "Find a command", adjustments: "Settings of the viewer", search: "Find a command" };

  function set(element, name, value) {
    if (element.getAttribute(name) !== value) element.setAttribute(name, value);
  }

  function rowLabel(element) {
    for (let row = element.closest(".mantine-Flex-root"); row; row = row.parentElement?.closest(".mantine-Flex-root")) {
      const label = row.querySelector("label[for]");
      if (label !== null) return label.textContent;
    }
    return "";
  }

  function controls() {
    const ids = new Map(); // of boxes, by label
    const labelled = new Set();
    for (const { textContent, htmlFor } of document.querySelectorAll("label[for]")) {
      labelled.add(htmlFor);
      if (!ids.has(textContent)) ids.set(textContent, htmlFor);
    }
    // What a slider stands at, as its exact box says it: on a logarithmic slider its own value is the logarithm.
    const exact = window.schuler.say(", exact");
    const valueOf = (label) => document.getElementById(ids.get(`${label}${exact}`))?.value ?? "";
    for (const slider of document.querySelectorAll('[role="slider"]')) {
      const label = rowLabel(slider) || slider.getAttribute("aria-label");
      if (!label) continue;
      set(slider, "aria-label", label);
      const value = valueOf(label);
      if (value) set(slider, "aria-valuetext", value);
    }
    for (const box of document.querySelectorAll("input:not([type=hidden])")) {
      if (labelled.has(box.id) || box.ariaLabel) continue; // box.labels would look the whole page through
      const label = rowLabel(box);
      if (label) set(box, "aria-label", label);
    }
    for (const button of document.querySelectorAll("button:not([aria-label])")) {
      if (button.textContent.trim() || button.title || button.ariaHidden === "true") continue;
      const icon = [...(button.querySelector("svg")?.classList ?? [])].find((name) => name.startsWith("tabler-icon-"));
      const name = icon?.slice("tabler-icon-".length) ?? "";
      set(button, "aria-label", ICONS[name] ?? (name.replaceAll("-", " ") || "Close"));
    }
    for (const picture of document.querySelectorAll("img:not([alt])")) picture.alt = "";
    for (const head of document.querySelectorAll("th:empty:not([aria-label])")) set(head, "aria-label", "Quantity");
    for (const formula of document.querySelectorAll(".sb-formula")) {
      if (formula.scrollWidth > formula.clientWidth) set(formula, "tabindex", "0");
    }
    // A text that is longer than its panel is scrolled by keys, too.
    for (const area of document.querySelectorAll(".mantine-ScrollArea-viewport")) {
      const long = area.scrollHeight > area.clientHeight || area.scrollWidth > area.clientWidth;
      if (long && !area.querySelector("button, input, a, [tabindex]")) set(area, "tabindex", "0");
    }
  }

  function plots() {
    for (const plot of document.querySelectorAll(".js-plotly-plot")) {
      const titles = (plot._fullLayout?.annotations ?? []).map((a) => a.text).filter((text) => text?.startsWith("<b>"));
      const names = [...new Set((plot._fullData ?? []).map((t) => t.name))].filter((name) => !/^trace \d+$/.test(name));
      const words = [titles.join(", ").replace(/<[^>]*>/g, ""), names.filter(Boolean).join(", ")].filter(Boolean);
      if (words.length === 0) continue; // nothing is drawn in it yet
      set(plot, "role", "figure");
      set(plot, "aria-label", words.length > 1 ? `Plot: ${words[0]}; curves: ${words[1]}` : `Plot: ${words[0]}`);
    }
    for (const { chart } of Object.values(window.__viserTestpoints?.uplots ?? {})) {
      const names = chart.series.slice(1).map((series) => series.label).join(", ");
      set(chart.root, "role", "figure");
      set(chart.root, "aria-label", `Plot over time: ${chart.axes[1].label}; curves: ${names}`);
    }
    for (const plot of document.querySelectorAll(".uplot:not([aria-label])")) {
      set(plot, "role", "figure");
      set(plot, "aria-label", "Plot over time");
    }
  }

  function landmarks() {
    const root = document.getElementById("root");
    if (root !== null) set(root, "role", "main");
    const view = document.querySelector("canvas[data-engine]");
    if (view !== null) {
      set(view, "role", "img");
      set(view, "aria-label", "Map in 3D: the true track, the computed tracks and the ship. Metrics (tab Errors) has the numbers.");
    }
    if (document.querySelector('h1, [aria-level="1"]') !== null) return;
    const title = [...document.querySelectorAll("div")].find((d) => d.children.length === 0 && d.textContent === "Schuler Bench");
    if (title === undefined) return;
    set(title, "role", "heading");
    set(title, "aria-level", "1");
  }

  // viser moves the camera by letters and arrows wherever they are pressed: on a control they are the control's.
  const CONTROL = 'input, textarea, select, button, [role="slider"], [role="tab"], [contenteditable]';
  document.documentElement.addEventListener("keydown", (event) => {
    const moves = /^(Arrow(Left|Right|Up|Down)|Key[WASDQE])$/.test(event.code);
    if (moves && event.target instanceof Element && event.target.closest(CONTROL)) event.stopPropagation();
  });

  // Tab and Enter: the first slider lies thirty keys behind the top bar and the chips.
  const skip = Object.assign(document.createElement("button"), { id: "sb-skip", type: "button", textContent: "To the first slider" });
  skip.addEventListener("click", () => document.querySelector('[data-dock-region="left"] [role="slider"]')?.focus());

  let changed = true;
  window.schuler.changed(() => (changed = true));
  addEventListener("resize", () => (changed = true)); // what has become too long for its panel
  setInterval(() => {
    if (!changed) return;
    changed = false;
    if (!skip.isConnected && !window.schuler.alone) document.body.prepend(skip);
    controls();
    plots();
    landmarks();
  }, 700);
})();
