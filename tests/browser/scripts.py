"""What the driver asks a page in its own language."""

UP_TO_DATE = """() => {
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  const run = document.querySelector('#sb-run').dataset.run;
  return plots.length > 0 && plots.every(p => String(p._fullLayout?.meta?.run) === run);
}"""
PLOTLY = """() => {
  const plain = values => Array.from(values ?? [], v => (Number.isFinite(v) ? v : null));
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  return plots.flatMap(p => p._fullData.map(t => ({name: t.name, x: plain(t.x), y: plain(t.y)})));
}"""
UPLOT = """() => {
  const charts = Object.values(window.__viserTestpoints?.uplots ?? {}).map(entry => entry.chart);
  return charts.map(c => ({label: c.axes[1].label, data: c.data.map(d => Array.from(d))}));
}"""
# Sums that any change of a value or of its place changes: whole arrays would take a second to hand over.
SUMS = """count => {
  const sum = values => {
    let total = 0;
    (values ?? []).forEach((v, i) => { if (Number.isFinite(v)) total += v * (1 + (i % 97)); });
    return `${values?.length ?? 0}:${total}`;
  };
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  const charts = Object.values(window.__viserTestpoints?.uplots ?? {}).map(entry => entry.chart);
  const nodes = window.__viserSceneTree.getState();
  const lines = [...Array(count).keys()].map(i => nodes[`/track/method${i}`]?.message.props.points);
  return {
    plotly: plots.flatMap(p => p._fullData.map(t => [t.name, sum(t.x), sum(t.y)])),
    curves: charts.map(c => c.data.map(sum)),
    track: lines.map(points => sum(points)),
  };
}"""
# The server has heard of the window's size and of the tabs in front (app/shell/static/page.js).
HEARD = "() => document.querySelector('#sb-heard')?.dataset.state === schuler.state()"
# The tab in which a new scenario opens is in front.
OPENED = """() => {
  const wanted = document.querySelector('#sb-focus')?.dataset ?? {};
  return !wanted.scenario || schuler.tab(wanted.tab) === undefined
    || document.documentElement.dataset.opened === wanted.scenario;
}"""
# What a report of a failed test says of the page.
ACCOUNT = """() => {
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
}"""
# viser's page gives uPlot its numbers after the frame in which the rest of a message is shown.
NEXT_FRAME = "() => new Promise(go => requestAnimationFrame(() => setTimeout(go)))"
NO_NOTICES = """() => {
  document.querySelectorAll('.mantine-Notification-closeButton').forEach(button => button.click());
  return document.querySelector('.mantine-Notification-root') === null;
}"""
LINE = """name => {
  const node = window.__viserSceneTree.getState()[name];
  return node ? Array.from(node.message.props.points) : null;
}"""
