(A shallow bowl: grooves along X side by side, each an arc in the plane of X and Z)
G21 G90
G0 X10 Y10 Z1
G1 Z0 F200
G18
G2 X50 R120 F800
G0 Z1
Y15
G1 X10 Z0 F800
G2 X50 R75
G1 Y20
G3 X10 R60
G1 Y25
G2 X50 R55
G1 Y30
G3 X10 R60
G1 Y35
G2 X50 R75
G1 Y40
G3 X10 R120
G19 G0 Z1
G1 X30 Y45 Z0
G2 Y5 Z0 R60                (one across them, in the plane of Y and Z)
G0 Z2
M30
