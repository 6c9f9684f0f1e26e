// The map where there is no WebGL: what the 3D view holds, drawn flat, north up. Leans on viser's handles of its scene,
// as pinned: tests/browser/test_page_details.py looks at the result.
(() => {
  const PERIOD_MS = 200;
  const [HALF, NORTH, SOUTH] = [5, 5.9, -6.9]; // of the sea, of the arrow to the north, of the scale bar: scene units
  const [LATITUDE_PX, RIGHT_PX] = [66, 14];
  const ORDER = ["/map/", "/track/", "/trail/", "/error/"];
  const SHIP = [[0, 9], [3.5, 3], [3.5, -8], [-3.5, -8], [-3.5, 3]]; // px
  const HEADING = [[0, 9], [0, 24]];
  const SVG = "http://www.w3.org/2000/svg";
  let before = [];

  const make = (name, attributes, text = "") => {
    const made = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    return made;
  };
  const rgb = ([red, green, blue]) => `rgb(${red} ${green} ${blue})`;
  const path = (places) => places.map(([x, y], k) => `${k % 2 ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");

  function draw(width, height, tree, poses) {
    const across = width - LATITUDE_PX - RIGHT_PX;
    const scale = Math.min(across / (2 * HALF), height / (NORTH - SOUTH));
    const [left, top] = [LATITUDE_PX + across / 2, (height + scale * (NORTH + SOUTH)) / 2];
    const at = (x, y) => [left + scale * x, top - scale * y];
    const [west, north] = at(-HALF, HALF);
    const side = 2 * HALF * scale;
    const sea = make("rect", { x: west, y: north, width: side, height: side, fill: "#d9e4ee" });

    const line = (name, { points, colors, thickness }) => {
      const places = [];
      for (let k = 0; k < points.length; k += 3) places.push(at(points[k], points[k + 1]));
      const wide = Math.max(1, 36 * thickness);
      return make("path", { d: path(places), fill: "none", stroke: rgb(colors), "stroke-width": wide, "data-line": name });
    };
    const lines = ORDER.flatMap((group) =>
      Object.entries(tree).filter(([name, node]) => name.startsWith(group) && node.message.props.points && node.visibility !== false)
        .map(([name, node]) => line(name, node.message.props)));

    const labels = Object.entries(tree).filter(([name]) => name.startsWith("/map/labels")).map(([name, node]) => {
      const [x, y] = poses[name]?.position ?? [0, 0];
      const beside = x < -HALF && Math.abs(y) <= HALF; // a latitude
      const [px, py] = at(x, y);
      const [anchor, baseline] = [beside ? "end" : "middle", y < -HALF ? "hanging" : "central"];
      const place = { x: px.toFixed(1), y: py.toFixed(1), "text-anchor": anchor, "dominant-baseline": baseline };
      return make("text", place, node.message.props.text);
    });

    // Turned as its bow points on the map.
    const ship = (name, color, opacity) => {
      const pose = poses[name];
      if (!pose || !tree[name]) return [];
      const [w, x, y, z] = pose.wxyz;
      const bearing = (Math.atan2(2 * (x * y - w * z), 1 - 2 * (x * x + z * z)) * 180) / Math.PI;
      const [px, py] = at(...pose.position);
      const outline = (points) => points.map(([a, b]) => `${a},${-b}`).join(" ");
      const whole = make("g", { transform: `translate(${px.toFixed(1)} ${py.toFixed(1)}) rotate(${bearing.toFixed(1)})`, "data-ship": name, opacity });
      whole.append(make("polygon", { points: outline(SHIP), fill: color }));
      whole.append(make("polyline", { points: outline(HEADING), stroke: color, "stroke-width": 1.5 }));
      return [whole];
    };
    const computed = tree["/computed/hull"]?.message.props.color ?? [0, 0, 0];
    return [sea, ...lines, ...labels, ...ship("/computed", rgb(computed), 0.6), ...ship("/ship", "rgb(31 41 51)", 1)];
  }

  setInterval(() => {
    const stage = document.getElementById("sb-stage");
    const tree = window.__viserSceneTree?.getState();
    const poses = window.__viserMutable?.nodePoseData;
    if (stage === null || !tree || !poses) return;
    let box = stage.querySelector(":scope > .sb-flat");
    const flat = Boolean(window.schuler.without3d);
    if (flat && box === null) {
      box = document.createElement("div");
      box.className = "sb-flat";
      box.append(make("svg", { role: "img", "aria-label": window.schuler.say("map of the tracks, north up") }));
      stage.querySelector(":scope > .sb-instruments").after(box);
    }
    if (box === null) return;
    box.hidden = !flat;
    const { clientWidth: width, clientHeight: height } = box;
    if (!flat || width < 2 * LATITUDE_PX || height < LATITUDE_PX) return;
    // Drawn anew when something differs: a node's message is another one then, a pose has other numbers.
    const nodes = Object.entries(tree).filter(([, node]) => node.message);
    const now = [width, height, ...nodes.flatMap(([, node]) => [node.message, node.visibility]),
      ...["/ship", "/computed"].map((name) => `${poses[name]?.position} ${poses[name]?.wxyz}`)];
    if (now.length === before.length && now.every((each, k) => each === before[k])) return;
    before = now;
    const svg = box.firstElementChild;
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.replaceChildren(...draw(width, height, Object.fromEntries(nodes), poses));
  }, PERIOD_MS);
})();
