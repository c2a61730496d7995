"""The service program: a page in the browser, for this machine only, with a unit behind it.

`command` is the entry. `app` answers the page: texts to be checked (`checking`) and drawn
(`curves`) by HTTP, all that concerns units by a web socket (`browsers`, `orders`). One thread,
`worker`, owns the line; `virtual` is the line without hardware, `live` watches it. `guard` keeps
others out.
"""
