// Parts of the scenario by the clipboard, as TOML: a method, the log's events (app/shell/palette.py); the equations of a method
// as LaTeX and as text (app/views/method/taking.py). What is copied stands
// in a dialog, from which it can be copied again: a page that came over http may not write to the clipboard by itself.
// Ctrl+V takes such a text anywhere but in a text box.
(() => {
  const PART = /^\s*\[\[?\s*(method|reference\.(event|outage))\s*\]/m;
  const { act, command, dialog, element } = window.schuler;
  const LONGEST = 9000; // app/shell/commands.py: LONGEST_TEXT

  function area(text, label, attributes) {
    const made = element("textarea", "", { rows: "14", spellcheck: "false", "aria-label": label, ...attributes });
    made.value = text;
    return made;
  }

  function row(...content) {
    const made = element("p", "");
    made.append(...content);
    return made;
  }

  function copied(text, title, kind, told) {
    const shown = area(text, kind, { readonly: "" });
    const again = element("button", "Copy", { class: "sb-do" });
    const done = element("span", "", { role: "status" });
    async function write() {
      shown.select();
      await window.schuler.copy(text);
      done.textContent = " Copied.";
    }
    again.addEventListener("click", write);
    dialog(title, ...(told ? [element("p", told)] : []), shown, row(again, done));
    // A browser that asks for a click first gets it from the button.
    write().catch(() => (done.textContent = ""));
  }

  function take(text) {
    if (text.length <= LONGEST) command("paste-text", text);
    else dialog("Not pasted", element("p", `The text has ${text.length} characters; at most ${LONGEST} are taken.`));
  }

  function ask() {
    const box = area("", "TOML to paste");
    const use = element("button", "Paste", { class: "sb-do" });
    const told = "One or more blocks [[method]] are added behind the method that is edited; blocks [[reference.event]] and " +
      "[[reference.outage]] take the place of the log's own.";
    const shown = dialog("Paste a method, or the log's events", element("p", told), box, row(use));
    use.addEventListener("click", () => {
      shown.close();
      if (box.value.trim()) take(box.value);
    });
    box.focus();
  }

  const elsewhere = "Paste it into the page of another session with Ctrl+V, or into a scenario file.";
  act("copy", (text) => copied(text, "Copied as TOML", "TOML", elsewhere));
  act("copy-latex", (text) => copied(text, "Copied as LaTeX", "LaTeX"));
  act("copy-plain", (text) => copied(text, "Copied as text", "equations"));
  act("paste", ask);

  addEventListener("paste", (event) => {
    const text = event.clipboardData?.getData("text") ?? "";
    const typed = event.target instanceof Element && event.target.closest("input, textarea, [contenteditable], dialog");
    if (typed || !PART.test(text)) return;
    event.preventDefault();
    take(text);
  });
})();
