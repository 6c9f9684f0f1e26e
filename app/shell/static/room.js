// Gives room by what the page's texts take, in whatever font and size. The plots of a panel fill what the rest of it
// leaves: the server's heights are a first estimate (app/shell/layout.py). Lines that may fold (`data-sb-folds`) do so where
// their panel is too small for them. And the tabs of a panel stand in as few rows as they can, their type as large as
// those rows allow (page.css); the chooser of modes (tabs.js) beside them, or below where the row has no room for both.
(() => {
  const SPARE_PX = 6; // so much may stay empty before the plots are drawn anew
  const FAR = 0.06; // off the height that the server took: then it is told, and makes the figure anew
  const LEAST_PX = { plotly: 160, chart: 84 };
  const VIEWPORT = ".mantine-ScrollArea-viewport";
  // Type (px), padding (em) and, of the last, letter spacing (em): for fonts as wide as DejaVu Sans.
  const TYPES = [[13, 0.6], [13, 0.4], [12, 0.4], [12, 0.25], [11, 0.3], [11, 0.17], [10.5, 0.1, -0.03]];
  const READABLE = 4; // of them, beside a chooser of modes
  const FOLDS = "details[data-sb-folds]";
  const waiting = new Set();
  const chosen = new Map(); // id of what folds -> whether the user has opened it
  let titles = "";

  // Leans on viser's handles of its charts, as cursor.js does.
  const charts = () => Object.values(window.__viserTestpoints?.uplots ?? {}).map(({ chart }) => chart);

  function fold(viewport) {
    for (const lines of viewport.querySelectorAll(FOLDS)) {
      if (lines.getClientRects().length === 0) continue;
      lines.open = true;
      lines.open = chosen.get(lines.id) ?? viewport.scrollHeight <= viewport.clientHeight;
    }
  }

  addEventListener("click", ({ target }) => {
    const lines = target instanceof Element && target.closest("summary")?.closest(FOLDS);
    if (lines) chosen.set(lines.id, !lines.open);
  }, true);

  // The tools above a plot stand beside the tabs of their panel and the chooser of modes, where all have room in one row; where
  // the chooser has a row of its own, beside it (page.css).
  const TOOL = ':is([data-sb-kind="select"], [data-sb-kind="number"], [data-sb-kind="other"], [data-sb-kind="mark"], :has(> .mantine-Button-root))';
  function raise(viewport) {
    const strip = viewport.closest("[data-dock-group]")?.querySelector(":scope > [data-dock-strip]");
    const stacked = strip?.hasAttribute("data-sb-stacks") ?? false;
    const chooser = window.schuler.placeModes(strip, stacked);
    const area = (chooser ?? strip)?.nextElementSibling;
    if (!area) return;
    const tools = [...viewport.querySelectorAll(`[data-sb-holds~="tools"] > ${TOOL}`)];
    const tabs = [...(strip?.children ?? [])];
    const look = viewport.querySelector(".sb-look")?.title;
    if (look) tabs.find((tab) => tab.ariaSelected === "true")?.setAttribute("title", look);
    const shown = tabs.filter((tab) => tab.offsetWidth > 0); // those behind have no place in it
    const rows = stacked ? 1 : new Set(shown.map((tab) => tab.offsetTop)).size;
    if (tools.length < 2 || shown.length === 0 || rows > 1) return area.removeAttribute("data-sb-up");
    area.dataset.sbUp = "";
    const row = stacked ? chooser : strip;
    const start = strip.offsetParent === shown[0].offsetParent ? strip.offsetLeft : 0;
    const ends = [...(stacked ? chooser.children : shown), ...(stacked || !chooser ? [] : [chooser])];
    const end = Math.max(...ends.map(({ offsetLeft, offsetWidth }) => offsetLeft + offsetWidth));
    area.style.setProperty("--sb-tabs-px", `${row.offsetHeight}px`);
    area.style.setProperty("--sb-left-px", `${end - start + 10}px`);
    const boxes = tools.map((tool) => tool.getBoundingClientRect());
    const tops = boxes.map(({ top }) => Math.round(top));
    const { right } = area.getBoundingClientRect();
    const fits = Math.max(...tops) - Math.min(...tops) <= row.offsetHeight / 2 &&
      boxes.every((box) => box.right <= right + 1) && viewport.scrollWidth <= viewport.clientWidth;
    if (!fits) area.removeAttribute("data-sb-up");
  }

  // What is scrolled away goes behind the tabs, which stand over the panel where its tools are beside them (page.css).
  addEventListener("scroll", ({ target }) => {
    if (target instanceof Element && target.matches(VIEWPORT)) target.toggleAttribute("data-sb-scrolled", target.scrollTop > 0);
  }, true);

  // Heights with which plots over time, in the order of their rows, fill a room that they leave or exceed by ``spare``, all
  // curves in areas as high as each other's. One that has just been made anew has the server's height beside the others.
  function evened(drawn, spare) {
    const abreast = new Set(drawn.map((chart) => Math.round(chart.root.getBoundingClientRect().left))).size;
    const rows = drawn.map((_, place) => Math.floor(place / abreast));
    const most = (size) => rows.reduce((found, row, place) => Object.assign(found, { [row]: Math.max(found[row] ?? 0, size(drawn[place])) }), []);
    const beside = most(({ height, over }) => height - over.clientHeight); // titles and numbers of the time axis
    const total = (sizes) => sizes.reduce((sum, size) => sum + size, 0);
    const area = Math.floor((total(most(({ height }) => height)) + spare - total(beside)) / beside.length);
    return rows.map((row) => Math.max(area + beside[row], LEAST_PX.chart));
  }

  function fill(viewport) {
    if (viewport.getClientRects().length === 0) return; // of a tab that has just gone: the panel is another's now
    raise(viewport);
    fold(viewport);
    const frame = viewport.getBoundingClientRect();
    const seen = (plot) => viewport.contains(plot) && plot.getClientRects().length > 0;
    const figures = [...viewport.querySelectorAll(".js-plotly-plot")].filter((plot) => plot._fullLayout && seen(plot));
    const inOrder = (one, other) => (one.root.compareDocumentPosition(other.root) & Node.DOCUMENT_POSITION_FOLLOWING ? -1 : 1);
    const drawn = charts().filter((chart) => seen(chart.root)).sort(inOrder);
    const boxes = [...figures, ...drawn.map((chart) => chart.root)].map((plot) => plot.getBoundingClientRect());
    if (frame.height === 0 || boxes.length === 0) return;
    const content = viewport.firstElementChild.getBoundingClientRect();
    const spare = Math.floor(frame.height) - Math.ceil(content.height);
    const heights = figures.length === 0 ? evened(drawn, spare) : null;
    if (spare >= 0 && spare < SPARE_PX && !heights?.some((wanted, place) => Math.abs(wanted - drawn[place].height) >= SPARE_PX)) return;
    const each = Math.floor(spare / new Set(boxes.map(({ top }) => Math.round(top))).size);
    for (const figure of figures) {
      const { height } = figure._fullLayout;
      const wanted = Math.max(Math.floor(height + each), LEAST_PX.plotly);
      if (wanted !== height) window.schuler.setHeight(figure, wanted);
    }
    for (const [place, chart] of drawn.entries()) {
      const { width, height } = chart;
      const wanted = Math.max(heights?.[place] ?? height + each, LEAST_PX.chart);
      if (wanted !== height) chart.setSize({ width, height: wanted });
    }
    dispatchEvent(new Event("filled-plots")); // page.js reports them
  }

  // Heights of the figures in view that are far from what the server took, by the titles of their tabs.
  window.schuler.rooms = () => {
    const rooms = {};
    for (const figure of document.querySelectorAll(".js-plotly-plot")) {
      const { height, meta } = figure._fullLayout ?? {};
      const far = Math.abs(height / window.schuler.heightOf(figure) - 1) > FAR;
      if (far && meta?.view && figure.getClientRects().length > 0) rooms[meta.view] = height;
    }
    return rooms;
  };

  function fit(strip) {
    if (strip.getClientRects().length === 0) return;
    const tabs = [...strip.children].filter((tab) => tab.getClientRects().length > 0);
    const rows = ([type, padding, spacing = 0]) => {
      strip.style.setProperty("--sb-type", `${type}px`);
      strip.style.setProperty("--sb-padding", `${padding}em`);
      strip.style.setProperty("letter-spacing", `${spacing}em`);
      return new Set(tabs.map((tab) => tab.offsetTop)).size;
    };
    const beside = window.schuler.placeModes(strip, false)?.offsetWidth ?? 0;
    strip.style.paddingRight = beside > 0 ? `${beside + 2 * window.schuler.modesGap}px` : "";
    const stacks = beside > 0 && !TYPES.slice(0, READABLE).some((type) => rows(type) === 1);
    if (stacks) strip.style.paddingRight = "";
    strip.toggleAttribute("data-sb-stacks", stacks);
    const fewest = rows(TYPES.at(-1));
    TYPES.find((type) => rows(type) === fewest);
    window.schuler.placeModes(strip, stacks);
  }

  // In the next frame: what changes a size while sizes are told would be told of in vain.
  const sizes = new ResizeObserver((changes) => {
    if (waiting.size === 0) {
      requestAnimationFrame(() => {
        const elements = [...waiting].filter((element) => element.isConnected);
        waiting.clear();
        for (const element of elements) (element.matches(VIEWPORT) ? fill : fit)(element);
      });
    }
    for (const { target } of changes) waiting.add(target.closest(`${VIEWPORT}, [data-dock-strip]`) ?? target);
  });

  // What is observed already stays so.
  window.schuler.changed(() => {
    const strips = [...document.querySelectorAll("[data-dock-strip]")];
    const now = strips.map((strip) => `${strip.textContent}${window.schuler.chooserOf(strip)?.textContent}`).join("|");
    if (now !== titles) {
      titles = now;
      strips.forEach(fit);
    }
    for (const viewport of document.querySelectorAll(`[data-dock-column] ${VIEWPORT}`)) {
      fold(viewport);
      for (const element of [viewport, viewport.firstElementChild]) sizes.observe(element);
    }
    strips.forEach((strip) => sizes.observe(strip));
    // One that is made anew beside others may be lower than they are, and change no size but its own.
    for (const { root } of charts()) if (root.closest(`[data-dock-column] ${VIEWPORT}`)) sizes.observe(root);
  });
})();
