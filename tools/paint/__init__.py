"""Time from a change on the page to its last paint in Chromium (`make paint`)."""
