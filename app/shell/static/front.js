// Brings tabs to the front once the page has opened: those that the address names ("?tab=Frequency,Sensors"), or those
// that were in front before the page was loaded again in another language (app/languages/static/language.js).
(() => {
  const KEPT = "schuler-front";
  const MOST = 12;
  const STEADY = 4; // checks in a row: the page may be laid out anew while it opens
  const kept = fromStore();
  const named = new URLSearchParams(location.search).getAll("tab").flatMap((names) => names.split(","));
  const wanted = (kept.length > 0 ? kept : named.filter((name) => name.trim() !== "")).slice(0, MOST);

  // A browser that blocks cookies refuses its store, too: then nothing was kept.
  function fromStore() {
    try {
      const text = sessionStorage.getItem(KEPT);
      sessionStorage.removeItem(KEPT);
      return JSON.parse(text ?? "[]");
    } catch {
      return [];
    }
  }

  const plain = (name) => name.toLowerCase().replace(/[^\p{L}\p{N}]/gu, "");
  const english = (tab) => window.schuler.english(tab.textContent);

  function titleNamed(name) {
    const fits = (title) => [title, window.schuler.say(title)].some((each) => plain(each) === plain(name));
    return [...window.schuler.titles()].find(fits) ?? name;
  }

  // The first run is shown, which some tabs need, and the scenario's own tab has come to the front.
  function opened() {
    const own = document.getElementById("sb-focus")?.dataset;
    if (own === undefined || document.querySelector("#sb-run[data-run]") === null) return false;
    return document.documentElement.dataset.opened === own.scenario || window.schuler.tab(own.tab) === undefined;
  }

  function heard(tabs) {
    const [size, ...front] = (document.getElementById("sb-heard")?.dataset.state ?? "").replace(/~\d+/g, "").split("|");
    return size.startsWith(`${innerWidth}x${innerHeight}`) && tabs.every((tab) => front.includes(english(tab)));
  }

  let steady = 0;
  let told = false;

  function bring() {
    if (!opened()) return;
    const titles = wanted.map(titleNamed);
    const found = titles.map(window.schuler.tab);
    if (!told && kept.length === 0) {
      const unknown = wanted.filter((_, place) => found[place] === undefined);
      if (unknown.length > 0) window.schuler.command("no-tab", unknown.join("|"));
    }
    if (!told) titles.forEach(window.schuler.unfold);
    told = true;
    const foremost = window.schuler.foremost(found);
    const behind = foremost.filter((tab) => tab.getAttribute("aria-selected") !== "true");
    behind.forEach((tab) => window.schuler.open(tab));
    steady = behind.length === 0 && heard(foremost) ? steady + 1 : 0;
    if (steady >= STEADY) end();
  }

  function end() {
    clearInterval(timer);
    document.documentElement.dataset.fronted = "";
  }

  if (wanted.length === 0 || window.schuler.alone) return;
  const timer = setInterval(bring, 100);
  // Whoever goes on by hand is not taken back.
  for (const kind of ["pointerdown", "keydown"]) addEventListener(kind, (event) => event.isTrusted && end(), { capture: true, once: true });
})();
