"""The command-line tools of the RKM04 unit; `tools/rkm04 --help` lists what they do.

A command reads program files (`source`), has them parsed by the firmware itself (`host`), looks for
what is surely not meant (`flow`, `lint`), runs them on the simulated unit (`sim`) and draws what
happened (`plot`). It talks to units over a line: `line` is the library for that, `client`
has the commands. `cli` is the entry.
"""
