// viser calls every file that has arrived "uploaded successfully", also one that cannot be used: whether it can is said
// by the notification that follows.
(() => {
  const THEIRS = "File uploaded successfully.";
  const OURS = "The file has arrived and is being read.";

  function reword() {
    for (const text of document.querySelectorAll(".mantine-Notification-description")) {
      if (text.textContent === THEIRS) text.textContent = OURS;
    }
  }

  const started = setInterval(() => {
    const places = document.querySelectorAll(".mantine-Notifications-root");
    if (places.length === 0) return;
    clearInterval(started);
    const watch = new MutationObserver(reword);
    for (const place of places) watch.observe(place, { childList: true, subtree: true, characterData: true });
  }, 200);
})();
