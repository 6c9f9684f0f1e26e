"""Files in: recorded logs, tracks and headings (NMEA 0183, CSV, Parquet, MAT), and what they hold.

`navcore.io.recording.load` reads and joins files, `navcore.checks.file.check_file` says what one holds.
"""
