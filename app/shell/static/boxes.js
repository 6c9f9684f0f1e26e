// Number boxes by wheel, double click and unit. The arrow keys step a box by themselves; the wheel does the same over the
// box that has the focus. A double click on a control's name takes the field back to how the scenario was opened. A letter
// or a space behind typed digits opens a line for the unit: "30 min" (app/shell/palette.py reads it).
(() => {
  const BOX = ".mantine-NumberInput-input";
  const UNIT = /^[smhdknarguµ° ]$/i;
  let typed = null; // the box into which digits are being typed
  let before = ""; // what it held before them

  // The control in whose row something is: the server knows it by its id, whatever the page calls it.
  const labelOf = (inside) => inside.closest(".mantine-Flex-root")?.querySelector("label");

  addEventListener(
    "wheel",
    (event) => {
      const box = event.target instanceof Element && event.target.closest(BOX);
      if (!box || box !== document.activeElement || event.deltaY === 0) return;
      event.preventDefault();
      const key = event.deltaY < 0 ? "ArrowUp" : "ArrowDown";
      box.dispatchEvent(new KeyboardEvent("keydown", { key, code: key, bubbles: true, cancelable: true }));
    },
    { passive: false, capture: true },
  );

  addEventListener("dblclick", (event) => {
    const label = event.target instanceof Element && event.target.closest("label, .mantine-Slider-root");
    if (label && label.closest(".mantine-Flex-root")) window.schuler.command("reset-named", labelOf(label)?.htmlFor ?? "");
  });

  // ------------------------------------------------------------ units

  addEventListener("focusin", () => (typed = null));
  addEventListener("beforeinput", ({ target }) => target.matches?.(BOX) && typed !== target && (before = target.value), true);
  addEventListener("input", (event) => event.target.matches?.(BOX) && event.isTrusted && (typed = event.target), true);
  addEventListener("keydown", ({ key }) => /^(Arrow(Up|Down)|Enter)$/.test(key) && (typed = null), true);

  // Whether a unit may still follow what is being typed into a control: its value waits (socket.js).
  window.schuler.typing = (control) => typed?.id === control && /\(.+\)/.test(labelOf(typed)?.textContent ?? "");

  // Before the keys of commands.js, which listens on the document's element.
  addEventListener(
    "keydown",
    (event) => {
      const box = event.target;
      if (box !== typed || event.ctrlKey || event.metaKey || event.altKey || !UNIT.test(event.key)) return;
      event.preventDefault();
      event.stopPropagation();
      const text = `${box.value} ${event.key.trim()}`;
      takeBack(box);
      ask(box, text);
    },
    true,
  );

  addEventListener(
    "paste",
    (event) => {
      const box = event.target instanceof Element && event.target.closest(BOX);
      const text = event.clipboardData?.getData("text").trim() ?? "";
      if (!box || text === "" || Number.isFinite(Number(text))) return;
      event.preventDefault();
      event.stopPropagation();
      ask(box, text);
    },
    true,
  );

  // A number whose unit comes is no value yet: until it is complete the box keeps what it held.
  function takeBack(box) {
    typed = null;
    window.schuler.forget(box.id);
    if (box.value !== before) window.schuler.write(box, before);
  }

  function ask(box, text) {
    const label = labelOf(box);
    const at = box.getBoundingClientRect();
    const line = document.createElement("input");
    line.className = "sb-unit";
    line.value = text;
    line.setAttribute("aria-label", `${label?.textContent ?? ""}: value with its unit, Enter takes it over`);
    line.style.cssText = `position:fixed;z-index:400;left:${at.left}px;top:${at.top}px;width:${Math.max(at.width, 96)}px;` +
      `height:${at.height}px;box-sizing:border-box;padding:0 6px;border:2px solid #1c7ed6;border-radius:4px;font:12px var(--sb-font)`;
    let open = true; // taking it off the page is a blur, too
    const close = () => {
      if (open) {
        open = false;
        line.remove();
      }
    };
    line.addEventListener("keydown", (event) => {
      if (event.key === "Enter") window.schuler.command("typed", label?.htmlFor ?? "", "\t", line.value);
      else if (event.key !== "Escape") return;
      event.stopPropagation();
      close();
      box.focus();
    });
    line.addEventListener("blur", close);
    document.body.append(line);
    line.focus();
    line.setSelectionRange(text.length, text.length);
  }
})();
