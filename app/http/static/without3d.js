// A page without WebGL. viser's page takes what the server sends only once it has a 3D view: where the browser gives none,
// its canvas gets a context that takes every call and draws nothing, so that controls, plots and tables come. The line
// below the view says so (app/views/scene/playback.js reads `schuler.without3d`), also when a context is lost later on.
(() => {
  const { prototype: canvas } = HTMLCanvasElement;
  const native = canvas.getContext;
  const methods = window.WebGL2RenderingContext?.prototype;
  const INSTEAD = "webgl2";
  const LARGEST = 1024; // of whatever a program may ask for: textures, uniforms, attributes

  const told = (what) => {
    window.schuler.without3d = what;
    window.dispatchEvent(new Event("without3d"));
  };

  function answers(gl, own) {
    const size = () => new Int32Array([0, 0, own.width, own.height]);
    const known = new Map([
      [gl.VERSION, () => "WebGL 2.0"],
      [gl.SHADING_LANGUAGE_VERSION, () => "WebGL GLSL ES 3.00"],
      [gl.VIEWPORT, size],
      [gl.SCISSOR_BOX, size],
      [gl.IMPLEMENTATION_COLOR_READ_TYPE, () => gl.HALF_FLOAT], // what viser's light is read back as
    ]);
    return {
      getParameter: (name) => known.get(name)?.() ?? LARGEST,
      getContextAttributes: () => ({ alpha: true, antialias: false, depth: true, stencil: false }),
      getShaderPrecisionFormat: () => ({ precision: 23, rangeMin: 127, rangeMax: 127 }),
      getExtension: () => null,
      getSupportedExtensions: () => [],
      getShaderParameter: () => true,
      getProgramParameter: (_, name) => (name === gl.LINK_STATUS ? true : 0), // no uniforms, no attributes
      getShaderInfoLog: () => "",
      getProgramInfoLog: () => "",
      getAttribLocation: () => -1,
      getUniformLocation: () => null,
      checkFramebufferStatus: () => gl.FRAMEBUFFER_COMPLETE,
      clientWaitSync: () => gl.ALREADY_SIGNALED,
      getError: () => gl.NO_ERROR,
      isContextLost: () => false,
      fenceSync: () => ({}),
    };
  }

  function nothing(own) {
    const gl = new Proxy({ canvas: own }, {
      get(kept, name) {
        if (name in kept) return kept[name];
        if (name === "drawingBufferWidth") return own.width;
        if (name === "drawingBufferHeight") return own.height;
        const { value } = Object.getOwnPropertyDescriptor(methods, name) ?? {};
        return typeof value === "function" ? () => (name.startsWith("create") ? {} : undefined) : value;
      },
    });
    return Object.assign(gl, answers(gl, own));
  }

  // Whether the browser has none at all: a canvas that is drawn on otherwise gets none either.
  let missing;
  const isMissing = () => (missing ??= native.call(document.createElement("canvas"), INSTEAD) === null);
  const given = new WeakMap();

  canvas.getContext = function (kind, ...rest) {
    const found = native.call(this, kind, ...rest);
    if (found !== null || kind !== INSTEAD || methods === undefined || !isMissing()) return found;
    if (!window.schuler.without3d) told("missing");
    if (!given.has(this)) given.set(this, nothing(this));
    return given.get(this);
  };

  // Neither bubbles.
  addEventListener("webglcontextlost", () => told("lost"), true);
  addEventListener("webglcontextrestored", () => told(""), true);
})();
