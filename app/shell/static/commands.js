// What the page asks the server for: `schuler.command("name", "argument", ...)`, from any script of ours, from keys and
// from elements with data-command="name argument". It is written, with a running number, into the control labelled
// "page command", which the page's style hides (app/shell/commands.py). Of a control's values only the newest is sent in
// 30 ms: everything that the server has not heard is written again.
(() => {
  const LABEL = "page command";
  const SPACING_MS = 60;
  const REPEAT_MS = 250;
  let count = 0;
  let waiting = [];
  let timer = 0;
  let sent = 0;

  const heard = () => Number(document.getElementById("sb-told")?.dataset.count ?? 0);

  function send() {
    timer = 0;
    waiting = waiting.filter(({ asked }) => asked[0] > heard());
    if (waiting.length === 0) return;
    timer = setTimeout(send, REPEAT_MS);
    const input = window.schuler.box(LABEL);
    // While the user moves something, only what is new and asked for is worth displacing a value of theirs.
    const busy = window.schuler.busy();
    const ready = waiting.filter(({ gives }) => !(gives && busy)).slice(0, 50);
    if (input === null || ready.length === 0 || (busy && ready.every(({ told }) => told))) return;
    const text = JSON.stringify(ready.map(({ asked }) => asked));
    for (const one of ready) one.told = true;
    window.schuler.write(input, text);
    sent = performance.now();
  }

  function ask(name, words, { onlyLatest = false, gives = false } = {}) {
    if (onlyLatest) waiting = waiting.filter(({ asked }) => asked[1] !== name);
    waiting.push({ asked: [++count, name, words.join(" ")], gives, told: false });
    clearTimeout(timer);
    timer = setTimeout(send, Math.max(0, sent + SPACING_MS - performance.now()));
  }

  Object.assign(window.schuler, {
    copy: copyText,
    // Every one of these is carried out, in order.
    command(name, ...words) {
      window.schuler.end();
      ask(name, words);
    },
    // Of these, for what changes continuously, the next of the same name replaces one that is not yet sent.
    stream: (name, ...words) => ask(name, words, { onlyLatest: true }),
    // What the page says by itself: it waits too while the user moves something, whose value it would displace.
    report: (name, ...words) => ask(name, words, { onlyLatest: true, gives: true }),
    // The number of the last command asked for, and that of the last one which the server has carried out.
    asked: () => count,
    heard,
  });

  addEventListener("click", (event) => {
    const asked = event.target instanceof Element && event.target.closest("[data-command]");
    if (!asked || asked.getAttribute("aria-disabled") === "true") return;
    window.schuler.command(...asked.dataset.command.split(" "));
  });

  // ------------------------------------------------------------ keys

  const TYPED = "input:not([type=checkbox]):not([type=radio]):not([type=button]), textarea, select, [contenteditable]";
  let keys = {};
  let read = "";

  function command(event) {
    const text = document.getElementById("sb-commands")?.dataset.keys ?? "{}";
    if (text !== read) keys = JSON.parse((read = text));
    const key = event.key === " " ? "space" : event.key.toLowerCase();
    const control = event.ctrlKey || event.metaKey;
    // What Shift makes of a key that is no letter is in the key already: "?".
    const shift = event.shiftKey && (key.length > 1 || key.toUpperCase() !== key.toLowerCase());
    return keys[`${control ? "ctrl+" : ""}${event.altKey ? "alt+" : ""}${shift ? "shift+" : ""}${key}`];
  }

  // Before viser's own listener, on the document, which moves the camera by letters and arrows.
  document.documentElement.addEventListener("keydown", (event) => {
    const target = event.target instanceof Element ? event.target : document.body;
    if (event.defaultPrevented || target.closest(TYPED) || target.closest("[role=dialog], dialog")) return;
    // These two keys press what has the focus.
    if ([" ", "Enter"].includes(event.key) && target.closest("button, a, summary, [role=button], [role=tab]")) return;
    const name = command(event);
    if (name === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat || event.ctrlKey || event.metaKey) window.schuler.command(name);
  });

  // A value that is typed and ended by Enter or Escape is done with: the keys act again. A form's text stays open.
  addEventListener("keydown", (event) => {
    const box = event.target;
    if (!["Enter", "Escape"].includes(event.key) || !(box instanceof HTMLInputElement)) return;
    if (box.form !== null || !box.closest(".mantine-TextInput-root")) return;
    if (box.closest("[role=dialog], dialog")) return;
    setTimeout(() => box.blur());
  });

  // ------------------------------------------------------------ what the server asks the page for

  function openTab(name) {
    const tab = window.schuler.show(name);
    tab?.focus();
    if (document.activeElement !== tab) requestAnimationFrame(() => tab?.focus()); // of the menu: seen only then (tabs.js)
  }

  // A field that the palette found: its tab may have to be shown first, and its control to be made.
  function openField(text) {
    const [tab, id] = JSON.parse(text);
    openTab(tab);
    let tries = 40;
    const timer = setInterval(() => {
      const label = [...document.getElementsByTagName("label")].find(({ htmlFor }) => htmlFor === id);
      const row = label?.closest(".mantine-Flex-root");
      const box = row?.querySelector("input, select, [role=slider], button");
      if ((!box || box.getClientRects().length === 0) && --tries > 0) return;
      clearInterval(timer);
      if (!box) return;
      row.scrollIntoView({ block: "center" });
      box.focus();
      box.select?.();
    }, 50);
  }

  function element(tag, text, attributes = {}) {
    const made = Object.assign(document.createElement(tag), { textContent: text });
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    return made;
  }

  // The browser's own dialog: it holds the focus, and Escape closes it.
  function dialog(title, ...content) {
    document.querySelector("dialog.sb-dialog")?.remove();
    const made = element("dialog", "", { class: "sb-dialog", "aria-label": title });
    const close = element("button", "Close", { class: "sb-do" });
    close.addEventListener("click", () => made.close());
    made.append(element("h2", title), ...content, close);
    made.addEventListener("close", () => made.remove());
    document.body.append(made);
    // What the dark theme does to the page does not reach the browser's top layer.
    made.style.filter = getComputedStyle(document.documentElement).filter;
    made.showModal();
    return made;
  }

  function showKeys() {
    const told = JSON.parse(document.getElementById("sb-commands")?.dataset.told ?? "[]");
    const table = element("table", "");
    for (const [key, title] of [["Ctrl+K", "All commands"], ...told]) {
      const row = table.insertRow();
      row.append(element("th", key, { scope: "row" }), element("td", title));
    }
    dialog("Keys", element("p", "They act while no text box has the focus: Enter or Esc leaves one. Esc closes what is open."), table);
  }

  // What brings the tabs to the front that are there now (front.js).
  function tabsInFront() {
    const front = [...document.querySelectorAll('[role="tab"][aria-selected="true"]')];
    return `?tab=${front.map((tab) => encodeURIComponent(window.schuler.english(tab.textContent))).join()}`;
  }

  // Only a page that came over https, or from this computer, may write to the clipboard by itself.
  async function copyText(text) {
    if (navigator.clipboard) return navigator.clipboard.writeText(text);
    const box = element("textarea", text);
    document.body.append(box);
    box.select();
    document.execCommand("copy");
    box.remove();
  }

  function showLink(id, query = "") {
    const link = new URL(`../${id}/${query}`, location.origin + location.pathname).href;
    const input = element("input", "", { readonly: "", value: link, "aria-label": "Link to this state" });
    const copy = element("button", "Copy the link", { class: "sb-do" });
    const done = element("span", "", { role: "status" });
    copy.addEventListener("click", async () => {
      await copyText(link);
      done.textContent = " Copied.";
    });
    const told = "Whoever opens this link gets a copy of the present state, under an address of their own. What you " +
      "or they change afterwards does not change what the link opens.";
    const row = element("p", "");
    row.append(copy, done);
    const texts = [element("p", told)];
    if (/^(localhost|127(\.\d+){3}|\[::1\]|.*\.localhost)$/.test(location.hostname)) {
      const alone = "Only this computer can open this link: its address is that of the computer itself. Others can open " +
        "it when the server listens on the network (schuler serve --host) and this page is opened at that address.";
      texts.push(element("p", alone, { class: "sb-alone", role: "note" }));
    }
    dialog("Share this state", ...texts, input, row);
    input.select();
  }

  // The browser opens its file dialog because the user has just pressed a key or a button.
  function upload() {
    openTab("Files");
    setTimeout(() => document.querySelector("input[type=file]")?.click(), 200);
  }

  // Tabs come to the front without taking the focus: those of who presents; those that the server knew to be there before
  // the panels were made anew, but for what the user has chosen since.
  const bring = (names) => window.schuler.foremost(names.map(window.schuler.tab)).forEach(window.schuler.open);
  const follow = (names) => bring(names.split("|"));
  const bringBack = (names) => bring([...names.split("|"), ...window.schuler.unheard()]);

  const ACTIONS = {
    language: window.schuler.switchLanguage,
    tab: openTab,
    field: openField,
    front: follow,
    "front-again": bringBack,
    upload,
    keys: showKeys,
    link: (id) => showLink(id),
    "link-view": (id) => showLink(id, tabsInFront()),
    embed: (id) => window.schuler.embed?.(id),
  };
  Object.assign(window.schuler, {
    element,
    dialog,
    // Let the server ask for more: `run(text)` for what app/shell/commands.py calls ``ask_page``.
    act: (what, run) => (ACTIONS[what] = run),
  });
  let answered = 0;
  let seen = "[]";

  window.schuler.changed(() => {
    const asked = document.getElementById("sb-asked")?.dataset.asked ?? "[]";
    if (asked === seen) return;
    seen = asked;
    for (const [number, what, text] of JSON.parse(asked)) {
      if (number <= answered) continue;
      answered = number;
      ACTIONS[what]?.(text);
    }
  });

  // ------------------------------------------------------------ buttons in HTML of ours

  // The HTML is replaced when what it says changes: the focus goes to the new button of the same command.
  const KEEPS = [".sb-row", ".sb-legend", ".sb-pins", ".sb-chips"];
  let focused = "";
  addEventListener("focusin", (event) => {
    const inside = event.target instanceof Element && KEEPS.some((where) => event.target.closest(where)) &&
      event.target.closest("[data-command]");
    focused = inside ? inside.dataset.command : "";
  });
  addEventListener("focusout", (event) => {
    if (focused !== "" && event.relatedTarget !== null) focused = "";
  });
  window.schuler.changed(() => {
    if (focused === "" || document.activeElement !== document.body) return;
    const wanted = KEEPS.map((where) => `${where} [data-command="${CSS.escape(focused)}"]`).join();
    document.querySelector(wanted)?.focus();
  });

  addEventListener("click", (event) => {
    if (!(event.target instanceof Element) || !event.target.closest("[data-palette]")) return;
    const pressed = { key: "k", code: "KeyK", ctrlKey: true, bubbles: true };
    document.documentElement.dispatchEvent(new KeyboardEvent("keydown", pressed));
  });
})();
