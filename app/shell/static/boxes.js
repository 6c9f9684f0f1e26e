// Boxes for numbers: text boxes, whose text the server reads as a whole or refuses (app/bridge/boxes.py says which, and by
// which step their arrow keys go). What is typed waits for Enter, for the focus to leave, or for a pause behind a plain
// number: "1" may become "1e-3" or "1 min". Escape gives back what the box held. The wheel steps the box that has the
// focus, as the arrow keys do; Shift makes ten steps. A double click on a control's name takes the field back to how the
// scenario was opened.
(() => {
  const PAUSE_MS = 1000;
  const PIECE_MS = 300; // behind what came in one piece: pasted, or dropped
  const PLAIN = /^\s*[-+\u2212]?(\d+(\.\d+)?|\.\d+)(e[-+]?\d+)?\s*$/i;
  let text = "{}"; // of the element that says which boxes hold numbers
  let steps = {};
  let typed = null; // the box into which something is being typed
  let before = ""; // what it held before
  let piece = false; // what was typed last came in one piece

  const isBox = (element) => element instanceof HTMLInputElement && steps[element.id] !== undefined;

  // The control in whose row something is: the server knows it by its id, whatever the page calls it.
  const labelOf = (inside) => inside.closest(".mantine-Flex-root")?.querySelector("label");

  // Step of a control's box; 0 for one with several numbers, undefined for what is no box for numbers.
  window.schuler.numberBox = (control) => steps[control];

  // viser's text box has an id of its own, so that its label names nothing: it is given the control's. The rest is what a
  // phone, a browser's spelling or translation would otherwise make of a number.
  function dress(label) {
    const box = label.closest(".mantine-Flex-root")?.querySelector("input");
    if (!box || box.id === label.htmlFor) return;
    box.id = label.htmlFor;
    const inputmode = steps[box.id] > 0 ? "decimal" : "text";
    const wanted = { "data-sb-number": "", inputmode, autocomplete: "off", autocapitalize: "off", spellcheck: "false", translate: "no" };
    for (const [name, value] of Object.entries(wanted)) box.setAttribute(name, value);
  }

  window.schuler.changed(() => {
    const told = document.getElementById("sb-numbers")?.dataset.boxes ?? "{}";
    const others = told !== text;
    if (others) steps = JSON.parse((text = told));
    for (const label of document.getElementsByTagName("label")) if (steps[label.htmlFor] !== undefined) dress(label);
    if (others) dispatchEvent(new Event("numbers"));
  });

  // ------------------------------------------------------------ typing

  addEventListener("focusin", () => (typed = null));
  addEventListener("beforeinput", ({ target }) => isBox(target) && typed !== target && (before = target.value), true);
  addEventListener(
    "input",
    (event) => {
      if (!isBox(event.target) || !event.isTrusted) return;
      typed = event.target;
      piece = /^insertFrom(Paste|Drop)|^insertReplacement/.test(event.inputType ?? "") || event.data?.length > 1;
    },
    true,
  );

  // How long the text of a control waits for more of it, ms (socket.js).
  window.schuler.typing = (control) => {
    if (typed === null || typed.id !== control) return 0;
    if (piece) return PIECE_MS;
    return steps[control] > 0 && PLAIN.test(typed.value) ? PAUSE_MS : Infinity;
  };

  // What the server has made of the text before does not displace the one that is being typed; Escape brings it.
  addEventListener("arrived", ({ detail }) => {
    for (const { type, uuid, updates } of detail) {
      if (type !== "GuiUpdateMessage" || updates.value === undefined) continue;
      if (typed?.id === uuid && window.schuler.holds(uuid)) {
        before = updates.value;
        delete updates.value;
      } else keepSelected(document.getElementById(uuid), updates.value);
    }
  });

  // A text that arrives takes the selection away: who has selected all of a box replaces all of it, not a part.
  function keepSelected(box, arriving) {
    if (!isBox(box) || box !== document.activeElement || box.value === arriving) return;
    if (box.selectionEnd === 0 || box.selectionStart !== 0 || box.selectionEnd !== box.value.length) return;
    const again = (frames) => {
      if (typed === box || box !== document.activeElement) return;
      if (box.value === arriving) box.select();
      else if (frames) requestAnimationFrame(() => again(frames - 1));
    };
    again(30);
  }

  addEventListener(
    "keydown",
    (event) => {
      const box = event.target;
      if (!isBox(box)) return;
      if (event.key === "Enter") typed = null;
      else if (event.key === "Escape") takeBack(box);
      else if (/^Arrow(Up|Down)$/.test(event.key) && !event.ctrlKey && !event.metaKey && !event.altKey && steps[box.id] > 0) {
        event.preventDefault();
        step(box, (event.key === "ArrowUp" ? 1 : -1) * (event.shiftKey ? 10 : 1));
      }
    },
    true,
  );

  // What has not been sent yet is forgotten; what a pause has sent is taken back.
  function takeBack(box) {
    if (typed !== box) return;
    typed = null;
    window.schuler.forget(box.id);
    if (box.value !== before) window.schuler.write(box, before);
  }

  // ------------------------------------------------------------ stepping

  const decimals = (number) => {
    const [, digits = "", power = "0"] = /^-?\d+\.?(\d*)(?:e([-+]\d+))?$/.exec(String(number)) ?? [];
    return Math.max(0, digits.length - Number(power));
  };

  function step(box, count) {
    if (box.disabled || !PLAIN.test(box.value)) return;
    const value = Number(box.value.replace("\u2212", "-"));
    const size = steps[box.id];
    const exact = Math.min(Math.max(decimals(value), decimals(size)), 100);
    typed = null;
    window.schuler.write(box, String(Number((value + count * size).toFixed(exact))));
  }

  addEventListener(
    "wheel",
    (event) => {
      const box = event.target instanceof Element && event.target.closest("input");
      if (!isBox(box) || box !== document.activeElement || event.deltaY === 0 || !(steps[box.id] > 0)) return;
      event.preventDefault();
      step(box, (event.deltaY < 0 ? 1 : -1) * (event.shiftKey ? 10 : 1));
    },
    { passive: false, capture: true },
  );

  addEventListener("dblclick", (event) => {
    const label = event.target instanceof Element && event.target.closest("label, .mantine-Slider-root");
    if (label && label.closest(".mantine-Flex-root")) window.schuler.command("reset-named", labelOf(label)?.htmlFor ?? "");
  });
})();
