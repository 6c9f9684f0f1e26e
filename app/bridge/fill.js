// Puts HTML into an element whose HTML has changed: only what differs from before is put there. Text that is made anew is
// laid out anew, which without a graphics card costs 10 ms for the buttons above the panel alone; a slider step changes
// one number in them. What stays keeps what our scripts made of it, the focus, and the language that it was put into.
(() => {
  const before = new WeakMap(); // elements: their HTML, and once it has changed what was read from it
  const OWN = /^(INPUT|TEXTAREA|SELECT|SCRIPT|STYLE|IFRAME|CANVAS)$/; // what they show is not in their HTML
  let telling = false;

  function read(html) {
    const template = document.createElement("template");
    template.innerHTML = html;
    return template.content;
  }

  // The scripts are told when all that a message changes is in its place.
  function tell() {
    if (telling) return;
    telling = true;
    queueMicrotask(() => {
      telling = false;
      dispatchEvent(new Event("filled"));
    });
  }

  function name(live, had, has) {
    for (const { namespaceURI, name, value } of has.attributes)
      if (had.getAttribute(name) !== value) live.setAttributeNS(namespaceURI, name, value);
    for (const { name } of had.attributes) if (!has.hasAttribute(name)) live.removeAttribute(name);
  }

  function follow(live, had, has) {
    const [lives, hads, nodes] = [live, had, has].map(({ childNodes }) => [...childNodes]);
    if (hads.length !== nodes.length || hads.length !== lives.length) return live.replaceChildren(...nodes.map((node) => document.importNode(node, true)));
    for (const [place, node] of nodes.entries()) exchange(lives[place], hads[place], node);
  }

  // A button that does something else is another one: who has the focus on it would press what was not meant.
  const isSame = (one, other) => one.nodeName === other.nodeName && one.dataset?.command === other.dataset?.command;

  function exchange(live, had, has) {
    if (had.isEqualNode(has)) return;
    if (!isSame(had, has) || !isSame(live, has) || OWN.test(has.nodeName)) live.replaceWith(document.importNode(has, true));
    else if (has instanceof Element) {
      name(live, had, has);
      follow(live, had, has);
    } else live.nodeValue = has.nodeValue;
  }

  Object.assign(window.schuler, {
    fill(element, html) {
      const had = before.get(element);
      if (had === undefined) {
        before.set(element, { html });
        element.innerHTML = html;
        return;
      }
      if (had.html === html) return;
      const nodes = read(html);
      follow(element, had.nodes ?? read(had.html), nodes);
      before.set(element, { html, nodes });
      tell();
    },
  });
})();
