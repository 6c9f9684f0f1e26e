// Nine tabs for all views. viser gives each view a tab of its own; of those that share one (app/shell/tabs.py) the strip
// shows the view that was in front last, under the name of their tab, and beside the tabs stands a chooser of its modes. A
// view of the menu is seen in the strip only while it is in front. So a view that is not chosen is a tab behind others,
// for server and viser alike: it is not drawn. Whatever opens a view does so by its title, `schuler.show("Step")`.
// Comes before room.js, which gives tabs and chooser their room.
(() => {
  const STRIP = '[data-dock-strip][role="tablist"]';
  const GAP_PX = 14; // between the last tab and the chooser
  const latest = new Map(); // title of a tab -> of the view in it that was in front last
  let told = "[]";
  let views = [];

  function known() {
    const now = document.getElementById("sb-views")?.dataset.tabs ?? "[]";
    if (now !== told) views = JSON.parse((told = now));
    return views;
  }

  const titleOf = (tab) => window.schuler.english(tab.textContent);

  function set(element, name, value) {
    if (!value) element.removeAttribute(name);
    else if (element.getAttribute(name) !== value) element.setAttribute(name, value);
  }

  // The tabs of a strip in the registry's order, each with what is known of its view; folds share one.
  function placed(strip) {
    const found = [...strip.children].map((tab) => {
      const title = titleOf(tab);
      const place = known().findIndex((view) => view.title === title || (view.fold && view.tab === title));
      const { tab: of = title, mode = title } = place < 0 || known()[place].fold ? {} : known()[place];
      const order = of === "" ? place : known().findIndex((view) => view.tab === of);
      return { tab, title, place, order, of, mode };
    });
    return found.sort((one, other) => one.order - other.order || one.place - other.place);
  }

  // Of the views of each tab the one that the strip shows.
  function shownOf(found) {
    const shown = new Map();
    for (const one of found) {
      const wanted = one.of !== "" && (!shown.has(one.of) || latest.get(one.of) === one.title);
      if (wanted) shown.set(one.of, one);
    }
    return shown;
  }

  function arrange(strip) {
    const found = placed(strip);
    const front = found.find(({ tab }) => tab.ariaSelected === "true");
    if (front) latest.set(front.of, front.title);
    const shown = shownOf(found);
    for (const one of found) {
      const seen = one.of === "" ? one === front : shown.get(one.of) === one;
      const name = seen && one.of !== "" && one.of !== one.title && window.schuler.say(one.of);
      set(one.tab, "data-sb-behind", !seen && "yes");
      set(one.tab, "data-sb-named", name);
      set(one.tab, "aria-label", name);
      if (one.tab.style.order !== String(one.order)) one.tab.style.order = one.order;
    }
    offer(strip, front?.of ? found.filter(({ of }) => of === front.of) : []);
  }

  const chooserOf = (strip) => strip.parentElement.querySelector(":scope > .sb-modes");

  // The chooser of the modes of the tab in front. It is kept while they are the same: it may have the focus.
  function offer(strip, modes) {
    const key = modes.length > 1 ? JSON.stringify(modes.map(({ title }) => title)) : "";
    let chooser = chooserOf(strip);
    if (key === "" || chooser?.dataset.modes !== key) {
      chooser?.remove();
      chooser = null;
    }
    if (key === "") return;
    if (chooser === null) {
      const label = `Modes of ${window.schuler.say(modes[0].of)}`;
      chooser = window.schuler.element("div", "", { class: "sb-modes", role: "radiogroup", "data-modes": key, "aria-label": label });
      for (const { title, mode } of modes) {
        const button = window.schuler.element("button", mode, { type: "button", role: "radio", "data-view": title });
        button.addEventListener("click", () => window.schuler.show(title));
        chooser.append(button);
      }
      strip.after(chooser);
    }
    for (const [place, button] of [...chooser.children].entries()) {
      const chosen = modes[place].tab.ariaSelected === "true";
      set(button, "aria-checked", String(chosen));
      set(button, "tabindex", chosen ? "0" : "-1");
    }
  }

  // Left and right move between the modes, as between the tabs.
  function step(event, all, at, go) {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (by === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    const next = all[all.indexOf(at) + by];
    if (next) go(next);
  }

  // viser's own keys would move through the tabs that are not shown.
  document.documentElement.addEventListener("keydown", (event) => {
    if (!(event.target instanceof Element)) return;
    const tab = event.target.closest(`${STRIP} > [role="tab"]`);
    const mode = event.target.closest(".sb-modes > button");
    if (tab) {
      const all = placed(tab.parentElement).map((one) => one.tab).filter((each) => !each.hasAttribute("data-sb-behind"));
      step(event, all, tab, (next) => (window.schuler.open(next), next.focus()));
    } else if (mode) {
      step(event, [...mode.parentElement.children], mode, (next) => (next.focus(), next.click()));
    }
  }, true);

  let seen = "";
  function arrangeAll() {
    const strips = [...document.querySelectorAll(STRIP)];
    const state = (strip) => [strip.dataset.dockStrip, ...[...strip.children].map((tab) => `${tab.textContent}${tab.ariaSelected}`)];
    const now = [known().length, ...strips.flatMap(state)].join("|");
    if (now === seen || known().length === 0) return;
    seen = now;
    strips.forEach(arrange);
  }

  window.schuler.changed(arrangeAll);
  new MutationObserver(arrangeAll).observe(document.documentElement, { subtree: true, attributeFilter: ["aria-selected"] });

  Object.assign(window.schuler, {
    // viser's tab of a view, by its title in English, or that of the view which a tab of this title shows.
    tab(name) {
      const all = [...document.querySelectorAll('[role="tab"]')];
      const own = all.find((tab) => titleOf(tab) === name);
      if (own !== undefined) return own;
      const fold = known().find((view) => view.fold && view.title === name);
      if (fold !== undefined) return all.find((tab) => titleOf(tab) === fold.tab);
      const inside = known().filter((view) => view.tab === name).map((view) => view.title);
      const wanted = [latest.get(name), ...inside];
      return wanted.map((title) => all.find((tab) => titleOf(tab) === title)).find(Boolean);
    },

    // Bring the view of this title to the front, as a mode or a fold of its tab; give its tab.
    show(name) {
      const tab = window.schuler.tab(name);
      window.schuler.open(tab);
      window.schuler.unfold(name); // folds.js
      return tab;
    },

    // Titles in English by which views can be asked for: their own, and those of the tabs.
    titles: () => new Set(known().flatMap(({ title, tab }) => [title, tab]).filter(Boolean)),

    // Place the chooser beside the tabs, or below them: ``stacked``. Give it, null where there is none.
    placeModes(strip, stacked) {
      const chooser = strip && chooserOf(strip);
      if (!chooser) return null;
      chooser.toggleAttribute("data-sb-stacked", stacked);
      const tabs = [...strip.children].filter((tab) => tab.offsetWidth > 0);
      const start = strip.offsetParent === tabs[0]?.offsetParent ? 0 : strip.offsetLeft;
      const end = Math.max(0, ...tabs.map(({ offsetLeft, offsetWidth }) => offsetLeft + offsetWidth));
      chooser.style.left = stacked ? "" : `${start + end + GAP_PX}px`;
      chooser.style.top = stacked ? "" : `${strip.offsetTop}px`;
      return chooser;
    },
    chooserOf,
    modesGap: GAP_PX,
  });
})();
