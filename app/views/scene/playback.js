// The bar over the 3D view: play, time, speed, loop, cameras; the pendulum and the readout above it; and the present
// time as a line in every plot over time. All it shows comes from #sb-playback (app/views/scene/view.py); what is
// pressed goes back as commands (commands.js).
(() => {
  const PERIOD_MS = 300;
  const AFTER_SCRUB_MS = 500;
  const HEARD_MS = 250;
  const CHOICE_MS = 2000;
  const HEAD_PX = 104; // top bar and strip of results
  const NARROW_PX = 60; // narrower it is a rail
  const LOW_PX = 800; // lower, and small, it has room for one instrument
  const WITHOUT = {
    missing: "No 3D view: this browser has no WebGL. The map is drawn flat.",
    lost: "The 3D view is lost: the browser has taken its WebGL away. The map is drawn flat. Load the page again to get it back.",
  };
  const UNITS = { s: 1, min: 60, h: 3600, d: 86400 };
  let now = null;
  let shown = "";
  let scrubbed = -1e9;
  let heard = -1e9;
  let stage = null;
  const wanted = window.schuler.alone && document.documentElement.dataset.alone;
  let chosen = -1e9;

  const element = (html) => {
    const holder = document.createElement("template");
    holder.innerHTML = html;
    return holder.content.firstElementChild;
  };
  const find = (name) => stage.querySelector(`[data-is="${name}"]`);

  function clock(seconds) {
    const minutes = Math.floor(seconds / 60 + 1e-6);
    const two = (n) => String(n).padStart(2, "0");
    return `${Math.floor(minutes / 60)}:${two(minutes % 60)}:${two(Math.floor(seconds % 60))}`;
  }

  function build() {
    const speeds = now.speeds.map((x) => `<option value="${x}">${x >= 3600 ? `${x / 3600} h/s` : `${x / 60} min/s`}</option>`);
    const cameras = now.cameras.map(
      (c) => `<button type="button" data-command="camera-${c}" data-camera="${c}" aria-label="view: ${c}">${c}</button>`,
    );
    stage = element(`<section id="sb-stage" aria-label="time and 3D view">
      <div class="sb-instruments">
        <div class="sb-shown" role="group" aria-label="instruments">
          <button type="button" data-shows="pendulum" title="Schuler pendulum: tilt of every method's platform">pendulum</button>
          <button type="button" data-shows="readout" title="true and computed attitude and speed">readout</button>
          <button type="button" data-mode="view" aria-label="large 3D view" title="3D view and plots change places">⇄</button>
          <button type="button" data-mode="rail" aria-label="fold the 3D view" title="fold the 3D view to a rail">⇤</button>
        </div>
        <div class="sb-meters"><div class="sb-pendulum" data-is="pendulum"></div><div class="sb-readout" data-is="readout"></div></div>
      </div>
      <div class="sb-foot"><div class="sb-key"><p data-is="caption"></p>
        <div class="sb-entries" data-is="key" role="group" aria-label="tracks and their position errors"></div></div>
      <div class="sb-bar"><div>
        <button type="button" class="sb-play" data-command="play" data-is="play"></button>
        <input type="range" min="0" max="1000" step="1" data-is="time" aria-label="time in the run">
        <output data-is="clock" title="hours : minutes : seconds"></output></div><div>
        <select data-is="speed" aria-label="speed of the playback" title="time of the run in a second">${speeds.join("")}</select>
        <button type="button" data-is="loop" aria-label="begin anew at the end" title="begin anew at the end">⟲</button>
        <span class="sb-cameras" role="group" aria-label="camera">${cameras.join("")}</span>
      </div></div></div></section>`);
    document.body.append(stage);
    find("time").addEventListener("input", (event) => {
      scrubbed = performance.now();
      const time = (now.span * event.target.value) / 1000;
      window.schuler.stream("seek", time);
      find("clock").textContent = clock(time);
      mark(time);
    });
    find("speed").addEventListener("change", (event) => window.schuler.command("speed", event.target.value));
    find("loop").addEventListener("click", () => window.schuler.command("loop", now.loop ? "off" : "on"));
    // After a click by the mouse the space bar plays; whoever goes by the keyboard keeps the focus.
    stage.addEventListener("click", (event) => event.detail > 0 && event.target.closest("button")?.blur());
    // While one presents, or as a lesson asks: what a visitor has folded is unfolded, and not folded again.
    window.schuler.act("large", (mode) => {
      if ((mode === "view") !== (window.schuler.mode?.() === "view")) window.schuler.setMode?.("view");
    });
    for (const button of stage.querySelectorAll("[data-mode]")) {
      button.addEventListener("click", () => window.schuler.setMode(button.dataset.mode)); // columns.js
    }
    for (const button of stage.querySelectorAll("[data-shows]")) {
      button.addEventListener("click", () => reveal(button, button.getAttribute("aria-pressed") !== "true"));
      reveal(button, innerHeight - HEAD_PX >= (button.dataset.shows === "pendulum" ? 500 : 900));
    }
    stage.classList.toggle("sb-alone", now.cameras.includes(wanted));
  }

  // The camera of the address: asked for until the server shows it, since a page that opens may lose a command.
  function choose() {
    if (now.camera === wanted || !now.cameras.includes(wanted) || performance.now() - chosen < CHOICE_MS) return;
    chosen = performance.now();
    window.schuler.command(`camera-${wanted}`);
  }

  // A small view has room for one of them.
  function reveal(button, shown) {
    if (shown && stage.classList.contains("sb-one")) {
      for (const other of stage.querySelectorAll("[data-shows]")) if (other !== button) reveal(other, false);
    }
    button.setAttribute("aria-pressed", String(shown));
    find(button.dataset.shows).hidden = !shown;
  }

  // Text and attributes are written when they differ: what is written is laid out anew.
  const set = (target, name, value) => target.getAttribute(name) !== value && target.setAttribute(name, value);
  const write = (target, text) => target.textContent !== text && (target.textContent = text);

  // viser tells of software rendering in a notice that lies over the pendulum: one line below the map says it too.
  let soft = false;
  const SOFT = "Software WebGL rendering detected";
  const titles = document.getElementsByClassName("mantine-Notification-title");
  const watch = new MutationObserver(() => {
    const told = [...titles].find(({ textContent }) => window.schuler.english(textContent) === SOFT)
      ?.closest(".mantine-Notification-root");
    if (!told) return;
    soft = true;
    watch.disconnect();
    told.style.display = "none";
    told.querySelector(".mantine-Notification-closeButton")?.click();
  });
  watch.observe(document.documentElement, { childList: true, subtree: true });
  setTimeout(() => watch.disconnect(), 60_000);

  // The entries stay what they are while only their errors change: a click ends on the button on which it began.
  function showKey() {
    const without = WITHOUT[window.schuler.without3d];
    const drawn = without !== undefined ? [". ", without] : soft ? ["; 3D drawn in software"] : [];
    write(find("caption"), [now.caption, ...drawn].map(window.schuler.say).join(""));
    const box = find("key");
    if (!stage.classList.contains("sb-alone")) return; // the strip of results is the legend
    const names = now.key.map((each) => each.key).join("\n");
    if (box.dataset.names !== names) {
      box.dataset.names = names;
      const rows = now.key.map(() =>
        element('<button type="button" class="sb-entry"><span class="sb-line"></span><span></span><small></small></button>'));
      box.replaceChildren(...rows);
    }
    for (const [place, each] of now.key.entries()) {
      const row = box.children[place];
      const [line, name, error] = row.children;
      set(row, "data-command", `legend ${each.key}`);
      set(row, "data-state", each.state);
      set(row, "title", each.hint);
      set(line, "style", `height:3px;background:${each.color}`);
      write(name, each.key);
      write(error, each.said === "" ? each.error : `${each.error}, ${each.said}`);
    }
  }

  // A range's value, and its words for who hears it.
  function update(source) {
    const scrubbing = performance.now() - scrubbed < AFTER_SCRUB_MS;
    const play = find("play");
    set(play, "aria-label", now.playing ? "pause" : "play");
    write(play, now.playing ? "❚❚" : "▶");
    if (!scrubbing) {
      find("time").value = now.span > 0 ? Math.round((1000 * now.time) / now.span) : 0;
      write(find("clock"), clock(now.time));
    }
    set(find("time"), "aria-valuetext", `${clock(now.time)} hours`);
    if (document.activeElement !== find("speed")) find("speed").value = String(now.speed);
    set(find("loop"), "aria-pressed", String(now.loop));
    for (const button of stage.querySelectorAll("[data-camera]")) {
      set(button, "aria-pressed", String(button.dataset.camera === now.camera));
    }
    for (const part of ["pendulum", "readout"]) {
      window.schuler.fill(find(part), source.querySelector(`[data-part="${part}"]`)?.innerHTML ?? "");
    }
    showKey();
    if (!scrubbing) mark(now.time);
  }

  // Leans on viser's handles of its charts, as pinned: tests/browser/test_page_scene.py looks at the result. The width
  // is the chart's own: asked of the element, the browser would lay the page out again for each plot.
  function mark(time) {
    const charts = Object.values(window.__viserTestpoints?.uplots ?? {});
    for (const { chart } of charts) {
      const over = chart?.over;
      if (!over?.isConnected) continue;
      let line = over.querySelector(":scope > .sb-time");
      if (line === null) {
        line = element('<div class="sb-time" aria-hidden="true"></div>');
        over.append(line);
      }
      const unit = UNITS[/\((\w+)\)/.exec(chart.series[0].label)?.[1]] ?? 3600;
      const [x, left, right] = [time / unit, chart.scales.x.min, chart.scales.x.max].map((value) => chart.valToPos(value, "x"));
      const within = Number.isFinite(x) && x >= left - 0.5 && x <= right + 0.5;
      line.style.display = within ? "" : "none";
      if (within) line.style.transform = `translateX(${x.toFixed(1)}px)`;
    }
  }

  function place() {
    const canvas = document.querySelector("canvas[data-engine]") ?? document.querySelector("canvas");
    const box = canvas?.getBoundingClientRect();
    if (!box || box.width < 10) return;
    stage.classList.toggle("sb-rail", box.width < NARROW_PX);
    for (const button of stage.querySelectorAll("[data-mode]")) set(button, "aria-pressed", String(button.dataset.mode === window.schuler.mode?.()));
    // alone.js lets it fill the window: viser's own frame of the canvas, of which the canvas takes its size.
    canvas.parentElement.parentElement.dataset.sbViews = now.cameras.join(" ");
    const [left, width] = [box.left, box.width].map(Math.round);
    stage.style.left = `${left}px`;
    stage.style.top = `${Math.round(box.top)}px`;
    stage.style.width = `${width}px`;
    stage.style.height = `${Math.round(box.height)}px`;
    const scale = Number(document.getElementById("sb-size")?.dataset.scale ?? 1);
    const small = box.width < 480 * scale;
    const one = small && box.height < LOW_PX * scale;
    stage.classList.toggle("sb-small", small);
    if (one === stage.classList.contains("sb-one")) return;
    stage.classList.toggle("sb-one", one);
    const shown = stage.querySelectorAll('[data-shows][aria-pressed="true"]');
    if (one && shown.length > 1) reveal(shown[0], true);
  }

  // The server slows the playback down when it hears nothing, and it hears nothing while the user moves something.
  function tellShown() {
    const time = performance.now();
    if (!now.playing || time - heard < HEARD_MS) return;
    heard = time;
    window.schuler.report("shown", now.count);
  }

  // In the frame that shows the picture to which it belongs.
  window.schuler.changed(() => {
    const source = document.getElementById("sb-playback");
    if (source === null || source.dataset.now === shown) return;
    shown = source.dataset.now;
    now = JSON.parse(shown);
    if (stage === null) build();
    choose();
    update(source);
    tellShown();
  });
  addEventListener("without3d", () => now !== null && showKey());
  setInterval(() => {
    if (now === null) return;
    choose();
    place();
    if (performance.now() - scrubbed > AFTER_SCRUB_MS) mark(now.time); // a plot was zoomed or made anew
  }, PERIOD_MS);
})();
