// Folds of the left column: viser's folders, of which those are open that hold something of a newly opened scenario
// (app/shell/left.py). viser forgets which are open when its tab goes behind, and opens them slowly: here they are viser's
// open folders, and what is closed is out of sight by our style. A key opens them, too, and a screen reader hears it.
(() => {
  const HEAD = "[data-sb-fold] > [aria-expanded]";
  const open = new Map(); // title of a view -> whether its fold is open
  let shown = "0";

  const folds = () => JSON.parse(document.getElementById("sb-views")?.dataset.tabs ?? "[]").filter(({ fold }) => fold);

  // The heads of the folds, by the titles of their views.
  function heads() {
    const found = new Map();
    for (const head of document.querySelectorAll('[data-dock-region="left"] .mantine-Paper-root > .mantine-Paper-root:first-child')) {
      const name = window.schuler.english(head.textContent);
      const fold = folds().find(({ mode }) => mode === name);
      if (fold !== undefined) found.set(fold.title, head);
    }
    return found;
  }

  function set(element, name, value) {
    if (element.getAttribute(name) !== value) element.setAttribute(name, value);
  }

  function show() {
    const told = document.getElementById("sb-folds")?.dataset;
    if (told !== undefined && told.count !== shown) {
      shown = told.count;
      const used = JSON.parse(told.open);
      for (const { title } of folds()) open.set(title, used.includes(title));
    }
    for (const [title, head] of heads()) {
      const isOpen = open.get(title) ?? true;
      set(head.parentElement, "data-sb-fold", title);
      head.parentElement.toggleAttribute("data-sb-shut", !isOpen);
      set(head, "role", "button");
      set(head, "tabindex", "0");
      set(head, "aria-expanded", String(isOpen));
    }
  }

  const headOf = ({ target }) => (target instanceof Element ? target.closest(HEAD) : null);

  function turn(event, head) {
    event.preventDefault();
    event.stopPropagation(); // viser's own folder stays open
    const title = head.parentElement.dataset.sbFold;
    open.set(title, !open.get(title));
    show();
  }

  document.documentElement.addEventListener("click", (event) => {
    const head = headOf(event);
    if (head) turn(event, head);
  }, true);
  document.documentElement.addEventListener("keydown", (event) => {
    const head = headOf(event);
    if (head === event.target && ["Enter", " "].includes(event.key)) turn(event, head);
  }, true);

  window.schuler.changed(show);

  // Open the fold of a view.
  window.schuler.unfold = (title) => {
    if (!folds().some((fold) => fold.title === title)) return;
    open.set(title, true);
    show();
    requestAnimationFrame(() => heads().get(title)?.scrollIntoView({ block: "nearest" })); // its tab may only now be in front
  };
})();
