"""Files: archives, checkpoints, writing whole or not at all."""
