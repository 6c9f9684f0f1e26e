// Says once more where a slider that the user has moved stands: viser's page sends a value in 30 ms, whichever control it
// comes from, and drops what comes between. What the page shows holds; the server shows nothing over it.
(() => {
  const REST_MS = 300;
  let moved = null; // { slider, from }: the one in hand, and where it stood
  let rest = 0;

  const under = (event) => (event.target instanceof Element ? event.target.closest(".mantine-Slider-root") : null);
  const stands = (slider) => slider.querySelector("[role=slider]")?.getAttribute("aria-valuenow");

  function tell() {
    clearTimeout(rest);
    const { slider, from } = moved;
    moved = null;
    const now = stands(slider);
    if (slider.id && now && now !== from) window.schuler.tell(slider.id, Number(now));
  }

  function heed(event) {
    const slider = under(event);
    if (moved && moved.slider !== slider) tell(); // before what the user does next
    if (!slider) return;
    moved ??= { slider, from: stands(slider) };
    wait();
  }

  function wait() {
    clearTimeout(rest);
    rest = setTimeout(tell, REST_MS);
  }

  for (const kind of ["pointerdown", "keydown"]) addEventListener(kind, heed, true);
  for (const kind of ["pointermove", "pointerup"]) addEventListener(kind, () => moved && wait(), true);
})();
