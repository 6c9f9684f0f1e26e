// The page's language: that of ?lang=, else the visitor's last choice, else the browser's. What comes from the server is
// translated there: the cookie tells it the language before viser's websocket is opened (app/http/running.py). What
// scripts write themselves, and what viser's page says, is exchanged here as it appears; the words are in zh-CN.js.
(() => {
  const COOKIE = "schuler_language";
  const FRONT = "schuler-front";
  const YEAR_S = 365 * 24 * 3600;
  const words = (window.schuler.words = window.schuler.words ?? {});

  const known = () => ["en", ...Object.keys(words)];

  // The language we have for one that is wanted: "zh", "zh-Hant" and "zh-CN" are all zh-CN.
  function ours(wanted) {
    const first = String(wanted).toLowerCase().split("-")[0];
    return known().find((name) => name.toLowerCase().split("-")[0] === first);
  }

  // A frame without an origin has no cookies: nothing is kept there.
  function kept() {
    try {
      return document.cookie.split("; ").find((part) => part.startsWith(`${COOKIE}=`))?.slice(COOKIE.length + 1);
    } catch {
      return undefined;
    }
  }

  function keep(language, forGood) {
    try {
      document.cookie = `${COOKIE}=${language}; path=/; SameSite=Lax${forGood ? `; max-age=${YEAR_S}` : ""}`;
    } catch {
      // as said above
    }
  }

  const asked = ours(new URL(location.href).searchParams.get("lang") ?? "");
  const language = asked ?? ours(kept() ?? "") ?? (navigator.languages ?? []).map(ours).find(Boolean) ?? "en";
  keep(language, asked !== undefined);
  document.documentElement.lang = language;

  const exact = new Map();
  const patterns = [];
  for (const [key, said] of Object.entries(words[language] ?? {})) {
    if (!/\{\d+\}/.test(key)) exact.set(key, said);
    else {
      const plain = key.split(/\{\d+\}/).map((part) => part.replace(/[.*+?^${}()|[\]\\]/g, "\\$&"));
      patterns.push({ test: new RegExp(`^${plain.join("([^]*?)")}$`), said, letters: plain.join("").length });
    }
  }
  patterns.sort((one, other) => other.letters - one.letters); // of two that fit, the one that says more is meant

  function say(text) {
    const found = exact.get(text.trim());
    if (found !== undefined) return text.replace(text.trim(), found);
    for (const { test, said } of patterns) {
      const values = test.exec(text.trim());
      if (values !== null) return said.replace(/\{(\d+)\}/g, (_, number) => say(values[Number(number) + 1]));
    }
    return text;
  }

  // Keys are sorted: of two with one translation, "Errors" and "error", the title comes first, and is meant.
  const english = new Map([...exact].reverse().map(([key, said]) => [said, key]));

  Object.assign(window.schuler, {
    language,
    say,

    // What a word of the page is in English: for names that scripts and server tell each other.
    english(text) {
      return english.get(text) ?? text;
    },

    // The server builds the page anew in the other language; the session and the tabs in front
    // stay (app/shell/static/front.js).
    switchLanguage(wanted) {
      const next = ours(wanted);
      if (next === undefined || next === language) return;
      const tabs = document.querySelectorAll('[role="tab"][aria-selected="true"]');
      try {
        sessionStorage.setItem(FRONT, JSON.stringify([...tabs].map((tab) => window.schuler.english(tab.textContent))));
      } catch {
        // A browser that blocks cookies refuses its store, too: the tabs in front are those of a new page.
      }
      keep(next, true);
      const address = new URL(location.href);
      address.searchParams.delete("lang");
      if (address.href === location.href) location.reload();
      else location.replace(address.href);
    },
  });

  const ATTRIBUTES = ["title", "aria-label", "placeholder", "alt"];
  const LETTERS = /[A-Za-z]{2}/;

  function exchangeNames(element) {
    for (const name of ATTRIBUTES) {
      const text = element.getAttribute(name);
      if (text !== null && LETTERS.test(text) && say(text) !== text) element.setAttribute(name, say(text));
    }
  }

  function exchange(node) {
    if (node instanceof Text) {
      if (!LETTERS.test(node.data)) return;
      const said = say(node.data);
      if (said !== node.data) node.data = said;
    } else if (node instanceof Element && !node.closest(".js-plotly-plot, .uplot, [hidden], script, style")) {
      exchangeNames(node);
      for (const inner of node.childNodes) exchange(inner);
    }
  }

  if (exact.size + patterns.length > 0) {
    new MutationObserver((changes) => {
      for (const { type, target, addedNodes } of changes) {
        if (type === "childList") addedNodes.forEach(exchange);
        else if (type === "characterData") exchange(target);
        else exchangeNames(target);
      }
    }).observe(document.documentElement, {
      subtree: true, childList: true, characterData: true, attributeFilter: ATTRIBUTES,
    });
  }
})();
