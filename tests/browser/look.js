// What the tests ask of a page in its own language; the driver puts it into every page.
window.look = {};

// ------------------------------------------------------------ placing

// Where a place of a panel lies in the window, CSS px; null before there is a figure with a handle.
look.spot = ([across, up, x, y]) => {
  const plot = [...document.querySelectorAll('.js-plotly-plot')].find(
    p => p.offsetParent !== null && p._fullLayout?.meta?.handle);
  if (!plot) return null;
  const [xaxis, yaxis] = [plot._fullLayout[across], plot._fullLayout[up]];
  const frame = plot.getBoundingClientRect();
  return [frame.left + xaxis._offset + xaxis.d2p(x), frame.top + yaxis._offset + yaxis.d2p(y)];
};

look.centre = ring => {
  const box = ring.getBoundingClientRect();
  return [box.left + box.width / 2, box.top + box.height / 2];
};

// The last ring in view stands at a place.
look.at = place => {
  const spot = look.spot(place);
  const rings = [...document.querySelectorAll('.sb-handle')].filter(r => r.offsetParent && !r.hidden);
  if (spot === null || rings.length === 0) return false;
  const at = look.centre(rings.at(-1));
  return Math.hypot(at[0] - spot[0], at[1] - spot[1]) < 2;
};

// ------------------------------------------------------------ driver

look.upToDate = () => {
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  const run = document.querySelector('#sb-run').dataset.run;
  return plots.length > 0 && plots.every(p => String(p._fullLayout?.meta?.run) === run);
};

look.plotly = () => {
  const plain = values => Array.from(values ?? [], v => (Number.isFinite(v) ? v : null));
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  return plots.flatMap(p => p._fullData.map(t => ({name: t.name, x: plain(t.x), y: plain(t.y)})));
};

look.uplot = () => {
  const charts = Object.values(window.__viserTestpoints?.uplots ?? {}).map(entry => entry.chart);
  return charts.map(c => ({label: c.axes[1].label, data: c.data.map(d => Array.from(d))}));
};

// The server has heard of the window's size and of the tabs in front (app/shell/static/page.js).
look.heard = () => document.querySelector('#sb-heard')?.dataset.state === schuler.state();

// So many panels with results stand beside the 3D view, as wide as the layout says.
look.laidOut = ([panels, right]) => {
  const lists = [...document.querySelectorAll('[role=tablist]')].map(l => l.getBoundingClientRect());
  const beside = lists.filter(box => box.left > innerWidth / 3);
  const wide = beside.every(box => Math.abs(innerWidth - box.left - right) < 12);
  return beside.length === panels && wide;
};

// Closes a lesson, takes the focus out of text boxes, and shows both instruments where there is room for them.
look.clean = () => {
  document.activeElement?.blur();
  if (document.querySelector("[data-command='lesson list']")) schuler.command('lesson', 'list');
  const hidden = innerWidth >= 1600 ? '#sb-stage [data-shows][aria-pressed=false]' : 'none';
  document.querySelectorAll(hidden).forEach(each => each.click());
};

// The tab in which a new scenario opens is in front.
look.opened = () => {
  const wanted = document.querySelector('#sb-focus')?.dataset ?? {};
  return !wanted.scenario || schuler.tab(wanted.tab) === undefined
    || document.documentElement.dataset.opened === wanted.scenario;
};

// What a report of a failed test says of the page.
look.account = () => {
  const texts = selector => [...document.querySelectorAll(selector)]
    .filter(e => e.offsetParent !== null).map(e => e.innerText.trim());
  return {
    window: `${innerWidth}x${innerHeight}`,
    'tabs in front': texts('[role=tab][aria-selected=true]'),
    'server has heard': document.querySelector('#sb-heard')?.dataset.state,
    'run shown': document.querySelector('#sb-run')?.dataset.run,
    status: document.querySelector('#sb-status')?.textContent,
    notices: texts('.mantine-Notification-root'),
    notes: texts('.sb-note'),
    focus: document.activeElement?.outerHTML.slice(0, 200),
  };
};

// viser's page gives uPlot its numbers after the frame in which the rest of a message is shown.
look.nextFrame = () => new Promise(go => requestAnimationFrame(() => setTimeout(go)));

look.noNotices = () => {
  document.querySelectorAll('.mantine-Notification-closeButton').forEach(button => button.click());
  return document.querySelector('.mantine-Notification-root') === null;
};

look.line = name => {
  const node = window.__viserSceneTree.getState()[name];
  return node ? Array.from(node.message.props.points) : null;
};

// ------------------------------------------------------------ test_page_access

look.named = () => [...document.querySelectorAll('[role=slider]')].every(s => s.ariaLabel)
  && [...document.querySelectorAll('.js-plotly-plot, .uplot')].every(p => p.ariaLabel);

look.focus = () => {
  const {outlineStyle, outlineWidth} = getComputedStyle(document.activeElement);
  return [outlineStyle, parseFloat(outlineWidth) >= 2, document.activeElement.outerHTML.slice(0, 160)];
};

look.reached = () => {
  window.reached = [];
  document.addEventListener('keydown', event => window.reached.push(event.code), {once: false});
};

look.tooWide = () => [...document.querySelectorAll('.sb-lesson')].map(e => e.scrollWidth - e.clientWidth);

look.tabRows = () => {
  const tabs = [...document.querySelectorAll('[role=tab]')].filter(t => t.getClientRects().length > 0);
  const boxes = tabs.map(t => t.getBoundingClientRect());
  return new Set(boxes.filter(b => b.left < innerWidth / 3).map(b => Math.round(b.top))).size;
};

// ------------------------------------------------------------ test_page_behaviour

