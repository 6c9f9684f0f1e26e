// Draws the curves of a plot over time for what they cost without a graphics card, which is most of what a picture costs.
// As three hairlines beside each other in the place of one wide line: a noisy curve of 1.5 or 2 pixels costs four times as
// much as its three hairlines, for six plots 40 ms a picture. The hairlines stand in a triangle, so that a line is as wide
// in every direction. And a curve that stands still (paths.js) as a picture of it, once it has been drawn twice.
// Lines that are wider, as on a screen with small pixels, or translucent stay as they are.
(() => {
  const WIDEST = 2.2;
  const CORNERS = [0, 120, 240].map((degrees) => [Math.sin((degrees * Math.PI) / 180), -Math.cos((degrees * Math.PI) / 180)]);
  const STYLE = ["strokeStyle", "lineWidth", "lineCap", "lineJoin", "miterLimit", "lineDashOffset"];
  const { stroke } = CanvasRenderingContext2D.prototype;
  const drawn = new WeakMap(); // paths: how each was drawn last, and its picture

  const isCurve = (context, path) =>
    path instanceof Path2D && context.lineWidth > 1 && context.lineWidth <= WIDEST && context.globalAlpha === 1 &&
    String(context.strokeStyle).startsWith("#") && context.canvas.parentElement?.className === "u-wrap";

  function hairlines(context, path) {
    const width = context.lineWidth;
    const away = (width - 1) / 1.35;
    context.lineWidth = 1;
    for (const [x, y] of CORNERS) {
      context.translate(away * x, away * y);
      context.stroke(path);
      context.translate(-away * x, -away * y);
    }
    context.lineWidth = width;
  }

  function picture(context, path, way) {
    const own = new OffscreenCanvas(context.canvas.width, context.canvas.height).getContext("2d");
    for (const name of STYLE) own[name] = context[name];
    own.setLineDash(context.getLineDash());
    own.setTransform(way);
    hairlines(own, path);
    return own.canvas.transferToImageBitmap();
  }

  CanvasRenderingContext2D.prototype.stroke = function (...path) {
    const [curve] = path;
    if (!isCurve(this, curve)) return stroke.apply(this, path);
    const way = this.getTransform();
    const { width, height } = this.canvas;
    const how = [way, this.getLineDash(), width, height, ...STYLE.map((name) => this[name])].join(" ");
    const had = drawn.get(curve);
    if (had?.how !== how) {
      drawn.set(curve, { how });
      return hairlines(this, curve);
    }
    had.image ??= picture(this, curve, way);
    this.resetTransform();
    this.drawImage(had.image, 0, 0);
    this.setTransform(way);
  };
})();
