// The start card, the guided tour and the galleries of scenarios and networks; what they say comes from #sb-start and
// #sb-gallery (app/views/start/view.py). The card greets a new session once in a browser; `?start=no` leaves it out.
(() => {
  const KEY = "sb-start";
  const { element, dialog, act } = window.schuler;
  const source = () => document.getElementById("sb-start");
  const asked = window.schuler.alone ? "no" : new URLSearchParams(location.search).get("start");

  // A browser may refuse storage: then the card comes again with the next new session.
  const remembered = () => {
    try {
      return localStorage.getItem(KEY) === "closed";
    } catch {
      return false;
    }
  };
  const remember = () => {
    try {
      localStorage.setItem(KEY, "closed");
    } catch {
      // as said above
    }
  };

  function button(text, run, attributes = {}) {
    const made = element("button", text, { type: "button", class: "sb-do", ...attributes });
    made.addEventListener("click", run);
    return made;
  }

  // ------------------------------------------------------------ the card

  function showCard() {
    const doors = [...(source()?.querySelectorAll(".sb-door") ?? [])].map((door) => door.cloneNode(true));
    const holder = element("div", "", { class: "sb-doors" });
    holder.append(...doors);
    const more = element("p", "", { class: "sb-more" });
    more.append(
      button("Guided tour, six steps", () => (made.close(), showStep(0))),
      button("Choose a scenario", () => made.close(), { "data-command": "scenarios" }),
    );
    const told = "Judge the damping of an inertial navigation system: the networks, their parameters, and when to switch.";
    const made = dialog("Schuler Bench", element("p", told), holder, more);
    made.classList.add("sb-broad");
    made.addEventListener("close", remember);
    closing(made);
  }

  // What is chosen in a dialog closes it.
  const closing = (made) =>
    made.addEventListener("click", (event) => event.target.closest("[data-command]") && setTimeout(() => made.close()));

  // ------------------------------------------------------------ the menu

  // What is chosen in the menu closes it; a view that has nothing to show now is not offered.
  addEventListener("click", ({ target }) => target.closest?.(".sb-links [data-command]")?.closest("[popover]").hidePopover());
  addEventListener("beforetoggle", ({ target }) => {
    for (const entry of target.querySelectorAll?.('.sb-links [data-command^="tab "]') ?? [])
      entry.hidden = window.schuler.tab(entry.dataset.command.slice(4)) === undefined;
  }, true);

  // ------------------------------------------------------------ galleries

  function showGallery(title, tries = 20) {
    const found = document.getElementById("sb-gallery");
    if (found?.dataset.title !== title) {
      if (tries > 0) setTimeout(() => showGallery(title, tries - 1), 100);
      return;
    }
    const content = element("div", "");
    content.innerHTML = found.innerHTML;
    const made = dialog(found.title, content);
    made.classList.add("sb-broad");
    closing(made);
  }

  // What is entered in a form of a dialog goes to the server as one command.
  addEventListener("submit", (event) => {
    const form = event.target.closest?.("form[data-send]");
    if (!form) return;
    event.preventDefault();
    window.schuler.command(form.dataset.send, JSON.stringify(Object.fromEntries(new FormData(form))));
    form.closest("dialog")?.close();
  });

  // ------------------------------------------------------------ the tour

  const LOST_LOOKS = 4;
  let tour = null;
  let lost = 0; // looks in a row at which what the card speaks of was out of sight

  // A control is found by its label, which the server says in the page's language, as it does the label itself.
  function target(step) {
    const { find } = step.dataset;
    if (find !== "") return [...document.querySelectorAll(find)].find((each) => each.getClientRects().length > 0) ?? null;
    const found = [...document.querySelectorAll("label")].find((each) => each.textContent === step.title);
    return found?.closest(".mantine-Flex-root") ?? null;
  }

  function endTour() {
    tour?.remove();
    tour = null;
    lost = 0;
    document.querySelector(".sb-ring")?.remove();
  }

  function showStep(place) {
    endTour();
    const steps = [...(source()?.querySelectorAll("[data-step]") ?? [])];
    const step = steps[place];
    if (step === undefined) return;
    const { tab } = step.dataset;
    if (tab !== "") window.schuler.show(tab);
    const card = element("section", "", { class: "sb-tour", role: "dialog", "aria-label": "Guided tour", tabindex: "-1" });
    const row = element("p", "", { class: "sb-more" });
    row.append(element("span", `Step ${place + 1} of ${steps.length}`, { class: "sb-said" }));
    if (place > 0) row.append(button("Back", () => showStep(place - 1)));
    if (place + 1 < steps.length) {
      const next = button("Next", () => showStep(place + 1));
      next.classList.add("sb-next");
      row.append(next);
    }
    row.append(button("Close", endTour));
    card.append(...[...steps[place].children].map((part) => part.cloneNode(true)), row);
    card.addEventListener("keydown", (event) => {
      const to = { ArrowRight: place + 1, ArrowLeft: place - 1 }[event.key];
      if (event.key === "Escape") endTour();
      else if (to >= 0 && to < steps.length) showStep(to);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
    const ring = element("div", "", { class: "sb-ring", "aria-hidden": "true" });
    document.body.append(ring, card);
    tour = card;
    follow(card, ring, step);
    (card.querySelector(".sb-next") ?? card.querySelector("button:last-child")).focus();
  }

  // Card and ring stay with what they speak of while the page is laid out.
  function follow(card, ring, step) {
    if (tour !== card) return;
    if (document.querySelector("dialog.sb-dialog[open]") !== null) return endTour();
    const box = target(step)?.getBoundingClientRect();
    const seen = box !== undefined && box.width > 0;
    if (seen) card.dataset.seen = "";
    else if (card.dataset.seen === "" && ++lost > LOST_LOOKS) return endTour(); // another tab has come before it
    if (seen) lost = 0;
    ring.style.display = seen ? "" : "none";
    const { width, height } = card.getBoundingClientRect();
    let [left, top] = [(innerWidth - width) / 2, (innerHeight - height) / 2];
    if (seen) {
      Object.assign(ring.style, {
        left: `${box.left - 4}px`, top: `${box.top - 4}px`, width: `${box.width + 8}px`, height: `${box.height + 8}px`,
      });
      const below = box.bottom + 12 + height <= innerHeight;
      const above = box.top - 12 - height >= 0;
      // What stands in the left column has the controls above and below it.
      const beside = box.left < 40 && box.width < innerWidth / 2 && box.right + 16 + width <= innerWidth;
      if ((below || above) && !beside) {
        const controls = document.querySelector('[data-dock-region="left"]')?.getBoundingClientRect().right ?? 0;
        left = Math.max(box.left, controls + 8);
        top = below ? box.bottom + 12 : box.top - 12 - height;
      } else {
        left = !beside && box.left > width + 24 ? box.left - width - 16 : box.right + 16;
        top = box.top + 24;
      }
    }
    card.style.left = `${Math.round(Math.max(8, Math.min(left, innerWidth - width - 8)))}px`;
    card.style.top = `${Math.round(Math.max(8, Math.min(top, innerHeight - height - 8)))}px`;
    setTimeout(() => follow(card, ring, step), 150);
  }

  act("start", () => source() && showCard());
  act("tour", (place) => showStep(Number(place) || 0));
  act("gallery", showGallery);

  const waiting = setInterval(() => {
    const found = source();
    if (found === null) return;
    clearInterval(waiting);
    if (asked === "no") return;
    if (asked === "yes" || (found.dataset.fresh === "1" && !remembered())) showCard();
  }, 100);
})();
