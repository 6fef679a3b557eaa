# Filled in with the packaging step.
