(A pocket of 40 x 30 mm, 2 mm deep, with a cutter of 6 mm)
G21 G90 G17 G94
T1 M6 (cutter of 6 mm)
S12000 M3
M8
G0 X30 Y25 Z5
G0 Z1
G3 X30 Y25 Z-2 I-3 J0 F300  (down along a helix)
G1 X24 Y22 F900             (from inside to outside)
X36
Y28
X24
Y22
X18 Y16
X42
Y34
X18
Y16
X13 Y13                     (the wall, with round corners)
X45
G3 X47 Y15 R2
G1 Y35
G3 X45 Y37 R2
G1 X15
G3 X13 Y35 R2
G1 Y15
G3 X15 Y13 R2
G1 X20
G0 Z5
M30
