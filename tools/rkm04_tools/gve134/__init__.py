"""The command `tools/gve134`: the same for the GVE134 unit as `tools/rkm04` for the RKM04."""
