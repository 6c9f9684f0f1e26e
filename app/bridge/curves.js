// The server does not send again the curves that the page has of a plot over time (app/bridge/mends.py): null stands in
// their place. Here the page's own curves are put there, before viser's program sees the messages.
(() => {
  const kept = new Map(); // curves by plot

  // A curve's own numbers: as it comes, it is a window on the whole batch of messages, which would be kept with it.
  const whole = (had, data) => data.map((curve, place) => curve?.slice() ?? had[place]);

  function take(message) {
    const plot = message.uuid;
    if (message.type === "GuiUplotMessage") kept.set(plot, (message.props.data = whole([], message.props.data)));
    else if (message.type === "GuiRemoveMessage") kept.delete(plot);
    else if (message.type === "GuiUpdateMessage" && message.updates.data !== undefined && kept.has(plot))
      kept.set(plot, (message.updates.data = whole(kept.get(plot), message.updates.data)));
  }

  // Both from socket.js. The server keeps nothing of a connection that was lost.
  addEventListener("connected", () => kept.clear());
  addEventListener("arrived", ({ detail }) => detail.forEach(take));
})();
