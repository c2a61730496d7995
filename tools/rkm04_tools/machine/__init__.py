"""A machine in one file (.rkm): its format, and the commands that check, compare and send it."""