look.moved = async ids => {
  const thumbs = ids.map(id => document.querySelector(`[id='${id}'] [role=slider]`));
  const key = () => new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true});
  for (let i = 0; i < 6; i++) for (const thumb of thumbs) {
    thumb.dispatchEvent(key());
    for (let turn = 0; turn < 100; turn++) await null; // React has taken it
  }
};

look.drawnNames = () => [...document.querySelectorAll('.js-plotly-plot')].flatMap(
  p => p.offsetParent === null ? [] : p._fullData.filter(t => t.visible === true).map(t => t.name));

look.opacity = () => Number(getComputedStyle(document.querySelector('.js-plotly-plot')).opacity);

// ------------------------------------------------------------ test_page_jobs

look.dashed = () => Object.values(window.__viserTestpoints?.uplots ?? {}).map(({chart}) =>
  chart.series.filter(s => (s.dash ?? []).length).map(s => s.stroke(chart, 1)));

look.why = fits => document.querySelector('#sb-why')?.dataset.fits === fits;

look.bars = () => [...document.querySelectorAll('.js-plotly-plot')]
  .filter(p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Design')
  .flatMap(p => p._fullData.filter(t => t.yaxis === 'y').map(t => t.x[2]))
  .reduce((a, b) => a + b, 0);

// Values of each curve of the tab "Sweep".
look.sweep = () => [...document.querySelectorAll('.js-plotly-plot')]
  .filter(p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Sweep')
  .flatMap(p => p._fullData.map(t => [...t.y]));

// Cells of the map of a study, and what is written in them.
look.study = () => [...document.querySelectorAll('.js-plotly-plot')]
  .find(p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Study');
look.mapped = () => look.study()?._fullLayout.shapes.filter(s => s.type === 'rect').length ?? 0;
look.written = () => look.study()?._fullLayout.annotations.map(a => a.text).join('|') ?? '';

// Bands of the plot of the east velocity, and the sum of the last one's upper edge.
look.band = () => {
  const chart = Object.values(window.__viserTestpoints?.uplots ?? {})
    .map(entry => entry.chart).find(c => c.root.offsetParent !== null && c.axes[1].label.startsWith('φE'));
  const bands = chart?.bands ?? [];
  return [bands.length, bands.length ? chart.data[bands.at(-1).series[0]].reduce((a, b) => a + b, 0) : 0];
};

look.legend = () => document.body.innerText.match(/band: .*/)?.[0] ?? '';

// Where a point of the fronts lies in the window, CSS px; null while it is not drawn.
look.frontSpot = name => {
  const plot = [...document.querySelectorAll('.js-plotly-plot')].find(
    p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Tune');
  const trace = plot?._fullData?.find(t => t.name === name);
  if (!trace) return null;
  const frame = plot.getBoundingClientRect();
  const {xaxis: x, yaxis: y} = plot._fullLayout;
  return [frame.left + x._offset + x.d2p(trace.x[0]), frame.top + y._offset + y.d2p(trace.y[0])];
};

// Where it has been for half a second: a figure that is laid out anew moves its points.
let frontAt = {spot: null, since: 0};
look.frontRests = name => {
  const spot = look.frontSpot(name);
  if (String(spot) !== String(frontAt.spot)) frontAt = {spot, since: performance.now()};
  return spot !== null && performance.now() - frontAt.since > 500;
};

look.panels = () => [...document.querySelectorAll('.js-plotly-plot')]
  .filter(p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Design')
  .map(p => new Set(p._fullData.map(t => t.yaxis)).size)[0] ?? 0;

// ------------------------------------------------------------ test_page_language

look.seen = () => {
  const found = new Set();
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const parent = walker.currentNode.parentElement;
    const quiet = parent.closest('script, style, pre, math, [hidden], [data-sb-kind=hidden]');
    const seen = quiet === null && parent.checkVisibility({visibilityProperty: true});
    if (seen) found.add(walker.currentNode.data.trim());
  }
  for (const name of ['title', 'aria-label', 'placeholder']) {
    for (const one of document.querySelectorAll(`[${name}]`)) {
      if (!one.closest('[data-sb-kind=hidden]')) found.add(one.getAttribute(name));
    }
  }
  for (const {chart} of Object.values(window.__viserTestpoints?.uplots ?? {})) {
    for (const one of [...chart.series.slice(1), ...chart.axes]) found.add(one.label ?? '');
  }
  return [...found];
};

// ------------------------------------------------------------ test_page_layout

// Of every scrolling area in view: how much is cut off to the right and below.
look.cut = () => [...document.querySelectorAll('.mantine-ScrollArea-viewport')]
  .filter(e => e.clientHeight > 0 && e.getBoundingClientRect().left > innerWidth / 3)
  .map(e => [e.scrollWidth - e.clientWidth, e.scrollHeight - e.clientHeight]);

// Texts in view that are cut: by what hides what stands out of it, by the window, or by the end of their box.
look.clipped = () => {
  const found = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const {data, parentElement: parent} = walker.currentNode;
    const quiet = data.trim() === '' || parent.closest('script, style, svg, math, [hidden]');
    if (quiet || !parent.checkVisibility({visibilityProperty: true, opacityProperty: true})) continue;
    const range = document.createRange();
    range.selectNodeContents(walker.currentNode);
    const text = range.getBoundingClientRect();
    let [cut, scrolls] = [text.left < -1 || text.right > innerWidth + 1, false];
    for (let at = parent; at !== document.body; at = at.parentElement) {
      const {clipPath, overflowX, overflowY, position} = getComputedStyle(at), box = at.getBoundingClientRect();
      if (clipPath !== 'none' || box.width < 2) { cut = false; break; } // for screen readers
      if (at.matches('[data-sb-drops]') && text.top >= box.bottom - 1) { cut = false; break; } // left out whole
      cut ||= overflowX !== 'visible' && (text.left < box.left - 1.5 || text.right > box.right + 1.5);
      scrolls ||= ['auto', 'scroll'].includes(overflowY);
      cut ||= !scrolls && overflowY === 'hidden' && (text.top < box.top - 3 || text.bottom > box.bottom + 3);
      if (position === 'fixed') break; // what is around it does not cut it
    }
    if (cut) found.push(data.trim());
  }
  const boxes = [...document.querySelectorAll('input')].filter(e => e.offsetParent && e.clientWidth > 2 && e.checkVisibility());
  return [...found, ...boxes.filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.value)];
};

// Every plotly figure in view is laid out, and the browser has painted it.
look.drawn = async () => {
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  if (!plots.every(p => p._fullLayout && p.querySelector('.cartesianlayer'))) return false;
  for (let i = 0; i < 2; i++) await new Promise(requestAnimationFrame);
  return true;
};

// Plots in view, with the part of their panel's height that they fill together.
look.filled = () => [...document.querySelectorAll('.mantine-ScrollArea-viewport')]
  .filter(e => e.clientHeight > 0 && e.getBoundingClientRect().left > innerWidth / 3)
  .map(e => [...e.querySelectorAll('.js-plotly-plot, .uplot')].map(p => p.getBoundingClientRect()))
  .map((boxes, i, all) => boxes.length
    ? Math.max(...boxes.map(b => b.bottom)) - Math.min(...boxes.map(b => b.top)) : null);

look.misprintDrawn = () => [...document.querySelectorAll('.js-plotly-plot')]
  .some(p => p.offsetParent !== null && p._fullLayout?.meta?.misprint && p.querySelector('.trace'));

// Texts of the plots in view that reach beyond their plot.
look.textOutside = () => {
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  const beyond = (b, f) =>
    b.left < f.left - 1 || b.right > f.right + 1 || b.bottom > f.bottom + 1 || b.top < f.top - 1;
  return plots.flatMap(plot => {
    const frame = plot.getBoundingClientRect();
    const texts = [...plot.querySelectorAll('text')].map(t => [t.textContent, t.getBoundingClientRect()]);
    return texts.filter(([_, box]) => box.width > 0 && beyond(box, frame)).map(([text]) => text);
  });
};

// Texts of the figure of a view that lie over each other.
look.met = view => {
  const plot = [...document.querySelectorAll('.js-plotly-plot')].find(
    p => p.offsetParent !== null && p._fullLayout?.meta?.view === view);
  const texts = [...plot.querySelectorAll('text')].map(t => [t.textContent, t.getBoundingClientRect()])
    .filter(([text, box]) => text.trim() !== '' && box.width > 0);
  const met = (a, b) => a.left < b.right - 2 && b.left < a.right - 2
    && a.top < b.bottom - 3 && b.top < a.bottom - 3;
  return texts.flatMap(([text, box], i) =>
    texts.slice(i + 1).filter(([_, other]) => met(box, other)).map(([other]) => `${text} | ${other}`));
};

// Ends of the imaginary axis of the right one of the pole maps.
look.zoomed = () => [...document.querySelectorAll('.js-plotly-plot')]
  .find(p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Poles')._fullLayout.yaxis2.range;

// Labels in view that the "?" covers when the pointer comes to their control, or to which none comes.
look.covered = () => {
  const met = (a, b) => b.width > 1 && a.left < b.right - 0.5 && b.left < a.right - 0.5
    && a.top < b.bottom - 0.5 && b.top < a.bottom - 0.5;
  const seen = l => l.offsetParent !== null && l.getBoundingClientRect().width > 2
    && !l.closest('[data-sb-kind=slider] + [data-sb-kind=number], [data-sb-kind=hidden], [data-sb-holds~=topbar]');
  const labels = [...document.querySelectorAll('label[for]')].filter(seen);
  const found = [];
  for (const label of labels) {
    label.dispatchEvent(new PointerEvent('pointerover', {bubbles: true}));
    const mark = document.querySelector('.sb-mark');
    const text = document.createRange();
    text.selectNodeContents(label);
    const box = mark?.getBoundingClientRect();
    if (!mark || [...text.getClientRects()].some(each => met(box, each))) found.push(label.textContent);
  }
  return [labels.length, found];
};

// Labels in view whose unit, in parentheses at their end, stands in two lines.
look.torn = () => [...document.querySelectorAll('label[for]')].filter(label => {
  const text = label.firstChild;
  const from = text?.data?.lastIndexOf('(') ?? -1;
  if (label.offsetParent === null || from < 0 || !text.data.endsWith(')')) return false;
  const unit = document.createRange();
  unit.setStart(text, from);
  unit.setEnd(text, text.data.length);
  return new Set([...unit.getClientRects()].map(box => Math.round(box.top))).size > 1;
}).map(label => label.textContent);

// Words in view within an element that go on in a further line.
look.broken = within => {
  const walker = document.createTreeWalker(document.querySelector(within), NodeFilter.SHOW_TEXT);
  const found = [], word = document.createRange();
  while (walker.nextNode()) {
    for (const {0: letters, index} of walker.currentNode.data.matchAll(/\p{L}+/gu)) {
      word.setStart(walker.currentNode, index);
      word.setEnd(walker.currentNode, index + letters.length);
      if (new Set([...word.getClientRects()].map(box => Math.round(box.top))).size > 1) found.push(letters);
    }
  }
  return found;
};

// Rows in which the tabs of each panel stand.
look.rows = () => [...document.querySelectorAll('[role=tablist]')].map(list => {
  const tabs = [...list.querySelectorAll('[role=tab]')].filter(tab => tab.getClientRects().length > 0);
  const boxes = tabs.map(tab => tab.getBoundingClientRect());
  const tops = boxes.map(box => Math.round(box.top));
  return new Set(tops).size;
});

// Of each panel the names of its tabs that are seen, from left to right; of its chooser of modes those, and the pressed one.
look.tabs = () => [...document.querySelectorAll('[data-dock-strip]')].map(strip => {
  const left = tab => tab.getBoundingClientRect().left;
  const seen = [...strip.children].filter(tab => tab.getClientRects().length > 0);
  const name = tab => tab.ariaLabel ?? tab.textContent;
  const modes = [...strip.parentElement.querySelectorAll(':scope > .sb-modes > button')];
  return {
    tabs: seen.sort((one, other) => left(one) - left(other)).map(name),
    modes: modes.map(mode => mode.textContent),
    pressed: modes.filter(mode => mode.ariaChecked === 'true').map(mode => mode.textContent),
    front: seen.filter(tab => tab.ariaSelected === 'true').map(name),
  };
}).filter(({tabs}) => tabs.length > 0);

look.axes = () => [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null)
  .flatMap(p => Object.entries(p._fullLayout).filter(([k]) => /^[xy]axis/.test(k))
  .map(([k, a]) => [k, a.title?.text || a.matches || !a.showticklabels]));

look.toolsInRow = () => {
  const tools = [...document.querySelectorAll('.sb-tools')].map(e => e.parentElement.parentElement);
  return tools.filter(t => t.offsetParent !== null).map(t => {
    const controls = [...t.children].filter(c => c.querySelector('.js-plotly-plot') === null);
    const found = controls.flatMap(c => [...c.querySelectorAll('input:not([type=hidden]), button')]);
    const boxes = found.map(e => e.getBoundingClientRect());
    const middles = boxes.filter(b => b.width > 0).map(b => b.top + b.height / 2);
    const labels = [...t.querySelectorAll('p:has(> label)')].map(p => p.scrollWidth - p.clientWidth);
    return [Math.max(...middles) - Math.min(...middles), Math.max(...labels)];
  });
};

look.misprint = ([id, shown]) => {
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  const plot = plots.find(p => p._fullLayout?.meta?.misprint === id && p._fullLayout.meta.shown === shown);
  return plot ? plot._fullData.map(t => [t.name, t.line.dash, t.y.length]) : null;
};

// ------------------------------------------------------------ test_page_lessons

look.inFront = tabs => tabs.every(name => [...document.querySelectorAll('[role=tab]')]
  .some(tab => tab.textContent === name && tab.getAttribute('aria-selected') === 'true'));

// ------------------------------------------------------------ test_page_fonts

// Texts in view that are in another font than this.
look.otherFonts = family => [...document.querySelectorAll('body *')]
  .filter(e => e.offsetParent && [...e.childNodes].some(c => c.nodeType === 3 && c.data.trim()))
  .filter(e => !getComputedStyle(e).fontFamily.startsWith(family)).map(e => e.outerHTML.slice(0, 80));

// ------------------------------------------------------------ test_page_reading

look.chart = label => Object.values(window.__viserTestpoints.uplots).map(e => e.chart)
  .find(c => c.axes[1].label.startsWith(label));

// ------------------------------------------------------------ test_page_redraw

look.plot = () => [...document.querySelectorAll('.js-plotly-plot')].find(p => p.offsetParent !== null);

// How often plotly has laid a figure out since, what is drawn, and what a drawing anew makes of it.
look.countLayouts = () => { window.laidOut = 0; look.plot().on('plotly_afterplot', () => { window.laidOut += 1; }); };

look.paths = () => [...look.plot().querySelectorAll('.scatterlayer path.js-line')]
  .map(line => line.getAttribute('d').match(/-?[0-9.]+/g).map(Number));

look.anew = () => Plotly.redraw(look.plot());

look.bodeAxes = () => ['xaxis', 'yaxis', 'yaxis2', 'yaxis3', 'yaxis4'].map(name => look.plot()._fullLayout[name].range);

look.mapAxes = () => ['xaxis', 'yaxis', 'xaxis2', 'yaxis2'].map(name => look.plot()._fullLayout[name].range);

look.labels = () => [...look.plot().querySelectorAll('.ytick text')]
  .map(label => [label.textContent, label.getAttribute('y')]).sort();

look.homes = () => ['yaxis', 'yaxis2'].map(name => look.plot()._fullLayout[name])
  .map(axis => [axis._rangeInitial0, axis._rangeInitial1]);

// plotly keeps its points unless it lays out the whole figure
look.keep = () => { look.plot().calcdata.kept = true; };

look.kept = () => look.plot().calcdata.kept === true;

// The page's thread has no time for three seconds; then come three steps before what the server has sent
// meanwhile, and three after it.
look.busy = async id => {
  const thumb = document.getElementById(id).querySelector('[role=slider]');
  const press = kind => thumb.dispatchEvent(
    new KeyboardEvent(kind, {key: 'ArrowRight', code: 'ArrowRight', bubbles: true, cancelable: true}));
  for (const end = performance.now() + 3000; performance.now() < end; );
  for (let step = 1; step <= 6; step++) {
    ['keydown', 'keyup'].forEach(press);
    for (let turn = 0; turn < 100; turn++) await null; // React has taken it
    if (step === 3) await new Promise(go => setTimeout(go, 300));
  }
};

look.ink = width => {
  const wrap = Object.assign(document.createElement('div'), {className: 'u-wrap'});
  const plain = document.createElement('div');
  document.body.append(wrap, plain);
  const ink = [wrap, plain].map(parent => {
    const canvas = Object.assign(document.createElement('canvas'), {width: 300, height: 120});
    parent.append(canvas);
    const context = canvas.getContext('2d'), curve = new Path2D();
    for (let x = 0; x <= 300; x++) curve.lineTo(x, 60 + 45 * Math.sin(x / 18));
    [context.lineWidth, context.strokeStyle] = [width, '#1a6fb5'];
    context.stroke(curve);
    const shades = context.getImageData(0, 0, 300, 120).data.filter((_, place) => place % 4 === 3);
    return [shades.reduce((sum, shade) => sum + shade, 0), context.lineWidth, shades.join()];
  });
  wrap.remove();
  plain.remove();
  const [[hairlines, left, one], [line, , other]] = ink;
  return {ratio: hairlines / line, left, same: one === other};
};

look.still = () => {
  const wrap = Object.assign(document.createElement('div'), {className: 'u-wrap'});
  const canvas = Object.assign(document.createElement('canvas'), {width: 300, height: 120});
  wrap.append(canvas);
  document.body.append(wrap);
  const context = canvas.getContext('2d'), curve = new Path2D();
  for (let x = 0; x <= 300; x++) curve.lineTo(x, 60 + 45 * Math.sin(x / 18));
  context.lineWidth = 2;
  const shades = color => {
    context.resetTransform();
    context.fillStyle = '#fff';
    context.fillRect(0, 0, 300, 120);
    context.strokeStyle = color;
    context.setTransform(1, 0, 0, 1, 0.5, 0.5);
    context.stroke(curve);
    const {e, f} = context.getTransform();
    return {left: [e, f], pixels: [...context.getImageData(0, 0, 300, 120).data]};
  };
  const drawn = ['#1a6fb5', '#1a6fb5', '#1a6fb5', '#b51a1a'].map(shades);
  wrap.remove();
  const [{pixels: first}] = drawn;
  const most = pixels => pixels.reduce((worst, pixel, at) => Math.max(worst, Math.abs(pixel - first[at])), 0);
  return {apart: drawn.map(({pixels}) => most(pixels)), left: drawn.map(({left}) => left)};
};

// The buttons above the panel with their texts, marked.
look.buttons = () => [...document.querySelectorAll('.sb-row[role=toolbar]:not(.sb-lecture) button')];

look.nodes = () => look.buttons().flatMap(button => [button, ...button.childNodes]);

look.mark = () => look.nodes().forEach(node => { node.made = true; });

look.marked = () => look.nodes().map(node => node.made === true);

look.fill = () => {
  const box = document.createElement('div');
  document.body.append(box);
  const seen = [];
  const fill = html => {
    schuler.fill(box, html);
    seen.push(box.innerHTML);
  };
  fill('<p title="a" lang="en">one <b>1</b></p><i>two</i>');
  const [p, b, i] = ['p', 'b', 'i'].map(name => box.querySelector(name));
  fill('<p title="b">one <b>2</b></p><i>two</i>');
  const stays = [p, b, i].every(node => box.contains(node));
  i.textContent = 'zwei'; // as a script of ours may have put it
  fill('<p title="b">one <b>3</b></p><i>two</i>');
  fill('<p title="b">one</p><u>two</u><i>two</i>');
  fill('<p title="b">one</p><s>two</s><i>three</i>');
  fill('<button data-command="undo">four</button>');
  const button = box.firstChild;
  fill('<button data-command="redo">four</button>');
  const pressed = box.contains(button);
  const other = document.createElement('div'); // nothing is known of what it had
  schuler.fill(other, '<i>four</i>');
  box.remove();
  return {seen, stays, pressed, other: other.innerHTML};
};

// The curves of each plot over time, by the name of its axis, as float32 in base64.
look.curves = () => Object.fromEntries(Object.values(window.__viserTestpoints.uplots).map(({chart}) => [
  chart.axes[1].label,
  chart.data.map(curve => {
    let letters = '';
    for (const byte of new Uint8Array(Float32Array.from(curve).buffer)) letters += String.fromCharCode(byte);
    return btoa(letters);
  }),
]));

// A hand on a slider: to the right and back, until it is let go.
look.drag = id => {
  let step = 0;
  window.drag = setInterval(() => {
    const key = step++ % 12 < 6 ? 'ArrowRight' : 'ArrowLeft';
    const thumb = document.getElementById(id).querySelector('[role=slider]');
    for (const kind of ['keydown', 'keyup'])
      thumb.dispatchEvent(new KeyboardEvent(kind, {key, code: key, bubbles: true, cancelable: true}));
  }, 50);
};

// Which curves of the first plot over time have the path that they had at the last look.
look.samePaths = () => {
  const {series} = Object.values(window.__viserTestpoints.uplots)[0].chart;
  const kept = series.slice(1).map(each => each._paths === each.lookedAt);
  for (const each of series) each.lookedAt = each._paths;
  return kept;
};

// ------------------------------------------------------------ test_page_scene

look.color = () => window.__viserSceneTree.getState()['/computed/hull'].message.props.color;

// Counts the frames of the 3D view from now on: each begins by clearing its picture.
look.countFrames = () => {
  const { clear } = WebGL2RenderingContext.prototype;
  window.framesOf3D = 0;
  WebGL2RenderingContext.prototype.clear = function (...what) {
    window.framesOf3D += 1;
    return clear.apply(this, what);
  };
};

look.frames = () => window.framesOf3D;

look.drawAgain = () => new Promise(done => {
  window.__viserMutable.requestRender();
  requestAnimationFrame(() => requestAnimationFrame(done));
});

look.view = () => {
  const box = document.querySelector('canvas[data-engine]').getBoundingClientRect();
  return [box.left, box.top, box.right, box.bottom];
};

// The view and what stands over it, read in one moment; false until both stand where the layout puts them.
look.placed = ([left, width]) => {
  const view = document.querySelector('canvas[data-engine]').getBoundingClientRect();
  const stage = document.querySelector('#sb-stage').getBoundingClientRect();
  const there = Math.abs(view.left - left) < 12 && Math.abs(view.width - width) < 24
    && Math.abs(view.left - stage.left) < 2 && Math.abs(view.top - stage.top) < 2
    && Math.abs(view.width - stage.width) < 2 && Math.abs(view.height - stage.height) < 2;
  const sides = box => [box.left, box.top, box.right, box.bottom];
  const parts = ['.sb-pendulum', '.sb-readout', '.sb-bar', '.sb-shown'].map(
    name => [name, sides(document.querySelector(`#sb-stage ${name}`).getBoundingClientRect())]);
  return there && [sides(view), Object.fromEntries(parts)];
};

look.now = () => JSON.parse(document.getElementById('sb-playback').dataset.now);

// Time in hours at which each plot over time has its line; null where there is none.
look.lines = () => Object.values(window.__viserTestpoints.uplots).map(({chart}) => {
  const line = chart.over.querySelector('.sb-time');
  if (!line || line.style.display === 'none') return null;
  const x = new DOMMatrix(getComputedStyle(line).transform).m41;
  return chart.posToVal(x, 'x');
});

// ------------------------------------------------------------ test_page_servers

// The buttons that are seen over the 3D view, and those of the key: read in one moment.
look.stageButtons = () => ['button', '.sb-entry'].map(name => [...document.querySelectorAll(`#sb-stage ${name}`)]
  .filter(each => each.checkVisibility({visibilityProperty: true})).map(each => each.innerText));

// ------------------------------------------------------------ test_page_state

// A watcher's box is unlocked in the page and changed.
look.unlocked = id => {
  const box = document.getElementById(id);
  box.disabled = false;
  Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, 'value').set.call(box, '0.3');
  box.dispatchEvent(new Event('input', {bubbles: true}));
};

look.allLocked = () => [...document.querySelectorAll('input')].every(i => i.offsetParent === null
  || i.disabled || i.closest('.js-plotly-plot, #sb-stage'));

// ------------------------------------------------------------ test_page_touch

// What a finger must hit and is smaller than that: of a slider and of a label with it, the row is hit.
look.small = least => [...document.querySelectorAll('button, select, summary, [role=tab], input')]
  .filter(e => e.offsetParent !== null && !e.closest('[data-sb-kind=hidden]') && e.type !== 'file')
  .map(e => [e.ariaLabel || e.textContent || e.id, e.getBoundingClientRect()])
  .filter(([_, box]) => box.width > 0 && Math.min(box.width, box.height) < least - 0.5)
  .map(([name, box]) => `${name} ${Math.round(box.width)} x ${Math.round(box.height)}`);

look.times = () => {
  const scale = Object.values(window.__viserTestpoints.uplots)[0].chart.scales.x;
  return [scale.min, scale.max];
};

// Two taps in the middle of the first plot: those of a driver come as late as the machine is busy.
look.twoTaps = () => {
  const over = document.querySelector('.u-over'), box = over.getBoundingClientRect();
  const at = {clientX: box.left + box.width / 2, clientY: box.top + box.height / 2};
  const how = {bubbles: true, pointerType: 'touch', isPrimary: true, pointerId: 7, ...at};
  for (const kind of ['pointerdown', 'pointerup', 'pointerdown', 'pointerup']) {
    over.dispatchEvent(new PointerEvent(kind, how));
  }
};

// ------------------------------------------------------------ test_page_workbench

look.hasTrace = name => [...document.querySelectorAll('.js-plotly-plot')].some(
  p => p.offsetParent !== null && p._fullData?.some(t => t.name === name && t.x?.length > 0));

look.hasNoTrace = name => !look.hasTrace(name);

look.hasLabel = label => Object.values(window.__viserTestpoints?.uplots ?? {})
  .some(entry => entry.chart.axes[1].label.startsWith(label));

look.plotsCut = () => [...document.querySelectorAll('.mantine-ScrollArea-viewport')]
  .filter(e => e.clientHeight > 0 && e.querySelector('.js-plotly-plot'))
  .map(e => [e.scrollWidth - e.clientWidth, e.scrollHeight - e.clientHeight]);

look.limits = () => Object.values(window.__viserTestpoints?.uplots ?? {}).map(({chart}) => [
  chart.axes[1].label,
  chart.series.map((s, i) => s.label === 'limit' ? chart.data[i][0] : null).filter(v => v !== null)])
  .filter(([label, found]) => found.length);

// ------------------------------------------------------------ windows/seeing

// What keeps a person from seeing an element; empty: it is seen. Where its panel scrolls, it is scrolled to
// first, and what lets the pointer through is asked for as if it did not.
look.hidden = element => {
  const outside = (box, frame) => box.left < frame.left - 1.5 || box.top < frame.top - 1.5
    || box.right > frame.right + 1.5 || box.bottom > frame.bottom + 1.5;
  const told = box => [box.left, box.top, box.right, box.bottom].map(Math.round).join();
  const frames = [];
  // what is around something fixed does not cut it
  const inside = at => (getComputedStyle(at).position === 'fixed' ? null : at.parentElement);
  for (let at = inside(element); at; at = inside(at)) {
    const {overflowX, overflowY} = getComputedStyle(at);
    if (overflowX === 'visible' && overflowY === 'visible') continue;
    const frame = at.getBoundingClientRect(), box = element.getBoundingClientRect();
    if (['auto', 'scroll'].includes(overflowY)) {
      const [above, below] = [frame.top - box.top, box.bottom - frame.bottom];
      if (below > 0) at.scrollTop += Math.min(below, -above) + 2;
      else if (above > 0) at.scrollTop -= above + 2;
    }
    frames.push(at);
  }
  const box = element.getBoundingClientRect();
  const shown = element.checkVisibility({visibilityProperty: true, opacityProperty: true});
  if (!shown || box.width < 2 || box.height < 2) return 'it is not shown';
  const all = {left: 0, top: 0, right: innerWidth, bottom: innerHeight};
  if (outside(box, all)) return `it leaves the window: ${told(box)}`;
  const frame = frames.find(each => outside(box, each.getBoundingClientRect()));
  if (frame) return `${told(box)} is cut by ${frame.className} ${told(frame.getBoundingClientRect())}`;
  for (const part of [element, ...element.querySelectorAll('*')]) {
    const typed = part.tagName === 'INPUT';
    const written = typed || [...part.childNodes].some(n => n.nodeType === 3 && n.data.trim() !== '');
    const clips = typed || getComputedStyle(part).overflowX !== 'visible';
    if (written && clips && !part.readOnly && part.clientWidth > 2 && part.scrollWidth > part.clientWidth + 1)
      return `its text is cut: ${part.value ?? part.textContent}`;
  }
  const through = getComputedStyle(element).pointerEvents === 'none';
  const kept = element.style.pointerEvents;
  if (through) element.style.pointerEvents = 'auto';
  const whole = element.closest('.mantine-Input-wrapper') ?? element; // a box has parts over its ends
  const over = [[.5, .5], [.2, .2], [.8, .2], [.2, .8], [.8, .8]]
    .map(([x, y]) => document.elementFromPoint(box.left + x * box.width, box.top + y * box.height))
    .find(top => top === null || !(whole.contains(top) || top.contains(element)));
  if (through) element.style.pointerEvents = kept;
  return over === undefined ? '' : `it is covered by ${over?.outerHTML.slice(0, 120)}`;
};

// ------------------------------------------------------------ windows/test_comparing

look.uplotNames = () => Object.values(window.__viserTestpoints?.uplots ?? {})
  .map(entry => entry.chart.series.slice(1).map(s => s.label));

look.banner = () => getComputedStyle(document.body, '::after').content;

look.runs = () => [...document.querySelectorAll('.sb-pins tbody tr b')].map(b => b.textContent);

// Numbers of the table of metrics as they are seen, by the place of their decimal points in each column.
look.points = () => {
  const rows = [...document.querySelectorAll('.sb-table tbody tr')].map(row => [...row.cells]);
  const found = {};
  const shown = rows.filter(row => row.length > 6 && row[0].offsetParent !== null);
  for (const cells of shown) for (const [place, cell] of cells.entries()) {
    const text = cell.querySelector('.sb-best')?.firstChild ?? cell.firstChild;
    if (place < 2 || text?.nodeType !== 3 || !/^-?[0-9]+[.][0-9]+$/.test(text.data)) continue;
    const range = document.createRange();
    range.setStart(text, 0);
    range.setEnd(text, text.data.indexOf('.'));
    (found[place] ??= []).push([text.data, range.getBoundingClientRect().right]);
  }
  return Object.values(found);
};

// Where the labels of the map's lines stand in the 3D view, px, and the view's size.
look.meridians = () => {
  const {camera, nodeRefFromName: nodes} = window.__viserMutable;
  const view = document.querySelector('canvas[data-engine]').getBoundingClientRect();
  const pen = document.createElement('canvas').getContext('2d');
  pen.font = '11px sans-serif';
  const found = [];
  for (const [name, {message}] of Object.entries(window.__viserSceneTree.getState())) {
    const text = message?.props.text ?? '', {position} = window.__viserMutable.nodePoseData[name] ?? {};
    if (!name.startsWith('/map/labels') || !text.includes('°') || !position) continue;
    const at = camera.position.clone().set(...position).applyMatrix4(nodes[''].matrixWorld).project(camera);
    const [x, y] = [view.width * (1 + at.x) / 2, view.height * (1 - at.y) / 2];
    const half = pen.measureText(text).width / 2;
    found.push([text, x - half, y, x + half, y + 11]);
  }
  return [found, view.width, view.height];
};

// How much of the 3D view's width and height what is drawn in it takes.
look.viewFilled = () => {
  const view = document.querySelector('canvas[data-engine]');
  const copy = Object.assign(document.createElement('canvas'), {width: view.width, height: view.height});
  const pen = copy.getContext('2d');
  pen.drawImage(view, 0, 0);
  const seen = new Uint32Array(pen.getImageData(0, 0, view.width, view.height).data.buffer);
  const [across, up] = [new Set(), new Set()];
  for (const [place, color] of seen.entries()) if (color !== seen[0]) {
    across.add(place % view.width);
    up.add(Math.floor(place / view.width));
  }
  return [across.size / view.width, up.size / view.height];
};

// ------------------------------------------------------------ windows/test_drawing

look.status = () => document.querySelector('#sb-status > b').textContent;

// A key of the slider is held down: to the right and back, until it is let go.
look.hold = id => {
  let step = 0;
  window.hand = setInterval(() => {
    const key = step++ % 40 < 20 ? 'ArrowRight' : 'ArrowLeft';
    const thumb = document.getElementById(id).querySelector('[role=slider]');
    const event = {key, code: key, repeat: true, bubbles: true, cancelable: true};
    thumb.dispatchEvent(new KeyboardEvent('keydown', event));
  }, 40);
};

look.firstCurve = () => {
  const {chart} = Object.values(window.__viserTestpoints.uplots)[0];
  return chart.data.at(-1).reduce((sum, value, place) => sum + (value ?? 0) * (1 + place % 97), 0);
};

// ------------------------------------------------------------ windows/test_editing

look.away = () => [...document.querySelectorAll('.sb-handle')].every(r => !r.offsetParent);

look.pasted = text => {
  const clipboardData = new DataTransfer();
  clipboardData.setData('text/plain', text);
  document.activeElement?.blur();
  document.body.dispatchEvent(new ClipboardEvent('paste', {clipboardData, bubbles: true, cancelable: true}));
};

// ------------------------------------------------------------ windows/test_opening

// The card of the tour is within the window, and does not lie over what it speaks of.
look.clear = () => {
  const card = document.querySelector('.sb-tour').getBoundingClientRect();
  const ring = document.querySelector('.sb-ring').getBoundingClientRect();
  const within = card.left >= 0 && card.top >= 0 && card.right <= innerWidth && card.bottom <= innerHeight;
  const beside = card.left >= ring.right || ring.left >= card.right;
  const over = !beside && card.top < ring.bottom && ring.top < card.bottom;
  return within && ring.width > 20 && ring.height > 10 && !over;
};

look.titles = () => [...document.querySelectorAll('[role=tab]')].map(tab => tab.textContent);

look.veiled = () => document.getElementById('sb-veil') !== null;

// Buttons below the state of the run: each with its area and the colour of its ground.
look.weights = () => [...document.querySelectorAll('.sb-row .sb-do')].filter(b => b.offsetParent !== null)
  .map(b => [b.dataset.command ?? '', b.offsetHeight, getComputedStyle(b).backgroundColor]);

look.hiddenNotices = () => [...document.querySelectorAll('.mantine-Notification-root')]
  .every(notice => !notice.checkVisibility());

// ------------------------------------------------------------ windows/test_results

// Where the bobs of the pendulum stand in its side view.
look.bobs = () => [...document.querySelectorAll('#sb-stage .sb-bob')].map(bob => Number(bob.getAttribute('cx')));

// In the front panel of the pole map: left and right end of its axis.
look.near = () => [...document.querySelectorAll('.js-plotly-plot')]
  .find(p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Poles')?._fullLayout.xaxis2.range;

look.cells = () => [...document.querySelectorAll('.sb-verdicts [data-measure]')]
  .filter(e => e.offsetParent !== null)
  .map(e => [e.dataset.measure, Number(e.dataset.value), e.dataset.passed, e.textContent.trim()]);

look.shapes = () => [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null)
  .flatMap(p => (p._fullLayout?.shapes ?? []).filter(s => s.name))
  .map(s => [s.name, s.xref, s.x0 ?? null, s.y1 ?? null, s.path ?? null]);

// ------------------------------------------------------------ windows/test_sharing

look.front = () =>
  [...document.querySelectorAll('[role=tab][aria-selected=true]')].map(tab => tab.textContent);

// The view with this name fills the window and has been drawn.
look.fills = view => {
  const shown = document.querySelector(`[data-sb-alone="${view}"]`);
  const drawn = shown?.querySelector('.js-plotly-plot .trace, .uplot canvas');
  if (!drawn || document.getElementById('sb-veil')) return false;
  const plots = [...shown.querySelectorAll('.js-plotly-plot, .uplot')]
    .map(plot => plot.getBoundingClientRect());
  const [top, left] = ['top', 'left'].map(side => Math.min(...plots.map(box => box[side])));
  const [bottom, right] = ['bottom', 'right'].map(side => Math.max(...plots.map(box => box[side])));
  const within = top >= 0 && left >= 0 && bottom <= innerHeight && right <= innerWidth;
  return within && right - left > 0.9 * innerWidth && bottom - top > 0.72 * innerHeight;
};

// Labels or roles of the controls that a user sees.
look.controls = () =>
  [...document.querySelectorAll('input, select, textarea, [role=tab], [role=slider], .mantine-Button-root')]
    .filter(each => each.checkVisibility({visibilityProperty: true}))
    .map(each => each.getAttribute('aria-label') ?? each.getAttribute('role') ?? each.tagName);

// The 3D view fills the window, seen so; its key stands over it, without the bar.
look.stage = camera => {
  const now = JSON.parse(document.getElementById('sb-playback')?.dataset.now ?? '{}');
  const box = document.querySelector('canvas[data-engine]')?.getBoundingClientRect();
  const seen = selector => document.querySelector(selector)?.checkVisibility({visibilityProperty: true});
  return !document.getElementById('sb-veil') && now.camera === camera && box?.width === innerWidth
    && box.height === innerHeight && seen('#sb-stage .sb-key') && !seen('#sb-stage .sb-bar');
};

// Sizes of the type in the panels (px of the window) with its text, the smallest first.
look.type = () => {
  const seen = e => e.offsetParent !== null || e instanceof SVGElement;
  const written = e => [...e.childNodes].some(n => n.nodeType === 3 && n.textContent.trim() !== '');
  const here = ({width, height, top, bottom}) => width > 1 && height > 1 && bottom > 0 && top < innerHeight;
  const small = ['SUB', 'SUP', 'tspan', 'OPTION', 'STYLE'];
  const html = [...document.querySelectorAll('[data-dock-column] *')]
    .filter(e => seen(e) && written(e) && !small.includes(e.tagName) && !e.closest('math, [hidden]'))
    .filter(e => here(e.getBoundingClientRect()))
    .map(e => [parseFloat(getComputedStyle(e).fontSize) * e.currentCSSZoom, e.textContent.slice(0, 40)]);
  const charts = Object.values(window.__viserTestpoints?.uplots ?? {}).map(entry => entry.chart);
  const drawn = charts.filter(c => c.root.offsetParent !== null && c.axes[0].label)
    .map(c => [parseFloat(c.axes[0].font[0]) / devicePixelRatio, 'axis of a time plot']);
  return [...html, ...drawn].sort((a, b) => a[0] - b[0]);
};

look.shownLabels = () => [...document.querySelectorAll('[data-dock-region=left] label')]
  .filter(l => l.offsetParent !== null).map(l => schuler.english(l.textContent));

// Notes all texts of notices, however short they stay.
look.noteAll = () => {
  window.told = new Set();
  const look = () => document.querySelectorAll('.mantine-Notification-root')
    .forEach(notice => window.told.add(notice.textContent));
  window.telling = setInterval(look, 10);
};

look.noted = () => { clearInterval(window.telling); return [...window.told]; };
