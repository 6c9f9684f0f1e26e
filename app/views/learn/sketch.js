// The curve that a learner draws before the run shows it: with the pointer, or with the arrow keys.
(() => {
  let drawing = null;
  let column = 0;

  function read(svg) {
    const { columns, given } = svg.dataset;
    const heights = given === "" ? [] : given.split(",");
    return Array.from({ length: Number(columns) }, (_, place) => {
      const text = heights[place] ?? "";
      return text === "" ? NaN : Number(text);
    });
  }

  function show(svg, heights) {
    const { left, top, wide, high } = svg.dataset;
    const points = heights.map((height, place) =>
      Number.isNaN(height)
        ? null
        : `${Number(left) + (Number(wide) * place) / (heights.length - 1)},${Number(top) + 0.5 * high * (1 - height)}`,
    );
    svg.querySelector(".sb-mine").setAttribute("points", points.filter((point) => point !== null).join(" "));
    svg.dataset.given = heights.map((height) => (Number.isNaN(height) ? "" : height.toFixed(3))).join(",");
  }

  function send(svg) {
    window.schuler.command(svg.dataset.sketch, "sketch", svg.dataset.given);
  }

  // Column and height under the pointer.
  function under(svg, event) {
    const { columns, left, top, wide, high } = svg.dataset;
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const share = Math.min(Math.max((at.x - left) / wide, 0), 1);
    return [share * (columns - 1), Math.min(Math.max(1 - (2 * (at.y - top)) / high, -1), 1)];
  }

  // Every column between the pointer's last place and this one: a quick hand leaves none out.
  function drawTo(event) {
    const { svg, heights, last } = drawing;
    const [place, height] = under(svg, event);
    const [from, began] = last ?? [place, height];
    const [low, high] = [Math.min(from, place), Math.max(from, place)];
    for (let each = Math.ceil(low); each <= Math.floor(high); each++) {
      heights[each] = place === from ? height : began + ((height - began) * (each - from)) / (place - from);
    }
    heights[Math.round(place)] = height;
    drawing.last = [place, height];
    show(svg, heights);
  }

  // The mark stands at the root: the HTML of the sketch is replaced with each answer of a class.
  addEventListener("click", (event) => {
    const { dataset } = document.documentElement;
    if (event.target instanceof Element && event.target.matches(".sb-enlarge")) {
      if (dataset.largeSketch === undefined) dataset.largeSketch = "";
      else delete dataset.largeSketch;
    }
  });
  addEventListener("keydown", (event) => {
    if (event.key === "Escape") delete document.documentElement.dataset.largeSketch;
  });

  addEventListener("pointerdown", (event) => {
    const svg = event.target instanceof Element ? event.target.closest("svg[data-sketch]") : null;
    if (svg === null || event.button !== 0) return;
    event.preventDefault();
    svg.focus({ preventScroll: true });
    drawing = { svg, heights: read(svg), last: null, pointer: event.pointerId };
    svg.setPointerCapture(event.pointerId);
    drawTo(event);
  });
  addEventListener("pointermove", (event) => {
    if (drawing?.pointer === event.pointerId) drawTo(event);
  });
  for (const ending of ["pointerup", "pointercancel"]) {
    addEventListener(ending, (event) => {
      if (drawing?.pointer !== event.pointerId) return;
      const { svg } = drawing;
      drawing = null;
      send(svg);
    });
  }

  // Left and right choose a time, up and down the height there; it is sent when the focus leaves, or with Enter.
  const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
  addEventListener(
    "keydown",
    (event) => {
      const svg = event.target instanceof Element && event.target.matches("svg[data-sketch]") ? event.target : null;
      if (svg === null || event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key === "Enter") {
        event.preventDefault();
        return send(svg);
      }
      const step = STEPS[event.key];
      if (step === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      const heights = read(svg);
      const before = Number.isNaN(heights[column]) ? 0 : heights[column];
      column = Math.min(Math.max(column + step[0], 0), heights.length - 1);
      const there = Number.isNaN(heights[column]) ? before : heights[column];
      heights[column] = Math.min(Math.max(there + step[1], -1), 1);
      show(svg, heights);
    },
    true,
  );
})();
