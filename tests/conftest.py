"""Settings of the whole suite: hypothesis draws the same examples every time and leaves no files behind."""

from hypothesis import settings

settings.register_profile("suite", max_examples=40, deadline=None, derandomize=True, database=None)
settings.load_profile("suite")
