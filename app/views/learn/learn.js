// Lessons and explanations: what viser's page cannot do. Answers typed into a lesson, tabs that a lesson brings to the
// front, and the panel that explains the control in use ("?" beside a label, F1, or E).
(() => {
  // ------------------------------------------------------------ answers

  addEventListener("submit", (event) => {
    const form = event.target;
    if (!(form instanceof HTMLFormElement) || form.dataset.answer === undefined) return;
    event.preventDefault();
    window.schuler.command(form.dataset.answer, form.dataset.what ?? "answer", form.querySelector("input").value);
  });

  // HTML that is replaced takes the focus with it: it goes back to what was pressed, or to what has its place.
  let pressed = "";
  addEventListener("click", (event) => {
    const asked = event.target instanceof Element && event.target.closest(".sb-lesson [data-command]");
    if (asked) pressed = asked.dataset.command;
  });
  // Who goes on elsewhere is not called back.
  addEventListener("focusin", ({ target }) => {
    if (target.dataset?.command !== pressed) pressed = "";
  });
  window.schuler.changed(() => {
    if (pressed === "" || document.activeElement !== document.body) return;
    const again = [...document.querySelectorAll(".sb-lesson [data-command]")];
    (again.find((other) => other.dataset.command === pressed) ?? again[0])?.focus({ preventScroll: true });
    pressed = "";
  });

  // ------------------------------------------------------------ tabs in front

  let fronted = "0";
  let tries = 0;

  function bringToFront() {
    const wanted = document.getElementById("sb-front")?.dataset ?? {};
    if (wanted.count === undefined || wanted.count === fronted) return;
    // The tab in which a newly chosen scenario opens comes first (page.js).
    const focus = document.getElementById("sb-focus")?.dataset.scenario;
    if (focus && document.documentElement.dataset.opened !== focus) return;
    const found = wanted.tabs.split("|").map(window.schuler.tab);
    // A tab may still have to come with the run.
    if (found.includes(undefined) && ++tries < 60) return;
    fronted = document.documentElement.dataset.fronted = wanted.count;
    tries = 0;
    // Of tabs that share a panel, as in a small window, only the one named last comes to the front.
    const lists = found.map((tab) => tab?.closest('[role="tablist"]'));
    found.filter((_, place) => lists.lastIndexOf(lists[place]) === place).forEach(window.schuler.open);
  }

  setInterval(bringToFront, 150);

  // ------------------------------------------------------------ help while the pointer rests

  // Of a control in the left column it stands beside the column, not over the control's neighbours, where viser has it.
  let pointed = null;
  addEventListener("pointerover", (event) => (pointed = event.target.closest?.("[data-sb-kind]") ?? null));
  window.schuler.changed(() => {
    const help = document.querySelector(".mantine-Tooltip-tooltip:not([data-sb-beside])");
    const row = pointed?.getBoundingClientRect();
    if (help === null || row === undefined || row.left > 40) return;
    help.dataset.sbBeside = "";
    help.style.setProperty("--sb-left", `${row.right + 8}px`);
    help.style.setProperty("--sb-top", `${Math.max(8, Math.min(row.top, innerHeight - help.offsetHeight - 8))}px`);
  });

  // ------------------------------------------------------------ the control in use, explained

  const ROW = ".mantine-Flex-root";
  const TYPED = "input:not([type=checkbox]):not([type=radio]), textarea, select, [contenteditable]";
  let hovered = null;
  let panel = null;
  let shown = "0";

  // A slider has rows of its own inside the row that its label stands in.
  function labelOf(element) {
    for (let row = element?.closest?.(ROW); row; row = row.parentElement?.closest(ROW)) {
      const label = row.querySelector("label[for]");
      if (label !== null) return label;
    }
    return null;
  }

  function explain(label) {
    window.schuler.report("explain", label?.htmlFor ?? "");
  }

  // Where a "?" covers no label: at the end of the room for the label, or where there is none, in the row of tools above
  // a plot, at the end of the box.
  const TIGHT = '[data-sb-holds~="tools"] > :is([data-sb-kind="select"], [data-sb-kind="number"])';
  const placeOf = (label) => (label?.closest(TIGHT) ? label.closest(ROW) : label?.parentElement?.parentElement);

  // A "?" beside the label that the pointer is over; by key it is not needed.
  addEventListener("pointerover", (event) => {
    hovered = labelOf(event.target);
    const place = placeOf(hovered);
    if (!place || place.querySelector(".sb-mark") || document.querySelector(`[id="${hovered.htmlFor}"]`) === null) return;
    for (const old of document.querySelectorAll(".sb-mark")) if (!old.matches(":hover")) old.remove();
    const mark = document.createElement("button");
    mark.className = "sb-mark";
    mark.textContent = "?";
    mark.tabIndex = -1;
    mark.ariaLabel = mark.title = `Explain ${hovered.textContent}`;
    const label = hovered;
    mark.addEventListener("click", () => explain(label));
    place.append(mark);
  });

  addEventListener(
    "keydown",
    (event) => {
      if (event.key === "Escape" && panel?.isConnected && !document.querySelector("[role=dialog]")) return close();
      const asked = event.key === "F1" || (event.key === "e" && !event.target.closest?.(TYPED));
      if (!asked || event.ctrlKey || event.metaKey || event.altKey || event.target.closest?.("[role=dialog]")) return;
      event.preventDefault();
      event.stopPropagation();
      explain(labelOf(document.activeElement) ?? hovered);
    },
    true,
  );

  // An open panel follows the control in use.
  addEventListener("focusin", (event) => {
    const label = panel?.isConnected ? labelOf(event.target) : null;
    if (label) explain(label);
  });

  function close() {
    panel?.remove();
  }

  // Over the 3D view, between the columns and above the bar of the playback.
  function place() {
    const lists = [...document.querySelectorAll('[role="tablist"]')].map((list) => list.getBoundingClientRect());
    const left = Math.round((lists.find((box) => box.left < innerWidth / 3)?.right ?? 340) + 14);
    const right = Math.min(innerWidth, ...lists.filter((box) => box.left > innerWidth / 3).map((box) => box.left));
    panel.style.left = `${left}px`;
    panel.style.width = `${Math.max(240, Math.min(384, Math.round(right - left - 14)))}px`;
  }

  function showExplained() {
    const source = document.getElementById("sb-explained");
    if (source === null || source.dataset.count === shown) return;
    shown = source.dataset.count;
    if (panel === null) {
      panel = document.createElement("aside");
      panel.id = "sb-explain";
      panel.className = "sb-explain";
      panel.ariaLabel = "Explanation of a control";
    }
    panel.innerHTML = `<button class="sb-close" aria-label="Close the explanation">\u00d7</button><div role="status">${source.innerHTML}</div>`;
    panel.querySelector(".sb-close").addEventListener("click", close);
    document.body.append(panel);
    place();
  }

  window.schuler.changed(showExplained);
  addEventListener("resize", () => panel?.isConnected && place());
})();
