// Draws the plots that are to be saved, and saves them: the server asks by #sb-export, which carries the figures
// (app/views/appearance/document.py). A plot that is in front is saved alone as it is seen, with its zoom; every other one
// as the server made it. Between two pictures the page goes on with its other work.
(() => {
  const GAP = 24;
  const HEAD = 64;
  const CAPTION = 26;
  const INK = "#243b53";
  let done = 0;

  const pause = () => new Promise((go) => setTimeout(go, 30));

  // plotly is read late (app/http/static/plotly.js): a first figure has it read.
  async function ready() {
    if (Plotly.toImage === undefined) await Plotly.react(document.createElement("div"), [], {}, {});
  }

  function inFront(view) {
    const plots = [...document.querySelectorAll(".js-plotly-plot")];
    return view && plots.find((plot) => plot._fullLayout?.meta?.view === view && plot.offsetParent !== null);
  }

  async function single({ pictures: [{ figure, view, width, height }], format }) {
    const plot = inFront(view);
    const box = plot ? plot.getBoundingClientRect() : { width, height };
    const size = { width: Math.round(box.width), height: Math.round(box.height), scale: format === "png" ? 2 : 1 };
    return Plotly.toImage(plot || figure, { format, ...size });
  }

  // The 3D view as it is seen now, without what is empty around it; its canvas keeps what was drawn last.
  function scene() {
    const view = document.querySelector("canvas[data-engine]");
    if (!view?.checkVisibility() || view.width < 50 || view.height < 50) return {};
    const { width, height } = view;
    const canvas = Object.assign(document.createElement("canvas"), { width, height });
    const pen = canvas.getContext("2d", { willReadFrequently: true });
    pen.drawImage(view, 0, 0);
    const colors = new Uint32Array(pen.getImageData(0, 0, width, height).data.buffer);
    const box = { left: width, right: 0, top: height, bottom: 0 };
    for (const [place, color] of colors.entries()) {
      if (color === colors[0]) continue;
      const [x, y] = [place % width, Math.floor(place / width)];
      box.left = Math.min(box.left, x);
      box.right = Math.max(box.right, x + 1);
      box.top = Math.min(box.top, y);
      box.bottom = Math.max(box.bottom, y + 1);
    }
    const size = { width: box.right - box.left, height: box.bottom - box.top };
    if (size.width < 1) return {};
    Object.assign(canvas, size);
    pen.drawImage(view, -box.left, -box.top);
    return { address: canvas.toDataURL("image/png"), ...size };
  }

  async function all({ pictures }) {
    const drawn = [];
    for (const [place, { figure, title, width, height }] of pictures.entries()) {
      tell(`Drawing plot ${place + 1} of ${pictures.length}`);
      await pause();
      const address = figure && (await Plotly.toImage(figure, { format: "svg", width, height }));
      drawn.push({ title, ...(figure ? { address, width, height } : scene()) });
    }
    return drawn;
  }

  async function page(job) {
    const made = new DOMParser().parseFromString(job.page, "text/html");
    for (const [place, { address, width, height }] of (await all(job)).entries()) {
      const image = made.querySelector(`img[data-picture="${place}"]`);
      if (address === undefined) {
        image.closest("figure").remove();
        continue;
      }
      image.src = address;
      image.width = width;
      image.height = height;
      image.removeAttribute("data-picture");
    }
    const kind = new XMLSerializer().serializeToString(made.doctype);
    return URL.createObjectURL(new Blob([kind, made.documentElement.outerHTML], { type: "text/html" }));
  }

  // All plots two abreast in one picture, in the order of their tabs.
  async function overview(job) {
    const drawn = (await all(job)).filter(({ address }) => address !== undefined);
    const wide = Math.max(...job.pictures.map(({ width }) => width ?? 0));
    const bottoms = [HEAD, HEAD];
    for (const picture of drawn) {
      const column = bottoms[1] < bottoms[0] ? 1 : 0;
      const scale = Math.min(wide / picture.width, wide / picture.height);
      Object.assign(picture, { x: GAP + column * (wide + GAP), y: bottoms[column], scale });
      bottoms[column] += CAPTION + picture.height * scale + GAP;
    }
    const canvas = document.createElement("canvas");
    canvas.width = 2 * wide + 3 * GAP;
    canvas.height = Math.ceil(Math.max(...bottoms));
    const pen = canvas.getContext("2d");
    const family = getComputedStyle(document.body).fontFamily;
    const write = (text, x, y, px) => {
      pen.fillStyle = INK;
      pen.font = `600 ${px}px ${family}`;
      pen.fillText(text, x, y, canvas.width - x - GAP);
    };
    pen.fillStyle = "#fff";
    pen.fillRect(0, 0, canvas.width, canvas.height);
    write(job.title, GAP, 42, 26);
    for (const { title, address, width, height, x, y, scale } of drawn) {
      write(title, x, y + 18, 17);
      const image = new Image(width, height);
      image.src = address;
      await image.decode();
      pen.drawImage(image, x, y + CAPTION, width * scale, height * scale);
    }
    const content = await new Promise((give) => canvas.toBlob(give, "image/png"));
    return URL.createObjectURL(content);
  }

  function save(address, name) {
    const link = document.createElement("a");
    link.href = address;
    link.download = name;
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
  }

  // Beside the buttons, which cannot be pressed meanwhile.
  function tell(text) {
    const line = document.querySelector(".sb-making");
    if (line) line.textContent = window.schuler.say(text);
    for (const button of document.querySelectorAll(".sb-export .sb-do")) button.ariaDisabled = text ? "true" : "false";
  }

  async function make(job) {
    try {
      await ready();
      const draw = { html: page, overview }[job.format] ?? single;
      save(await draw(job), job.name);
      window.schuler.command("exported");
    } catch (error) {
      window.schuler.command("exported", String(error));
    }
    tell("");
  }

  setInterval(() => {
    const wanted = document.getElementById("sb-export")?.dataset;
    if (wanted === undefined || Number(wanted.count) === done) return;
    done = Number(wanted.count);
    make(JSON.parse(wanted.job));
  }, 200);
})();
