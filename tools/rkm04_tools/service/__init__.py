"""The service program: a page in the browser, for this machine only, with a unit behind it.

What the pages of all units share: `hosting` serves one until Ctrl-C, `guard` keeps others out,
`http` answers it, `browsers` are its web sockets, and `virtual` is a line without hardware.

That of RKM04: `command` is the entry. `app` has texts checked (`checking`) and drawn (`curves`) by
HTTP; all that concerns units goes to the `desk` (`orders`). One thread, `worker`, owns the line;
`live` watches it.
"""
