"""`bench`: the figures of the GVE134 beside their goals, of the host build and of the image."""
