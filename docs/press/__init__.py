"""What makes the site out of the pages: `make docs`, that is docs/make_site.py."""
