// The moving part of a report: sliders run the error model (error_model.wasm) in this page. Nothing is loaded.
(async () => {
  const root = document.getElementById("sb-moving");
  const text = (id) => document.getElementById(id).content.textContent;
  const bytes = (id) => Uint8Array.from(atob(text(id)), (letter) => letter.charCodeAt(0));
  const element = (name, content = "", attributes = {}) => {
    const made = document.createElement(name);
    made.textContent = content;
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
  };

  async function start() {
    const header = JSON.parse(text("sb-moving-header"));
    const unpacked = new Blob([bytes("sb-moving-numbers")]).stream().pipeThrough(new DecompressionStream("gzip"));
    const numbers = new Float64Array(await new Response(unpacked).arrayBuffer());
    const { instance } = await WebAssembly.instantiate(bytes("sb-moving-program"));
    const { run, memory, __heap_base: heap } = instance.exports;

    // ---------------------------------------------------------------- memory: the numbers, then what sliders change
    const columns = header.components.length;
    const rows = Math.floor(header.steps / header.every) + 1;
    let end = numbers.length;
    const room = (count) => (end += count) - count;
    const work = { sensors: room(header.sensors[1]), start: room(header.start[1]) };
    const logs = new Map(); // methods that see the same log share its place
    for (const method of header.methods) {
      const key = method.log[0];
      if (!logs.has(key)) logs.set(key, { given: method.log, work: room(method.log[1]) });
      Object.assign(method, { work: logs.get(key).work, rows: room(rows * columns) });
    }
    const base = Math.ceil(heap.value / 8);
    const missing = (base + end) * 8 - memory.buffer.byteLength;
    if (missing > 0) memory.grow(Math.ceil(missing / 65536));
    const held = new Float64Array(memory.buffer, base * 8, end);
    held.set(numbers);
    const at = (place) => (base + place) * 8;
    const part = ([place, count]) => numbers.subarray(place, place + count);

    // ---------------------------------------------------------------- the model
    const values = Object.fromEntries(header.sliders.map((slider) => [slider.field, slider.present]));
    const positions = header.methods.map((method) => method.present);

    function add(into, from, by, key) {
      if (key !== "log") {
        for (let i = 0; i < from.length; i++) into[i] += by * from[i];
        return;
      }
      for (let k = 0, i = 0; i < from.length; k += 4, i += 2) {
        into[k + 1] += by * from[i];
        into[k + 2] += by * from[i + 1];
      }
    }

    // Errors of the sensors and the log with the sliders as they are: what was packed, and so much of each more.
    function disturb(key, place, given) {
      const into = held.subarray(place, place + given[1]);
      into.set(part(given));
      for (const slider of header.sliders) {
        const by = values[slider.field] - slider.present;
        if (slider[key] && by !== 0) add(into, part(slider[key]), by, key);
      }
    }

    // Those that a slider changes; without one all.
    function disturbBy(slider) {
      if (!slider || slider.sensors) disturb("sensors", work.sensors, header.sensors);
      if (!slider || slider.start) disturb("start", work.start, header.start);
      if (!slider || slider.log) for (const { given, work: place } of logs.values()) disturb("log", place, given);
    }

    function compute(place) {
      const method = header.methods[place];
      method.written = run(
        header.steps, header.step_s, header.every, at(header.coefficients[0]), header.along, at(header.motion[0]),
        at(work.sensors), at(method.work), at(work.start), at(method.laws[positions[place]][0]), at(method.rows),
      );
    }

    // ---------------------------------------------------------------- the picture
    const hours = (header.every * header.step_s) / 3600;
    const plots = header.plots.map((plot) => {
      const figure = element("figure");
      const canvas = element("canvas", "", { width: "1520", height: "360", role: "img", "aria-label": plot.title });
      figure.append(element("figcaption", `${plot.title} (${plot.unit})`), canvas);
      return { ...plot, canvas, figure, ink: canvas.getContext("2d") };
    });
    const table = element("table", "", { class: "sb-peaks" });

    function lengths(method, plot) {
      const found = new Float64Array(method.written);
      for (let k = 0; k < found.length; k++) {
        let sum = 0;
        for (const column of plot.columns) sum += held[method.rows + k * columns + column] ** 2;
        found[k] = plot.columns.length > 1 ? Math.sqrt(sum) / plot.size : held[method.rows + k * columns + plot.columns[0]] / plot.size;
      }
      return found;
    }

    const short = (value) => Number(value.toPrecision(4)).toString();

    function draw() {
      const peaks = header.methods.map(() => []);
      for (const plot of plots) {
        const curves = header.methods.map((method) => lengths(method, plot));
        let low = 0, high = 1e-12;
        curves.forEach((curve, place) => {
          let most = 0;
          for (const value of curve) {
            if (value < low) low = value;
            if (value > high) high = value;
            if (Math.abs(value) > most) most = Math.abs(value);
          }
          peaks[place].push(most);
        });
        const { ink, canvas } = plot, left = 130, bottom = canvas.height - 50, top = 14, right = canvas.width - 20;
        const x = (k) => left + ((right - left) * k) / (rows - 1);
        const y = (value) => bottom - ((bottom - top) * (value - low)) / (high - low);
        ink.clearRect(0, 0, canvas.width, canvas.height);
        ink.font = "24px sans-serif";
        ink.fillStyle = "#243b53";
        ink.strokeStyle = "#d5dde5";
        ink.lineWidth = 2;
        for (const value of [low, (low + high) / 2, high]) {
          ink.beginPath();
          ink.moveTo(left, y(value));
          ink.lineTo(right, y(value));
          ink.stroke();
          ink.textAlign = "right";
          ink.fillText(short(value), left - 10, y(value) + 9);
        }
        for (let quarter = 0; quarter <= 4; quarter++) {
          const k = ((rows - 1) * quarter) / 4;
          ink.textAlign = quarter === 4 ? "right" : "center";
          ink.fillText(quarter === 4 ? `${short(k * hours)} h` : short(k * hours), x(k), bottom + 34);
        }
        ink.lineWidth = 3;
        curves.forEach((curve, place) => {
          ink.strokeStyle = header.methods[place].color;
          ink.beginPath();
          for (let k = 0; k < curve.length; k++) ink.lineTo(x(k), y(curve[k]));
          ink.stroke();
        });
      }
      table.replaceChildren(row("th", "largest", ...plots.map((plot) => `${plot.title} (${plot.unit})`)));
      header.methods.forEach((method, place) => {
        const made = row("td", method.name, ...peaks[place].map(short));
        made.firstChild.style.borderLeft = `6px solid ${method.color}`;
        if (method.written < rows) made.append(element("td", "left the range of the linear model"));
        table.append(made);
      });
    }

    function row(kind, ...cells) {
      const made = element("tr");
      made.append(...cells.map((cell) => element(kind, cell)));
      return made;
    }

    // ---------------------------------------------------------------- sliders
    const steps = []; // time of each, ms
    function timed(act) {
      const began = performance.now();
      act();
      draw();
      steps.push(performance.now() - began);
    }

    function setError(slider, value) {
      values[slider.field] = value;
      timed(() => {
        disturbBy(slider);
        header.methods.forEach((_, place) => compute(place));
      });
    }

    function setLaw(place, position) {
      positions[place] = position;
      timed(() => compute(place));
    }

    const sliders = element("div", "", { class: "sb-sliders" });
    const resets = [];
    function slider(label, attributes, present, shown, set, color) {
      const box = element("label", "", { class: "sb-slider" });
      const words = element("span", label), number = element("output");
      const input = element("input", "", { type: "range", "aria-label": label, ...attributes });
      if (color) box.style.borderLeft = `6px solid ${color}`;
      const say = () => input.setAttribute("aria-valuetext", (number.textContent = shown(Number(input.value))));
      input.value = present;
      input.addEventListener("input", () => {
        say();
        set(Number(input.value));
      });
      resets.push(() => {
        input.value = present;
        say();
      });
      say();
      words.append(" ", number);
      box.append(words, input);
      sliders.append(box);
    }

    header.methods.forEach((method, place) => {
      if (method.values.length < 2) return;
      const attributes = { min: 0, max: method.values.length - 1, step: 1, "data-field": method.field };
      const shown = (position) => short(method.values[position]);
      slider(`${method.name}: ${method.label}`, attributes, method.present, shown, (position) => setLaw(place, position), method.color);
    });
    for (const one of header.sliders) {
      const attributes = { min: one.low, max: one.high, step: (one.high - one.low) / 200, "data-field": one.field };
      const present = one.present;
      slider(one.label, attributes, present, short, (value) => setError(one, value));
    }
    const reset = element("button", "As in the report", { type: "button" });
    reset.addEventListener("click", () => {
      for (const act of resets) act();
      for (const one of header.sliders) values[one.field] = one.present;
      header.methods.forEach((method, place) => (positions[place] = method.present));
      timed(() => {
        disturbBy();
        header.methods.forEach((_, place) => compute(place));
      });
    });

    disturbBy();
    header.methods.forEach((_, place) => compute(place));
    draw();
    root.querySelector(".sb-waits").replaceWith(sliders, reset, table, ...plots.map((plot) => plot.figure));
    root.moving = {
      steps,
      rows: (place) => [...held.subarray(header.methods[place].rows, header.methods[place].rows + header.methods[place].written * columns)],
    };
  }

  try {
    await start();
  } catch (problem) {
    root.querySelector(".sb-waits").textContent = `This browser cannot run it: ${problem.message}`;
  }
})();
