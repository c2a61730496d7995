"""The command `tools/positioning`: for the positioning unit what `tools/rkm04` is for the RKM04."""
