"""The service page of the positioning unit: what is behind it.

`command` is the entry, `app` answers HTTP, `desk` takes what browsers ask for (`orders`). One
thread, `worker`, owns the line: it does what is asked for (`acting`) by the client of the other
commands, stops axes (`stopping`) and looks at the unit in between (`looking`).
"""
