"""Results as tables of pandas and as data sets of xarray."""
