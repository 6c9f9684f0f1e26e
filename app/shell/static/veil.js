// Until the page has its tabs, viser shows its own empty panel and axes: this stands before them.
(() => {
  const LONGEST_MS = 20_000;
  const veil = Object.assign(document.createElement("div"), { id: "sb-veil", textContent: "Schuler Bench is opening …" });
  veil.setAttribute("role", "status");
  veil.style.cssText = "position:fixed;inset:0;z-index:250;display:grid;place-items:center;background:#fff;color:#52667a;" +
    "font:15px var(--sb-font,sans-serif)";
  // Behind it the 3D view draws in a few pixels: without a GPU each of its first pictures takes a tenth of a second.
  const small = document.createElement("style");
  small.textContent = "[data-dock-root] > * > :has(canvas) { width: 16px !important; height: 16px !important; }";
  document.documentElement.append(small, veil);
  const timer = setInterval(() => {
    // Where one view is to stand alone, alone.js removes it.
    const opened = document.querySelector('[role="tab"]') !== null && !window.schuler?.alone;
    if (!opened && performance.now() < LONGEST_MS) return;
    clearInterval(timer);
    veil.remove();
    small.remove();
  }, 50);
})();
