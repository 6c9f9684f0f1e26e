// viser's widgets, as our scripts handle them: comes before all others that do.
(() => {
  const setter = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set;

  const AFTER_INPUT_MS = 300;
  let moved = -Infinity;

  for (const kind of ["pointerdown", "pointermove", "keydown", "wheel"]) {
    addEventListener(kind, (event) => (kind !== "pointermove" || event.buttons) && (moved = performance.now()), true);
  }

  const looks = [];

  function lookAll() {
    for (const look of looks) {
      try {
        look();
      } catch (error) {
        reportError(error); // one that fails does not keep the others from looking
      }
    }
  }

  new MutationObserver(lookAll).observe(document.documentElement, { childList: true, subtree: true });
  addEventListener("filled", lookAll); // texts and attributes alone (app/bridge/fill.js)

  Object.assign(window.schuler, {
    // Call `look` whenever elements of the page have been changed, before they are painted. What the server has to say to
    // our scripts comes in hidden elements.
    changed: (look) => looks.push(look),

    // Whether the user is just moving something: whatever we write then may displace their value.
    busy: () => performance.now() - moved < AFTER_INPUT_MS,

    // The text box with this label, null while there is none.
    box(label) {
      for (const found of document.getElementsByTagName("label")) {
        if (found.textContent === label) return found.closest(".mantine-Flex-root")?.querySelector("input") ?? null;
      }
      return null;
    },

    // Write into a text box as if it were typed; the same text again would be no change.
    write(input, text) {
      setter.call(input, input.value === text ? `${text} ` : text);
      input.dispatchEvent(new Event("input", { bubbles: true }));
    },

    // viser's tabs react to a pointer's whole way, or to a key; a click alone does nothing.
    open(tab) {
      if (!tab || tab.getAttribute("aria-selected") === "true") return;
      const pressed = { key: "Enter", bubbles: true, cancelable: true };
      tab.dispatchEvent(new KeyboardEvent("keydown", pressed));
      tab.dispatchEvent(new KeyboardEvent("keyup", pressed)); // page.js reports the tabs in front after it
    },

    // Of several tabs of one panel the last one stays in front.
    foremost: (tabs) => [...new Map(tabs.filter(Boolean).map((tab) => [tab.closest('[role="tablist"]'), tab])).values()],
  });
})();
