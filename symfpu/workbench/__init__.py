"""The workbench: a page in the browser on which tori are chosen and looked at."""
