"""The doors of the viser server: address, access rules, session path, checked messages, stop.

`schuler_bench.http.server.start` is the one entry; it is not imported here, so that a refused address
costs no viser import.
"""
