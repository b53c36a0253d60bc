"""Files: archives, checkpoints, writing whole or not at all; what a long run tells."""
