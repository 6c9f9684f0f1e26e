// Folds of the left column: viser's folders, of which those are open that hold something of a newly opened scenario
// (app/shell/left.py). viser lets a pointer open them; here a key does so, too, and a screen reader hears which are open.
(() => {
  const OPEN = ".tabler-icon-chevron-up"; // leans on viser's icons, as pinned
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

  const isOpen = (head) => head.querySelector(OPEN) !== null;

  function mark() {
    for (const [title, head] of heads()) {
      const open = String(isOpen(head));
      if (head.getAttribute("aria-expanded") === open) continue;
      head.parentElement.dataset.sbFold = title;
      head.setAttribute("role", "button");
      head.setAttribute("tabindex", "0");
      head.setAttribute("aria-expanded", open);
    }
    const wanted = document.getElementById("sb-folds")?.dataset;
    if (wanted === undefined || wanted.count === shown) return;
    const all = heads();
    if (all.size < folds().length) return;
    shown = wanted.count;
    const open = JSON.parse(wanted.open);
    for (const [title, head] of all) if (isOpen(head) !== open.includes(title)) head.click();
  }

  addEventListener("keydown", (event) => {
    const head = event.target instanceof Element && event.target.closest("[data-sb-fold] > [aria-expanded]");
    if (head !== event.target || !["Enter", " "].includes(event.key)) return;
    event.preventDefault();
    head.click();
  });

  window.schuler.changed(mark);

  // Open the fold of a view.
  window.schuler.unfold = (title) => {
    const head = heads().get(title);
    if (head === undefined) return;
    if (!isOpen(head)) head.click();
    requestAnimationFrame(() => head.scrollIntoView({ block: "nearest" })); // its tab may only now be in front
  };
})();
