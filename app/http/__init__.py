"""What the viser server is wrapped in: address, access rules, session path, checked messages, stop.

`app.http.server.start` is the one entry; it is not imported here, so that a refused address costs no viser
import.
"""
