(Reference runs, Z first; then to a place that counts from the switches)
G21 G90
G28
G0 X20 Y10
G1 Z-5 F300
X40 F900
G0 Z0
M30
