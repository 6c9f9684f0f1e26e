// The dividers between controls, 3D view and plots, and between the two panels of plots, in the place of viser's own grips
// (page.css), which lay nothing out anew. What is dragged is kept in the browser and told to the server with the window's
// size (page.js), which makes the pictures for it; a double click takes it back. And which of 3D view and plots has the
// most room: "plots", "view", or "rail" where the 3D view is folded.
(() => {
  const KEY = "schuler-columns";
  const STEP_PX = 24;
  const LEAST_UPPER = 0.2;
  const PLAIN = { left: 0, view: 0, upper: 0.5, mode: "plots" };
  const kept = { ...PLAIN, ...fromStore() };
  if (window.schuler.alone) return;

  function fromStore() {
    try {
      return JSON.parse(localStorage.getItem(KEY) ?? "{}");
    } catch {
      return {}; // a browser that blocks cookies refuses its store, too
    }
  }

  function keep(changes) {
    Object.assign(kept, changes);
    try {
      localStorage.setItem(KEY, JSON.stringify(kept));
    } catch {
      // as said above
    }
    show();
    dispatchEvent(new Event("columns")); // page.js reports them
  }

  Object.assign(window.schuler, {
    // As the server reads them behind the window's size; nothing for a page as it suits.
    columns: () => (kept.left || kept.view || kept.mode !== "plots" ? ` ${kept.left},${kept.view},${kept.mode}` : ""),
    mode: () => kept.mode,
    setMode: (mode) => keep({ mode: mode === kept.mode ? "plots" : mode }),
  });

  // ------------------------------------------------------------ the dividers

  const place = document.createElement("section"); // what is outside all landmarks is not found
  place.ariaLabel = "Dividers of the page";
  const region = (side) => document.querySelector(`[data-dock-region="${side}"]`)?.getBoundingClientRect();
  const panels = () => [...document.querySelectorAll('[data-dock-region="right"] [data-dock-leaf]')].map((leaf) => leaf.getBoundingClientRect());
  const clamp = (value, low, high) => Math.round(Math.min(Math.max(value, low), high));

  // Each: its name, where it stands, and what it sets at a place of the pointer.
  const DIVIDERS = [
    {
      name: "Width of the controls", key: "left", upright: true,
      at: () => region("left")?.right,
      set: (x) => ({ left: clamp(x, 250, innerWidth / 3) }),
    },
    {
      name: "Width of the 3D view", key: "view", upright: true,
      at: () => region("right")?.left,
      set(x) {
        const view = kept.mode === "view" ? innerWidth - x : x - region("left").right;
        return { view: clamp(view, 160, innerWidth - region("left").right - 360), mode: kept.mode === "rail" ? "plots" : kept.mode };
      },
    },
    {
      name: "Height of the upper plots", key: "upper", upright: false,
      at: () => panels()[1]?.top,
      set(y) {
        const [first, last] = [panels()[0].top, panels().at(-1).bottom];
        return { upper: Math.min(Math.max((y - first) / (last - first), LEAST_UPPER), 1 - LEAST_UPPER) };
      },
    },
  ].map((divider) => ({ ...divider, line: make(divider) }));

  function make({ name, upright }) {
    const line = document.createElement("div");
    line.className = "sb-divider";
    line.tabIndex = 0;
    line.setAttribute("role", "separator");
    line.setAttribute("aria-orientation", upright ? "vertical" : "horizontal");
    line.title = line.ariaLabel = name;
    return line;
  }

  for (const { line, key, upright, at, set } of DIVIDERS) {
    let held = false;
    const pointed = (event) => (upright ? event.clientX : event.clientY);
    const move = (event) => (line.style[upright ? "left" : "top"] = `${pointed(event)}px`);
    line.addEventListener("pointerdown", (event) => {
      held = true;
      line.setPointerCapture(event.pointerId);
      line.classList.add("sb-held");
      event.preventDefault();
    });
    // The page is laid out anew once it is let go: made at every step it would lag behind the pointer.
    line.addEventListener("pointermove", (event) => held && move(event));
    for (const kind of ["pointerup", "pointercancel"]) {
      line.addEventListener(kind, (event) => {
        if (held && kind === "pointerup" && Math.abs(pointed(event) - at()) > 2) keep(set(pointed(event)));
        held = false;
        line.classList.remove("sb-held");
        show();
      });
    }
    line.addEventListener("dblclick", () => keep({ [key]: PLAIN[key] }));
    line.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowUp: -1, ArrowRight: 1, ArrowDown: 1 }[event.key];
      if (/^Home$/.test(event.key)) keep({ [key]: PLAIN[key] });
      else if (step !== undefined) keep(set(at() + STEP_PX * step));
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
  }

  function show() {
    document.documentElement.style.setProperty("--sb-upper", kept.upper);
    const right = region("right");
    for (const { line, at, upright, key } of DIVIDERS) {
      const here = at();
      line.hidden = here === undefined || right === undefined || (key === "view" && kept.mode === "rail");
      if (line.hidden || line.classList.contains("sb-held")) continue;
      if (line.parentElement === null) place.append(line);
      if (place.parentElement === null) document.body.append(place);
      Object.assign(line.style, upright ? { left: `${here}px` } : { top: `${here}px`, left: `${right.left}px` });
      line.setAttribute("aria-valuenow", Math.round(here));
      line.setAttribute("aria-valuemax", upright ? innerWidth : innerHeight);
    }
  }

  const sizes = new ResizeObserver(show);
  window.schuler.changed(() => {
    for (const part of document.querySelectorAll('[data-dock-region], [data-dock-region="right"] [data-dock-leaf]')) sizes.observe(part);
  });
  addEventListener("resize", show);

  // ------------------------------------------------------------ a window in which nothing has room

  // By itself: on a phone viser folds the panel in which our style sheet comes.

  const small = document.createElement("div");
  small.id = "sb-too-small";
  small.style.cssText = "position:fixed;z-index:260;inset:0;place-content:center;gap:18px;padding:24px;text-align:center;" +
    "background:#fff;color:#243b53;font:18px/1.4 var(--sb-font,sans-serif)";
  const why = document.createElement("div");
  why.textContent = "This page needs a window at least 700 px wide: open it on a tablet or a computer.";
  const how = document.createElement("div");
  how.textContent = "Here it can show one view of this session alone:";
  small.append(why, how);
  for (const [name, title] of Object.entries({ errors: "Errors", metrics: "Metrics", map: "Map" })) {
    const view = new URL(location.href);
    view.searchParams.set("view", name);
    const link = document.createElement("a");
    Object.assign(link, { textContent: title, href: view.href });
    link.style.cssText = "padding:10px;border:1px solid #b8c4d0;border-radius:6px;color:#1864ab;text-decoration:none";
    small.append(link);
  }
  const narrow = matchMedia("(max-width: 699px)");
  const tell = () => (small.style.display = narrow.matches ? "grid" : "none");
  narrow.addEventListener("change", tell);
  tell();
  document.documentElement.append(small);

  // ------------------------------------------------------------ viser's own ways to take a panel apart

  // A tab that is pulled out of its row would float over the page.
  let pressed = false;
  addEventListener("pointerdown", ({ target }) => (pressed = target instanceof Element && target.closest("[data-dock-strip]") !== null), true);
  addEventListener("pointermove", (event) => pressed && event.stopImmediatePropagation(), true);
  for (const kind of ["pointerup", "pointercancel"]) addEventListener(kind, () => (pressed = false), true);

  // ------------------------------------------------------------ viser's own settings, behind ours

  addEventListener("click", ({ target }) => {
    if (!(target instanceof Element)) return;
    target.closest("#sb-menu button")?.closest("#sb-menu").hidePopover();
    if (!target.closest("[data-viewer]")) return;
    document.querySelector("[data-dock-unmergeable-header] button:last-of-type")?.click();
  });
})();
