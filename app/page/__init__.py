"""One open page: its widgets' arrangement, commands, notices, and what it is told."""
