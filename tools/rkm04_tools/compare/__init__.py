"""`compare`: a logic analyser's capture against the steps of the simulator.

recording, sigrok, vcd, saleae  files to edges        channels  names to motors
simulated                       what should be there  align     which pulse is which, on two clocks
clock, follow                   how clocks run, and what crystals can do
findings                        what differs          report    in words and as JSON
"""
