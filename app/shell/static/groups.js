// Tabs of results stand in groups and in the registry's order (app/shell/view.py): a small label before the first tab of a
// group. Those of the group "more" are chosen from a list at the right end of their strip; the one in front is a tab, too.
// Comes before room.js, which gives the tabs their size.
(() => {
  const STRIPS = '[data-dock-strip][role="tablist"]';
  const LABELS = { network: "Network", run: "Run", decide: "Decide" };
  let seen = "";

  function set(element, name, value) {
    if (value) element.setAttribute(name, value);
    else element.removeAttribute(name);
  }

  function arrange(strip, groups) {
    const titles = Object.keys(groups);
    const placed = [...strip.children].map((tab) => ({ tab, place: titles.indexOf(window.schuler.english(tab.textContent)) }));
    let before = "";
    const more = [];
    for (const { tab, place } of placed.sort((one, other) => one.place - other.place)) {
      const group = groups[titles[place]];
      tab.style.order = place;
      set(tab, "data-sb-group", group !== before && LABELS[group] && window.schuler.say(LABELS[group]));
      set(tab, "data-sb-more", group === "more" && "yes");
      before = group;
      if (group === "more") more.push(tab);
    }
    offer(strip, more);
  }

  function offer(strip, tabs) {
    const was = strip.parentElement.querySelector(":scope > .sb-more-tabs");
    was?.remove();
    strip.style.paddingRight = "";
    if (tabs.length === 0) return;
    const list = window.schuler.element("select", "", { class: "sb-more-tabs", "aria-label": "More tabs" });
    list.append(new Option("More", "", true, true), ...tabs.map((tab) => new Option(tab.textContent)));
    list.addEventListener("change", () => {
      window.schuler.open(tabs[list.selectedIndex - 1]);
      list.selectedIndex = 0;
    });
    strip.after(list);
    list.style.top = `${strip.offsetTop}px`;
    strip.style.paddingRight = `${list.offsetWidth + 8}px`;
  }

  window.schuler.changed(() => {
    const told = document.getElementById("sb-views")?.dataset.groups;
    const strips = [...document.querySelectorAll(STRIPS)];
    const now = [told, ...strips.map((strip) => [strip.dataset.dockStrip, strip.textContent].join())].join("|");
    if (told === undefined || now === seen) return;
    seen = now;
    strips.forEach((strip) => arrange(strip, JSON.parse(told)));
  });
})();
