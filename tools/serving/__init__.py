"""Many visitors on one server (`make soak`), and the table of docs/serving.md (`make serving`)."""
