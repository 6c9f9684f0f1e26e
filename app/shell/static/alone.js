// "?view=bode" in the address: this view fills the window, without controls and keys, for a frame in another page. The
// names come from #sb-views (app/shell/reports.py); page.css hides the rest of the page, which stays where it is.
(() => {
  const asked = new URLSearchParams(location.search).get("view")?.trim().toLowerCase() ?? null;
  window.schuler.alone = asked !== null;
  if (asked === null) return;
  document.documentElement.dataset.alone = asked;
  // In a narrow window viser leaves out the column in which the views stand.
  const matches = window.matchMedia.bind(window);
  window.matchMedia = (query) => matches(query.includes("max-width") ? "(max-width: 0px)" : query);
  const PATIENCE = 50;
  let looks = 0; // in vain: a tab may still have to come with the run
  let told = false;

  function tell() {
    if (!told) window.schuler.command("no-view", asked);
    told = true;
  }

  // What is to be seen: the area of the view's tab, or what a view without one has named so (data-sb-views).
  function area(title) {
    if (title === "") return document.querySelector(`[data-sb-views~="${CSS.escape(asked)}"]`);
    const tab = window.schuler.tab(title);
    window.schuler.open(tab);
    // A panel keeps one area for each of its tabs; those behind have no box.
    const areas = [...(tab?.closest(".mantine-Paper-root")?.querySelectorAll(".mantine-ScrollArea-root") ?? [])];
    return areas.find((each) => each.getClientRects().length > 0);
  }

  // Again and again: the page is laid out anew when the window changes, and a scenario brings its own tab to the front.
  function show() {
    const names = JSON.parse(document.getElementById("sb-views")?.dataset.names ?? "null");
    if (names === null || document.querySelector("#sb-run[data-run]") === null) return;
    const title = names[asked];
    const wanted = title === undefined ? undefined : area(title);
    looks = wanted ? 0 : looks + 1;
    if (title === undefined || looks > PATIENCE) tell();
    for (const shown of document.querySelectorAll("[data-sb-alone]")) {
      if (shown !== wanted) delete shown.dataset.sbAlone;
    }
    if (wanted && wanted.dataset.sbAlone === undefined) wanted.dataset.sbAlone = asked;
    if (wanted || told) document.getElementById("sb-veil")?.remove();
    if (wanted) offer();
  }

  // One click copies what another page needs to show this view: a frame with a copy of the present state. In a frame it
  // is not offered, nor on a phone, where it covers what is seen.
  function offer() {
    if (window.top !== window || innerWidth < 700 || document.getElementById("sb-embed") !== null) return;
    const title = "Copy the HTML of a frame that shows this view as it is now";
    const button = window.schuler.element("button", "Embed", { id: "sb-embed", class: "sb-do", title });
    button.addEventListener("click", () => window.schuler.command("share-embed"));
    document.body.append(button);
  }

  window.schuler.embed = async (id) => {
    const query = `?view=${encodeURIComponent(asked)}`;
    const link = new URL(`../${id}/${query}`, location.origin + location.pathname).href;
    const name = document.title.replace(/["<>&]/g, "");
    await window.schuler.copy(`<iframe src="${link}" title="${name}" width="960" height="540" style="border:0"></iframe>`);
    const button = document.getElementById("sb-embed");
    button.textContent = "Copied";
    setTimeout(() => (button.textContent = "Embed"), 2000);
  };

  setInterval(show, 100);
  // Ours and viser's keys act on what is not to be seen here; what the browser does by itself goes on.
  addEventListener("keydown", (event) => event.isTrusted && event.stopPropagation(), true);
})();
