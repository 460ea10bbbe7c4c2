"""The report: its model (the JSON) and the ways it is shown."""
