"""G-code: programs become vector files.

The doors for other parts of the tools: `axes.read_mill` reads a machine file, `reading.lines_of` a
program, `turning.turn_file` turns it, `directives.directive_of` tells what a vector file asks of
the host, `preview.Preview` how long it takes.
"""
