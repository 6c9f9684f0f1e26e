"""app: the dashboard and the command ``schuler``, on top of `navcore`."""
