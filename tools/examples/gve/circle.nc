(A circle of 40 mm, a half and two quarters, cut in one go)
G21 G90 G17
G0 X10 Y30 Z2
G1 Z-1 F200
G2 X50 Y30 I20 J0 F1200     (half a turn, by its centre)
G2 X30 Y10 R20              (a quarter, by its radius)
G2 X10 Y30 R20
G0 Z2
M30
