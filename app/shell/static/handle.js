// The handle over a plotly figure, a ring at the pole pair of the edited method: dragged by mouse or finger, or moved by the arrow
// keys, it places the pair. A figure says by layout.meta.handle where the pair is and which pairs are possible
// (app/shell/pair_handle.py). The ring follows the hand at once, and the pictures follow as they do a slider: its newest
// place goes to the server through a control of its own (app/bridge/socket.js). What is drawn is an element of ours, so
// that plotly lays out nothing; while a pole is dragged the axes of its figure stay (redraw.js).
(() => {
  const STEP_PX = 2;
  const FAST = 6; // with Shift
  const SLOP_PX = 3;
  const PAUSE_MS = 1000; // keys that follow each other faster are one step of undo
  const SETTLE_MS = 1500; // so long a picture of the pair is waited for
  const LENGTH = 0.88; // of the scale of the damping ratio in a Bode plot, over the height of its panel
  const ABOVE_PX = 24; // what stands at the lower edge of a panel
  const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const figures = new Map(); // figure: {rings, told, pair, until, anchors}
  let dragged = null;
  let last = { gesture: 0, time: -1e9, figure: null };

  const within = (value, [low, high]) => Math.min(Math.max(value, low), high);
  const short = (value) => String(Number(value.toPrecision(3)));

  // Between a pair (damping ratio, frequency over omega_s) and its place in a panel, px from its upper left corner.
  const KINDS = {
    poles: {
      place: ([damping, size], across, up) => {
        const part = Math.min(damping, 1);
        return [across.d2p(-part * size), up.d2p(size * Math.sqrt(1 - part * part))];
      },
      pair: ([left, top], across, up) => {
        const [re, im] = [Math.min(across.p2d(left), 0), Math.max(up.p2d(within(top, [0, up._length])), 0)];
        const size = Math.max(Math.hypot(re, im), 1e-6);
        return [Math.max(-re / size, 1e-6), size];
      },
    },
    // Across is the frequency of the plot; up is the damping ratio, small above, where a resonance is high. The anchor
    // is where the ring stands on its curve, and at which ratio: the scale is logarithmic from there, as long as its range.
    bode: {
      place: ([damping, size], across, up, { dampings: [low, high], omega_s, anchor }) => {
        const ratio = within(damping, [low, high]);
        return [across.d2p(size * omega_s), anchor.top + (LENGTH * up._length * Math.log(ratio / anchor.damping)) / Math.log(high / low)];
      },
      pair: ([left, top], across, up, { dampings: [low, high], omega_s, anchor }) => {
        const ratio = anchor.damping * (high / low) ** ((top - anchor.top) / (LENGTH * up._length));
        return [within(ratio, [low, high]), across.p2d(left) / omega_s];
      },
    },
  };

  // The possible pair next to one; the server has the last word (MainPair.nearest).
  function nearest([damping, size], handle) {
    const ends = handle.frequencies.map((range) => within(size, range));
    const away = (found) => Math.abs(Math.log(found / size));
    return [within(damping, handle.dampings), ends.reduce((one, other) => (away(other) < away(one) ? other : one))];
  }

  const handleOf = (figure) => figure._fullLayout?.meta?.handle;
  const axes = (figure, [across, up]) => [figure._fullLayout[across], figure._fullLayout[up]];

  // How high the method's curve runs in a panel, px from its upper edge; null where it has none.
  function heightOfCurve(figure, { color, panels }, panel, omega) {
    const [x, y] = panels[panel].map((name) => name.replace("axis", ""));
    const traces = (figure.calcdata ?? []).map((points) => points[0]?.trace);
    const trace = traces.find((each) => each?.visible === true && each.xaxis === x && each.yaxis === y && each.line?.color === color);
    const next = trace?.x.findIndex((value) => value >= omega) ?? -1;
    if (next < 1) return null;
    const [across, up] = axes(figure, panels[panel]);
    const [left, right] = [next - 1, next].map((place) => across.d2p(trace.x[place]));
    const [from, to] = [next - 1, next].map((place) => up.d2p(trace.y[place]));
    // A resonance has a point of its own, which may be one of the grid's too.
    const part = right > left ? (across.d2p(omega) - left) / (right - left) : 0;
    const top = from + (to - from) * part;
    return Number.isFinite(top) ? top : null;
  }

  // A handle as its panel has it: in a Bode plot with the anchor, which stays while a picture of the pair is waited for.
  function inPanel(figure, panel) {
    const handle = handleOf(figure);
    if (handle.kind !== "bode") return handle;
    const state = figures.get(figure);
    const pair = pairOf(figure);
    if (state.pair === null || state.anchors[panel] === undefined) {
      const [low, high] = handle.dampings;
      const damping = within(pair[0], [low, high]);
      const [, up] = axes(figure, handle.panels[panel]);
      const top = heightOfCurve(figure, handle, panel, pair[1] * handle.omega_s);
      const alone = ((1 - LENGTH) / 2 + (LENGTH * Math.log(damping / low)) / Math.log(high / low)) * up._length;
      state.anchors[panel] = { damping, top: top ?? alone };
    }
    return { ...handle, anchor: state.anchors[panel] };
  }

  // ------------------------------------------------------------ drawing

  function ring(figure, panel) {
    const made = window.schuler.element("button", "", { type: "button", class: "sb-handle" });
    // Elements, not texts: a browser that translates puts elements of its own in the place of texts.
    const tip = window.schuler.element("span", "", { class: "sb-handle-tip", "aria-hidden": "true", translate: "no" });
    const numbers = window.schuler.element("span", "");
    const index = window.schuler.element("sub", "s");
    tip.append(numbers, index);
    made.append(tip);
    made.addEventListener("pointerdown", (event) => press(event, figure, panel, made));
    made.addEventListener("keydown", (event) => step(event, figure, panel));
    const scale = window.schuler.element("div", "", { class: "sb-handle-scale", "aria-hidden": "true", translate: "no" });
    return { made, numbers, index, scale };
  }

  // While the handle of a Bode plot is dragged: the damping ratios along its way up and down.
  function showScale(scale, made, handle, across, up) {
    if (handle.kind !== "bode") return void scale.remove();
    if (made.nextSibling !== scale) made.after(scale);
    const [low, high] = handle.dampings;
    const placeOf = (damping) => within(KINDS.bode.place([damping, 1], { d2p: () => 0 }, up, handle)[1], [0, up._length]);
    const ratioAt = (top) => KINDS.bode.pair([0, top], { p2d: () => 0 }, up, handle)[0];
    const [from, to] = [low, high].map(placeOf);
    const marks = [from, handle.anchor.top, to];
    while (scale.childElementCount < marks.length) scale.append(window.schuler.element("span", ""));
    for (const [place, top] of marks.entries()) {
      scale.children[place].textContent = `ζ ${short(ratioAt(top))}`;
      scale.children[place].style.top = `${top - from}px`;
    }
    scale.style.height = `${to - from}px`;
    scale.style.transform = `translate(${across}px,${up._offset + from}px)`;
  }

  function name(element, pair, handle) {
    const told = `Pair of ${handle.name}: damping ratio ${short(pair[0])}, frequency ${short(pair[1])} ${handle.unit}. The arrow keys move it.`;
    const said = window.schuler.say(told);
    if (element.ariaLabel !== said) element.ariaLabel = said;
  }

  function show(figure) {
    const handle = handleOf(figure);
    const frame = figure.querySelector(".svg-container");
    if (!figure.isConnected || frame === null) return void figures.delete(figure);
    let state = figures.get(figure);
    if (state === undefined) {
      if (handle === undefined) return;
      figures.set(figure, (state = { rings: [], told: null, pair: null, until: 0, anchors: [] }));
      figure.on("plotly_afterplot", () => show(figure)); // a zoom, another size
    }
    const there = handle?.pair !== undefined && !window.schuler.alone ? handle : undefined;
    explain(figure, frame, state);
    const count = there === undefined ? 0 : there.panels.length;
    while (state.rings.length > count) {
      const { made, scale } = state.rings.pop();
      made.remove();
      scale.remove();
    }
    while (state.rings.length < count) state.rings.push(ring(figure, state.rings.length));
    if (there === undefined) return;
    const pair = pairOf(figure);
    for (const [panel, { made, numbers, index, scale }] of state.rings.entries()) {
      if (made.parentElement !== frame) frame.append(made);
      const [across, up] = axes(figure, there.panels[panel]);
      const handle = inPanel(figure, panel);
      const [left, top] = KINDS[there.kind].place(pair, across, up, handle);
      const height = handle.anchor?.top ?? top;
      const inside = left >= 0 && left <= across._length && height >= -1 && height <= up._length + 1;
      made.hidden = !inside && dragged?.made !== made;
      const x = across._offset + within(left, [0, across._length]);
      const y = up._offset + within(top, [0, up._length]);
      made.style.transform = `translate(${x.toFixed(1)}px,${y.toFixed(1)}px)`;
      showScale(scale, made, handle, x, up);
      made.style.setProperty("--color", there.color);
      made.classList.toggle("sb-left", left > 0.7 * across._length);
      const schuler = there.unit === "ωₛ";
      const said = `ζ ${short(pair[0])}  ω ${short(pair[1])} ${schuler ? "ω" : there.unit}`;
      if (numbers.textContent !== said) numbers.textContent = said;
      index.hidden = !schuler;
      name(made, pair, there);
    }
  }

  // Why there is no handle, in the lower left corner of the last panel.
  function explain(figure, frame, state) {
    const meta = figure._fullLayout.meta;
    const said = handleOf(figure) && !window.schuler.alone ? meta.told ?? "" : "";
    if (said === "") return void (state.told?.remove(), (state.told = null));
    state.told ??= window.schuler.element("p", "", { class: "sb-handle-told" });
    if (state.told.parentElement !== frame) frame.append(state.told);
    const [across, up] = axes(figure, meta.handle.panels.at(-1));
    if (state.told.textContent !== said) state.told.textContent = said;
    state.told.style.transform = `translate(${across._offset + 6}px,${up._offset + up._length - ABOVE_PX}px) translateY(-100%)`;
    state.told.style.maxWidth = `${across._length - 12}px`;
  }

  // Where the hand has put the pair, until a picture shows it; else where the picture has it.
  function pairOf(figure) {
    const state = figures.get(figure);
    const { pair } = handleOf(figure);
    if (state.pair === null) return pair;
    const shown = state.pair.every((value, place) => Math.abs(value / pair[place] - 1) < 1e-3);
    if (dragged?.figure === figure || (!shown && performance.now() < state.until)) return state.pair;
    state.pair = null;
    return pair;
  }

  // ------------------------------------------------------------ moving

  function move(figure, panel, place, gesture, ends) {
    const handle = inPanel(figure, panel);
    const [across, up] = axes(figure, handle.panels[panel]);
    const wanted = KINDS[handle.kind].pair([within(place[0], [0, across._length]), place[1]], across, up, handle);
    const pair = nearest(wanted, handle);
    const state = figures.get(figure);
    [state.pair, state.until] = [pair, performance.now() + SETTLE_MS];
    show(figure);
    setTimeout(() => show(figure), SETTLE_MS + 50);
    // Of a pair whose frequency is fixed only the damping ratio is wanted.
    const [[low, high]] = handle.frequencies;
    const asked = handle.frequencies.length === 1 && low === high ? pair : wanted;
    const words = [gesture, handle.method, ...asked.map((value) => value.toPrecision(4)), Number(ends)];
    window.schuler.send({ type: "GuiUpdateMessage", uuid: handle.control, updates: { value: words.join(" ") } });
  }

  function press(event, figure, panel, made) {
    if (event.button !== 0 || handleOf(figure)?.pair === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    made.focus();
    made.setPointerCapture(event.pointerId);
    const [across, up] = axes(figure, handleOf(figure).panels[panel]);
    const [left, top] = KINDS[handleOf(figure).kind].place(pairOf(figure), across, up, inPanel(figure, panel));
    const [x, y] = [event.clientX, event.clientY];
    dragged = { figure, panel, made, id: event.pointerId, x, y, left, top, gesture: Date.now(), at: null, frame: 0, moved: false };
    if (handleOf(figure).kind === "poles") window.schuler.holdAxes(figure); // a Bode plot's frequencies stand still
    made.classList.add("sb-held");
  }

  function follow(ends) {
    const { figure, panel, at, gesture } = dragged;
    if (at !== null && figure.isConnected) move(figure, panel, at, gesture, ends);
  }

  addEventListener("pointermove", (event) => {
    if (dragged === null || event.pointerId !== dragged.id) return;
    const [dx, dy] = [event.clientX - dragged.x, event.clientY - dragged.y];
    dragged.moved ||= Math.hypot(dx, dy) >= SLOP_PX;
    if (!dragged.moved) return;
    const scale = dragged.figure.getBoundingClientRect().width / (dragged.figure.offsetWidth || 1);
    dragged.at = [dragged.left + dx / scale, dragged.top + dy / scale];
    dragged.frame ||= requestAnimationFrame(() => {
      if (dragged === null) return;
      dragged.frame = 0;
      follow(false);
    });
  });

  function release(event) {
    if (dragged === null || event.pointerId !== dragged.id) return;
    const { figure, made } = dragged;
    cancelAnimationFrame(dragged.frame);
    follow(true);
    dragged = null;
    made.classList.remove("sb-held");
    window.schuler.freeAxes(figure);
    show(figure);
  }
  for (const kind of ["pointerup", "pointercancel"]) addEventListener(kind, release);

  function step(event, figure, panel) {
    const way = ARROWS[event.key];
    if (way === undefined || event.ctrlKey || event.metaKey || event.altKey || dragged !== null) return;
    event.preventDefault();
    event.stopPropagation();
    const handle = inPanel(figure, panel);
    const [across, up] = axes(figure, handle.panels[panel]);
    const place = KINDS[handle.kind].place(pairOf(figure), across, up, handle);
    const size = STEP_PX * (event.shiftKey ? FAST : 1);
    const now = performance.now();
    const same = figure === last.figure && now - last.time < PAUSE_MS;
    last = { gesture: same ? last.gesture : Date.now(), time: now, figure };
    move(figure, panel, [place[0] + size * way[0], place[1] + size * way[1]], last.gesture, true);
  }

  addEventListener("drawn", (event) => show(event.target)); // redraw.js
})();
