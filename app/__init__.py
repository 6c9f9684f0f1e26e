"""schuler_bench: the dashboard and the command ``schuler``, on top of `navcore`. Its folder is ``app``."""
