"""The service page of the GVE134 unit: what is behind it.

`command` is the entry, `app` answers HTTP, `desk` takes what browsers ask for (`orders`). `files`
reads vector files and G-code, and makes their course (`course`). One thread, `worker`, owns the
line: it uses the client of the other commands, sends a file by its `Sender`, and looks at the unit
(`looking`) between two commands. `heard` tells what follows from what was sent.
"""
