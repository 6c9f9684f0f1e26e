// The way between page and server. viser's page sends at most one value in 30 ms, whichever control it comes from,
// and drops what comes between: of two controls changed at once one is lost. Here each control keeps its newest value
// until it is sent, and nothing is dropped. viser's websocket lives in a worker, which takes what it is to send as
// messages; the worker is found when viser makes it, and told to connect to the server that the page came from. Leans
// on viser's page, as pinned: app/bridge/program.py puts `schuler.send` into it, and tests/attack/test_viser_insides.py
// looks for the messages to and from the worker.
(() => {
  const PERIOD_MS = 30;
  const Plain = window.Worker;
  // viser takes the whole address of the page but for its query: what follows a # would be no address of a websocket.
  const ADDRESS = `${location.origin.replace("http", "ws")}${location.pathname.replace(/\/$/, "")}`;
  const waiting = new Map(); // by control; the newest is last
  const held = new Map(); // what is being typed, by control: {message, timer}; it waits for its end
  let socket = null;
  let resting = false;

  window.Worker = class extends Plain {
    constructor(...given) {
      super(...given);
      // Before viser's program listens: what our scripts change in a message, it finds changed.
      this.addEventListener("message", ({ data }) => {
        if (data?.type === "connected") window.dispatchEvent(new Event("connected"));
        if (data?.type === "closed") window.dispatchEvent(new Event("disconnected"));
        if (data?.type === "message_batch") window.dispatchEvent(new CustomEvent("arrived", { detail: data.messages }));
      });
    }

    postMessage(data, ...rest) {
      if (data?.type === "set_server") {
        socket = this;
        data = { ...data, server: ADDRESS };
        window.dispatchEvent(new Event("connecting"));
      }
      super.postMessage(data, ...rest);
    }
  };

  const post = (message) => socket?.postMessage({ type: "send", message });

  function flush() {
    resting = waiting.size > 0;
    for (const message of waiting.values()) post(message);
    waiting.clear();
    if (resting) setTimeout(flush, PERIOD_MS);
  }

  // What was being typed in a control is done with.
  function release(control) {
    const { message, timer } = held.get(control) ?? {};
    clearTimeout(timer);
    if (held.delete(control)) enqueue(message);
  }

  function enqueue(message) {
    const control = message.type === "GuiUpdateMessage" ? message.uuid : Symbol();
    waiting.delete(control);
    waiting.set(control, message);
    if (!resting) flush();
  }

  // Enter, another control, or the end of the page: nothing more is typed.
  for (const kind of ["keydown", "focusout", "pointerdown", "pagehide"]) {
    addEventListener(kind, (event) => (kind !== "keydown" || event.key === "Enter") && window.schuler.end());
  }

  window.schuler = {
    // A message of viser's page: of one control's values the newest, at most one in 30 ms, in the order of their changes.
    // A number waits while it is typed: boxes.js says how many ms.
    send(message) {
      const control = message.uuid;
      window.schuler.forget(control);
      const wait = message.type === "GuiUpdateMessage" ? (window.schuler.typing?.(control) ?? 0) : 0;
      if (wait === 0) return enqueue(message);
      held.set(control, { message, timer: wait < Infinity ? setTimeout(() => release(control), wait) : 0 });
    },
    // What is being typed is at its end.
    end: () => [...held.keys()].forEach(release),
    // Whether what is being typed in a control is not at its end.
    holds: (control) => held.has(control),
    // Forget what was being typed in a control.
    forget(control) {
      clearTimeout(held.get(control)?.timer);
      held.delete(control);
    },
    // Give a control a value on the server at once; the page itself goes on showing what it shows.
    tell: (uuid, value) => post({ type: "GuiUpdateMessage", uuid, updates: { value } }),
  };
})();
