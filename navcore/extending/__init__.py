"""Methods from outside the program: registering a class, and the packages and files that bring some.

A class is added by `navcore.register`, wherever it is defined: in a package with the entry point group
``schuler_bench.methods``, in a file named by ``--plugin`` or ``SCHULER_PLUGINS``, or in a notebook's cell.
`register` says what can be added and checks it, `plugins` loads packages and files, `baggage` takes what was
added along to another process.
"""
