// Tells the server what viser does not: the size of the window and which tabs are in front. It is written into the
// control labelled "page state", which the page's style hides; the server reads it as "1920x1080|Frequency|Errors", or as
// "480x320 alone|..." where one view fills the window (alone.js), "1180x820 touch|..." where a finger is the pointer,
// "1920x1080 1.14|..." where a text is wider than in Arial, for which the server counts letters,
// "1920x1080 300,240,plots|..." where dividers have been moved (columns.js). A plot
// that is far from as high as the server took it has its height: "...|Poles~310" (room.js).
// And brings the tab to the front in which a newly chosen scenario opens: viser's server cannot.
(() => {
  const LABEL = "page state";
  const SAMPLE = "The quick brown fox jumps over the lazy dog 0123456789";
  const IN_ARIAL = 25.627; // width of the sample over its size
  let waiting = 0;
  let letter = "";
  let lettered = false; // the page's font is there, or does not come in time
  const font = document.fonts.load("13px Arimo").catch(() => {});
  Promise.race([font, new Promise((late) => setTimeout(late, 1000))]).then(() => (lettered = true));

  // Width of a text in the page's font over its width in Arial, once the page has its style. It is measured in the
  // page: a least size of type, which some browsers have, counts too.
  function measure() {
    const known = getComputedStyle(document.documentElement).getPropertyValue("--sb-font") !== "";
    if (letter !== "" || !known || !lettered) return letter;
    const sample = Object.assign(document.createElement("span"), { textContent: SAMPLE, ariaHidden: "true" });
    sample.style.cssText = "position:absolute;visibility:hidden;white-space:pre;font:13px var(--sb-font)";
    document.body.append(sample);
    const width = (sample.getBoundingClientRect().width / (13 * IN_ARIAL)).toFixed(2);
    sample.remove();
    letter = width === "1.00" ? " " : ` ${width}`;
    return letter;
  }

  function state() {
    const rooms = window.schuler.rooms?.() ?? {};
    const tabs = [...document.querySelectorAll('[role="tab"][aria-selected="true"]')].map((tab) => window.schuler.english(tab.textContent));
    const front = tabs.map((title) => (rooms[title] ? `${title}~${rooms[title]}` : title));
    const alone = window.schuler.alone ? " alone" : "";
    const touch = matchMedia("(pointer: coarse)").matches ? " touch" : "";
    const columns = window.schuler.columns?.() ?? ""; // columns.js
    return [`${innerWidth}x${innerHeight}${alone}${touch}${measure().trimEnd()}${columns}`, ...front].join("|");
  }

  window.schuler.state = state;

  // What the server has heard is in #sb-heard: what it has not is reported again.
  function report() {
    waiting = 0;
    const input = window.schuler.box(LABEL);
    if (input === null || !lettered) return;
    const text = state();
    if (document.getElementById("sb-heard")?.dataset.state === text) return void (unheard = []);
    window.schuler.write(input, text);
  }

  // Tabs that were brought to the front, the last one last, of which the server may not have heard.
  let unheard = [];
  function note({ target }) {
    const tab = target instanceof Element && target.closest('[role="tab"]');
    if (!tab) return false;
    unheard.push(window.schuler.english(tab.textContent));
    return true;
  }
  window.schuler.unheard = () => [...unheard];

  // One click may open a tab and close another, and tabs change after the click: they are read once they stand still.
  function soon(delay = 60) {
    clearTimeout(waiting);
    waiting = setTimeout(report, delay);
  }

  let opened = "";

  function openTab() {
    const wanted = document.getElementById("sb-focus")?.dataset ?? {};
    if (!wanted.scenario || wanted.scenario === opened) return;
    if (window.schuler.tab(wanted.tab) === undefined) return;
    opened = document.documentElement.dataset.opened = wanted.scenario;
    window.schuler.show(wanted.tab);
    soon();
  }

  // The page is laid out for its window: it is printed as it stands there, on one sheet of the window's proportions, which
  // the browser fits to the paper.
  const sheet = document.createElement("style");
  function setSheet() {
    sheet.textContent = `@media print { @page { size: ${innerWidth}px ${innerHeight}px; margin: 0; } }`;
  }
  document.documentElement.append(sheet);
  setSheet();
  addEventListener("resize", () => matchMedia("print").matches || setSheet());

  window.schuler.changed(openTab);
  addEventListener("resize", () => soon(150));
  addEventListener("filled-plots", () => soon());
  addEventListener("columns", () => soon());
  addEventListener("click", (event) => (note(event), soon()), true);
  addEventListener("keyup", (event) => note(event) && soon());
  setInterval(() => window.schuler.busy() || report(), 1000);
  const started = setInterval(() => {
    if (window.schuler.box(LABEL) === null || !lettered) return;
    clearInterval(started);
    report();
  }, 20);
})();
