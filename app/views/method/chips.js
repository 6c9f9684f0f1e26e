// The menu of the edited method's chip (chips.py): Escape, a click elsewhere and what it does close it. Its box renames the
// method when it is left, or on Enter.
(() => {
  function close(menu) {
    const held = menu.contains(document.activeElement);
    menu.open = false;
    if (held) menu.querySelector("summary").focus();
  }

  const opened = () => document.querySelector("details.sb-menu[open]");

  addEventListener("click", ({ target }) => {
    const menu = opened();
    if (menu && (!menu.contains(target) || target.closest("[data-command]"))) close(menu);
  });

  addEventListener("toggle", ({ target }) => target.matches?.(".sb-menu[open]") && target.querySelector("input").select(), true);

  addEventListener("keydown", (event) => {
    const menu = opened();
    if (!menu || !["Enter", "Escape"].includes(event.key)) return;
    const box = event.target.closest?.(".sb-rename");
    if (event.key === "Enter" && !box) return;
    if (box && event.key === "Escape") box.value = box.defaultValue;
    event.preventDefault();
    event.stopPropagation();
    close(menu);
  }, true);

  // Until the server has renamed it, the box says what the method is called.
  addEventListener("change", ({ target: box }) => {
    if (!box.matches?.(".sb-rename") || box.value === box.defaultValue) return;
    window.schuler.command("method-rename", box.value.trim());
    box.value = box.defaultValue;
  });
})();
