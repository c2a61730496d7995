"""`bench`: the figures of the positioning unit, of this machine and of the image of a board."""
