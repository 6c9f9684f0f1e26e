// The map where there is no WebGL: what the 3D view holds, drawn flat, north up. Leans on viser's handles of its scene,
// as pinned: tests/browser/test_page_details.py looks at the result.
(() => {
  const PERIOD_MS = 200;
  const [LATITUDE_PX, RIGHT_PX] = [66, 14];
  const BEYOND = 0.4; // scene units beyond the northernmost and the southernmost label
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
    const words = Object.entries(tree).filter(([name]) => name.startsWith("/map/labels"))
      .map(([name, node]) => [node.message.props.text, ...(poses[name]?.position ?? [0, 0])]);
    const half = Math.max(...Object.values(tree["/map/sea"].message.props.vertices));
    const ends = words.map(([, , y]) => y).concat(half, -half);
    const [north, south] = [Math.max(...ends) + BEYOND, Math.min(...ends) - BEYOND];
    const across = width - LATITUDE_PX - RIGHT_PX;
    const scale = Math.min(across / (2 * half), height / (north - south));
    const [left, top] = [LATITUDE_PX + across / 2, (height + scale * (north + south)) / 2];
    const at = (x, y) => [left + scale * x, top - scale * y];
    const [x, y] = at(-half, half);
    const side = 2 * half * scale;
    const sea = make("rect", { x, y, width: side, height: side, fill: "#d9e4ee" });

    const line = (name, { points, colors, thickness }) => {
      const places = [];
      for (let k = 0; k < points.length; k += 3) places.push(at(points[k], points[k + 1]));
      const wide = Math.max(1, 36 * thickness);
      return make("path", { d: path(places), fill: "none", stroke: rgb(colors), "stroke-width": wide, "data-line": name });
    };
    const lines = ORDER.flatMap((group) =>
      Object.entries(tree).filter(([name, node]) => name.startsWith(group) && node.message.props.points && node.visibility !== false)
        .map(([name, node]) => line(name, node.message.props)));

    const labels = words.map(([text, x, y]) => {
      const beside = x < -half && Math.abs(y) <= half; // a latitude
      const [px, py] = at(x, y);
      const [anchor, baseline] = [beside ? "end" : "middle", y < -half ? "hanging" : "central"];
      const place = { x: px.toFixed(1), y: py.toFixed(1), "text-anchor": anchor, "dominant-baseline": baseline };
      return make("text", place, text);
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
    const flat = Boolean(window.schuler.without3d);
    if (!flat && before.length === 0) return;
    const stage = document.getElementById("sb-stage");
    const tree = window.__viserSceneTree?.getState();
    const poses = window.__viserMutable?.nodePoseData;
    if (stage === null || !tree?.["/map/sea"] || !poses) return;
    let box = stage.querySelector(":scope > .sb-flat");
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
