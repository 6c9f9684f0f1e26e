// A slider plays: a button beside its label drags it from where it stands to its end, in some eight seconds, and every
// picture follows. Escape, a click on the button or a hand on any control stops it.
(() => {
  const TICK_MS = 60;
  const WHOLE_MS = 8000;
  const ROW = '[data-sb-kind="slider"]';
  const button = document.createElement("button");
  button.className = "sb-animate";
  button.type = "button";
  let row = null;
  let drag = null; // what is under way: its timer, and where the hand would be

  const thumb = () => row?.querySelector('[role="slider"]') ?? null;
  const track = () => thumb()?.closest(".mantine-Slider-track, .mantine-Slider-trackContainer") ?? null;

  function hand(kind, x) {
    const box = track().getBoundingClientRect();
    const at = { clientX: x, clientY: box.top + box.height / 2, button: 0, bubbles: true, cancelable: true };
    (kind === "mousedown" ? track() : document).dispatchEvent(new MouseEvent(kind, at));
  }

  function say() {
    const label = row?.querySelector("label")?.textContent ?? "";
    button.textContent = drag ? "\u25a0" : "\u25b6";
    button.ariaLabel = button.title = drag ? `Stop at this value: ${label}` : `Play: ${label}`;
  }

  function stop() {
    clearInterval(drag.timer);
    if (track()) hand("mouseup", drag.x);
    drag = null;
    say();
  }

  function play() {
    const box = track().getBoundingClientRect();
    const place = thumb().getBoundingClientRect();
    const now = place.left + place.width / 2;
    const x = now >= box.right - 2 ? box.left : now;
    const end = Math.ceil(box.right); // a mouse event's place is cut to whole pixels
    const began = performance.now();
    drag = { x, timer: 0 };
    hand("mousedown", x);
    drag.timer = setInterval(() => {
      if (!row.isConnected || !track() || drag.x >= end) return stop();
      drag.x = Math.min(end, x + (box.width * (performance.now() - began)) / WHOLE_MS);
      hand("mousemove", drag.x);
    }, TICK_MS);
    say();
  }

  button.addEventListener("click", () => (drag ? stop() : play()));
  addEventListener("keydown", (event) => drag && event.isTrusted && event.key === "Escape" && stop(), true);
  addEventListener("pointerdown", (event) => drag && event.target !== button && stop(), true);

  function offer(event) {
    const near = event.target.closest?.(ROW);
    if (drag || !near || near === row || thumb()?.ariaDisabled === "true") return;
    row = near;
    row.querySelector("label")?.parentElement?.parentElement?.append(button);
    say();
  }

  addEventListener("pointerover", offer);
  addEventListener("focusin", offer);
})();
