// Boxes in the table of requirements (table.py): what is typed is a limit once the box is left, or on Enter.
(() => {
  const boxOf = (target) => (target instanceof Element ? target.closest(".sb-limit") : null);
  let held = ""; // limit in whose box the caret stands: the box is made anew with its limit

  addEventListener("change", ({ target }) => {
    const box = boxOf(target);
    if (box) window.schuler.command("limit", box.dataset.limit, box.value.trim());
  });

  addEventListener("keydown", (event) => {
    const box = boxOf(event.target);
    if (box && event.key === "Escape") box.value = box.defaultValue;
  });

  // The rows stay where they are while the user goes from box to box.
  addEventListener("focusin", ({ target }) => {
    const box = boxOf(target);
    held = box?.dataset.limit ?? "";
    if (box?.closest(".sb-unasked")) unfold(box.closest("table"), true);
  });
  addEventListener("pointerdown", ({ target }) => boxOf(target) || (held = ""), true);

  window.schuler.changed(() => {
    if (held && document.activeElement === document.body) document.querySelector(`.sb-limit[data-limit="${held}"]`)?.focus();
  });

  function unfold(table, open) {
    table.toggleAttribute("data-open", open);
    table.querySelector(".sb-unfold button").ariaExpanded = String(open);
  }

  addEventListener("click", ({ target }) => {
    const row = target instanceof Element && target.closest(".sb-unfold button")?.closest("table");
    if (row) unfold(row, !row.hasAttribute("data-open"));
  });
})();
